// SPDX-License-Identifier: Apache-2.0
// Robust scales of a scene, from samples, so that one outlier does not turn a picture to one colour.
#pragma once

#include "io/picture/scene.hpp"
#include "io/picture/viewport.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace cadt::io::picture {

/// The q-quantile (0 to 1) of the values, 0 if there are none. Reorders them.
[[nodiscard]] float quantile(std::vector<float>& values, double q);

/// Heights mapped so that the 0.5 % and 99.5 % quantiles become 0 and 1. Empty if there is no height or all are equal.
[[nodiscard]] std::vector<float> relative_heights(const Scene& scene);

/// Median length of the edges in pixels; 0 without triangles.
[[nodiscard]] float median_edge(const Scene& scene, std::span<const Point2f> position);

/// Colour position of a triangle by its area in pixels: log scale, 0 small and 1 large.
class AreaScale {
 public:
  AreaScale(const Scene& scene, std::span<const Point2f> position);
  [[nodiscard]] float operator()(Point2f a, Point2f b, Point2f c) const;

 private:
  float low_ = 0.0f, high_ = 1.0f;
};

/// How far a triangle counts as ground: 1, falling to a low value for triangles far larger than the usual ones, which
/// bridge a gap in the data or fill a bay of the hull.
class GroundOpacity {
 public:
  explicit GroundOpacity(float median_edge_pixels);
  [[nodiscard]] float operator()(Point2f a, Point2f b, Point2f c) const;

 private:
  float begin_, end_;
};

}  // namespace cadt::io::picture
