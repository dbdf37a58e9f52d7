// SPDX-License-Identifier: Apache-2.0
// Values between the points (interpolate.dev.h, natural_neighbor.dev.h), and rasters of them (rasterize.dev.h).
#pragma once

#include <cadt/queries.hpp>

#include "common/queries/mesh_index.hpp"

namespace cadt {

/// `per_point` values of each query to `results`. Returns the triangle of each, as locate_queries; null without
/// triangles. \throws InputError
Allocation interpolate_queries(Context& ctx, const MeshIndex& mesh, const QueryBatch& queries, const Allocation& values,
                               std::size_t per_point, Interpolation method, Outside outside, const Allocation& results);

/// \throws InputError, LimitError
void require_grid(const Grid& grid);

/// One value of each cell to `cells`. \pre require_grid
void rasterize_mesh(Context& ctx, MeshIndex& mesh, const Grid& grid, const Allocation& values, Interpolation method,
                    double max_edge, const Allocation& cells);

}  // namespace cadt
