// SPDX-License-Identifier: Apache-2.0
// Lines over the mesh: the Voronoi cells that are in view. No window, no OpenGL.
#pragma once

#include <cadt/queries.hpp>

#include "viewer/draw/camera.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace cadt::viewer {

struct VoronoiLines {
  std::vector<std::array<double, 4>> segments;
  std::size_t in_view = 0;  ///< edges in the picture; above `most` there are no segments
};
/// Edges of cells that can be seen; rays end outside of the picture.
[[nodiscard]] VoronoiLines voronoi_lines(std::span<const double> xy, const VoronoiDiagram& diagram,
                                         const Camera& camera, std::size_t most);

}  // namespace cadt::viewer
