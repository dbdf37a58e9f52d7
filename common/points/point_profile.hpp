// SPDX-License-Identifier: Apache-2.0
// Shapes of the point set, from a sample (common/points/point_profile.dev.h): they decide on the strategy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace cadt {

/// What a sample shows, within floating-point rounding: no shape is proven, and none decides on a result.
struct PointShapes {
  bool overfull = false;    ///< nearly all points are in over-full cells of the grid, and few are duplicates
  bool on_line = false;     ///< no sampled point is certainly beside one line: perhaps all are on it
  bool on_circle = false;   ///< most points are on one circle
  bool on_hull = false;     ///< nearly all points are vertices of the hull
  bool on_ring = false;     ///< more points are on the hull than of evenly spread ones, and cells are not over-full
  bool on_rays = false;     ///< many are collinear with their neighbours in order, but not along an axis: a polar grid
  bool on_circles = false;  ///< many are cocircular with their neighbours in order, which takes bigints to decide
  bool on_lattice = false;  ///< many are cocircular with their neighbours in order, which a cheap test decides
};

/// With fewer points the counts of neighbours in order are not taken.
constexpr std::size_t fewest_sampled = 9000;

/// Shapes of n points, `overfull_points` of them in over-full cells, from the CADT_ORDER_WORDS of flag_distinct.
[[nodiscard]] PointShapes shapes_of(std::span<const std::uint32_t> counts, std::size_t n,
                                    std::uint32_t overfull_points) noexcept;

}  // namespace cadt
