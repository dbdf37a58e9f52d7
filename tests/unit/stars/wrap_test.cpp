// SPDX-License-Identifier: Apache-2.0
// Gift wrapping as the host compiles it: what the first kernel finds, and when the second one gives up.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#define CADT_WIDE 0
namespace {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/stars/wrap_exact.dev.h"
#include "common/stars/wrap_fast.dev.h"
#pragma GCC diagnostic pop

using Points = std::vector<cadt_point>;

/// side * side points, in Morton order. `turn`: by this angle, so that nothing is exactly cocircular any more.
Points lattice(std::uint32_t side, double turn) {
  Points points;
  const double c = std::cos(turn), s = std::sin(turn);
  const auto walk = [&](const auto& self, std::uint32_t x, std::uint32_t y, std::uint32_t size) -> void {
    if (size == 1) {
      points.push_back({(c * x - s * y) / 256, (s * x + c * y) / 256});
      return;
    }
    for (std::uint32_t k = 0; k < 4; ++k) self(self, x + (k & 1U) * size / 2, y + (k >> 1U) * size / 2, size / 2);
  };
  walk(walk, 0, 0, side);
  return points;
}

Points polygon(int corners) {
  Points points;
  for (int i = 0; i < corners; ++i)
    points.push_back({std::cos(2 * std::numbers::pi * i / corners), std::sin(2 * std::numbers::pi * i / corners)});
  return points;
}

Points parabola(int count) {
  Points points;
  for (int i = 0; i < count; ++i) points.push_back({i / 4096.0, i / 4096.0 * i / 4096.0});
  return points;
}

/// One point at random in each cell of a lattice of side * side, in the unit square and in Morton order.
Points scattered(std::uint32_t side) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  Points points = lattice(side, 0.0);
  for (cadt_point& p : points) p = {(256 * p.x + unit(random)) / side, (256 * p.y + unit(random)) / side};
  return points;
}

/// Two such sets 1e12 apart: for one of them all points of the other are nearly in one direction.
Points far_apart(std::uint32_t side) {
  Points points = scattered(side);
  const std::size_t count = points.size();
  for (std::size_t i = 0; i < count; ++i) points.push_back({points[i].x + 1e12, points[i].y + 1e12});
  return points;
}

/// On a line but for what is rounded off.
Points nearly_straight(int count) {
  Points points;
  for (int i = 0; i < count; ++i) points.push_back({i / 64.0, i / 64.0 / 3.0});
  return points;
}

/// The AABB tree of the points.
struct AabbTree {
  std::vector<cadt_aabb> leaves, nodes;

  AabbTree(const Points& points, std::uint32_t* sizes, std::uint32_t* counts)
      : leaves((points.size() - 1) / CADT_AABB_LEAF + 1), nodes((leaves.size() - 1) / CADT_AABB_FANOUT + 1) {
    const auto node_count = static_cast<std::uint32_t>(nodes.size());
    cadt_build_aabb_tree(0, 1, points.data(), static_cast<std::uint32_t>(points.size()), nullptr, 0, node_count,
                         node_count, leaves.data(), nodes.data(), sizes, counts);
  }
};

/// What searches the star of w.p, by one work-item.
struct Searcher {
  AabbTree in;
  std::unique_ptr<cadt_wrap_memory> memory = std::make_unique<cadt_wrap_memory>();
  cadt_counters counters{};
  cadt_wrapper w{};

  explicit Searcher(const Points& points) : in(points, nullptr, nullptr) {
    const auto n = static_cast<std::uint32_t>(points.size());
    w.m = memory.get();
    w.in = cadt_aabb_tree_of(cadt_wrap_span_of(nullptr, 0, n), points.data(), in.leaves.data(), in.nodes.data());
    w.counters = &counters;
    w.lanes = 1;
  }
  Searcher(const Searcher&) = delete;
  Searcher& operator=(const Searcher&) = delete;
};

/// Both kernels, one work-item each.
struct Wrapped {
  std::vector<std::uint32_t> star_vertices, begins, sizes, todo, counts = std::vector<std::uint32_t>(CADT_WRAP_WORDS);
  std::uint32_t left = 0;  ///< by the first kernel

