// SPDX-License-Identifier: Apache-2.0
// Distinct points and duplicates of sorted points (common/points/duplicates.dev.h).
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/points/spatial_sort.hpp"

namespace cadt {

/// Sorts short runs of equal keys, and sets flags[i] to 1 where a point differs from the one before, else 0. Into the
/// CADT_ORDER_WORDS of `totals`, 0 before: CADT_OVERFULL, whether a run was too long to sort; CADT_EQUAL, the number of
/// duplicates; from CADT_SHAPE_BESIDE on, the counts of the sample (point_profile.hpp), with those of `neighbours` in
/// order only if asked for.
void flag_distinct(Context& ctx, const Allocation& keys, const Allocation& sorted, const Allocation& order,
                   const Allocation& flags, std::size_t n, bool neighbours, const Allocation& totals);

/// Moves the distinct points, those with a flag, into `result`, and lists the `equal` others as duplicates. `sets`:
/// sets whose first positions among the distinct points are to be found; null if there is one set.
void compact_distinct(Context& ctx, SortedPoints& result, Allocation sorted, Allocation order, const Allocation& flags,
                      std::size_t n, std::uint32_t equal, SetStarts* sets = nullptr);

}  // namespace cadt
