// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/driver/context.hpp"
#include "common/insertion/drop_locks.hpp"
#include "common/mesh/mesh.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// The mesh of some of the points, to insert the others into: of those that represent the blocks of 2^level positions
/// (common/insertion/base_mesh.dev.h), numbered as these, positions and half-edges.
struct BaseMesh {
  Mesh mesh;
  unsigned level = 0;
};

/// Blocks of 2^level positions of n.
[[nodiscard]] constexpr std::size_t blocks_of_level(std::size_t n, unsigned level) { return ((n - 1) >> level) + 1; }

/// Inserts all points level by level, certifies by legality sweeps and drops the locks. Mesh::points is null
/// unless edges are to be constrained. `base`: on GPUs, the levels above are not inserted.
[[nodiscard]] Mesh insert_incrementally(Context& ctx, SortedPoints points, MeshUse use = MeshUse::whole,
                                        std::optional<BaseMesh> base = std::nullopt);

/// Legality sweeps over a mesh made otherwise, of two locked triangles a point; `edges`: how many it has, those to the
/// ghost included.
[[nodiscard]] LockedTriangles sweep_legality(Context& ctx, const SortedPoints& points, Allocation locked,
                                             std::uint64_t edges);

/// Triangles that one launch of a legality sweep, or of cadt_certify, examines.
[[nodiscard]] std::size_t slots_per_launch(const Device& device);

}  // namespace cadt
