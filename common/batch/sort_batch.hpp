// SPDX-License-Identifier: Apache-2.0
// The points of a batch along Hilbert's curve, set by set (common/batch/batch.dev.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/points/spatial_sort.hpp"

namespace cadt {

struct SortedBatch {
  SortedPoints order;  ///< of the points of all sets; the grid is the square of one set
  SetStarts starts;
  Allocation sets;    ///< a cadt_set for each set
  Allocation states;  ///< a word for each set: CADT_SET_...

  /// First positions of the sets, and the end of the last.
  [[nodiscard]] const Allocation& positions() const noexcept {
    return starts.positions ? starts.positions : starts.points;
  }
};

/// Sorts the points of sets: set s has points starts[s] to starts[s + 1] - 1. `most_batched`: sets with at most so many
/// points are batched, others individual. \throws InputError for the first NaN or infinity; it counts `first` points
/// and `first_set` sets before these
[[nodiscard]] SortedBatch sort_batch(Context& ctx, Allocation input, std::span<const std::uint32_t> starts,
                                     std::size_t most_batched, std::size_t first, std::size_t first_set);

}  // namespace cadt
