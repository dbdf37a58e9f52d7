// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewer/gl/objects.hpp"

#include <cstddef>
#include <cstdint>

namespace cadt::viewer::gl {

/// Fills large buffers. NVIDIA's glClearNamedBufferSubData takes 2.4 ms for 75 MB on an H100, this a fiftieth.
class Fill {
 public:
  /// \throws DisplayError
  Fill();
  /// Sets the first `count` words. Changes binding 0.
  void operator()(const Buffer& buffer, std::size_t count, std::uint32_t word) const;

 private:
  Program program_;
};

}  // namespace cadt::viewer::gl
