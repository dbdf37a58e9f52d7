// SPDX-License-Identifier: Apache-2.0
// The star stage makes the mesh that insertion makes, on every kind of set, and it does run: where stars can be proven,
// they are.
#include "tests/system/stars/stars.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace cadt::test {
namespace {

double proven_share(const Triangulation& mesh) {
  const Statistics& s = mesh.statistics();
  return static_cast<double>(s.proven_stars) / static_cast<double>(std::max<std::uint64_t>(s.distinct, 1));
}

/// As two_clusters(), near enough to each other for narrow arithmetic.
Points clusters_apart(std::size_t n, double distance) {
  Points xy = uniform_points(n, 31);
  for (std::size_t i = n / 2; i < n; ++i) xy[2 * i] += distance;
  return xy;
}

/// Squares far from each other.
Points tight_squares(std::size_t squares, std::size_t points_of_each, double side) {
  Points xy;
  const Points corners = uniform_points(squares, 36);
  for (std::size_t s = 0; s < squares; ++s) {
    const Points some = uniform_points(points_of_each, 37 + s);
    for (std::size_t i = 0; i < some.size(); ++i) xy.push_back(corners[2 * s + i % 2] + side * some[i]);
  }
  return xy;
}

/// Over-full cells at the end of both axes of the sort keys' grid, where cells are closed on all sides.
Points crowd_in_a_corner(std::size_t n, double size) {
  Points xy = uniform_points(n, 32);
  const Points crowd = uniform_points(4 * n, 33);
  xy.insert(xy.end(), {0, 0, 1, 1});
  for (const double value : crowd) xy.push_back(1 - size * value);
  return xy;
}

Points box(std::size_t n, double width, double height) {
  Points xy = uniform_points(n, 34);
  for (std::size_t i = 0; i < xy.size(); i += 2) xy[i] *= width, xy[i + 1] *= height;
  return xy;
}

Points line_and_few(std::size_t n, std::size_t few) {
  Points xy;
  for (std::size_t i = 0; i < n; ++i) xy.insert(xy.end(), {3.0 * static_cast<double>(i), static_cast<double>(i)});
  for (const double value : uniform_points(few, 35)) xy.push_back(static_cast<double>(n) * value);
  return xy;
}

TEST_P(Stars, EveryFamily) {
  for (const FamilyGroup& group : family_groups()) {
    for (const Family& family : group.families())
      expect_same(std::string(group.name) + "/" + family.name, family.make());
    ASSERT_FALSE(HasFailure());
  }
}

TEST_P(Stars, UniformOfEverySize) {
  for (const std::size_t n : {3u, 4u, 5u, 6u, 7u, 8u, 12u, 20u, 50u, 100u, 639u, 640u, 641u, 1000u, 2561u, 20000u})
    expect_same(std::to_string(n), uniform_points(n, n));
}

/// These fail if the stage does not run.
TEST_P(Stars, NearlyAllAreProven) {
  for (const auto& [what, xy] :
       {std::pair("uniform", uniform_points(20000, 41)), std::pair("lattice", grid_points(160, 125)),
        std::pair("shuffled lattice", shuffled(grid_points(160, 125), 2)),
        std::pair("uniform with doubles of each", [] {
          Points twice = uniform_points(20000, 42);
          twice.insert(twice.end(), twice.begin(), twice.begin() + 40000);
          return twice;
        }())}) {
    const Triangulation mesh = expect_same(what, xy);
    EXPECT_GT(mesh.statistics().tiles, 20u) << what;
    EXPECT_GT(proven_share(mesh), 0.85) << what;
    // The hull does not go round its vertices.
    EXPECT_LE(mesh.statistics().proven_stars, mesh.statistics().distinct - mesh.hull().size()) << what;
  }
}

/// Radii as of a Kuzmin disk: a box tens of thousands of times as wide as where half of the points are.
Points heavy_tails(std::size_t n) {
  Points xy = uniform_points(n, 44);
  for (std::size_t i = 0; i < xy.size(); i += 2) {
    const double radius = std::sqrt(1 / ((1 - xy[i]) * (1 - xy[i])) - 1), angle = 6.283185307179586 * xy[i + 1];
    xy[i] = radius * std::cos(angle);
    xy[i + 1] = radius * std::sin(angle);
  }
  return xy;
}

/// The grid leaves out what is far away from most: else these have nearly all points in one cell.
TEST_P(Stars, OutermostPointsAreLeftOut) {
  EXPECT_GT(proven_share(expect_same("heavy tails", heavy_tails(60000))), 0.8);
  EXPECT_GT(proven_share(expect_same("moved", moved(heavy_tails(20000), 1e6, -3e6))), 0.6);
  Points few = uniform_points(80000, 45);
  for (std::size_t i = 0; i < 20; ++i)
    few.insert(few.end(), {1e7 * std::cos(1.7 * static_cast<double>(i)), 1e7 * std::sin(1.7 * static_cast<double>(i))});
  EXPECT_GT(proven_share(expect_same("few far away", few)), 0.7);
  Points sideways = uniform_points(80000, 46);
  for (std::size_t i = 0; i < 60; ++i)
    sideways.insert(sideways.end(), {(i % 2 == 0 ? 1e7 : -1e7) * (1.0 + static_cast<double>(i)), 0.5});
  EXPECT_GT(proven_share(expect_same("few far away to both sides", shuffled(sideways, 3))), 0.7);
}

/// Neither the size of the coordinates nor where they are counted from makes a difference to the proofs.
TEST_P(Stars, ProofsDoNotDependOnTheUnit) {
  const Points xy = uniform_points(5000, 43);
  const std::uint64_t proven = expect_same("as it is", xy).statistics().proven_stars;
  EXPECT_GT(proven, 4000u);
  for (const int exponent : {-900, -500, -3, 5, 400, 900}) {
    const Triangulation mesh = expect_same("times 2^" + std::to_string(exponent), scaled(xy, exponent));
    EXPECT_EQ(mesh.statistics().proven_stars, proven) << exponent;
  }
  const Points mirrored = [&] {
    Points result = xy;
    for (double& value : result) value = -value;
    return result;
  }();
  EXPECT_GT(expect_same("mirrored", mirrored).statistics().proven_stars, 4000u);
  for (const double offset : {5e5, 1e9, 1e13})
    EXPECT_GT(
        expect_same("moved by " + std::to_string(offset), moved(xy, offset, -3 * offset)).statistics().proven_stars,
        offset < 1e12 ? 4000u : 500u);
}

TEST_P(Stars, NearTheSmallestNumbers) {
  for (const int exponent : {-1074, -1073, -1070, -1060, -1040, -1030, -1022, -1015, -1010}) {
    expect_same("lattice times 2^" + std::to_string(exponent), scaled(grid_points(40, 30), exponent));
    expect_same("uniform times 2^" + std::to_string(exponent), scaled(uniform_points(1500, 44), exponent));
    Points odd;  // halves of these are none
    for (const double value : uniform_points(300, 45)) odd.push_back((2 * std::floor(1e6 * value) + 1) * 5e-324);
    expect_same("odd, times 2^" + std::to_string(exponent + 1074), scaled(odd, exponent + 1074));
  }
}

TEST_P(Stars, WideExponentsAreLeftToLocks) {
  Points xy = uniform_points(3000, 46);
  xy.insert(xy.end(), {1e-300, 0.5, 0.25, 1e-290});
  const Triangulation mesh = expect_same("wide", xy);
  EXPECT_TRUE(mesh.statistics().wide_arithmetic);
  EXPECT_EQ(mesh.statistics().tiles, 0u);
  EXPECT_EQ(mesh.statistics().proven_stars, 0u);
}

TEST_P(Stars, NoneIsProvenOnAConvexCurve) {
  for (const int n : {3, 4, 5, 17, 100, 1000}) {
    const Triangulation mesh = expect_same("polygon of " + std::to_string(n), regular_polygon(n, 3, 4, 5));
    if (n != 1000) {  // rounding leaves some of a thousand within the hull
      EXPECT_EQ(mesh.statistics().proven_stars, 0u) << n;
    }
  }
  expect_same("a hub has too many neighbours", hub_points(500));
}

TEST_P(Stars, LongBoxes) {
  for (const double aspect : {2.0, 10.0, 1e3, 1e6, 1e12}) {
    expect_same("1 : " + std::to_string(aspect), box(5000, aspect, 1));
    expect_same(std::to_string(aspect) + " : 1", box(5000, 1, aspect));
  }
  expect_same("lattice of two rows", grid_points(2500, 2));
  expect_same("lattice of two columns", grid_points(2, 2500));
  expect_same("lattice of nine rows", grid_points(500, 9));
}

TEST_P(Stars, Lines) {
  Points line;
  for (int i = 0; i < 3000; ++i) line.insert(line.end(), {7.0 * ((i * 11) % 3000), -2.0 * ((i * 11) % 3000)});
  EXPECT_EQ(expect_same("all on a line", line).dimension(), 1);
  for (const std::size_t few : {1u, 2u, 5u, 50u})
    expect_same(std::to_string(few) + " beside a line", line_and_few(2000, few));
  expect_same("axes", axis_cross(150));
}

TEST_P(Stars, OverfullCells) {
  expect_same("two clusters", clusters_apart(6000, 1e6));
  expect_same("two clusters, far", clusters_apart(6000, 1e12));
  expect_same("two clusters, 1e12 apart", two_clusters(6000));
  // A cluster in a corner of a tile would be one cell: tiles are divided again.
  const Statistics hundred = expect_same("hundred clusters", cluster_points(20000)).statistics();
  EXPECT_GT(hundred.tiles, hundred.distinct / 128) << "so many would do if each were full";
  // The sort keys have a second word, else none of these would be proven.
  const Points clusters = tight_squares(12, 1200, 1e-6);
  EXPECT_GT(proven_share(expect_same("squares", clusters)), 0.6);
  Points twice = clusters, longer = tight_squares(12, 1200, 1e-5);
  twice.insert(twice.end(), twice.begin(), twice.begin() + 6000);
  EXPECT_GT(proven_share(expect_same("squares, some points twice", twice)), 0.6);
  for (std::size_t i = 0; i < longer.size(); i += 2) longer[i] += std::floor(16 * longer[i + 1]);
  EXPECT_GT(proven_share(expect_same("squares in a long box", longer)), 0.6);
  for (std::size_t i = 0; i < longer.size(); i += 2) std::swap(longer[i], longer[i + 1]);
  EXPECT_GT(proven_share(expect_same("squares in a tall box", longer)), 0.6);
  expect_same("squares of fewer bits", moved(clusters, 1e4, -3e3));
  Points with_others = tight_squares(16, 1200, 1e-6);  // the grid leaves these out besides
  for (int i = 0; i < 20; ++i)
    with_others.insert(with_others.end(), {1e7 * std::cos(1.7 * i), 1e7 * std::sin(1.7 * i)});
  EXPECT_GT(proven_share(expect_same("squares and few points far away", with_others)), 0.6);
  expect_same("nearly all in one cell", skewed_points(20000));
  for (const double size : {0.25, 0.05, 0.01, 1e-3, 1e-5}) {
    const Points xy = crowd_in_a_corner(600, size);
    expect_same("crowd at the end of both axes, " + std::to_string(size), xy);
    Points other = xy;
    for (std::size_t i = 0; i < other.size(); i += 2) other[i] = 1 - other[i];
    expect_same("crowd at the end of one axis, " + std::to_string(size), other);
  }
}

/// Many points in the lower left corner, so that neighbourhood grids reach beyond the bounds there, and a point just
/// below a border of the keys' cells: its cell, counted from outside the bounds, rounds up to one beyond the grid.
TEST_P(Stars, RoundingAtTheLowerEdges) {
  const double h = 1.0 / 256;
  for (const bool sideways : {false, true})
    for (const double at : {0.05, 0.3, 0.5, 0.9}) {
      Points xy = {0, 0, 1, 1, 1, 0, 0, 1};
      const Points a = uniform_points(500, 61), b = uniform_points(300, 62), c = uniform_points(600, 63);
      for (std::size_t i = 0; i < a.size(); i += 2) xy.insert(xy.end(), {a[i] * h, a[i + 1] * h});
      for (std::size_t i = 0; i < b.size(); i += 2) xy.insert(xy.end(), {h + b[i] * h, b[i + 1] * h});
      for (std::size_t i = 0; i < c.size(); i += 2) xy.insert(xy.end(), {c[i] * 0.9 + 0.1, c[i + 1] * 0.9 + 0.1});
      xy.insert(xy.end(), {at * h, std::nextafter(2 * h, 0)});
      for (std::size_t i = 0; sideways && i < xy.size(); i += 2) std::swap(xy[i], xy[i + 1]);
      expect_same(std::to_string(at) + (sideways ? " sideways" : ""), xy);
    }
}

/// Half of an odd multiple of the smallest number is rounded: the least coordinate lies outside the grid of the keys.
TEST_P(Stars, LeastCoordinateIsRounded) {
  const double u = std::numeric_limits<double>::denorm_min();
  const auto tiny = [](double value) { return std::ldexp(value, -1022); };
  for (const double least : {-1.0, 3.0, 4.0, 5.0})
    for (const unsigned seed : {0U, 31U}) {
      Points xy = {tiny(256), tiny(255.5), tiny(256), 0, least * u, tiny(2.125)};
      for (const auto& [x, y] : std::vector<std::pair<double, double>>{
               {.51, 1.975}, {.51, 2.275}, {.535, 2.125}, {.62, 2.02}, {.62, 2.23}, {.6, 2.125}})
        xy.insert(xy.end(), {tiny(x) + 4 * u, tiny(y)});
      const Points a = uniform_points(600, 70 + seed), b = uniform_points(300, 1080 + seed),
                   c = uniform_points(500, 2090 + seed);
      for (std::size_t i = 0; i < a.size(); i += 2)
        xy.insert(xy.end(), {tiny(.9 + 3.1 * a[i]) + 4 * u, tiny(4 * a[i + 1])});
      for (std::size_t i = 0; i < b.size(); i += 2) xy.insert(xy.end(), {tiny(4 + 4 * b[i]), tiny(4 * b[i + 1])});
      for (std::size_t i = 0; i < c.size(); i += 2) xy.insert(xy.end(), {tiny(10 + 240 * c[i]), tiny(250 * c[i + 1])});
      expect_same(std::to_string(least) + ", " + std::to_string(seed), xy);
    }
}

TEST_P(Stars, RandomSmallSets) {
  Random random(47);
  for (int run = 0; run < 400; ++run) {
    const std::size_t n = 3 + random.below(120), span = 2 + random.below(24);
    Points xy;
    for (std::size_t i = 0; i < 2 * n; ++i) xy.push_back(static_cast<double>(random.below(span)));
    expect_same("whole numbers, run " + std::to_string(run), xy);
    ASSERT_FALSE(HasFailure());
  }
}

TEST_P(Stars, FastOrder) {
  for (const auto& [what, xy] :
       {std::pair("uniform", uniform_points(8000, 48)), std::pair("lattice", grid_points(80, 70))}) {
    SCOPED_TRACE(what);
    stars().options().order = Order::fast;
    const Triangulation fast = stars().triangulate(Reals(xy));
    stars().options().order = Order::canonical;
    const Triangulation expected = with_locks(Reals(xy));
    EXPECT_GT(fast.statistics().proven_stars, 4000u);
    EXPECT_TRUE(verified(xy, fast));
    EXPECT_EQ(fast.hash(), expected.hash());
    EXPECT_EQ(canonical_set(fast.triangles()), canonical_set(expected.triangles()));
    EXPECT_TRUE(std::ranges::equal(fast.neighbors(), neighbors_of(fast.triangles())));
    EXPECT_TRUE(std::ranges::equal(fast.hull(), expected.hull()));
  }
}

/// Nothing of one call is left for the next one.
TEST_P(Stars, AlternatesWithLocks) {
  const Points large = uniform_points(9000, 49), small = grid_points(30, 20), line = {0, 0, 1, 1, 2, 2};
  for (int round = 0; round < 3; ++round) {
    for (const Points* xy : {&large, &small, &line, &large}) {
      const Triangulation expected = with_locks(Reals(*xy));
      for (const Strategy strategy : {Strategy::locks, Strategy::stars, Strategy::stars, Strategy::automatic}) {
        stars().options().tuning.strategy = strategy;
        const Triangulation mesh = stars().triangulate(Reals(*xy));
        EXPECT_TRUE(same_arrays(mesh, expected)) << round << ", " << xy->size() / 2 << ", " << to_string(strategy);
        if (strategy == Strategy::locks) {
          EXPECT_EQ(mesh.statistics().tiles + mesh.statistics().proven_stars, 0u);
        }
        if (strategy == Strategy::stars && xy == &large) {
          EXPECT_GT(proven_share(mesh), 0.85);
        }
      }
    }
    stars().release_memory();
  }
}

TEST_P(Stars, Floats) {
  std::vector<float> values;
  for (const double value : uniform_points(6000, 50)) values.push_back(static_cast<float>(value));
  const std::span<const float> view(values);
  const Triangulation mesh = stars().triangulate(view);
  EXPECT_TRUE(same_arrays(mesh, with_locks(view)));
  EXPECT_GT(proven_share(mesh), 0.85);
}

std::vector<BackendCase> two_host_cases() {
  return {{"serial", Backend::host, 1, 0}, {"threads2", Backend::host, 2, 0}};
}
CADT_ON(host, Stars, two_host_cases);
CADT_ON(opencl, Stars, main_opencl_case);
CADT_ON(cuda, Stars, main_cuda_case);

TEST(Strategies, HaveNames) {
  EXPECT_EQ(to_string(Strategy::automatic), "auto");
  EXPECT_EQ(to_string(Strategy::locks), "locks");
  EXPECT_EQ(to_string(Strategy::stars), "stars");
}

}  // namespace
}  // namespace cadt::test
