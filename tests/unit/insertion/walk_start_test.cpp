// SPDX-License-Identifier: Apache-2.0
// Where walks start, by the text of GPUs, in whose order the points are: a launch takes as long as its longest walk.
#include "gpu_insertion.hpp"

#include <random>

#include <gtest/gtest.h>

namespace {

struct Walks {
  std::uint32_t longest = 0;
  double mean = 0;
};

std::vector<cadt_point> by_level(const std::vector<cadt_point>& sorted) {
  const auto count = static_cast<std::uint32_t>(sorted.size());
  std::vector<cadt_point> points(count);
  for (std::uint32_t i = 0; i < count; ++i) points[cadt_rank_of(0, i, count)] = sorted[i];
  return points;
}

/// Inserts `sorted` one after another, level by level; walks start as if a launch inserted so many levels.
Walks insert_all(const std::vector<cadt_point>& sorted, std::uint32_t levels_per_launch = 1) {
  SeededMesh m(by_level(sorted));
  const std::uint32_t n = m.size();
  CADT_DECLARE_WORKLIST(work);
  Walks walks;
  for (std::uint32_t level = 32U - static_cast<std::uint32_t>(__builtin_clz(n - 1)); level-- > 0;)
    for (std::uint32_t block = 0; block < cadt_blocks_of(level, n) / 2; ++block) {
      const std::uint32_t i = cadt_blocks_of(level + 1, n) + block, before = m.counters.count[CADT_COUNT_WALK_STEPS];
      if (i <= 2) continue;  // of the seed triangle
      const std::uint32_t above = (level / levels_per_launch + 1) * levels_per_launch;
      cadt_u32 start = cadt_start_beside(&m.mesh, above, i, n, m.points[i]);
      cadt_worklist_begin(&work, i, 1U << 20);
      work.apex_point = m.points[i];
      work.size = cadt_try_insert(&m.mesh, i, m.points[i], &start, work.half_edge, &m.counters);
      EXPECT_GT(work.size, 0U);
      m.hints[i] = start;
      walks.longest = std::max(walks.longest, m.counters.count[CADT_COUNT_WALK_STEPS] - before);
      cadt_legalize(&m.mesh, &work, &m.deferred, &m.counters);
    }
  EXPECT_EQ(m.counts[1], 0U);
  walks.mean = static_cast<double>(m.counters.count[CADT_COUNT_WALK_STEPS]) / n;
  return walks;
}

/// `count` points along a line, from the left to the right.
void add_row(std::vector<cadt_point>& points, std::uint32_t count, double y, std::mt19937& random) {
  std::uniform_real_distribution<double> shift(0, 1e-4);
  for (std::uint32_t i = 0; i < count; ++i) points.push_back({(i + 0.5) / count + shift(random), y + shift(random)});
}

// The order goes along three rows, each from the left to the right, as a curve comes back to a row from elsewhere.
// Blocks that have the end of a row and the beginning of another one have halves that are far apart.
TEST(WalkStart, RowsToWhichTheOrderComesBack) {
  std::mt19937 random(1);
  std::vector<cadt_point> points;
  add_row(points, 3000, 0.1, random);
  add_row(points, 2500, 0.3, random);
  add_row(points, 2700, 0.5, random);
  EXPECT_LT(insert_all(points).longest, 100U);
  EXPECT_LT(insert_all(points, 3).longest, 120U);
}

// Evenly spread points, in the order of their rows, each in the other direction than the last.
TEST(WalkStart, UniformPoints) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> place(0, 1);
  std::vector<cadt_point> points;
  for (int row = 0; row < 100; ++row) {
    std::vector<cadt_point> of_row;
    for (int i = 0; i < 100; ++i) of_row.push_back({place(random), (row + place(random)) / 100});
    std::ranges::sort(of_row, [&](cadt_point a, cadt_point b) { return row % 2 == 0 ? a.x < b.x : a.x > b.x; });
    points.insert(points.end(), of_row.begin(), of_row.end());
  }
  EXPECT_LT(insert_all(points).mean, 2.9);
}

}  // namespace
