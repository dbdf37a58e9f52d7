// SPDX-License-Identifier: Apache-2.0
// The lowest pair of segments that cross, where one of the first of them tells it.
#include "common/constraints/polygons/first_edges.hpp"
#include "tests/unit/constraints/segment_sets.hpp"

#include <gtest/gtest.h>

namespace cadt::test {
namespace {

std::optional<Segment> lowest(const std::vector<double>& xy, const std::vector<Segment>& segments) {
  return crossing_of_first_edges(PointsView(std::span<const double>(xy)), segments);
}

TEST(FirstEdges, ByHand) {
  const std::vector<double> xy = {0, 0, 4, 4, 0, 4, 4, 0, 2, 2, 2, 9, 9, 9, 9, 8};
  EXPECT_EQ(lowest({xy.begin(), xy.begin() + 8}, {{0, 1}, {2, 3}}), (Segment{0, 1}));
  EXPECT_EQ(lowest(xy, {{0, 1}, {2, 3}}), std::nullopt);          // point 4 divides both
  EXPECT_EQ(lowest(xy, {{0, 1}, {4, 5}, {4, 2}}), std::nullopt);  // they end on the first
  const std::vector<Segment> far(4, {6, 7});
  std::vector<Segment> segments = far;
  segments.insert(segments.end(), {{0, 1}, {2, 3}});
  EXPECT_EQ(lowest({xy.begin(), xy.begin() + 16}, segments), std::nullopt);  // none of the first four
}

TEST(FirstEdges, AreThoseOfAllPairs) {
  std::size_t told = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const SegmentSet set = lattice_segments(seed, 4 + static_cast<int>(seed % 30), 5 + seed % 30, 1, 1);
    const auto found = lowest(set.xy, set.segments);
    if (!found) continue;
    ASSERT_EQ(*found, find_crossings(PointsView(set.xy), set.segments).front()) << set.name;
    ++told;
  }
  EXPECT_GT(told, 150U);
}

}  // namespace
}  // namespace cadt::test
