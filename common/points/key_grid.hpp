// SPDX-License-Identifier: Apache-2.0
// The grid of the sort keys, and the keys of points in it (common/points/hilbert_keys.dev.h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <tuple>

#include "common/driver/context.hpp"
#include "common/points/bounds.hpp"

namespace cadt {

/// 2^bits_x x 2^bits_y square cells, for the points as they are in SortedPoints.
struct KeyGrid {
  unsigned bits_x = 1, bits_y = 1;
  double half_min_x = 0, half_min_y = 0;  ///< lower left corner, halved
  double scale = 0;                       ///< cells per unit of halved coordinates
  double most_x = 0, most_y = 0;          ///< largest coordinates of the points, in cells
  bool clipped = false;                   ///< some points lie outside; their cell is the nearest at the edge
  unsigned fine_levels = 0;               ///< of `levels()`, those in the low word of two-word keys
  /// CADT_GRID_PARAMETERS
  [[nodiscard]] auto arguments() const { return std::tie(half_min_x, half_min_y, scale, bits_x, bits_y); }
  [[nodiscard]] unsigned bits() const noexcept { return bits_x + bits_y; }
  [[nodiscard]] unsigned levels() const noexcept { return std::min(bits_x, bits_y); }
  /// The grid with so many levels more (or fewer, if negative) in the low word.
  [[nodiscard]] KeyGrid finer(int levels) const noexcept;
};

constexpr int most_key_bits = 32;  ///< of a one-word key

/// A grid of at most 2^bits square cells over the bounds.
[[nodiscard]] KeyGrid choose_grid(const Bounds& bounds, int bits);

/// The grid of n points with these bounds; with as many bits as a one-word key has, or as many as suit n points.
[[nodiscard]] KeyGrid grid_of_all(const Bounds& bounds, std::size_t n, bool finest);

/// Sort keys of n points on the device; one-word keys have no low words. \pre low || grid.fine_levels == 0
void make_keys(Context& ctx, const Allocation& points, const Allocation& high, const Allocation& low, std::size_t n,
               const KeyGrid& grid);

}  // namespace cadt
