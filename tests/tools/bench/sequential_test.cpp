// SPDX-License-Identifier: Apache-2.0
// The sequential baseline makes the library's set of triangles.
#include "bench/sequential.hpp"

#include <cadt/cadt.hpp>
#include <cadt/io/generate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/sequential_order.hpp"
#include "tests/support/families.hpp"
#include "tests/support/oracle.hpp"

namespace cadt::test {
namespace {

std::vector<Triangle> of_the_library(const Points& xy) {
  Options options;
  options.backend = Backend::host;
  const Triangulation mesh = triangulate(std::span<const double>(xy), options);
  std::vector<Triangle> triangles;
  const auto all = mesh.triangles();
  for (std::size_t t = 0; t < all.size(); t += 3) triangles.push_back({all[t], all[t + 1], all[t + 2]});
  return triangles;
}

testing::AssertionResult same_as_the_library(const Points& xy) {
  std::vector<Triangle> have = bench::sequential_delaunay(xy).triangles;
  make_canonical(have);
  const std::vector<Triangle> expected = of_the_library(xy);
  if (have.size() != expected.size())
    return testing::AssertionFailure() << have.size() << " triangles, not " << expected.size();
  for (std::size_t t = 0; t < have.size(); ++t)
    if (have[t] != expected[t]) return testing::AssertionFailure() << "triangle " << t << " differs";
  return testing::AssertionSuccess();
}

TEST(Sequential, Uniform) {
  for (const std::size_t n : {3u, 10u, 100u, 1000u, 50000u}) {
    const Points xy = uniform_points(n, n);
    EXPECT_GT(bench::sequential_delaunay(xy).triangles.size(), n / 4);
    EXPECT_TRUE(same_as_the_library(xy)) << n;
  }
}

TEST(Sequential, SetsOfTheBenchmark) {
  for (const char* name : {"uniform", "grid", "circles", "clusters", "two-clusters", "skewed", "kuzmin"}) {
    io::GenerateOptions options;
    options.n = 20000;
    options.epsilon = 0.0;  // circles: as round as doubles can be
    EXPECT_TRUE(same_as_the_library(io::generate(name, options).xy)) << name;
  }
}

TEST(Sequential, UpToFivePoints) {
  const Points line = {0, 0, 1, 1, 2, 2, 3, 3, 4, 4}, square = {0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5};
  for (std::size_t n = 0; n <= 5; ++n) {
    const auto size = static_cast<std::ptrdiff_t>(2 * n);
    EXPECT_TRUE(bench::sequential_delaunay({line.begin(), line.begin() + size}).triangles.empty());
    EXPECT_EQ(bench::sequential_delaunay({square.begin(), square.begin() + size}).triangles.size(),
              n < 3 ? 0 : n - 2 + (n == 5));
    EXPECT_TRUE(same_as_the_library(Points(square.begin(), square.begin() + size))) << n;
  }
}

TEST(Sequential, TwoTrianglesBesideOneEdge) {
  EXPECT_EQ(bench::sequential_delaunay(Points{0, 0, 1, 0, 0, 1, 1, 1.5}).triangles.size(), 2u);
}

TEST(Sequential, CollinearPointsHaveNoTriangles) {
  Points xy;
  for (int i = 0; i < 1000; ++i) xy.insert(xy.end(), {0.5 * (i * 7 % 1000), 1.5 * (i * 7 % 1000)});
  EXPECT_TRUE(bench::sequential_delaunay(xy).triangles.empty());
  EXPECT_TRUE(bench::sequential_delaunay(Points(2000, 3.25)).triangles.empty());
  xy.insert(xy.end(), {10.0, 10.0});
  EXPECT_EQ(bench::sequential_delaunay(xy).triangles.size(), 999u);
  EXPECT_TRUE(same_as_the_library(xy));
}

TEST(Sequential, PointsOnTheEdgesOfTheHull) {
  Points xy = uniform_points(3000, 5);
  for (int i = 0; i <= 64; ++i) {
    const double t = i / 64.0;
    xy.insert(xy.end(), {t, 0.0, t, 1.0, 0.0, t, 1.0, t});
  }
  EXPECT_TRUE(same_as_the_library(xy));
  EXPECT_TRUE(same_as_the_library(shuffled(xy, 3)));
}

TEST(Sequential, DuplicatesStandForTheLowestIndex) {
  Points xy = uniform_points(2000, 9);
  const Points once = xy;
  for (int copy = 0; copy < 3; ++copy) xy.insert(xy.end(), once.begin(), once.end());
  EXPECT_TRUE(same_as_the_library(xy));
  xy.insert(xy.end(), {0.0, 0.5, -0.0, 0.5, 0.0, -0.0, -0.0, 0.0});
  for (std::uint64_t seed = 1; seed < 6; ++seed) EXPECT_TRUE(same_as_the_library(shuffled(xy, seed)));
}

// Without the scaling by a power of two the products of the narrow predicates would under- or overflow.
TEST(Sequential, FarFromOne) {
  for (const int exponent : {-1000, -267, -260, 250, 260, 1000})
    EXPECT_TRUE(same_as_the_library(scaled(uniform_points(2000), exponent))) << exponent;
}

// Every family of the library's own tests: grids, circles, lines, clusters, both ends of the exponents, ...
class SequentialFamilies : public testing::TestWithParam<std::string> {};

TEST_P(SequentialFamilies, SameAsTheLibrary) {
  const auto group = std::ranges::find(family_groups(), GetParam(), &FamilyGroup::name);
  for (const Family& family : group->families()) EXPECT_TRUE(same_as_the_library(family.make())) << family.name;
}

std::vector<std::string> group_names() {
  std::vector<std::string> names;
  for (const FamilyGroup& group : family_groups()) names.emplace_back(group.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, SequentialFamilies, testing::ValuesIn(group_names()),
                         [](const auto& group) { return group.param; });

TEST(Sequential, TrianglesAreCounterclockwise) {
  const Points xy = grid_points(20, 30);  // whole numbers: the plain determinant is exact
  const auto mesh = bench::sequential_delaunay(xy);
  ASSERT_EQ(mesh.triangles.size(), 2u * 19 * 29);
  for (const auto& t : mesh.triangles) {
    const auto x = [&](std::size_t k) { return xy[2 * static_cast<std::size_t>(t[k])]; };
    const auto y = [&](std::size_t k) { return xy[2 * static_cast<std::size_t>(t[k]) + 1]; };
    EXPECT_GT((x(1) - x(0)) * (y(2) - y(0)) - (y(1) - y(0)) * (x(2) - x(0)), 0.0);
  }
}

TEST(Sequential, RefusesWhatHasNoTriangulation) {
  Points xy = uniform_points(10);
  xy[7] = std::numeric_limits<double>::quiet_NaN();
  try {
    (void)bench::sequential_delaunay(xy);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.index(), 3u);
  }
  xy[7] = -std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)bench::sequential_delaunay(xy), InputError);
  EXPECT_THROW((void)bench::sequential_delaunay(std::vector<double>{1, 2, 3}), std::invalid_argument);
}

