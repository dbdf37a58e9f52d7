// SPDX-License-Identifier: Apache-2.0
// Constrained edges in the locked mesh: never flipped, split in two, carried along by every split and flip. A list of
// pairs of vertices tells what must be constrained.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/insertion/drop_locks.dev.h"
#include "common/insertion/legality_sweep.dev.h"
#include "common/insertion/partitioned.dev.h"
#include "common/insertion/seed_triangle.dev.h"
#pragma GCC diagnostic pop

using Edge = std::pair<std::uint32_t, std::uint32_t>;
Edge edge(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

class ConstrainedMesh {
 public:
  /// Points of a lattice, so that many lie on edges.
  ConstrainedMesh(std::uint32_t wanted, std::uint32_t seed, bool partition) : random_(seed), partition_(partition) {
    std::set<Edge> taken;
    while (points_.size() < wanted) {
      const std::uint32_t x = below(24), y = below(24);
      if (taken.emplace(x, y).second) points_.push_back({x / 32.0, y / 32.0});
    }
    locked_.resize(2 * points_.size());
    flags_.resize(2 * points_.size());
    near_.resize(points_.size(), CADT_NONE);
    mesh_.locked = locked_.data();
    mesh_.points = points_.data();
    mesh_.vertex_to_triangle = near_.data();
    mesh_.edge_flags = flags_.data();
    mesh_.second = 1;
    mesh_.third = 2;
    cadt_counters_clear(&counters_);
    while (cadt_orientation(points_[0], points_[1], points_[mesh_.third], &counters_) == 0) ++mesh_.third;
    for (const std::uint32_t v : {0U, 1U, mesh_.third}) {
      mesh_.center.x += points_[v].x / 3;
      mesh_.center.y += points_[v].y / 3;
    }
    cadt_make_seed_mesh(&mesh_, &counters_);
  }

  void insert(std::uint32_t i) {
    if (i <= 1 || i == mesh_.third) return;
    const std::uint32_t edge_splits = counters_.count[CADT_COUNT_EDGE_SPLITS];
    if (partition_) {
      const cadt_partition all = {0, static_cast<std::uint32_t>(points_.size())};
      if (!cadt_insert_in_partition(&mesh_, &all, i, near_[0], &counters_)) insert_with_locks(i);
    } else {
      insert_with_locks(i);
    }
    if (counters_.count[CADT_COUNT_EDGE_SPLITS] == edge_splits) return;
    for (const auto& [a, b] : std::set<Edge>(constrained_)) {  // the edge that i lies on
      if (!is_between(a, i, b)) continue;
      constrained_.erase({a, b});
      constrained_.insert(edge(a, i));
      constrained_.insert(edge(i, b));
    }
  }

  /// A random inner edge, on both of its sides.
  void constrain() {
    for (;;) {
      const std::uint32_t t = below(static_cast<std::uint32_t>(locked_.size())), k = below(3);
      const auto& w = locked_[t].word;
      if (w[CADT_WORD_LOCK] == 0 || w[(k + 1) % 3] == CADT_GHOST || w[(k + 2) % 3] == CADT_GHOST) continue;
      const std::uint32_t across = w[CADT_WORD_HALF_EDGE + k];
      flags_[t] |= 1U << k;
      flags_[across >> 2] |= 1U << (across & 3U);
      constrained_.insert(edge(w[(k + 1) % 3], w[(k + 2) % 3]));
      return;
    }
  }

  /// The flagged edges; each must be flagged on both sides. `illegal`: sides of edges that are illegal, those that are
  /// not constrained and those that are.
  std::set<Edge> flagged(std::array<std::size_t, 2>& illegal) {
    std::set<Edge> all;
    illegal = {};
    for (std::uint32_t t = 0; t < locked_.size(); ++t) {
      const auto& w = locked_[t].word;
      if (w[CADT_WORD_LOCK] == 0) {
        EXPECT_EQ(flags_[t], 0U) << t;
        continue;
      }
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t across = w[CADT_WORD_HALF_EDGE + k], u = across >> 2, j = across & 3U;
        EXPECT_EQ(flags_[t] >> k & 1U, flags_[u] >> j & 1U) << "only one side of an edge";
        illegal[flags_[t] >> k & 1U] +=
            cadt_is_illegal(&mesh_, w[k], w[(k + 1) % 3], w[(k + 2) % 3], locked_[u].word[j], &counters_);
        if (flags_[t] >> k & 1U) all.insert(edge(w[(k + 1) % 3], w[(k + 2) % 3]));
      }
    }
    return all;
  }

  /// Edges that the legality sweep finds illegal.
  std::uint32_t sweep() {
    std::vector<std::uint32_t> edges(64), counts(CADT_DEFERRED_COUNTS + 5),
        rows(CADT_COUNTER_ROWS * CADT_COUNTER_STRIDE);
    const auto slots = static_cast<std::uint32_t>(locked_.size());
    cadt_legality_sweep(0, 1, locked_.data(), points_.data(), near_.data(), flags_.data(), 0, 0, 0, 0, 0,
                        CADT_STABILIZE_OFF, 0, 0.0, 0, slots, slots, 0, edges.data(), counts.data(), 64, rows.data());
    EXPECT_EQ(counts[CADT_DEFERRED_COUNTS], 3 * points_.size() - 3);
    return counts[CADT_DEFERRED_COUNTS + 1];
  }

  /// The flagged edges of the mesh without locks.
  std::set<Edge> flagged_in_arrays() {
    const auto slots = static_cast<std::uint32_t>(locked_.size());
    std::vector<std::uint32_t> ranks(slots + 1), vertices(3 * slots), half_edges(3 * slots), flags(slots);
    cadt_flag_triangles(0, 1, locked_.data(), ranks.data(), slots, slots, nullptr);
    std::uint32_t sum = 0;
    for (std::uint32_t& rank : ranks) sum += std::exchange(rank, sum);
    cadt_drop_locks(0, 1, locked_.data(), flags_.data(), ranks.data(), slots, 2 * mesh_.third, nullptr, slots,
                    vertices.data(), half_edges.data(), flags.data());
    std::set<Edge> all;
    for (std::uint32_t i = 0; i < 3 * (slots - 2); ++i)
      if (flags[i / 3] >> (i % 3) & 1U)
        all.insert(edge(vertices[i / 3 * 3 + (i + 1) % 3], vertices[i / 3 * 3 + (i + 2) % 3]));
    return all;
  }

  [[nodiscard]] const std::set<Edge>& constrained() const { return constrained_; }
  [[nodiscard]] std::uint64_t edge_splits() const { return counters_.count[CADT_COUNT_EDGE_SPLITS]; }
  std::uint32_t below(std::uint32_t end) { return std::uniform_int_distribution<std::uint32_t>(0, end - 1)(random_); }

 private:
  void insert_with_locks(std::uint32_t i) {
    std::vector<std::uint32_t> deferred_edges(64), counts(CADT_DEFERRED_COUNTS);
    const cadt_deferred deferred = {deferred_edges.data(), counts.data(), 64};
    std::uint32_t start = near_[0];
    CADT_DECLARE_WORKLIST(work);
    cadt_worklist_begin(&work, i, CADT_FLIP_LIMIT);
    work.apex_point = points_[i];
    while (work.size == 0) work.size = cadt_try_insert(&mesh_, i, points_[i], &start, work.half_edge, &counters_);
    near_[i] = start;
    cadt_legalize(&mesh_, &work, &deferred, &counters_);
    EXPECT_EQ(counts[1], 0U);
  }

  [[nodiscard]] bool is_between(std::uint32_t a, std::uint32_t i, std::uint32_t b) {
    const cadt_point p = points_[a], q = points_[i], r = points_[b];
    return cadt_orientation(p, q, r, &counters_) == 0 && (q.x - p.x) * (q.x - r.x) + (q.y - p.y) * (q.y - r.y) < 0;
  }

  std::mt19937 random_;
  bool partition_;
  std::vector<cadt_point> points_;
  std::vector<cadt_locked_triangle> locked_;
  std::vector<std::uint32_t> flags_, near_;
  std::set<Edge> constrained_;
  cadt_locked_mesh mesh_{};
  cadt_counters counters_;
};

TEST(ConstrainedEdges, GoThroughSplitsAndFlips) {
  std::size_t on_edges = 0, kept = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    constexpr std::uint32_t n = 90;
    ConstrainedMesh mesh(n, seed, seed % 2 != 0);
    std::array<std::size_t, 2> illegal{};
    for (std::uint32_t i = 2; i < n; ++i) {
      mesh.insert(i);
      if (i > 12 && i % 4 == 0) mesh.constrain();
      ASSERT_EQ(mesh.flagged(illegal), mesh.constrained()) << "seed " << seed << ", point " << i;
      ASSERT_EQ(illegal[0], 0U) << "seed " << seed << ", point " << i;
    }
    kept += illegal[1] / 2;
    on_edges += mesh.edge_splits();
    EXPECT_EQ(mesh.sweep(), 0U);
    EXPECT_EQ(mesh.flagged(illegal), mesh.constrained());
    EXPECT_EQ(mesh.flagged_in_arrays(), mesh.constrained());
  }
  EXPECT_GT(on_edges, 100U);
  EXPECT_GT(kept, 100U);
}

}  // namespace
