// SPDX-License-Identifier: Apache-2.0
// The dual of the mesh, and what circumcircles tell (voronoi.dev.h).
#pragma once

#include <cadt/queries.hpp>

#include <cstddef>
#include <vector>

#include "common/queries/mesh_index.hpp"

namespace cadt {

void write_circumcenters(Context& ctx, const MeshIndex& mesh, const Allocation& xy);
/// begin: points + 1 words; cells: 3 a triangle, or null.
void write_cells(Context& ctx, const MeshIndex& mesh, const Allocation& begin, const Allocation& cells);
/// The first edge of each triangle; one word more than triangles.
[[nodiscard]] Allocation count_edges(Context& ctx, const MeshIndex& mesh);
/// \pre `begin` is of count_edges
void write_edges(Context& ctx, const MeshIndex& mesh, const Allocation& begin, const Allocation& points,
                 const Allocation& vertices);
[[nodiscard]] VoronoiDiagram make_voronoi(Context& ctx, const MeshIndex& mesh);
/// \throws InputError
[[nodiscard]] VoronoiPolygons clip_voronoi(Context& ctx, const MeshIndex& mesh, const Box& box);
[[nodiscard]] std::vector<Circle> find_largest_circles(Context& ctx, MeshIndex& mesh, std::size_t wanted);
/// \throws OptionError
[[nodiscard]] Outline make_outline(Context& ctx, const MeshIndex& mesh, double max_radius, double max_edge);

}  // namespace cadt
