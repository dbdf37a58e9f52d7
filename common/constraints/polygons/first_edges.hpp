// SPDX-License-Identifier: Apache-2.0
// Points in no order, given as a ring: nearly all edges cross, many millions of pairs of some ten thousand.
#pragma once

#include <cadt/constrained.hpp>
#include <cadt/points.hpp>

#include <optional>
#include <span>

namespace cadt {

/// The lowest pair of segments that cross if that is easily told: each of the first four is tested with all others.
/// Nothing if none of them crosses another one, or the first that does meets it in a point, which divides both. O(n).
[[nodiscard]] std::optional<Segment> crossing_of_first_edges(const PointsView& points,
                                                             std::span<const Segment> segments);

}  // namespace cadt
