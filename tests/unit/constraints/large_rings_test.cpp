// SPDX-License-Identifier: Apache-2.0
// Rings of more points than one work-item takes, in no order: nearly all edges cross.
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

#include "tests/support/backends.hpp"
#include "tests/unit/constraints/polygon_sets.hpp"

namespace cadt::test {
namespace {

class LargeRings : public BackendTest {};

/// The first edges cross many others, some of them in points.
TEST_P(LargeRings, InNoOrder) {
  std::mt19937_64 random(8);
  for (const std::uint64_t size : {12U, 40U, 1U << 20}) {
    PolygonSet set;
    for (int i = 0; i < 8; ++i) {
      std::vector<Ring> polygon(1 + random() % 2);
      for (Ring& ring : polygon)
        for (std::uint64_t n = 600 + random() % 50; n > 0; --n)
          ring.push_back({static_cast<double>(random() % size), static_cast<double>(random() % size)});
      set.add(polygon);
    }
    const PolygonsResult result = set.triangulate(GetParam().options());
    ASSERT_EQ(result.problems().size(), set.size());
    for (const PolygonProblem& found : result.problems()) {
      const Expected expected = expected_of(set, found.polygon);
      EXPECT_EQ(found.status, expected.status) << "polygon " << found.polygon;
      EXPECT_EQ(found.first, expected.first) << "polygon " << found.polygon;
      EXPECT_EQ(found.second, expected.second) << "polygon " << found.polygon;
    }
  }
}

/// 1.6 * 10^9 pairs of edges cross; the lowest is wanted, and the other polygons.
TEST_P(LargeRings, PointsInNoOrderDoNotStopTheOthers) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> place(0, 1);
  Ring ring;
  for (int i = 0; i < 100000; ++i) ring.push_back({place(random), place(random)});
  PolygonSet set;
  set.add({{{0, 0}, {1, 0}, {0, 1}}});
  set.add({ring});
  set.add({{{0, 0}, {1, 0}, {0, 1}}});
  const PolygonsResult result = set.triangulate(GetParam().options());
  ASSERT_EQ(result.problems().size(), 1U);
  EXPECT_EQ(result.triangle_offsets().back(), 2);
  const PolygonProblem& found = result.problems()[0];
  EXPECT_EQ(found.status, PolygonStatus::self_crossing);
  EXPECT_EQ(found.first, 3);
  const auto crosses = [&](std::size_t j) {
    const auto part = [&](std::size_t a, std::size_t b) {
      return exact_orientation(ring[a], ring[a + 1], ring[b]) * exact_orientation(ring[a], ring[a + 1], ring[b + 1]) <
             0;
    };
    return part(0, j) && part(j, 0);
  };
  std::size_t lowest = 2;
  while (!crosses(lowest)) ++lowest;
  EXPECT_EQ(found.second, static_cast<std::int32_t>(3 + lowest));
}

CADT_ON_MAIN_BACKENDS(LargeRings);

}  // namespace
}  // namespace cadt::test
