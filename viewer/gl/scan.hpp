// SPDX-License-Identifier: Apache-2.0
// Exclusive prefix sums on the display's device.
#pragma once

#include "viewer/gl/objects.hpp"

#include <cstddef>
#include <deque>

namespace cadt::viewer::gl {

/// One group of work-items for each `size` elements. Along x at most 32,768, the others along y: shaders number them
/// gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x.
void dispatch_for(std::size_t elements, std::size_t size);
/// What shaders wrote before is seen by shaders, copies and reads after.
void wait_for_writes();

class Scan {
 public:
  /// \throws DisplayError
  Scan();
  /// Replaces each of `count` words by the sum of those before it, and word `count` by the sum of all.
  /// \pre room for count + 1 words, whose sum is below 2^32. Changes bindings 0 and 1
  void exclusive(const Buffer& words, std::size_t count);

 private:
  void level(const Buffer& words, std::size_t count, std::size_t depth);
  Program program_;
  std::deque<Buffer> sums_;  ///< of the groups of each level; elements stay where they are
};

}  // namespace cadt::viewer::gl
