// SPDX-License-Identifier: Apache-2.0
// Gift wrapping (common/stars/wrap_exact.dev.h): small sets, residual vertices of the star stage, and work limits.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace cadt::test {
namespace {

using Reals = std::span<const double>;

class Wrap : public BackendTest {
 protected:
  static Statistics check(const Points& xy, Strategy strategy = Strategy::stars) {
    Options options = GetParam().options();
    options.tuning.strategy = strategy;
    const Triangulation mesh = triangulate(Reals(xy), options);
    EXPECT_TRUE(same_mesh(mesh, expected_mesh(xy)));
    const Statistics& s = mesh.statistics();
    EXPECT_TRUE(s.certified);
    if (s.splits + s.edge_splits == 0) {
      EXPECT_EQ(s.sweep_repairs, 0u) << "a star was wrong";
    }
    return s;
  }
};

/// A centre with n neighbours, no four points on a circle.
Points noisy_hub(std::size_t n) {
  Points xy = {0, 0};
  const Points noise = uniform_points(n, 11);
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(n), r = 1 + 1e-6 * noise[i];
    xy.insert(xy.end(), {r * std::cos(angle), r * std::sin(angle)});
  }
  return shuffled(xy, 3);
}

/// A corner of the hull with n neighbours.
Points fan(std::size_t n) {
  Points xy = parabola_points(n);
  for (std::size_t i = 1; i < xy.size(); i += 2) xy[i] *= 0.01;
  xy.insert(xy.end(), {0, 10});
  return xy;
}

// Corners of the hull, sides with points between, triangles alone: all that a star can be.
TEST_P(Wrap, SmallestSets) {
  for (std::size_t n = 3; n < 40; ++n)
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      SCOPED_TRACE(n);
      const Statistics s = check(uniform_points(n, 100 * n + seed));
      EXPECT_EQ(s.wrapped_stars + s.proven_stars, n);
    }
}

TEST_P(Wrap, Lattices) {
  for (const auto& [columns, rows] : {std::pair{2, 2}, {2, 9}, {3, 3}, {5, 4}, {9, 9}, {1, 7}, {40, 2}}) {
    SCOPED_TRACE(columns);
    const Statistics s = check(shuffled(grid_points(columns, rows), 3));
    EXPECT_EQ(s.wrapped_stars, columns == 1 ? 0u : s.distinct - s.proven_stars);
  }
}

TEST_P(Wrap, AllThatIsLeftOfStars) {
  const Statistics s = check(uniform_points(20000, 5));
  EXPECT_GT(s.proven_stars, 10000u);
  EXPECT_EQ(s.wrapped_stars, s.distinct - s.proven_stars);
  EXPECT_EQ(s.splits + s.flips, 0u);
}

TEST_P(Wrap, LongThinSets) {
  for (const double height : {1e-3, 1e-6, 1e-9}) {
    Points xy = uniform_points(1500, 7);
    for (std::size_t i = 1; i < xy.size(); i += 2) xy[i] *= height;
    check(xy);
  }
}

// What is beyond an edge of the hull by less than single precision can tell, where that is not along an axis.
TEST_P(Wrap, HullsAlmostStraight) {
  for (const double bump : {1e-5, 1e-9, 1e-13, 0.0}) {
    for (const std::size_t columns : {8u, 15u, 60u}) {  // 24 and 45 points are known to every team, 180 are not
      const Points noise = uniform_points(3 * columns, columns);
      Points xy;
      for (std::size_t i = 0; i < columns; ++i) {
        const double x = static_cast<double>(i), *r = noise.data() + 6 * i;
        xy.insert(xy.end(), {x + 0.3 * r[0], bump * r[1], x + r[2], 1 + r[3], x + 0.3 * r[4], 3 - bump * r[5]});
      }
      for (std::size_t i = 0; i < xy.size(); i += 2) {
        const double x = xy[i], y = xy[i + 1];
        xy[i] = 0.8 * x - 0.6 * y;
        xy[i + 1] = 0.6 * x + 0.8 * y;
      }
      check(shuffled(xy, 3));
    }
  }
}

// The floating-point filter hardly separates the points of the other cluster from each other, but nearly all of them
// from the best one. During an exact test of one lane all others wait.
TEST_P(Wrap, FarApart) {
  for (const std::size_t n : {1500u, 4000u}) {
    const Statistics s = check(two_clusters(n));
    EXPECT_LT(s.exact_incircles, s.distinct);
  }
}
TEST_P(Wrap, OneCell) { check(skewed_points(1500)); }
TEST_P(Wrap, Duplicates) {
  Points xy = uniform_points(300, 8);
  const Points again = xy;
  for (int copy = 0; copy < 3; ++copy) xy.insert(xy.end(), again.begin(), again.end());
  check(shuffled(xy, 9));
}

