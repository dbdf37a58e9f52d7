// SPDX-License-Identifier: Apache-2.0
// Constrained Delaunay triangulations on every back end: the triangles and constrained edges of CGAL, whatever the
// order and the direction of segments.
#include <cadt/constrained.hpp>

#include "tests/support/families.hpp"
#include "tests/system/constrained/constrained_check.hpp"
#include "tests/system/constrained/legal_segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace cadt::test {
namespace {

using Constrained = ConstrainedTest;

TEST_P(Constrained, RandomPoints) {
  std::size_t inserted = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Points xy = uniform_points(5 + 7 * seed, seed);
    inserted += check(xy, legal_segments(xy, 20 + 4 * seed, seed)).statistics().inserted_segments;
  }
  EXPECT_GT(inserted, 500U);
}

TEST_P(Constrained, Families) {
  for (const FamilyGroup& group : family_groups()) {
    for (const Family& family : group.families()) {
      const Points xy = family.make();
      if (xy.size() > 2 * 300) continue;
      SCOPED_TRACE(std::string(group.name) + "/" + family.name);
      check(xy, legal_segments(xy, 60, 7));
    }
  }
}

TEST_P(Constrained, Lattices) {
  for (int columns = 2; columns <= 12; ++columns) {
    SCOPED_TRACE(std::to_string(columns) + " columns");
    const Points xy = grid_points(columns, 12);
    check(xy, legal_segments(xy, 150, static_cast<std::uint64_t>(columns)));
  }
}

TEST_P(Constrained, OrderAndDirectionDoNotMatter) {
  const Points xy = uniform_points(300, 3);
  std::vector<Segment> segments = legal_segments(xy, 200, 5);
  const Hash128 expected = check(xy, segments).hash();
  Random random(11);
  for (int round = 0; round < 10; ++round) {
    for (std::size_t i = segments.size(); i > 1; --i) std::swap(segments[i - 1], segments[random.below(i)]);
    for (Segment& s : segments)
      if (random.below(2) != 0) std::swap(s[0], s[1]);
    EXPECT_EQ(triangulated(xy, segments).hash(), expected);
  }
}

CADT_ON_MAIN_BACKENDS(Constrained);

}  // namespace
}  // namespace cadt::test
