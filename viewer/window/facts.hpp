// SPDX-License-Identifier: Apache-2.0
// What there is to say about a triangle, and its circumcircle as it is seen. No window, no OpenGL.
#pragma once

#include "viewer/draw/camera.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cadt::viewer {

using Place = std::array<double, 2>;

struct Circle {
  Place centre{0, 0};
  double radius = 0;
};
/// Rounded; empty if it is too large for doubles.
[[nodiscard]] std::optional<Circle> circumcircle(const std::array<Place, 3>& corners);

struct TriangleFacts {
  std::size_t index = 0;
  std::array<std::int32_t, 3> points{};
  std::array<Place, 3> corners{};
  std::optional<std::array<std::int32_t, 3>> neighbours;  ///< the k-th opposite point k, -1 outside; empty: not known
  std::optional<std::int32_t> region;                     ///< of a mesh with segments
  std::optional<Circle> circle;
  double area = 0, smallest_angle = 0;  ///< degrees
};
[[nodiscard]] TriangleFacts facts_of(std::size_t index, const std::array<std::int32_t, 3>& points,
                                     const std::array<Place, 3>& corners);

/// Names and values for the panel. Coordinates have all digits that they have.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> lines_of(const TriangleFacts& facts);
/// The shortest decimals that read back to the same doubles, one a line.
[[nodiscard]] std::string text_of(const Place& place);

/// The part of a circle that can be seen, as a polyline in pixels. A circle of any size: of a very large one the arc
/// through the picture. Empty if none of it is in the picture, or it is smaller than a pixel.
[[nodiscard]] std::vector<std::array<float, 2>> visible_arc(const Circle& circle, const Camera& camera);

}  // namespace cadt::viewer
