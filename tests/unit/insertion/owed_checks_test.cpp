// SPDX-License-Identifier: Apache-2.0
// Points that are inserted at the same time, by the text of GPUs: in whatever order their splits and flips come, no
// illegal edge is left. (What a thread reads may be old, so the legality sweep looks at all edges still.)
#include "gpu_insertion.hpp"

#include <memory>
#include <random>

#include <gtest/gtest.h>

namespace {

/// A point on its way, with the edges that it has yet to test.
struct Lane {
  Lane() { work.half_edge = ring; }
  Lane(const Lane&) = delete;
  Lane& operator=(const Lane&) = delete;
  cadt_u32 ring[CADT_WORKLIST] = {};
  cadt_worklist work{};
};

class Launch : private SeededMesh {
 public:
  Launch(const std::vector<cadt_point>& of, std::uint32_t seed) : SeededMesh(of), random_(seed) {}

  using SeededMesh::size;
  [[nodiscard]] std::uint32_t met_others() const { return counters.count[CADT_COUNT_STALE_EDGES]; }

  /// Points begin, ..., end - 1: at each step one of them does what comes next.
  void insert(std::uint32_t begin, std::uint32_t end) {
    std::vector<std::uint32_t> waiting;
    for (std::uint32_t i = begin; i < end; ++i) waiting.push_back(i);
    std::vector<std::unique_ptr<Lane>> lanes;
    while (!waiting.empty() || !lanes.empty()) {
      const std::uint32_t which = below(static_cast<std::uint32_t>(waiting.size() + 4 * lanes.size()));
      if (which < waiting.size()) {
        std::swap(waiting[which], waiting.back());
        lanes.push_back(split(waiting.back()));
        waiting.pop_back();
        continue;
      }
      const std::size_t lane = (which - waiting.size()) / 4;
      cadt_legalize_next(&mesh, &lanes[lane]->work, &deferred, &counters);
      if (cadt_worklist_pending(&lanes[lane]->work)) continue;
      std::swap(lanes[lane], lanes.back());
      lanes.pop_back();
      if (lanes.empty()) take_deferred(lanes);
    }
  }

  [[nodiscard]] std::uint64_t illegal_edges() {
    std::uint64_t illegal = 0;
    for (std::uint32_t t = 0; t < locked.size(); ++t)
      for (std::uint32_t k = 0; k < 3 && locked[t].word[CADT_WORD_LOCK] != 0; ++k) {
        const cadt_snapshot s = cadt_snapshot_from(&mesh, t, k);
        const cadt_snapshot u = cadt_snapshot_from(&mesh, CADT_TRIANGLE_OF(s.n0), CADT_EDGE_OF(s.n0));
        EXPECT_EQ(u.n0, CADT_HALF_EDGE(t, k));
        illegal += cadt_is_illegal(&mesh, s.v0, s.v1, s.v2, u.v0, &counters);
      }
    return illegal / 2;
  }

 private:
  std::uint32_t below(std::uint32_t end) { return std::uniform_int_distribution<std::uint32_t>(0, end - 1)(random_); }

  [[nodiscard]] std::unique_ptr<Lane> split(std::uint32_t i) {
    auto lane = std::make_unique<Lane>();
    cadt_worklist_begin(&lane->work, i, CADT_FLIP_LIMIT);
    lane->work.apex_point = points[i];
    cadt_u32 start = hints[0];
    lane->work.size = cadt_try_insert(&mesh, i, points[i], &start, lane->work.half_edge, &counters);
    EXPECT_EQ(lane->work.size, 3U) << "nobody holds a lock between two steps";
    return lane;
  }

  /// What a launch would leave to the next one.
  void take_deferred(std::vector<std::unique_ptr<Lane>>& lanes) {
    for (cadt_u32 e = 0; e < counts[1]; ++e) {
      lanes.push_back(std::make_unique<Lane>());
      cadt_worklist_begin(&lanes.back()->work, CADT_NONE, CADT_EDGE_FLIP_LIMIT);
      lanes.back()->work.next = edges[e];
    }
    counts[1] = 0;
  }

  std::mt19937 random_;
};

std::vector<cadt_point> random_points(std::uint32_t count, std::uint32_t seed, bool on_parabola) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::uint32_t> coordinate(0, (1U << 20) - 1);
  std::vector<cadt_point> points;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double x = std::ldexp(coordinate(random), -20);
    points.push_back({x, on_parabola ? x * x : std::ldexp(coordinate(random), -20)});
  }
  std::ranges::sort(points, [](cadt_point a, cadt_point b) { return a.x < b.x; });
  points.erase(std::unique(points.begin(), points.end(), [](cadt_point a, cadt_point b) { return a.x == b.x; }),
               points.end());
  std::ranges::shuffle(points, random);
  return points;
}

void expect_legal(const std::vector<cadt_point>& points, std::uint32_t seed) {
  Launch launch(points, seed);
  for (std::uint32_t begin = 3, end = 16; begin < launch.size(); begin = end, end = std::min(8 * end, launch.size())) {
    launch.insert(begin, std::min(end, launch.size()));
    EXPECT_EQ(launch.illegal_edges(), 0U) << "after " << end << " points, order " << seed;
  }
  EXPECT_GT(launch.met_others(), 0U) << "nobody has met another";
}

TEST(OwedChecks, UniformPoints) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) expect_legal(random_points(2000, seed, false), seed);
}

// All of one hub's triangles change again and again.
TEST(OwedChecks, Parabola) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) expect_legal(random_points(1000, seed, true), seed);
}

}  // namespace
