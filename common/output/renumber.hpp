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

/// Which triangle of the mesh is which of the result.
struct Numbering {
  Allocation
      numbers;  ///< of each triangle of the mesh, or (`ranked`) how many real ones are before it; null: its index
  bool ranked = false;
  std::size_t triangles = 0;
  Allocation set_starts;  ///< of a batch: the first triangle of each set, and the number of all
};

/// Numbers the triangles in the order of the options. `points`: the number of input points; `sets`: where each set of a
/// batch begins. If the mesh has no input ids, its vertices are input ids already.
[[nodiscard]] Numbering renumber(Context& ctx, const Mesh& mesh, std::size_t points, const SetStarts* sets = nullptr);

/// Writes the arrays of the result, three words a triangle, behind `first` triangles, in input ids and in numbers of
/// `numbering`. From a mesh in arrays, either result can be null and is left out; without numbers the results can be
/// the arrays of the mesh.
void write_triangles(Context& ctx, const Mesh& mesh, const Numbering& numbering, const Allocation& triangles,
                     const Allocation& neighbors, std::size_t first = 0);

/// The same with the arrays of the mesh as those of the result: slower than write_triangles with arrays of its own if
/// the order is canonical. Releases the input ids. Returns the number of triangles.
[[nodiscard]] std::size_t renumber_in_place(Context& ctx, Mesh& mesh, std::size_t points);

/// Turns the numbers of points and triangles that write_triangles has written into those within their own sets.
void renumber_within_sets(Context& ctx, const Numbering& numbering, const SetStarts& sets, const Allocation& triangles,
                          const Allocation& neighbors, std::size_t first);

/// Edges (from, to) as one loop that starts at the smallest index. \throws InternalError if they are not one
[[nodiscard]] std::vector<std::int32_t> chain_loop(const std::vector<std::array<std::uint32_t, 2>>& edges,
                                                   std::size_t points);

/// The boundary as one counterclockwise loop from its smallest index. `size`: its vertices, by Euler's formula.
[[nodiscard]] std::vector<std::int32_t> find_hull(Context& ctx, const Allocation& triangles,
                                                  const Allocation& neighbors, std::size_t count, std::size_t size,
                                                  std::size_t points);

}  // namespace cadt
