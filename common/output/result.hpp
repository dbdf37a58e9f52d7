// SPDX-License-Identifier: Apache-2.0
// From the mesh to the arrays of the result.
#pragma once

#include <cstddef>

#include "common/driver/context.hpp"
#include "common/mesh/mesh.hpp"

namespace cadt {

/// Three words a triangle each: vertices, as input ids, counterclockwise; and neighbours.
struct ResultArrays {
  MeshArray triangles, neighbors;
  Allocation edge_flags;  ///< a word a triangle, as in common/mesh/mesh_view.dev.h; null: no edge is constrained
  std::size_t count = 0;
};

/// Renumbers the triangles in the order that the options ask for, and writes them. `points`: number of input points.
[[nodiscard]] ResultArrays write_result(Context& ctx, Mesh mesh, std::size_t points);

}  // namespace cadt
