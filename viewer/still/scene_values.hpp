// SPDX-License-Identifier: Apache-2.0
// What the colours of a finished mesh depend on.
#pragma once

#include <cadt/io/points_file.hpp>
#include <cadt/triangulation.hpp>

#include "viewer/draw/renderer.hpp"

namespace cadt::viewer {

/// Sets the renderer's values and ramp for the mesh, which is in `buffers`. O(points + triangles).
void prepare_colour(Renderer& renderer, const MeshBuffers& buffers, const io::PointSet& points,
                    const Triangulation& mesh, ColourBy colour);

/// The hull as lines. O(hull).
[[nodiscard]] Stroke hull_stroke(const io::PointSet& points, const Triangulation& mesh, bool dark);

}  // namespace cadt::viewer
