// SPDX-License-Identifier: Apache-2.0
// Distinct points along a space-filling curve.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>
#include <functional>

#include "common/driver/context.hpp"
#include "common/points/key_grid.hpp"
#include "common/points/point_profile.hpp"

namespace cadt {

struct SortedPoints {
  Allocation points;     ///< distinct points in order, scaled by a power of two unless `wide`
  Allocation input_ids;  ///< their lowest input indices
  std::size_t distinct = 0;
  Allocation duplicates, representatives;  ///< points that equal an earlier one, ascending, and that one; null if none
  KeyGrid grid;
  Allocation keys;    ///< their sort keys in this grid, or null
  bool wide = false;  ///< exponents span too much for the narrow kernels
  PointShapes shapes;
  double scale = 1, scale_again = 1;  ///< the points are the input's, times both
  /// The points once more, if the input lies on the device anyway; else null. Set by who has called sort_spatially.
  std::function<Allocation(const SortedPoints&)> points_again;
};

/// Where the sets of a call with several begin (common/batch/batch.dev.h), and the end of the last one.
struct SetStarts {
  std::size_t count = 0;
  Allocation points;     ///< among the input points
  Allocation positions;  ///< among distinct ones; null: the same
};

/// Sorts n points (`input`: interleaved, as the device takes them), refines crowded cells, finds duplicates.
/// `keep_keys`: the result has the sort keys, unless cells were crowded or points equal; where a quarter of the points
/// is in crowded cells, they are in the order of a finer grid. \throws InputError for the
/// first NaN or infinity
[[nodiscard]] SortedPoints sort_spatially(Context& ctx, Allocation input, std::size_t n, bool keep_keys);

/// Binades that the narrow kernels take (common/predicates/bigint.dev.h).
constexpr int narrow_span = 240;
/// The build of the narrow kernels that these options ask for.
[[nodiscard]] constexpr KernelVariant narrow_variant(StatisticsDetail detail) noexcept {
  return detail == StatisticsDetail::timing ? KernelVariant::timed : KernelVariant::narrow;
}

}  // namespace cadt
