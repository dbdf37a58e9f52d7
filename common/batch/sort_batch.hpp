// SPDX-License-Identifier: Apache-2.0
// Sets of points along a space-filling curve, one after another (common/batch/batch.dev.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/points/spatial_sort.hpp"

namespace cadt {

struct SortedBatch {
  SortedPoints order;  ///< of the points of all sets; the grid is the square of one of them
  SetStarts starts;
  Allocation sets;    ///< cadt_set of each
  Allocation states;  ///< a word of each: CADT_SET_...

  /// First positions of the sets, and the end.
  [[nodiscard]] const Allocation& positions() const noexcept {
    return starts.positions ? starts.positions : starts.points;
  }
};

/// Sorts the points of sets: set s has those from starts[s] on, below starts[s + 1]. `together`: sets with up to so
/// many points are triangulated together. \throws InputError for the first NaN or infinity; `first` points and
/// `first_set` sets come before these
[[nodiscard]] SortedBatch sort_batch(Context& ctx, Allocation input, std::span<const std::uint32_t> starts,
                                     std::size_t together, std::size_t first, std::size_t first_set);

}  // namespace cadt
