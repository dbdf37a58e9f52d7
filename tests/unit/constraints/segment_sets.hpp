// SPDX-License-Identifier: Apache-2.0
// Sets of segments, and what is true of them by trying all pairs.
#pragma once

#include <cadt/constrained.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace cadt::test {

struct SegmentSet {
  std::string name;
  std::vector<double> xy;
  std::vector<Segment> segments;
};

/// Small sets of every kind: random ones, lattices with overlaps, contacts and many segments through one place,
/// vertical ones, at the ends of the range of doubles, almost parallel ones. The same for each call.
[[nodiscard]] std::vector<SegmentSet> small_segment_sets();

/// `count` segments between points of a lattice of `side` x `side`, times (x_unit, y_unit), with some points more.
[[nodiscard]] SegmentSet lattice_segments(std::uint64_t seed, int side, std::size_t count, double x_unit,
                                          double y_unit);
/// `count` segments of about the given length in the unit square.
[[nodiscard]] SegmentSet random_segments(std::uint64_t seed, std::size_t count, double length);

/// find_crossings by trying all pairs, and all points for each.
[[nodiscard]] std::vector<std::array<std::int32_t, 2>> crossings_by_brute_force(const SegmentSet& set);

}  // namespace cadt::test