  explicit Wrapped(const Points& points) {
    const auto n = static_cast<std::uint32_t>(points.size()), words = 6 * n;
    std::vector<std::uint16_t> arcs(std::size_t{n} * CADT_WRAP_ROW);
    star_vertices.resize(words);
    begins.resize(n);
    sizes.resize(n);
    todo.resize(n);
    const auto [leaves, nodes] = AabbTree(points, sizes.data(), counts.data());
    cadt_wrap_near(0, 1, points.data(), leaves.data(), nodes.data(), n, n, 0, star_vertices.data(), words,
                   begins.data(), sizes.data(), counts.data(), todo.data(), arcs.data());
    left = counts[CADT_WRAP_TODO];
    constexpr std::uint32_t effort = 96, spare = 4096;
    cadt_wrap_stars(0, 1, points.data(), leaves.data(), nodes.data(), n, todo.data(), 0, arcs.data(), nullptr, 0,
                    nullptr, nullptr, effort, spare, n, 0, star_vertices.data(), words, begins.data(), sizes.data(),
                    counts.data());
  }
  [[nodiscard]] std::uint32_t failed() const { return counts[CADT_WRAP_FAILED]; }
  [[nodiscard]] std::uint32_t effort() const { return counts[CADT_WRAP_WORK]; }
  [[nodiscard]] std::uint32_t exact_tests() const {
    return counts[CADT_WRAP_EXACT_ORIENTATIONS] + counts[CADT_WRAP_EXACT_INCIRCLES];
  }
  /// Neighbours, counterclockwise; the ghost is not one. From the hull edge on, or from the least one.
  [[nodiscard]] std::vector<std::uint32_t> star(std::uint32_t v) const {
    std::vector<std::uint32_t> star(star_vertices.begin() + begins[v], star_vertices.begin() + begins[v] + sizes[v]);
    const auto ghost = std::ranges::find(star, CADT_GHOST);
    std::ranges::rotate(star, ghost != star.end() ? ghost : std::ranges::min_element(star));
    std::erase(star, CADT_GHOST);
    return star;
  }
};

// Which of cocircular points is next rounded numbers do not tell, and those of the hull have to be searched in any
// case.
TEST(WrappedNear, HasTheStarsOfLattices) {
  constexpr std::uint32_t side = 32;
  for (const double turn : {0.0, 0.3, 1.1}) {
    const Wrapped wrapped(lattice(side, turn));
    EXPECT_LT(wrapped.left, 8 * side) << "turned by " << turn;
    EXPECT_GE(wrapped.left, 2 * side) << "turned by " << turn;
    EXPECT_LE(wrapped.failed(), static_cast<std::uint32_t>(CADT_MOST_HIGH_DEGREE));
    EXPECT_LE(std::ranges::count(wrapped.sizes, 0U), wrapped.failed());
  }
}

// The largest set, whose numbers have 16 bits. By Euler's formula the stars have 6n - 6 - h words in all, those of h
// hull vertices with the ghost.
TEST(WrappedNear, HasTheStarsOfTheLargestSet) {
  Points points = lattice(256, 0.3);
  for (std::size_t i = 0; i < points.size(); ++i) {  // or the hull would take exact tests, and not be searched
    points[i].x += 0.001 * std::sin(1.7 * static_cast<double>(i));
    points[i].y += 0.001 * std::cos(2.3 * static_cast<double>(i));
  }
  ASSERT_EQ(points.size(), static_cast<std::size_t>(CADT_WRAP_MOST));
  const Wrapped wrapped(points);
  EXPECT_GE(wrapped.left, 100U) << "the hull";
  EXPECT_EQ(wrapped.failed(), 0U);
  std::size_t words = 0, hull = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const auto star = std::span(wrapped.star_vertices).subspan(wrapped.begins[v], wrapped.sizes[v]);
    words += star.size();
    hull += std::ranges::count(star, CADT_GHOST);
    for (const std::uint32_t other : star) ASSERT_TRUE(other < points.size() || other == CADT_GHOST) << v;
  }
  EXPECT_EQ(words, 6 * points.size() - 6 - hull);
}

// Where all points are on the hull each would look at all others: nothing is searched, unless they are few.
TEST(WrappedStars, GivesUpOnHulls) {
  for (const Points& points : {polygon(CADT_WRAP_HULL_EXACT + 1), parabola(CADT_WRAP_HULL + 1)}) {
    const Wrapped wrapped(points);
    EXPECT_EQ(wrapped.left, points.size());
    EXPECT_GT(wrapped.failed(), static_cast<std::uint32_t>(CADT_MOST_HIGH_DEGREE));
    EXPECT_EQ(wrapped.effort(), 0U);
  }
  for (const Points& points : {polygon(100), parabola(300)}) {
    const Wrapped wrapped(points);
    EXPECT_LE(wrapped.failed(), static_cast<std::uint32_t>(CADT_MOST_HIGH_DEGREE));
    EXPECT_GT(wrapped.effort(), 0U);
  }
}

