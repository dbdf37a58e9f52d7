// SPDX-License-Identifier: Apache-2.0
// The quadratic worst case of insertion, which the library's own order avoids: points on the axes, one after another
// from left to right, by the functions of the kernels. Each point beyond the vertical axis takes over most of the
// others.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/insertion/legality_sweep.dev.h"
#include "common/insertion/seed_triangle.dev.h"
#pragma GCC diagnostic pop

struct Work {
  std::uint64_t flips = 0, most_flips = 0;  ///< of all; of one point or edge before it ends
  std::uint64_t deferred_edges = 0;
};

/// Inserts the points in their order, each with at most `limit` flips before the rest is left for later.
Work insert_in_order(const std::vector<cadt_point>& points, std::uint32_t limit,
                     std::vector<cadt_locked_triangle>& records) {
  const auto n = static_cast<std::uint32_t>(points.size());
  records.assign(2 * n, cadt_locked_triangle{});
  std::vector<std::uint32_t> hints(n), edges(8 * n), counts(CADT_DEFERRED_COUNTS);
  cadt_locked_mesh mesh{};
  mesh.locked = records.data();
  mesh.points = points.data();
  mesh.vertex_to_triangle = hints.data();
  mesh.second = 1;
  mesh.third = 2;
  mesh.center = {(points[0].x + points[1].x + points[2].x) / 3, (points[0].y + points[1].y + points[2].y) / 3};
  cadt_counters counters;
  cadt_counters_clear(&counters);
  cadt_make_seed_mesh(&mesh, &counters);
  Work done;
  std::uint32_t before = 0;
  const auto count_flips = [&] {
    done.most_flips = std::max<std::uint64_t>(done.most_flips, counters.count[CADT_COUNT_FLIPS] - before);
    before = counters.count[CADT_COUNT_FLIPS];
  };
  const cadt_deferred deferred = {edges.data(), counts.data(), static_cast<std::uint32_t>(edges.size())};
  for (std::uint32_t i = 3; i < n; ++i) {
    std::uint32_t hint = hints[i - 1];
    CADT_DECLARE_WORKLIST(work);
    cadt_worklist_begin(&work, i, limit);
    work.apex_point = points[i];
    for (int tries = 0; tries < CADT_INSERT_TRIES && work.size == 0; ++tries)
      work.size = cadt_try_insert(&mesh, i, points[i], &hint, work.half_edge, &counters);
    EXPECT_GT(work.size, 0U) << "point " << i;
    if (work.size == 0) return done;
    hints[i] = hint;
    cadt_legalize(&mesh, &work, &deferred, &counters);
    count_flips();
    while (counts[1] != 0) {  // what a launch would leave to the next one
      const std::vector<std::uint32_t> left(edges.begin(), edges.begin() + counts[1]);
      done.deferred_edges += left.size();
      counts[1] = 0;
      for (const std::uint32_t edge : left) {
        cadt_worklist_begin(&work, CADT_NONE, limit);
        work.next = edge;
        cadt_legalize(&mesh, &work, &deferred, &counters);
        count_flips();
      }
    }
  }
  done.flips = counters.count[CADT_COUNT_FLIPS];
  EXPECT_EQ(counters.count[CADT_COUNT_LOCK_FAILURES], 0U) << "nobody else is there";
  return done;
}

std::uint64_t illegal_edges(const std::vector<cadt_point>& points, std::vector<cadt_locked_triangle>& records) {
  cadt_locked_mesh mesh{};
  mesh.locked = records.data();
  mesh.points = points.data();
  cadt_counters counters;
  cadt_counters_clear(&counters);
  std::uint64_t illegal = 0, live = 0;
  for (std::uint32_t t = 0; t < records.size(); ++t) {
    if (records[t].word[CADT_WORD_LOCK] == 0) continue;
    ++live;
    EXPECT_EQ(records[t].word[CADT_WORD_LOCK] & 1U, 0U);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const cadt_snapshot s = cadt_snapshot_from(&mesh, t, k);
      const cadt_snapshot u = cadt_snapshot_from(&mesh, CADT_TRIANGLE_OF(s.n0), CADT_EDGE_OF(s.n0));
      EXPECT_EQ(u.n0, CADT_HALF_EDGE(t, k));
      illegal += cadt_is_illegal(&mesh, s.v0, s.v1, s.v2, u.v0, &counters);
    }
  }
  EXPECT_EQ(live, 2 * points.size() - 2);
  return illegal;
}

std::vector<cadt_point> axes(int arm) {
  std::vector<cadt_point> points;
  for (int i = 1; i <= arm; ++i) {
    const double d = std::ldexp(i, -9);
    for (const cadt_point& p : {cadt_point{d, 0}, cadt_point{0, d}, cadt_point{-d, 0}, cadt_point{0, -d}})
      points.push_back(p);
  }
  return points;
}

TEST(FlipCascades, InsideOut) {
  const std::vector<cadt_point> points = axes(250);
  std::vector<cadt_locked_triangle> records;
  const Work work = insert_in_order(points, CADT_FLIP_LIMIT, records);
  EXPECT_EQ(illegal_edges(points, records), 0U);
  EXPECT_LT(work.flips, 3 * points.size());
  EXPECT_EQ(work.deferred_edges, 0U);
}

TEST(FlipCascades, FromLeftToRight) {
  constexpr int arm = 250;
  std::vector<cadt_point> points = axes(arm);
  std::sort(points.begin(), points.end(),
            [](const cadt_point& a, const cadt_point& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  // the first that is not on the line of the first two comes third
  const auto off_line = std::find_if(points.begin(), points.end(), [](const cadt_point& p) { return p.y != 0; });
  std::rotate(points.begin() + 2, off_line, off_line + 1);
  std::vector<cadt_locked_triangle> records, limited;
  const Work free = insert_in_order(points, CADT_FLIP_LIMIT, records);
  const std::uint64_t n = points.size();
  EXPECT_GE(free.flips, 123504U);
  EXPECT_LE(free.flips, n * n / 8);
  EXPECT_EQ(illegal_edges(points, records), 0U);
  // Launches end in bounded time: who may make few flips leaves the others for later, and all are made in the end.
  constexpr std::uint32_t few = 16;
  const Work bounded = insert_in_order(points, few, limited);
  EXPECT_EQ(illegal_edges(points, limited), 0U);
  EXPECT_GE(bounded.flips, 123504U);
  EXPECT_GT(bounded.deferred_edges, 0U);
  EXPECT_GE(free.most_flips, static_cast<std::uint64_t>(arm)) << "or there was nothing to bound";
  EXPECT_LE(bounded.most_flips, few + CADT_WORKLIST)
      << "edges that are on the worklist by then may be flipped, once each";
}

}  // namespace
