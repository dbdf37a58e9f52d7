// SPDX-License-Identifier: Apache-2.0
// From the mesh to the result's arrays of input ids.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/driver/context.hpp"
#include "common/mesh/mesh.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// The number of each triangle of the mesh in the result, in the order of the options, as a half-edge
/// (renumber.dev.h); null: its index. `points`: the number of input points. If the mesh has no input ids, its vertices
/// are input ids already.
[[nodiscard]] Allocation number_triangles(Context& ctx, const Mesh& mesh, std::size_t points);

/// Where the result is written: three words a triangle, and one of flags where edges are constrained.
struct ResultPlace {
  const Allocation &triangles, &neighbors, &edge_flags;
  std::size_t first = 0;  ///< behind so many triangles
};

/// Writes the arrays of the result in input ids and in `numbers`. One that is null is left out; without numbers they
/// can be the arrays of the mesh.
void write_triangles(Context& ctx, const Mesh& mesh, const Allocation& numbers, const ResultPlace& to);

/// Replaces the arrays of the mesh by those of the result, in input ids and in the order that the options ask for. They
/// may be the same ones, and longer than needed.
void write_result(Context& ctx, Mesh& mesh, std::size_t points);

/// Turns the numbers of points and triangles that write_triangles has written for `count` triangles into those within
/// their own sets. `set_starts`: the first triangle of each set.
void renumber_within_sets(Context& ctx, const Allocation& set_starts, const SetStarts& sets, const ResultPlace& of,
                          std::size_t count);

/// Edges (from, to) as one loop that starts at the smallest index. \throws InternalError if they are not one
[[nodiscard]] std::vector<std::int32_t> chain_loop(std::vector<std::array<std::uint32_t, 2>> edges, std::size_t points);

/// The boundary as one counterclockwise loop from its smallest index. `size`: its vertices, by Euler's formula.
[[nodiscard]] std::vector<std::int32_t> find_hull(Context& ctx, const Allocation& triangles,
                                                  const Allocation& neighbors, std::size_t count, std::size_t size,
                                                  std::size_t points);

}  // namespace cadt