// The neighbour behind another point is the best of all on that side, whichever way it is leaves_tested for.
TEST(WrappedNext, IsTheBestOfAll) {
  for (const Points& points :
       {scattered(64), lattice(64, 0.0), lattice(32, 0.3), far_apart(32), polygon(500), nearly_straight(700)}) {
    const auto n = static_cast<std::uint32_t>(points.size());
    Searcher search(points);
    cadt_wrapper& w = search.w;
    std::mt19937_64 random(3);
    for (int trial = 0; trial < 400; ++trial) {
      w.p = static_cast<std::uint32_t>(random() % n);
      const std::uint64_t beside = trial % 2 == 0 ? random() % 64 : random();  // near in Morton order, or any
      const auto a = static_cast<std::uint32_t>((w.p + 1 + beside % (n - 1)) % n);
      for (const int side : {1, -1}) {
        std::uint32_t best = CADT_NONE;
        for (std::uint32_t i = 0; i < n; ++i)
          if (i != w.p && i != a && cadt_orientation(points[w.p], points[a], points[i], &search.counters) == side)
            best = best == CADT_NONE ? i : cadt_wrap_better_of(points.data(), w.p, a, side, best, i, &search.counters);
        ASSERT_EQ(cadt_wrap_next(&w, a, side), best) << "behind " << a << " of " << w.p << ", side " << side;
      }
    }
  }
}

// Where discs hold hundreds of points that rounded numbers hardly tell apart, few of them are tested exactly: lanes
// wait for each other's exact tests.
TEST(WrappedStars, TakeFewExactTestsOfPointsFarAway) {
  const Points points = far_apart(32);
  const Wrapped wrapped(points);
  EXPECT_LE(wrapped.failed(), static_cast<std::uint32_t>(CADT_MOST_HIGH_DEGREE));
  EXPECT_LT(wrapped.exact_tests(), 500U);
}

// From a point nobody knows to be a neighbour, inside and on the hull, comes the same star as from a neighbour.
TEST(WrappedStars, BeginAnywhere) {
  for (const Points& points : {scattered(32), lattice(16, 0.0), lattice(32, 0.3), far_apart(16), parabola(60)}) {
    const auto n = static_cast<std::uint32_t>(points.size());
    const Wrapped expected(points);
    Searcher search(points);
    cadt_wrapper& w = search.w;
    std::size_t hull = 0;
    for (w.p = 0; w.p < n; ++w.p) {
      w.m->arc[0] = 0;
      std::uint32_t begin = 0, size = 0;
      std::int32_t side = 1;
      const std::uint32_t kind = cadt_wrap_star(&w, &begin, &size, &side);
      ASSERT_EQ(kind, expected.sizes[w.p] == 0 ? 0U : kind) << w.p;
      if (kind == 0) continue;
      std::vector<std::uint32_t> star(w.m->star + begin, w.m->star + begin + size), known = expected.star(w.p);
      if (side < 0) std::ranges::reverse(star);
      if (kind == 1) std::ranges::rotate(star, std::ranges::min_element(star));
      hull += kind == 2 ? 1U : 0U;
      ASSERT_EQ(star, known) << "of " << w.p;
    }
    EXPECT_GE(hull, 3U);
  }
}

// Sides of a turned lattice are lines but for what is rounded off. A point on one has circles of which next to nothing
// is known; those that bulge inwards by less than a point's distance hold few points nevertheless.
TEST(WrappedStars, LookAtFewPointsBesideStraightSides) {
  const Wrapped wrapped(lattice(64, 0.3));
  EXPECT_LE(wrapped.failed(), static_cast<std::uint32_t>(CADT_MOST_HIGH_DEGREE));
  EXPECT_LT(wrapped.effort(), 70000U);  // 89,000 without
}