/// Mean distance from one point to the next along the last rounds. Steps from one crowd to another are left out.
double mean_step(const Points& xy, double longest) {
  const std::vector<std::uint32_t> order = bench::insertion_order(xy);
  double length = 0.0;
  std::size_t steps = 0;
  for (std::size_t i = order.size() / 4; i + 1 < order.size(); ++i) {
    const std::size_t a = order[i], b = order[i + 1];
    const double step = std::hypot(xy[2 * a] - xy[2 * b], xy[2 * a + 1] - xy[2 * b + 1]);
    if (step < longest) length += step, ++steps;
  }
  return length / static_cast<double>(steps);
}

TEST(SequentialOrder, IsAPermutation) {
  for (const Points& xy : {Points{}, Points{1, 2}, uniform_points(10000), Points(10000, 1.0), skewed_points(5000)}) {
    std::vector<std::uint32_t> order = bench::insertion_order(xy);
    ASSERT_EQ(order.size(), xy.size() / 2);
    std::ranges::sort(order);
    for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
  }
}

// Few points are one round: the curve alone. Each step of it goes to a neighbour in the lattice.
TEST(SequentialOrder, FollowsAHilbertCurve) {
  // The width of the second lattice is more than the largest double.
  for (const double unit : {1.0, std::ldexp(1.0, 1021)}) {
    Points xy = moved(grid_points(16, 16), -7.5, -7.5);
    for (double& value : xy) value *= unit;
    const std::vector<std::uint32_t> order = bench::insertion_order(xy);
    for (std::size_t i = 0; i + 1 < order.size(); ++i) {
      const std::size_t a = order[i], b = order[i + 1];
      const double dx = xy[2 * a] / unit - xy[2 * b] / unit, dy = xy[2 * a + 1] / unit - xy[2 * b + 1] / unit;
      ASSERT_EQ(std::abs(dx) + std::abs(dy), 1.0) << i;
    }
  }
}

TEST(SequentialOrder, KeepsNeighboursTogether) {
  constexpr std::size_t n = 40000;
  const double spacing = 1.0 / std::sqrt(n);
  EXPECT_LT(mean_step(uniform_points(n), 2.0), 1.2 * spacing);
}

TEST(SequentialOrder, RefinesCrowdedCells) {
  constexpr std::size_t n = 40000;
  const double spacing = 1.0 / std::sqrt(n);
  // One point far away makes a single cell of all others; in the second set the rest is spread.
  Points xy = scaled(uniform_points(n), -40);
  xy.insert(xy.end(), {1.0, 1.0});
  EXPECT_LT(mean_step(xy, 0.5), std::ldexp(1.2 * spacing, -40));
  EXPECT_LT(mean_step(skewed_points(n), 1e-11), 1.2e-12 * spacing);
}

}  // namespace
}  // namespace cadt::test
