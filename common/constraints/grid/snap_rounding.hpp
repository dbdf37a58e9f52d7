// SPDX-License-Identifier: Apache-2.0
// Snap rounding: segments that cross become chains on a grid that do not.
#pragma once

#include <cadt/constrained.hpp>

#include "common/constraints/stop_check.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt::constraints {

struct SnappedSegments {
  std::vector<double> xy;              ///< the input points, each moved to a grid point, then those added
  std::vector<std::int64_t> offsets;   ///< segment s has become the chain of the points
  std::vector<std::int32_t> vertices;  ///< from offsets[s] to offsets[s + 1] - 1, in its direction; none if
                                       ///< both of its ends have moved to the same place
  std::vector<std::array<std::int32_t, 2>> parents;  ///< for each added point the lowest pair of segments that cross in
                                                     ///< its pixel, ascending
};

/// J. D. Hobby, "Practical segment intersection with finite precision output" (Computational Geometry 13, 1999); M. T.
/// Goodrich, L. J. Guibas, J. Hershberger, P. J. Tanenbaum, "Snap rounding line segments efficiently in two and three
/// dimensions" (SoCG 1997). Points move to the nearest multiples of `grid`, halves upwards. Pixels with an input point
/// or a crossing are hot; a segment becomes the chain of the centres of all hot pixels that it passes, so it moves by
/// less than a pixel. Edges of chains meet in their ends alone, or are the same. The vertex of a pixel is the lowest
/// input point in it, else an added point.
///
/// O((n + length of chains) log n + sum of the tree's boxes along segments), some square root of n for each that is
/// long. The result does not depend on threads, nor on order and direction but for numbers. \throws InputError as
/// find_crossings; OptionError unless 0 < grid < infinity and multiples of the grid are doubles up to the largest
/// coordinate, or there are less than 2^25 of them, where their rounding does no harm; Cancelled
[[nodiscard]] SnappedSegments snap_segments(PointsView points, std::span<const Segment> segments, double grid,
                                            unsigned threads, const StopCheck& check_stop = {});

}  // namespace cadt::constraints
