// SPDX-License-Identifier: Apache-2.0
// The tile that triangles and edges are accumulated in: one float of each kind a pixel.
#pragma once

#include "io/picture/scene.hpp"
#include "io/picture/viewport.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt::io::picture {

/// Mean value of the triangles that touch each pixel.
class Field {
 public:
  Field(int width, int height);

  /// A triangle with a value at each corner. `opacity` in [0, 1] is averaged beside the value. Pixels whose centre lies
  /// inside get the interpolated value; a triangle below one pixel also gives its area and mean to the pixel of its
  /// centroid. Cost: pixels covered plus a constant, see `add` in the source for slivers.
  void add(const Point2f (&p)[3], const float (&value)[3], float opacity);
  /// Averages the sums and closes single-pixel holes that rounding or slivers left.
  void finish();

  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }
  [[nodiscard]] bool covered(std::size_t i) const noexcept { return weight_[i] > 0.0f; }
  [[nodiscard]] float value(std::size_t i) const noexcept { return value_[i]; }
  [[nodiscard]] float opacity(std::size_t i) const noexcept { return opacity_[i]; }

  struct Gradient {
    float x, y;
  };
  /// Difference quotient of the value to the neighbours that are covered. \pre after finish()
  [[nodiscard]] Gradient gradient(int x, int y) const;

 private:
  void splat(std::size_t i, float weight, float value, float opacity) {
    weight_[i] += weight;
    value_[i] += weight * value;
    opacity_[i] += weight * opacity;
  }
  int width_, height_;
  std::vector<float> weight_, value_, opacity_;
};

/// Length of edges in each pixel, in pixels.
class Ink {
 public:
  Ink(int width, int height);
  /// Anti-aliased segment. With `stride` s only every s-th step is taken and counts s times, from a phase that
  /// `key` decides: the expected ink is the same and the cost is 1/s.
  void line(Point2f a, Point2f b, int stride, std::uint32_t key);
  /// A unit of ink at a point.
  void dot(Point2f p);

  [[nodiscard]] std::span<const float> amounts() const noexcept { return amount_; }
  /// Mean over a square of 2 r + 1 pixels.
  [[nodiscard]] std::vector<float> blurred(int r) const;

 private:
  void put(int x, int y, float amount) {
    if (x >= 0 && y >= 0 && x < width_ && y < height_) {
      amount_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] += amount;
    }
  }
  int width_, height_;
  std::vector<float> amount_;
};

/// All edges of the scene, with a stride that bounds the steps by a small multiple of the pixels and edges: a million
/// edges from one side of the picture to the other must not take minutes.
[[nodiscard]] Ink edge_ink(const Scene& scene, std::span<const Point2f> position, int width, int height);

}  // namespace cadt::io::picture
