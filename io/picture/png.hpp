// SPDX-License-Identifier: Apache-2.0
// Opaque pixels in memory that libpng encodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cadt::io::picture {

class Pixels {
 public:
  Pixels(int width, int height, std::uint32_t background)
      : width_(width),
        height_(height),
        pixel_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background) {}

  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }
  /// 0x00RRGGBB each: Cairo's RGB24.
  [[nodiscard]] std::uint32_t* row(int y) {
    return pixel_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
  }

  /// The picture as a PNG file, 8-bit RGB.
  [[nodiscard]] std::string png() const;

 private:
  int width_, height_;
  std::vector<std::uint32_t> pixel_;
};

}  // namespace cadt::io::picture
