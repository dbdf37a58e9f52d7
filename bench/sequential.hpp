// SPDX-License-Identifier: Apache-2.0
// The sequential baseline: incremental insertion with Lawson flips, written for one core: no locks, no rounds, no
// legality sweep. Predicates and symbolic perturbation are the library's, so the set of triangles is the same.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt::bench {

struct SequentialMesh {
  /// Input indices, counterclockwise, in no particular order. Empty if all points are on a line.
  std::vector<std::array<std::int32_t, 3>> triangles;
};

/// Of equal points the lowest index is the vertex. \throws InputError for NaN or infinity, LimitError for more than
/// max_points(), std::invalid_argument for half a point
[[nodiscard]] SequentialMesh sequential_delaunay(std::span<const double> xy);

}  // namespace cadt::bench