// A high-degree vertex has no star of its own: its triangles come from its neighbours' stars.
TEST_P(Wrap, Hubs) {
  EXPECT_EQ(check(noisy_hub(30)).wrapped_stars, 31u);
  for (const std::size_t neighbours : {60u, 1200u}) {
    const Statistics s = check(noisy_hub(neighbours));
    EXPECT_EQ(s.wrapped_stars, neighbours);
    EXPECT_EQ(s.splits + s.edge_splits, 0u);
  }
}
// More neighbours than are noted for the exact steps, and circles that reach beyond the points around a vertex.
TEST_P(Wrap, ManyNeighboursAndWideCircles) {
  Points xy;
  for (std::size_t hub = 0; hub < 30; ++hub) {
    Points one = noisy_hub(22 + hub % 14);
    for (std::size_t i = 0; i < one.size(); i += 2) {
      const double stretch = i % 6 == 0 ? 40 : 1;  // few neighbours are near
      one[i] = stretch * one[i] + 100 * static_cast<double>(hub % 6);
      one[i + 1] = stretch * one[i + 1] + 100 * static_cast<double>(hub / 6);
    }
    xy.insert(xy.end(), one.begin(), one.end());
  }
  check(xy);
}
TEST_P(Wrap, HubsOnTheHull) {
  EXPECT_EQ(check(fan(30)).wrapped_stars, 31u);
  EXPECT_EQ(check(fan(500)).wrapped_stars, 500u);
}

/// Points on an arc around a hub, none of four on a circle.
void add_arc(Points& xy, double x, double y, double from, double to) {
  const std::size_t n = 60;
  const Points noise = uniform_points(n, xy.size());
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = (from + (to - from) * static_cast<double>(i) / (n - 1)) * 0.017453292519943295;
    xy.insert(xy.end(), {x + (1 + 1e-6 * noise[i]) * std::cos(angle), y + (1 + 1e-6 * noise[i]) * std::sin(angle)});
  }
}

// Triangles of high-degree vertices only: of three, and of two and the ghost vertex.
TEST_P(Wrap, HubsBesideEachOther) {
  Points three = {0, 0, 10, 0, 5, 8.66};
  add_arc(three, 0, 0, 130, 290);
  add_arc(three, 10, 0, -110, 50);
  add_arc(three, 5, 8.66, 10, 170);
  EXPECT_EQ(check(shuffled(three, 5)).wrapped_stars, 180u);
  Points two = {0, 0, 10, 0};
  add_arc(two, 0, 0, 5, 175);
  add_arc(two, 10, 0, 5, 175);
  EXPECT_EQ(check(shuffled(two, 5)).wrapped_stars, 120u);
}

// Edges between two high-degree vertices with triangles of such vertices on either side, which are in no star.
TEST_P(Wrap, ManyHubsBesideEachOther) {
  Points four = {0, 0, 10, 1, 0, 11, 9, 10};
  add_arc(four, 0, 0, 150, 290);
  add_arc(four, 10, 1, -110, 30);
  add_arc(four, 0, 11, 60, 200);
  add_arc(four, 9, 10, -20, 120);
  const Statistics s = check(shuffled(four, 5));
  EXPECT_EQ(s.wrapped_stars, 240u);
  EXPECT_EQ(s.splits + s.edge_splits, 0u);
  Points ring, exact;  // around a gap of ten triangles
  for (std::size_t i = 0; i < 12; ++i) {
    const double angle = 30.0 * static_cast<double>(i), r = 30 + 0.1 * static_cast<double>(i * i % 7);
    const double x = r * std::cos(angle * 0.017453292519943295), y = r * std::sin(angle * 0.017453292519943295);
    ring.insert(ring.end(), {x, y});
    add_arc(ring, x, y, angle - 80, angle + 80);
  }
  EXPECT_EQ(check(shuffled(ring, 5)).wrapped_stars, 720u);
  for (const int x : {-1, 1})
    for (const int y : {-1, 1}) {  // corners of a square, decided by ties
      exact.insert(exact.end(), {20.0 * x, 20.0 * y});
      const double angle = (x > 0 ? 45 : 135) * y;
      add_arc(exact, 20.0 * x, 20.0 * y, angle - 70, angle + 70);
    }
  EXPECT_EQ(check(shuffled(exact, 5)).wrapped_stars, 240u);
  Points row;  // the hull runs along them
  for (int i = 0; i < 8; ++i) {
    row.insert(row.end(), {10.0 * i, 0.01 * (i - 3) * (i - 3)});
    add_arc(row, 10.0 * i, 0.01 * (i - 3) * (i - 3), 20, 160);
  }
  EXPECT_EQ(check(shuffled(row, 5)).wrapped_stars, 480u);
}
// More than there is a list for: all goes to insertion.
TEST_P(Wrap, GivesUpTooManyHubsBesideEachOther) {
  Points ring;
  for (std::size_t i = 0; i < 64; ++i) {
    const double angle = 5.625 * static_cast<double>(i), r = 300 + 0.01 * static_cast<double>(i * i % 7);
    const double x = r * std::cos(angle * 0.017453292519943295), y = r * std::sin(angle * 0.017453292519943295);
    ring.insert(ring.end(), {x, y});
    add_arc(ring, x, y, angle - 80, angle + 80);
  }
  const Statistics s = check(shuffled(ring, 5));
  EXPECT_EQ(s.wrapped_stars, 0u);
  EXPECT_GT(s.splits + s.edge_splits, 0u);
}
// The work before the early-out depends on how many vertices are searched at a time.
TEST_P(Wrap, EndlessTies) {
  check(hub_points(400));
  check(regular_polygon(2000, 0, 0, 1));
}
TEST_P(Wrap, ConvexCurves) { check(parabola_points(1500)); }