// What is better than b on its side of the line p, a is in the disc, also where that is the one of a flat arc.
TEST(WrappedDisc, HoldsFlatArcs) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(-1, 1), part(0, 1);
  std::size_t flat = 0, better = 0;
  for (int trial = 0; trial < 400000; ++trial) {
    const cadt_point p{unit(random), unit(random)}, a{p.x + unit(random), p.y + unit(random)};
    // beside the line at a place between them, by any distance
    const auto beside = [&](double along) {
      const double off = std::ldexp(unit(random), -static_cast<int>(random() % 56));
      return cadt_point{p.x + along * (a.x - p.x) - off * (a.y - p.y), p.y + along * (a.y - p.y) + off * (a.x - p.x)};
    };
    const cadt_point b = beside(part(random)), c = beside(2 * part(random) - 0.5);
    cadt_counters counters{};
    const cadt_i32 side = cadt_orientation(p, a, b, &counters);
    if (side == 0 || cadt_orientation(p, a, c, &counters) != side) continue;
    const cadt_disc disc = cadt_disc_beside(p, a, b, side);
    const double length = std::hypot(a.x - p.x, a.y - p.y), radius = std::sqrt(disc.square);
    if (radius > 0.49 * CADT_WRAP_FLAT * length && radius < 0.51 * CADT_WRAP_FLAT * length) ++flat;
    if (cadt_incircle(side > 0 ? p : a, side > 0 ? a : p, b, c, &counters) <= 0) continue;
    ++better;
    const double x = c.x - p.x - disc.x, y = c.y - p.y - disc.y;
    ASSERT_FALSE(x * x + y * y > disc.square) << "trial " << trial;
  }
  EXPECT_GT(flat, 50000U);
  EXPECT_GT(better, 50000U);
  // and not much more than the arc
  const cadt_point p{0, 0}, a{1, 0}, b{0.25, 1e-14};
  const cadt_disc disc = cadt_disc_beside(p, a, b, 1);
  const auto holds = [&](double x, double y) { return std::hypot(x - disc.x, y - disc.y) <= std::sqrt(disc.square); };
  EXPECT_TRUE(holds(0.5, 1e-14));
  EXPECT_FALSE(holds(0.5, 1e-5));
  EXPECT_FALSE(holds(1.001, 1e-5));
}

// Of points on a line there is no circle, or by rounded numbers one without a centre: then nothing is excluded.
TEST(WrappedDisc, ThatIsNoNumberHoldsAll) {
  const Points points = {{0, 0}, {1, 0}, {2, 0}, {-3, 4}, {3, -4}};
  Searcher search(points);
  cadt_wrapper& w = search.w;
  cadt_wrap_step turn = {1, 1, CADT_NONE, {0.0, 0.0, std::numeric_limits<double>::infinity()}};
  cadt_wrap_set_best(&w, &turn, 2);
  EXPECT_TRUE(std::isnan(turn.disc.x));
  EXPECT_EQ(cadt_wrap_reaches(&w, &turn, 3), 1U);
  EXPECT_EQ(cadt_wrap_reaches(&w, &turn, 4), 0U) << "it is on the other side";
}

// Points just inside of the circle through p, a and b are in its disc, near p and far away; and the disc is not much
// larger than it need be, or long circles would hold whole clusters.
TEST(WrappedDisc, HoldsItsCircleTightly) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::size_t inside = 0;
  for (int trial = 0; trial < 300000; ++trial) {
    const auto length = [&] { return std::ldexp(1.0, static_cast<int>(random() % 40) - 30); };
    const double near = length(), far = length();
    const cadt_point p{unit(random), unit(random)}, a{p.x + near * unit(random), p.y + near * unit(random)},
        b{p.x + far * unit(random), p.y + far * unit(random)};
    cadt_counters counters{};
    if (cadt_orientation(p, a, b, &counters) <= 0) continue;
    const cadt_disc disc = cadt_disc_around(p, a, b);
    if (!std::isfinite(disc.square)) continue;
    const double radius = std::hypot(disc.x, disc.y), along = 3.2 * unit(random);
    const double spare = std::ldexp(radius, -45 - static_cast<int>(random() % 9)) * unit(random);
    const cadt_point c{p.x + disc.x + (radius + spare) * std::cos(along),
                       p.y + disc.y + (radius + spare) * std::sin(along)};
    if (cadt_incircle(p, a, b, c, &counters) <= 0) continue;
    ++inside;
    const double x = c.x - p.x - disc.x, y = c.y - p.y - disc.y;
    ASSERT_LE(x * x + y * y, disc.square) << "trial " << trial;
    cadt_aabb box{c, c};
    ASSERT_TRUE(cadt_aabb_matters(box, p, 0, 0, 0, &disc)) << "trial " << trial;
  }
  EXPECT_GT(inside, 50000U);
  const cadt_disc fair = cadt_disc_around({0, 0}, {1e12, 0}, {0, 1e12});
  EXPECT_LT(std::sqrt(fair.square), std::hypot(fair.x, fair.y) + 0.1);
}

}  // namespace
