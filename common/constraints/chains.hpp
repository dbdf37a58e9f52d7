// SPDX-License-Identifier: Apache-2.0
// The vertices along each segment, and the edges between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/constraints/constrained_data.hpp"

namespace cadt {

/// The chains of a result. Those of segments of no length are empty.
void take_chains(ConstrainedTriangulation::Data& data, std::vector<std::int64_t> offsets,
                 std::vector<std::int32_t> vertices);

/// Devices count the vertices of all chains in a word. \throws LimitError
void require_chain_length(std::size_t length);

/// \throws InputError: segment `s` has an end that is none of so many points
[[noreturn]] void refuse_segment(std::size_t s, const Segment& segment, std::size_t points);

/// Chains of segments between points on a line, where `data.mesh` has no triangles. \throws InputError for the first
/// segment with an end that is no point
void chain_on_line(PointsView points, std::span<const Segment> segments, ConstrainedTriangulation::Data& data);

/// The edges of chains. O(n log n).
[[nodiscard]] ConstrainedEdges edges_of_chains(std::span<const std::int64_t> offsets,
                                               std::span<const std::int32_t> vertices);

}  // namespace cadt
