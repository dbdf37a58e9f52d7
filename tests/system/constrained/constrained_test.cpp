// SPDX-License-Identifier: Apache-2.0
// Constrained Delaunay triangulations on every back end: the triangles and constrained edges of CGAL, whatever the
// order and the direction of segments.
#include <cadt/constrained.hpp>

#include "tests/support/families.hpp"
#include "tests/system/constrained/constrained_check.hpp"
#include "tests/system/constrained/legal_segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

/// Short segments side by side, some of which wait for others a few times, and long ones that stay longer.
TEST_P(Constrained, ShortOnesBetweenLongOnes) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Points xy = uniform_points(3000, seed);
    const auto n = static_cast<std::int32_t>(xy.size() / 2);
    std::vector<Segment> segments;
    for (std::int32_t i = 0; i < 3; ++i) {
      xy.insert(xy.end(), {-0.1, 0.2 + 0.3 * i, 1.1, 0.21 + 0.3 * i});
      segments.push_back({n + 2 * i, n + 2 * i + 1});
    }
    Random random(seed);
    for (int tries = 0; tries < 200000 && segments.size() < 63; ++tries) {
      const Segment one = {static_cast<std::int32_t>(random.below(3000)),
                           static_cast<std::int32_t>(random.below(3000))};
      const auto i = 2 * static_cast<std::size_t>(one[0]), j = 2 * static_cast<std::size_t>(one[1]);
      const double away = std::abs(xy[i] - xy[j]) + std::abs(xy[i + 1] - xy[j + 1]);
      const bool in_the_middle = std::abs(xy[i] - 0.5) < 0.1 && std::abs(xy[i + 1] - 0.35) < 0.1;
      if (one[0] == one[1] || away > 0.15 || !in_the_middle) continue;
      if (std::ranges::none_of(segments, [&](const Segment& other) { return crosses(xy, one, other); }))
        segments.push_back(one);
    }
    const Statistics& statistics = check(xy, segments).statistics();
    EXPECT_GT(statistics.inserted_segments, 30U);
    EXPECT_GT(statistics.segment_retries, 10U);
  }
}

/// Loose ends of short segments in the cavity of a long one, alone and in bushes, also at its ends: chains that come to
/// a vertex several times, at the apex and at the base.
TEST_P(Constrained, SpikesInACavity) {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Points xy = {0, 0, 40, 0, 20, -200, 20, 200};
    for (int i = 1; i < 40; i += 3) xy.insert(xy.end(), {i + random.uniform(0, 2), random.uniform(-3, -0.5)});
    std::vector<Segment> segments = {{0, 1}};
    const auto add = [&](std::int32_t from, double x, double y) {
      const auto tip = static_cast<std::int32_t>(xy.size() / 2);
      xy.insert(xy.end(), {x, y});
      const Segment spike = {from, tip};
      if (std::ranges::none_of(segments, [&](const Segment& s) { return crosses(xy, spike, s); }))
        segments.push_back(spike);
    };
    for (std::size_t bushes = 1 + seed % 5; bushes > 0; --bushes) {
      std::int32_t root = static_cast<std::int32_t>(random.below(2));
      if (random.below(3) != 0) {
        root = static_cast<std::int32_t>(xy.size() / 2);
        xy.insert(xy.end(), {random.uniform(1, 39), random.uniform(1, 9)});
      }
      const double x = xy[2 * static_cast<std::size_t>(root)], y = xy[2 * static_cast<std::size_t>(root) + 1];
      for (std::size_t spikes = 1 + random.below(4); spikes > 0; --spikes)
        add(root, x + random.uniform(-8, 8), std::abs(y + random.uniform(-2, 2)) + 0.01);
    }
    check(xy, segments);
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

/// More vertices than a patch has (find_segments.dev.h): segments are sorted. In each quadrilateral of a lattice, whose
/// points are moved a little, a side and a diagonal, and some of them again or of no length.
TEST_P(Constrained, SegmentsInSeveralPatches) {
  constexpr std::int32_t side = 265;
  Random random(13);
  Points xy;
  std::vector<Segment> segments;
  for (std::int32_t y = 0; y < side; ++y) {
    for (std::int32_t x = 0; x < side; ++x) {
      xy.insert(xy.end(), {x + random.uniform(-0.2, 0.2), y + random.uniform(-0.2, 0.2)});
      const std::int32_t v = y * side + x;
      if (x + 1 == side || y + 1 == side) continue;
      segments.push_back({v, v + 1});
      segments.push_back(random.below(2) != 0 ? Segment{v, v + side + 1} : Segment{v + 1, v + side});
      if (random.below(50) == 0) segments.push_back(segments.back());
      if (random.below(50) == 0) segments.push_back({v, v});
    }
  }
  for (std::size_t i = segments.size(); i > 1; --i) std::swap(segments[i - 1], segments[random.below(i)]);
  const ConstrainedTriangulation mesh = check(xy, segments);
  EXPECT_GT(mesh.statistics().inserted_segments, segments.size() / 10);
}

CADT_ON_MAIN_BACKENDS(Constrained);

}  // namespace
}  // namespace cadt::test
