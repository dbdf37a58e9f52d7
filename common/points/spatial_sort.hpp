// SPDX-License-Identifier: Apache-2.0
// Distinct points along a space-filling curve.
#pragma once

#include <cadt/triangulation.hpp>

#include <algorithm>
#include <cstddef>

#include "common/driver/context.hpp"

namespace cadt {

/// The grid of the sort keys (common/points/spatial_sort.dev.h), for the points as they are in SortedPoints.
struct KeyGrid {
  unsigned bits_x = 1, bits_y = 1;
  double half_min_x = 0, half_min_y = 0;
  double scale = 0;               ///< cells a unit of halved coordinates
  double most_x = 0, most_y = 0;  ///< largest coordinates of the points, in cells
  bool clipped = false;           ///< some points are outside, and have the nearest cell at the edge
  unsigned fine_levels = 0;       ///< of `levels()`, those in the low word of keys that have two
  [[nodiscard]] unsigned bits() const noexcept { return bits_x + bits_y; }
  [[nodiscard]] unsigned levels() const noexcept { return std::min(bits_x, bits_y); }
  /// So many levels more, or fewer: in the low word.
  [[nodiscard]] KeyGrid finer(int levels) const noexcept;
};

/// What the points are like, as far as a sample tells: it decides which way to their mesh is tried.
struct PointShapes {
  bool overfull = false;    ///< nearly all are in crowded cells of the grid, and not because they are equal
  bool on_line = false;     ///< none is beside a line by more than rounding hides: perhaps all are on it
  bool on_circle = false;   ///< most are on one circle, as far as rounded numbers tell
  bool on_hull = false;     ///< nearly all are on the hull, as far as a comparison with some others tells
  bool on_ring = false;     ///< more are than of points that are spread evenly, and not because they are crowded
  bool on_rays = false;     ///< many are on a line with their neighbours, not along an axis: a polar grid
  bool on_circles = false;  ///< many are on a circle with their neighbours, and long integers have to tell
  bool on_lattice = false;  ///< many are, and a cheap test tells
};

/// Of fewer points most shapes are not looked for.
constexpr std::size_t fewest_sampled = 9000;

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
};

/// Where the sets of a call with several begin (common/batch/batch.dev.h), and the end of the last one.
struct SetStarts {
  std::size_t count = 0;
  Allocation points;     ///< among the input points
  Allocation positions;  ///< among distinct ones; null: the same
};

/// Sort keys of n points of the device.
void make_keys(Context& ctx, const Allocation& points, const Allocation& keys, std::size_t n, const KeyGrid& grid);

/// Keys of two words. \pre grid.fine_levels > 0
void make_fine_keys(Context& ctx, const Allocation& points, const Allocation& high, const Allocation& low,
                    std::size_t n, const KeyGrid& grid);

/// Sorts n points (`input`: interleaved, as the device takes them), refines crowded cells, finds duplicates.
/// `keep_keys`: the result has the sort keys, unless cells were crowded or points equal; where a quarter of the points
/// is in crowded cells, they are in the order of a finer grid. \throws InputError for the
/// first NaN or infinity
[[nodiscard]] SortedPoints sort_spatially(Context& ctx, Allocation input, std::size_t n, bool keep_keys);

// ---- the steps after the keys, for other keys as well (sort_batch.hpp)

/// Binades that the narrow kernels take (common/predicates/bigint.dev.h).
constexpr int narrow_span = 240;
/// The build of the narrow kernels that these options ask for.
[[nodiscard]] constexpr KernelVariant narrow_variant(StatisticsDetail detail) noexcept {
  return detail == StatisticsDetail::timing ? KernelVariant::timed : KernelVariant::narrow;
}

/// Flags the members of crowded cells; how many there are.
[[nodiscard]] std::uint32_t flag_overfull(Context& ctx, const Allocation& keys, const Allocation& flags, std::size_t n);
/// Sorts the members of crowded cells by more bits, a round at a time (common/points/key_refinement.dev.h). False if
/// there are none; else `keys` are no longer those of the grid. \pre `crowd` of them are flagged in `spare`
[[nodiscard]] bool refine_overfull(Context& ctx, const Allocation& input, Allocation& keys, const Allocation& order,
                                   Allocation& spare, std::size_t n, std::uint32_t overfull_points);
/// Sorts runs of equal keys; 1 in `flags` where a point differs from the one before. Of the CADT_ORDER_WORDS of
/// `totals`, 0 before, totals[CADT_OVERFULL] says whether runs were too long for that, totals[CADT_EQUAL] counts the
/// others, and those behind it say what a sample is like, with `neighbours` in a row too.
void flag_distinct(Context& ctx, const Allocation& keys, const Allocation& sorted, const Allocation& order,
                   const Allocation& flags, std::size_t n, bool neighbours, const Allocation& totals);
/// Closes up distinct points, as flagged in `flags`; `equal` others. Where sets begin among them, if there are sets.
void compact_distinct(Context& ctx, SortedPoints& result, Allocation sorted, Allocation order, const Allocation& flags,
                      std::size_t n, std::uint32_t equal, SetStarts* sets = nullptr);

}  // namespace cadt
