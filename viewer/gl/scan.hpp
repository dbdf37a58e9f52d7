// SPDX-License-Identifier: Apache-2.0
// Exclusive prefix sums on the display's device.
#pragma once

#include "viewer/gl/objects.hpp"

#include <cstddef>
#include <deque>

namespace cadt::viewer::gl {

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
