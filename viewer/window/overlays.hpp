// SPDX-License-Identifier: Apache-2.0
// Lines over the mesh: its hull, and the Voronoi cells that are in view. No window, no OpenGL.
#pragma once

#include <cadt/queries.hpp>

#include "viewer/draw/camera.hpp"
#include "viewer/draw/renderer.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace cadt::viewer {

/// The loop of points as segments.
[[nodiscard]] std::vector<std::array<double, 4>> hull_segments(std::span<const double> xy, std::span<const std::int32_t> hull);

struct VoronoiLines {
  std::vector<std::array<double, 4>> segments;
  std::size_t in_view = 0;  ///< edges in the picture; above `most` there are no segments
};
/// Edges of cells that can be seen; rays end outside of the picture.
[[nodiscard]] VoronoiLines voronoi_lines(std::span<const double> xy, const VoronoiDiagram& diagram, const Camera& camera,
                                         std::size_t most);

/// Number of triangles at each point.
[[nodiscard]] std::vector<float> degrees_of(std::size_t points, std::span<const std::int32_t> triangles);

}  // namespace cadt::viewer