bool made_by_card(const Statistics& s, Backend backend) {
  bool gpu = false;
  for (const DeviceInfo& device : list_devices())
    gpu = gpu || (device.backend == backend && device.name == s.device && device.gpu);
  return gpu;
}

// By default a GPU wraps small sets; CPUs never do.
TEST_P(Wrap, ChosenOnCards) {
  const Statistics s = check(uniform_points(3000, 4), Strategy::automatic);
  EXPECT_EQ(s.wrapped_stars, made_by_card(s, GetParam().backend) ? 3000u : 0u);
}
// Over-full cells get keys of two words there, and need no refinement bit by bit.
TEST_P(Wrap, FinerKeysOnCards) {
  const Statistics s = check(cluster_points(4000), Strategy::automatic);
  const bool card = made_by_card(s, GetParam().backend);
  EXPECT_EQ(s.wrapped_stars, card ? s.distinct : 0u);
  EXPECT_EQ(s.refined_points == 0, card) << s.refined_points;
}
// But not where they would not tell most points apart, which a sample of larger sets tells.
TEST_P(Wrap, FinerKeysWhereTheyTellPointsApart) {
  const Statistics apart = check(cluster_points(17000), Strategy::automatic);
  EXPECT_EQ(apart.refined_points == 0, made_by_card(apart, GetParam().backend)) << apart.refined_points;
  EXPECT_GT(check(two_clusters(17000), Strategy::automatic).refined_points, 16000U);
}

/// Squares of 30 points each, far apart: those at their sides have wide circles, and no proven stars.
Points squares_apart(std::size_t rows) {
  Points xy = uniform_points(30 * rows * rows, 3);
  for (std::size_t i = 0; i < xy.size(); ++i) {
    const std::size_t square = i / 60;
    xy[i] = static_cast<double>(i % 2 == 0 ? square % rows : square / rows) + 0.1 * xy[i];
  }
  return shuffled(xy, 3);
}

/// n points on an ellipse and five times as many within, at similar distances. Half of those behind the ellipse have no
/// proven stars either.
Points layers_of_an_ellipse(std::size_t n) {
  Points xy;
  const Points noise = uniform_points(6 * n, 3);
  const double step = 6.283185307179586 / static_cast<double>(n);
  for (std::size_t i = 0; i < 6 * n; ++i) {
    const std::size_t layer = i / n;
    const double shift = layer == 0 ? 0 : 0.3, turn = static_cast<double>(i % n) + 0.5 * static_cast<double>(layer % 2);
    const double angle = step * (turn + shift * noise[2 * i]);
    const double radius = 1 - step * (static_cast<double>(layer) + shift * noise[2 * i + 1]);
    xy.insert(xy.end(), {radius * std::cos(angle), 0.8 * radius * std::sin(angle)});
  }
  return shuffled(xy, 3);
}

// More than a mesh that is wrapped as a whole has.
TEST_P(Wrap, ManyResidualVertices) {
  const Statistics s = check(squares_apart(60), Strategy::automatic);
  if (!made_by_card(s, GetParam().backend)) return;
  EXPECT_EQ(s.wrapped_stars + s.proven_stars, s.distinct);
  EXPECT_GT(s.wrapped_stars, 32768U);
}
// Nor are so many wrapped if the hull takes exact tests.
TEST_P(Wrap, ManyResidualVerticesFarAway) {
  const Statistics s = check(skewed_points(150000), Strategy::automatic);
  if (!made_by_card(s, GetParam().backend)) return;
  EXPECT_GT(s.distinct - s.proven_stars, 32768U);
  EXPECT_EQ(s.wrapped_stars, 0U);
}
// 15 bits count the edges of the hull.
TEST_P(Wrap, HullsOfManyEdges) {
  for (const std::size_t hull : {32000, 33200}) {
    const Statistics s = check(layers_of_an_ellipse(hull), Strategy::automatic);
    if (!made_by_card(s, GetParam().backend)) continue;
    EXPECT_GT(s.proven_stars, 4 * hull);
    EXPECT_EQ(s.wrapped_stars, hull == 32000 ? s.distinct - s.proven_stars : 0U);
  }
}
CADT_ON_EVERY_BACKEND(Wrap);

}  // namespace
}  // namespace cadt::test
