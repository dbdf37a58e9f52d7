// SPDX-License-Identifier: Apache-2.0
// The exact mesh of segments that cross, by way of one that takes the rounded crossings for points.
#pragma once

#include <memory>
#include <span>

#include "common/constraints/constrained_data.hpp"
#include "common/constraints/constraints.hpp"

namespace cadt {

/// The constrained mesh of points, rounded crossings and the edges of chains, if it is that of the exact places as well:
/// all triangles counterclockwise, all other edges legal, which leaves one mesh only (docs/constrained.md). Else false:
/// then `data` is as before. \pre `found.places` is there \throws as Triangulator::triangulate_constrained
[[nodiscard]] bool constrain_rounded(const std::shared_ptr<Triangulator::State>& state, PointsView points,
                                     std::span<const Segment> segments, FoundCrossings found,
                                     ConstrainedTriangulation::Data& data);

/// The chains of a result. Those of segments of no length are empty.
void take_chains(ConstrainedTriangulation::Data& data, std::vector<std::int64_t> offsets,
                 std::vector<std::int32_t> vertices);

/// Pairs of segments, read from the device.
[[nodiscard]] std::vector<Segment> read_pairs(Device& device, const FoundCrossings& found);

}  // namespace cadt
