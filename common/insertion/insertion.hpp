// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/driver/context.hpp"
#include "common/insertion/drop_locks.hpp"
#include "common/mesh/mesh.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// Inserts all points level by level, certifies by legality sweeps and drops the locks. Mesh::points is null
/// unless edges are to be constrained.
[[nodiscard]] Mesh insert_incrementally(Context& ctx, SortedPoints points, MeshUse use = MeshUse::whole);

/// Legality sweeps over a mesh made otherwise, of two locked triangles a point; `edges`: how many it has, those to the
/// ghost included.
[[nodiscard]] LockedTriangles sweep_legality(Context& ctx, const SortedPoints& points, Allocation locked,
                                             std::uint64_t edges);

/// Triangles that one launch of a legality sweep, or of cadt_certify, examines.
[[nodiscard]] std::size_t slots_per_launch(const Device& device);

}  // namespace cadt
