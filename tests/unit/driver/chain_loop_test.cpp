// SPDX-License-Identifier: Apache-2.0
// The hull as one loop of edges, in a set so small that a table of its points is made, and in a large one.
#include <gtest/gtest.h>

#include <cadt/errors.hpp>

#include <cstdint>
#include <vector>

#include "common/output/renumber.hpp"

namespace cadt {
namespace {

using Edges = std::vector<std::array<std::uint32_t, 2>>;
constexpr std::size_t point_counts[] = {20, 100000};

TEST(ChainLoop, StartsAtTheSmallest) {
  const std::vector<std::int32_t> expected = {2, 9, 5, 17, 4};
  for (const std::size_t points : point_counts)
    EXPECT_EQ(chain_loop(Edges{{17, 4}, {5, 17}, {2, 9}, {9, 5}, {4, 2}}, points), expected) << points;
}

TEST(ChainLoop, RefusesWhatIsNotOneLoop) {
  const std::vector<Edges> wrong = {
      {{1, 2}, {2, 3}, {3, 4}},                          // open
      {{1, 2}, {2, 3}, {3, 1}, {4, 5}, {5, 6}, {6, 4}},  // two loops
      {{1, 2}, {3, 1}},                                  // with a gap
      {{1, 2}, {2, 3}, {3, 2}},                          // does not return to its start
      {{1, 2}, {2, 1}, {2, 3}},                          // two from one vertex
  };
  for (const std::size_t points : point_counts)
    for (const Edges& edges : wrong)
      EXPECT_THROW((void)chain_loop(edges, points), InternalError) << points << " points, " << edges.size() << " edges";
}

}  // namespace
}  // namespace cadt
