// SPDX-License-Identifier: Apache-2.0
// Polygons with a defect, and those with holes of one and two points, which have none.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/constraints/polygons_test.hpp"

namespace cadt::test {
namespace {

class PolygonDefects : public Polygons {};

/// One polygon of each defect among good ones, which become what they are alone.
TEST_P(PolygonDefects, DefectsAreReportedOneByOne) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const Ring square = {{0, 0}, {9, 0}, {9, 9}, {0, 9}};
  const std::vector<std::pair<std::vector<Ring>, PolygonStatus>> cases = {
      {{square}, PolygonStatus::ok},
      {{}, PolygonStatus::too_few_points},
      {{{}, square}, PolygonStatus::too_few_points},
      {{{{1, 1}, {2, 2}, {1, 1}}, square}, PolygonStatus::too_few_points},
      {{{{0, 0}, {1, 0}, {0, nan}}}, PolygonStatus::not_finite},
      {{{{0, 0}, {-inf, 0}, {0, 1}}}, PolygonStatus::not_finite},
      {{{{0, 0}, {2, 2}, {2, 0}, {0, 2}}}, PolygonStatus::self_crossing},
      {{square, {{8, 1}, {10, 1}, {10, 2}}}, PolygonStatus::ring_crossing},
      {{{{0, 0}, {1, 1}, {3, 3}}}, PolygonStatus::zero_area},
      {{square, square}, PolygonStatus::zero_area},
      {{{{5, 2}, {5, 0}, {5, 2}, {3, 4}, {1, 2}, {3, 4}, {1, 4}}}, PolygonStatus::self_crossing},  // of two slits
      {{{{4, 0}, {4, 1}, {0, 3}, {4, 1}}, {{1, 1}, {2, 1}, {0, 0}, {2, 1}}, {{2, 2}, {4, 3}, {1, 0}, {4, 3}}},
       PolygonStatus::ring_crossing},
      {{square, {{1, 1}, {1, 1}, {2, 1}, {2, 2}, {2, 2}}}, PolygonStatus::ok},
  };
  PolygonSet set;
  for (const auto& one : cases) {
    set.add({square});
    set.add(one.first);
  }
  const PolygonsResult result = triangulate(set);
  std::size_t problems = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(result.status()[2 * i], PolygonStatus::ok);
    EXPECT_EQ(result.triangles(2 * i).size(), 6U);
    EXPECT_EQ(to_string(result.status()[2 * i + 1]), to_string(cases[i].second)) << i;
    if (cases[i].second != PolygonStatus::ok) ++problems;
  }
  EXPECT_EQ(result.problems().size(), problems);
  expect_equal(set);
}

/// Holes of one or two points are vertices and edges of the mesh; those without points are nothing.
TEST_P(PolygonDefects, HolesOfFewPoints) {
  const Ring square = {{0, 0}, {9, 0}, {9, 9}, {0, 9}}, dot = {{3, 4}}, line = {{1, 1}, {1, 8}},
             bow_tie = {{0, 0}, {2, 2}, {2, 0}, {0, 2}};
  const double far = 0x1p600;
  std::mt19937_64 random(9);
  struct Case {
    std::vector<Ring> rings;
    std::size_t triangles;
    PolygonStatus status = PolygonStatus::ok;
    std::int32_t first = -1, second = -1;  // of two edges that cross
  };
  const std::vector<Case> cases = {
      {{square, {}}, 2},
      {{square, dot}, 4},
      {{square, {{3, 4}, {3, 4}, {3, 4}}}, 4},
      {{square, line}, 6},
      {{square, {{1, 1}, {1, 8}, {1, 1}}}, 6},
      {{square, dot, {}, line, {{5, 5}}}, 10},
      {{square, {{9, 4}}}, 3},
      {{square, {{9, 9}}}, 2},
      {{square, {{9, 0}, {0, 9}}}, 2},
      {{square, {{20, 4}}, {{11, 2}, {30, 2}}}, 2},
      {{{{0, 0}, {far, 0}, {0, 0x1p-600}}, {{far / 4, 0x1p-602}}}, 3},
      {{square, {{1, 1}, {10, 1}}}, 0, PolygonStatus::ring_crossing},
      {{bow_tie, dot}, 0, PolygonStatus::self_crossing},
      {{square, dot, {{5, 4}, {6, 4}, {6, 3}, {5, 3.5}, {6.5, 3.5}}}, 0, PolygonStatus::self_crossing, 6, 8},
      {{square, dot, line, {{5, 5}, {5, 5}}, {{8, 1}, {10, 1}, {8, 2}}}, 0, PolygonStatus::ring_crossing, 1, 9},
      {{{{0, 0}, {1, 1}, {3, 3}}, dot}, 0, PolygonStatus::zero_area},
      {{dot}, 0, PolygonStatus::too_few_points},
      {{line, square}, 0, PolygonStatus::too_few_points},
      {{star(random, 600, 0, 0, 5e8, 1e9), dot}, 600},
  };
  PolygonSet set;
  for (int copy = 0; copy < 3; ++copy)
    for (const Case& one : cases) {
      set.add(one.rings);
      if (copy != 1) set.add({square});
    }
  expect_equal(set);
  const PolygonsResult result = triangulate(set);
  auto problem = result.problems().begin();
  std::size_t p = 0;
  for (int copy = 0; copy < 3; ++copy)
    for (const Case& one : cases) {
      EXPECT_EQ(to_string(result.status()[p]), to_string(one.status)) << p;
      if (one.status != PolygonStatus::ok) {
        ASSERT_EQ(problem->polygon, p);
        const auto begin = static_cast<std::int32_t>(set.rings_of(p)[0]);
        if (one.first >= 0)
          EXPECT_EQ(std::pair(problem->first - begin, problem->second - begin), std::pair(one.first, one.second)) << p;
        ++problem;
      }
      EXPECT_EQ(result.triangles(p++).size(), 3 * one.triangles) << p;
      if (copy == 1) continue;
      EXPECT_EQ(result.triangles(p++).size(), 6U) << p;
    }
}

/// What is told before any work is enough, and each polygon that is done alone shows progress.
TEST_P(PolygonDefects, MemoryAndProgressOfHolesOfFewPoints) {
  std::mt19937_64 random(3);
  PolygonSet set;
  for (int i = 0; i < 300; ++i) set.add({{{0, 0}, {9, 0}, {0, 9}}});
  set.add({star(random, 500, 0, 0, 5e8, 1e9), {{3, 4}}});
  for (int i = 0; i < 20; ++i) set.add({{{0, 0}, {9, 0}, {0, 9}}, {{1, 1}, {2, 1}}});
  Options options = GetParam().options();
  options.max_memory = 1;
  try {
    (void)set.triangulate(options);
    FAIL() << "a byte is enough";
  } catch (const OutOfMemory& error) {
    options.max_memory = error.needed();
  }
  std::vector<double> shown;
  options.progress = [&](const Progress& progress) { shown.push_back(progress.fraction); };
  const PolygonsResult result = set.triangulate(options);
  EXPECT_TRUE(result.problems().empty());
  EXPECT_GE(shown.size(), 21U);
  EXPECT_TRUE(std::ranges::is_sorted(shown));
}
CADT_ON_MAIN_BACKENDS(PolygonDefects);

}  // namespace
}  // namespace cadt::test
