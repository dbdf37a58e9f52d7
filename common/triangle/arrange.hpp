// SPDX-License-Identifier: Apache-2.0
// The parts of triangle_output that meshes of points and of segments share.
#pragma once

#include <cadt/triangle.hpp>

#include <cstddef>
#include <vector>

namespace cadt::triangle_detail {

/// Throws InputError unless the arrays fit together; `mesh_points`: the points of the input that the mesh knows.
void require_sizes(const TriangleInput& input, std::size_t mesh_points);

/// Edges, their triangles and markers, of the triangles and neighbours.
void set_edges(TriangleOutput& out);

/// Circumcentres, their attributes, and rays. \pre set_edges
void set_voronoi(TriangleOutput& out);

/// Takes the points away that are `gone`, and numbers the others anew. \pre no triangle, segment or edge has one
void jettison(TriangleOutput& out, const std::vector<bool>& gone);

}  // namespace cadt::triangle_detail
