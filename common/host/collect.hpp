// SPDX-License-Identifier: Apache-2.0
// From the records of the mesh to arrays of input indices.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/host/build_mesh.hpp"
#include "common/host/run.hpp"
#include "common/host/spatial_order.hpp"

namespace cadt {

/// Which record is which triangle of the result.
struct Numbering {
  Allocation numbers;  ///< of each record, or (`ranked`) the number of real triangles before it; null: as they are
  bool ranked = false;
  std::size_t triangles = 0;
  Allocation set_starts;  ///< of a call with several sets: the first triangle of each, and the number of all
};

/// Numbers the triangles in the order that the options ask for. `labels` maps vertices to input indices (null: they are
/// these), `points` is the number of input points, `sets` where each set begins, if there are several.
[[nodiscard]] Numbering number_triangles(Run& run, const DeviceMesh& mesh, const Allocation& labels, std::size_t points,
                                         const SetStarts* sets = nullptr);

/// Writes the arrays of the result: 3 words a triangle each, behind `first` triangles. The numbers are those of the
/// labels and of the numbering. From a mesh in arrays either can be null and is left out; without numbers they can be
/// the arrays of the mesh.
void emit_triangles(Run& run, const DeviceMesh& mesh, const Allocation& labels, const Numbering& numbering,
                    const Allocation& triangles, const Allocation& neighbors, std::size_t first = 0);

/// The same with the arrays of the mesh as those of the result, in more time than emit_triangles with arrays of its own
/// if the order is the canonical one. Releases `labels`. Returns the number of triangles.
[[nodiscard]] std::size_t emit_in_place(Run& run, DeviceMesh& mesh, Allocation& labels, std::size_t points);

/// Turns the numbers of points and triangles that emit_triangles has written into those of their own sets.
void number_within_sets(Run& run, const Numbering& numbering, const SetStarts& sets, const Allocation& triangles,
                        const Allocation& neighbors, std::size_t first);

/// Edges (from, to) as one loop that starts at the smallest index. \throws InternalError if they are not one
[[nodiscard]] std::vector<std::int32_t> link_loop(const std::vector<std::array<std::uint32_t, 2>>& edges,
                                                  std::size_t points);

/// The boundary as one counterclockwise loop from its smallest index. `size`: its vertices, as Euler's formula has it.
[[nodiscard]] std::vector<std::int32_t> find_hull(Run& run, const Allocation& triangles, const Allocation& neighbors,
                                                  std::size_t count, std::size_t size, std::size_t points);

}  // namespace cadt
