// SPDX-License-Identifier: Apache-2.0
// Distinct points along Hilbert's curve.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>

#include "common/driver/context.hpp"
#include "common/points/key_grid.hpp"
#include "common/points/point_profile.hpp"

namespace cadt {

struct SortedPoints {
  Allocation points;     ///< distinct points in order; scaled by a power of two unless `wide`
  Allocation input_ids;  ///< lowest input index of each
  std::size_t distinct = 0;
  Allocation duplicates, representatives;  ///< duplicates, ascending, and what each equals; null if none
  KeyGrid grid;
  Allocation keys;    ///< sort keys in this grid, or null
  bool wide = false;  ///< the exponents span too much for the narrow kernels
  PointShapes shapes;
  double scale = 1, scale_again = 1;  ///< each point is the input's times both factors
};

/// First elements of the sets of a batch (common/batch/batch.dev.h), and the end of the last set.
struct SetStarts {
  std::size_t count = 0;
  Allocation points;     ///< in the input points
  Allocation positions;  ///< in the distinct points; null if these are the same
};

/// Sorts n points (`input`: interleaved, as the device takes them), refines over-full cells, finds duplicates.
/// `keep_keys`: the result has the sort keys, unless cells were over-full or points equal; if a quarter of the points
/// is in over-full cells, the order is that of a finer grid. \throws InputError for the first NaN or infinity
[[nodiscard]] SortedPoints sort_spatially(Context& ctx, Allocation input, std::size_t n, bool keep_keys);

/// Range of exponents, in binades, that the narrow kernels take (common/predicates/bigint.dev.h).
constexpr int narrow_span = 240;
/// The variant of the narrow kernels that these options ask for.
[[nodiscard]] constexpr KernelVariant narrow_variant(StatisticsDetail detail) noexcept {
  return detail == StatisticsDetail::timing ? KernelVariant::timed : KernelVariant::narrow;
}

}  // namespace cadt
