// SPDX-License-Identifier: Apache-2.0
// From the records of the mesh to arrays of input indices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/driver/context.hpp"
#include "common/mesh/mesh.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// Which record is which triangle of the result.
struct Numbering {
  Allocation numbers;  ///< of each record, or (`ranked`) the number of real triangles before it; null: as they are
  bool ranked = false;
  std::size_t triangles = 0;
  Allocation set_starts;  ///< of a call with several sets: the first triangle of each, and the number of all
};

/// Numbers the triangles in the order that the options ask for. Vertices are input ids already where the mesh has none
/// besides; `points` is the number of input points, `sets` where each set begins, if there are several.
[[nodiscard]] Numbering renumber(Context& ctx, const Mesh& mesh, std::size_t points, const SetStarts* sets = nullptr);

/// Writes the arrays of the result: 3 words a triangle each, behind `first` triangles. The numbers are those of the
/// input ids and of the numbering. From a mesh in arrays either can be null and is left out; without numbers they can
/// be the arrays of the mesh.
void write_triangles(Context& ctx, const Mesh& mesh, const Numbering& numbering, const Allocation& triangles,
                     const Allocation& neighbors, std::size_t first = 0);

/// The same with the arrays of the mesh as those of the result, in more time than write_triangles with arrays of its
/// own if the order is the canonical one. Releases the input ids. Returns the number of triangles.
[[nodiscard]] std::size_t renumber_in_place(Context& ctx, Mesh& mesh, std::size_t points);

/// Turns the numbers of points and triangles that write_triangles has written into those of their own sets.
void renumber_within_sets(Context& ctx, const Numbering& numbering, const SetStarts& sets, const Allocation& triangles,
                          const Allocation& neighbors, std::size_t first);

/// Edges (from, to) as one loop that starts at the smallest index. \throws InternalError if they are not one
[[nodiscard]] std::vector<std::int32_t> chain_loop(const std::vector<std::array<std::uint32_t, 2>>& edges,
                                                   std::size_t points);

/// The boundary as one counterclockwise loop from its smallest index. `size`: its vertices, as Euler's formula has it.
[[nodiscard]] std::vector<std::int32_t> find_hull(Context& ctx, const Allocation& triangles,
                                                  const Allocation& neighbors, std::size_t count, std::size_t size,
                                                  std::size_t points);

}  // namespace cadt
