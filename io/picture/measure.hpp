// SPDX-License-Identifier: Apache-2.0
// Robust scales of a scene, from samples, so that one outlier does not turn a picture to one colour.
#pragma once

#include "io/picture/scene.hpp"
#include "io/picture/viewport.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cadt::io::picture {

/// The q-quantile (0 to 1) of the values, 0 if there are none. Reorders them.
[[nodiscard]] float quantile(std::vector<float>& values, double q);

/// Where the colours of heights begin and end: the 0.5 % and 99.5 % quantiles. Not set if there is no height or all are
/// equal.
struct HeightEnds {
  double low, high;
};
[[nodiscard]] std::optional<HeightEnds> height_ends(const Scene& scene);

/// Heights mapped so that those ends become 0 and 1. Empty if there are none.
[[nodiscard]] std::vector<float> relative_heights(const Scene& scene);

/// The number of each triangle's region among the different ones, ascending. Empty if they are less than two.
[[nodiscard]] std::vector<std::uint32_t> region_numbers(const Scene& scene);

/// Edges in pixels, estimated from samples; zeros without triangles.
struct EdgeLengths {
  float median = 0.0f;
  double total = 0.0;
};
[[nodiscard]] EdgeLengths edge_lengths(const Scene& scene, std::span<const Point2f> position);

/// Colour position of a triangle by its area in pixels: log scale, 0 small and 1 large.
class AreaScale {
 public:
  AreaScale(const Scene& scene, std::span<const Point2f> position);
  [[nodiscard]] float operator()(Point2f a, Point2f b, Point2f c) const;

 private:
  float low_ = 0.0f, high_ = 1.0f;
};

/// How far a triangle counts as ground: 1, but less for triangles that are far larger than usual and connected to the
/// hull: they fill bays of the outline, where nothing was measured. Large triangles in the interior (a lake, a flat
/// field between contour lines) are ground.
class GroundOpacity {
 public:
  GroundOpacity(const Scene& scene, std::span<const Point2f> position, float median_edge_pixels);
  /// \pre t < scene.faces()
  [[nodiscard]] float operator()(std::size_t t) const;
  /// One a point: whether large triangles connect it with the hull.
  [[nodiscard]] std::span<const std::uint8_t> outer() const noexcept { return outer_; }
  /// Pixels of the longest edge from which on such a triangle is less than ground.
  [[nodiscard]] float begin() const noexcept { return begin_; }

 private:
  [[nodiscard]] float longest_edge(std::size_t t) const;
  const Scene& scene_;
  std::span<const Point2f> position_;
  float begin_, end_;
  std::vector<std::uint8_t> outer_;
};

}  // namespace cadt::io::picture
