// SPDX-License-Identifier: Apache-2.0
// A grid of square pixels around the multiples of its width, exactly.
#pragma once

#include "common/constraints/exact/implicit_point.hpp"

#include <compare>
#include <cstdint>
#include <vector>

namespace cadt::constraints {

/// Pixel (x, y) of a grid of width g has its centre at (g x, g y), and is half-open: it has the points from
/// g (x - 1/2), inclusive, to g (x + 1/2), exclusive, and in y likewise. So each point is in one pixel.
struct Pixel {
  std::int64_t x, y;
  friend auto operator<=>(const Pixel&, const Pixel&) = default;
};

class PixelGrid {
 public:
  /// \pre width > 0, finite
  explicit PixelGrid(double width) : width_(width) {}

  /// The pixel that a point is in. \pre coordinates are below 2^52 widths
  [[nodiscard]] Pixel pixel_of(const exact::Place& p, const exact::ImplicitPoints& points) const;

  /// Whether a segment has a point in a pixel. \pre its end a is lexicographically before b
  [[nodiscard]] bool passes(const exact::Line& segment, const Pixel& pixel) const;

  [[nodiscard]] double width() const { return width_; }

 private:
  double width_;
};

/// Pixels in a tree of boxes, to be asked for those that a segment passes.
class PixelTree {
 public:
  /// \pre pixels are sorted and different
  PixelTree(const PixelGrid& grid, const std::vector<Pixel>& pixels);

  /// The indices of the pixels that the segment passes, in the order along it. \pre a is before b
  void find(const exact::Line& segment, std::vector<std::int32_t>& passed) const;

 private:
  struct Box {
    double left, bottom, right, top;  // around its pixels and a little more
  };
  void build(std::size_t node, std::size_t first, std::size_t last, bool by_x);
  void find(std::size_t node, std::size_t first, std::size_t last, const exact::Line& segment,
            std::vector<std::int32_t>& passed) const;

  const PixelGrid& grid_;
  const std::vector<Pixel>& pixels_;
  std::vector<std::int32_t> order_;
  std::vector<Box> boxes_;
};

}  // namespace cadt::constraints
