// SPDX-License-Identifier: Apache-2.0
// An opaque picture in memory that Cairo strokes on and libpng encodes.
#pragma once

#include "io/picture/colour.hpp"
#include "io/picture/scene.hpp"
#include "io/picture/viewport.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cadt::io::picture {

class Canvas {
 public:
  Canvas(int width, int height, std::uint32_t background);

  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }

  void set(int x, int y, std::uint32_t rgb) {
    pixel_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] = rgb;
  }
  /// Mixes a colour in; `i` counts row by row.
  void blend(std::size_t i, Rgb colour, float alpha) { pixel_[i] = to_srgb(mix(from_bytes(pixel_[i]), colour, alpha)); }

  /// All edges as anti-aliased strokes of one transparency, also where they meet.
  void edges(const Scene& scene, std::span<const Point2f> position, double stroke, std::uint32_t rgb, double alpha);
  /// A closed line through the points with these indices.
  void loop(std::span<const std::int32_t> indices, std::span<const Point2f> position, double stroke, std::uint32_t rgb);
  void discs(std::span<const Point2f> centre, double radius, std::uint32_t rgb);

  /// The picture as a PNG file, 8-bit RGB.
  [[nodiscard]] std::string png() const;

 private:
  static Rgb from_bytes(std::uint32_t rgb);
  int width_, height_;
  std::vector<std::uint32_t> pixel_;  ///< 0x00RRGGBB: Cairo's RGB24
};

}  // namespace cadt::io::picture
