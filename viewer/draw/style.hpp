// SPDX-License-Identifier: Apache-2.0
// How a mesh is drawn.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::viewer {

/// What decides the colour of a triangle.
enum class ColourBy {
  nothing,    ///< one colour
  angle,      ///< smallest angle, degrees
  area,       ///< on a log scale
  order,      ///< place in the array of triangles
  height,     ///< of the points, with light from the upper left
  degree,     ///< number of triangles around each vertex
  level,      ///< level of insertion of the points, their mean
  conflicts,  ///< lost locks of each triangle, while it grew
  flips,      ///< of the edges of each triangle, while it grew
  region      ///< between constrained edges: a colour each
};
[[nodiscard]] std::string_view to_string(ColourBy by) noexcept;
/// All names, in the order of the enumerators.
[[nodiscard]] const std::vector<std::string>& names_of_colours();
/// Not set for any other name.
[[nodiscard]] std::optional<ColourBy> colour_from_string(std::string_view name) noexcept;

struct Style {
  ColourBy colour = ColourBy::area;
  bool fill = true;
  bool points_alone = false;  ///< no triangles: discs, and the density of points where they are many
  float line_width = 1.0f;    ///< of edges, pixels; 0: none. Edges of triangles of a few pixels fade
  float edge_width = 2.0f;    ///< of constrained edges, pixels; they do not fade
  float point_radius = 0.0f;  ///< of vertices, pixels; 0: none
  bool hull = true;
  bool dark = false;
  int samples = 2;  ///< along the side of a pixel, 1 to 4
};

}  // namespace cadt::viewer
