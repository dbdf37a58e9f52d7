// SPDX-License-Identifier: Apache-2.0
// From the records of the mesh to arrays of input indices.
#pragma once

#include <vector>

#include "common/host/build_mesh.hpp"
#include "common/host/run.hpp"

namespace cadt {

/// Which record is which triangle of the result.
struct Numbering {
  Allocation numbers;  ///< of each record, or (`ranked`) the number of real triangles before it
  bool ranked = false;
  std::size_t triangles = 0;
};

/// Numbers the triangles in the order that the options ask for. `labels` maps vertices to input indices, `points` is
/// the number of input points.
[[nodiscard]] Numbering number_triangles(Run& run, const DeviceMesh& mesh, const Allocation& labels,
                                         std::size_t points);

/// Writes the arrays of the result: 3 words a triangle each.
void emit_triangles(Run& run, const DeviceMesh& mesh, const Allocation& labels, const Numbering& numbering,
                    const Allocation& triangles, const Allocation& neighbors);

/// The boundary as one counterclockwise loop from its smallest index. `size`: its vertices, as Euler's formula has it.
[[nodiscard]] std::vector<std::int32_t> find_hull(Run& run, const Allocation& triangles, const Allocation& neighbors,
                                                  std::size_t count, std::size_t size, std::size_t points);

}  // namespace cadt
