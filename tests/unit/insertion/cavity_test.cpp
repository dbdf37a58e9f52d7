// SPDX-License-Identifier: Apache-2.0
// The conflict region of a vertex, triangulated anew, in meshes that are far from Delaunay
// (common/insertion/cavity.dev.h).
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/insertion/cavity.dev.h"
#include "common/insertion/seed_triangle.dev.h"
#pragma GCC diagnostic pop

/// A mesh of random points, made by flips of any edge that may be flipped.
class RandomMesh {
 public:
  RandomMesh(std::uint32_t n, std::uint32_t seed, bool lattice) : random_(seed), hints_(n) {
    for (std::uint32_t i = 0; i < n; ++i) {
      points_.push_back(lattice ? cadt_point{below(9) / 16.0, below(9) / 16.0}
                                : cadt_point{below(1U << 20) / 1048576.0, below(1U << 20) / 1048576.0});
    }
    std::ranges::sort(points_, [](cadt_point a, cadt_point b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    points_.erase(std::unique(points_.begin(), points_.end(),
                              [](cadt_point a, cadt_point b) { return a.x == b.x && a.y == b.y; }),
                  points_.end());
    make();
  }

  [[nodiscard]] std::uint32_t vertices() const { return static_cast<std::uint32_t>(points_.size()); }
  [[nodiscard]] std::uint32_t slots() const { return static_cast<std::uint32_t>(records_.size()); }
  std::uint32_t below(std::uint32_t end) { return std::uniform_int_distribution<std::uint32_t>(0, end - 1)(random_); }

  /// Flips random edges whose quadrilaterals are convex.
  void shuffle(std::uint32_t flips) {
    cadt_locked_mesh m = view();
    cadt_counters counters;
    cadt_counters_clear(&counters);
    for (std::uint32_t i = 0; i < flips; ++i) {
      const std::uint32_t link = CADT_HALF_EDGE(below(slots()), below(3));
      const cadt_snapshot s = cadt_snapshot_from(&m, CADT_TRIANGLE_OF(link), CADT_EDGE_OF(link));
      if (s.lock == 0) continue;
      const cadt_snapshot u = cadt_snapshot_from(&m, CADT_TRIANGLE_OF(s.n0), CADT_EDGE_OF(s.n0));
      if (s.v0 == CADT_GHOST || s.v1 == CADT_GHOST || s.v2 == CADT_GHOST || u.v0 == CADT_GHOST) continue;
      if (side(s.v0, s.v1, u.v0) <= 0 || side(s.v0, u.v0, s.v2) <= 0) continue;
      cadt_write_flip(&m, link, &s, &u, &counters);
    }
  }

  /// What the driver does. How many triangles were made.
  std::uint32_t cavity(std::uint32_t w, std::uint32_t capacity) {
    std::vector<std::uint32_t> ends(CADT_CAVITY_SET_WORDS, ~0U), list(capacity), kept(capacity), spokes(2 * capacity),
        scratch(CADT_CAVITY_SCRATCH * capacity);
    std::array<std::uint32_t, CADT_CAVITY_WORDS> found{};
    const auto run = [&](auto kernel, auto... rest) {
      kernel(0, 1, records_.data(), points_.data(), hints_.data(), nullptr, 0, 0, 0, 0, 0, CADT_STABILIZE_OFF, 0, 0.0,
             rest...);
    };
    std::uint32_t size = 0;
    run(cadt_cavity_sizes, slots(), slots(), ends.data(), &w, 1U, &size);
    run(cadt_cavity_conflicts, slots(), slots(), ends.data(), w, list.data(), capacity, found.data());
    EXPECT_EQ(found[CADT_CAVITY_LISTED], size);
    const std::uint32_t conflicts = std::min(found[CADT_CAVITY_LISTED], capacity);
    run(cadt_cavity_star, conflicts, conflicts, w, list.data(), capacity, found.data());
    const std::uint32_t listed = std::min(found[CADT_CAVITY_LISTED], capacity);
    cadt_cavity_roots(0, 1, records_.data(), listed, listed, list.data(), scratch.data(), capacity);
    cadt_cavity_join(0, 1, records_.data(), listed, listed, list.data(), scratch.data());
    run(cadt_cavity_check, listed, listed, w, list.data(), scratch.data(), capacity);
    cadt_cavity_keep(0, 1, records_.data(), listed, listed, list.data(), scratch.data(), capacity, kept.data(),
                     found.data());
    const std::uint32_t count = found[CADT_CAVITY_KEPT];
    run(cadt_cavity_boundary, count, count, w, kept.data(), scratch.data(), spokes.data(), capacity, found.data());
    EXPECT_EQ(found[CADT_CAVITY_SIDES], count);
    EXPECT_LE(found[CADT_CAVITY_SPOKES], count);
    run(cadt_cavity_fill, count, found[CADT_CAVITY_SPOKES], 3 * slots(), w, kept.data(), scratch.data(), spokes.data());
    run(cadt_cavity_release, count, found[CADT_CAVITY_SPOKES], 3 * slots(), kept.data(), scratch.data(), spokes.data());
    return count;
  }

  /// Twice the area of the region, in units of 2^-40, and whether all triangles are counterclockwise, all links lead
  /// back, all records are free.
  [[nodiscard]] double check() const {
    double area = 0;
    for (std::uint32_t t = 0; t < slots(); ++t) {
      const std::uint32_t* r = records_[t].word;
      if (r[CADT_WORD_LOCK] == 0) continue;
      EXPECT_TRUE(cadt_is_unlocked(r[CADT_WORD_LOCK]));
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t* u = records_[CADT_TRIANGLE_OF(r[CADT_WORD_HALF_EDGE + k])].word;
        const std::uint32_t j = CADT_EDGE_OF(r[CADT_WORD_HALF_EDGE + k]);
        EXPECT_EQ(u[CADT_WORD_HALF_EDGE + j], CADT_HALF_EDGE(t, k));
        EXPECT_EQ(u[(j + 1) % 3], r[(k + 2) % 3]);
        EXPECT_EQ(u[(j + 2) % 3], r[(k + 1) % 3]);
      }
      if (r[0] == CADT_GHOST || r[1] == CADT_GHOST || r[2] == CADT_GHOST) continue;
      EXPECT_EQ(side(r[0], r[1], r[2]), 1);
      const cadt_point a = points_[r[0]], b = points_[r[1]], c = points_[r[2]];
      area += (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    }
    return area;
  }

  [[nodiscard]] std::uint32_t illegal_edges() {
    const cadt_locked_mesh m = view();
    cadt_counters counters;
    cadt_counters_clear(&counters);
    std::uint32_t illegal = 0;
    for (std::uint32_t t = 0; t < slots(); ++t)
      for (std::uint32_t k = 0; k < 3 && records_[t].word[CADT_WORD_LOCK] != 0; ++k) {
        const cadt_snapshot s = cadt_snapshot_from(&m, t, k);
        const cadt_snapshot u = cadt_snapshot_from(&m, CADT_TRIANGLE_OF(s.n0), CADT_EDGE_OF(s.n0));
        illegal += cadt_is_illegal(&m, s.v0, s.v1, s.v2, u.v0, &counters);
      }
    return illegal / 2;
  }

  [[nodiscard]] bool hints_are_good() const {
    return std::ranges::all_of(hints_, [&](std::uint32_t t) { return records_[t].word[CADT_WORD_LOCK] != 0; });
  }

 private:
  cadt_locked_mesh view() {
    cadt_locked_mesh m{};
    m.locked = records_.data();
    m.points = points_.data();
    m.vertex_to_triangle = hints_.data();
    return m;
  }
  [[nodiscard]] int side(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    cadt_counters counters;
    cadt_counters_clear(&counters);
    return cadt_orientation(points_[a], points_[b], points_[c], &counters);
  }
  /// By the kernels of the library.
  void make() {
    const auto n = vertices();
    records_.assign(2 * std::size_t{n}, cadt_locked_triangle{});
    std::uint32_t third = 1;
    while (side(0, n / 2, third) == 0) ++third;
    cadt_locked_mesh m = view();
    m.second = n / 2;
    m.third = third;
    cadt_counters counters;
    cadt_counters_clear(&counters);
    cadt_make_seed_mesh(&m, &counters);
    std::vector<std::uint32_t> left(4096), counts(16);
    const cadt_deferred deferred = {left.data(), counts.data(), 4096};
    for (std::uint32_t i = 0; i < n; ++i) {
      if (i == m.first || i == m.second || i == m.third) continue;
      std::uint32_t hint = hints_[0];
      CADT_DECLARE_WORKLIST(work);
      cadt_worklist_begin(&work, i, CADT_FLIP_LIMIT);
      work.apex_point = points_[i];
      work.size = cadt_try_insert(&m, i, points_[i], &hint, work.half_edge, &counters);
      hints_[i] = hint;
      cadt_legalize(&m, &work, &deferred, &counters);
    }
  }

  std::mt19937 random_;
  std::vector<cadt_point> points_;
  std::vector<cadt_locked_triangle> records_;
  std::vector<std::uint32_t> hints_;
};

TEST(Cavity, KeepsAnyMeshAMesh) {
  std::uint32_t made = 0, none = 0, fewer = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    RandomMesh mesh(4 + seed % 60, seed, seed % 3 == 0);
    ASSERT_EQ(mesh.illegal_edges(), 0U);
    mesh.shuffle(1 + seed % 40 * 20);
    const double area = mesh.check();
    for (int i = 0; i < 20; ++i) {
      const std::uint32_t before = mesh.illegal_edges();
      const std::uint32_t count = mesh.cavity(mesh.below(mesh.vertices()), i % 5 == 0 ? 3 : 500);
      ++(count == 0 ? none : made);
      EXPECT_EQ(mesh.check(), area);
      EXPECT_TRUE(mesh.hints_are_good());
      fewer += mesh.illegal_edges() < before ? 1 : 0;
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(made, 500U);
  EXPECT_GT(none, 500U);
  EXPECT_GT(fewer, made / 2);
}

}  // namespace
