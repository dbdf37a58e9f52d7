// SPDX-License-Identifier: Apache-2.0
// What is computed with rounding, where rounding, overflow or underflow could take all of it: far points among near
// ones, coordinates that are very small or large, and bounds that are met exactly.
#include "tests/support/backends.hpp"
#include "tests/system/queries/brute_force.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace cadt::test {
namespace {

using Doubles = std::vector<double>;
constexpr double infinity = std::numeric_limits<double>::infinity();

class Scales : public BackendTest {
 protected:
  struct Mesh {
    Mesh(const Points& points, const Options& options)
        : xy(points),
          mesh(triangulate(std::span<const double>(xy), options)),
          queries(std::span<const double>(xy), mesh, options) {}
    Points xy;
    Triangulation mesh;
    MeshQueries queries;
  };
  static Mesh mesh_of(const Points& xy) { return {xy, GetParam().options()}; }
  static Points random(std::size_t n) {
    std::mt19937_64 engine(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    Points xy(2 * n);
    for (double& v : xy) v = uniform(engine);
    return xy;
  }
  static Points times(Points xy, double factor) {
    for (double& v : xy) v *= factor;
    return xy;
  }
  static Points joined(Points a, const Points& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }
};

TEST_P(Scales, FarPointsChangeNoNaturalNeighbours) {
  const Points near = random(50), asked = random(400);
  const Doubles values = random(26);  // 52, from 0 to 1
  const Doubles near_values(values.begin() + 2, values.end());
  const auto reference = mesh_of(near).queries.interpolate(near_values, asked, Interpolation::natural);
  for (const double distance : {1e4, 1e8, 1e12, 1e16}) {
    SCOPED_TRACE(distance);
    const Points far{distance, 0.3, -0.68 * distance, 0.17 * distance, 0.1 * distance, -distance};
    Doubles far_first{0.1, 0.9, 0.4}, far_last = near_values;
    far_last.insert(far_last.end(), far_first.begin(), far_first.end());
    far_first.insert(far_first.end(), near_values.begin(), near_values.end());
    const auto first = mesh_of(joined(far, near)).queries.interpolate(far_first, asked, Interpolation::natural);
    const auto last = mesh_of(joined(near, far)).queries.interpolate(far_last, asked, Interpolation::natural);
    std::size_t same = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (distance < 1e9) {
        ASSERT_NEAR(first[i], last[i], 1e-12) << "query " << i << ": the order of the points";
      }
      ASSERT_TRUE(first[i] >= -1e-3 && first[i] <= 1 + 1e-3) << "query " << i << ": " << first[i];
      if (std::abs(first[i] - reference[i]) < 1e-3) ++same;
    }
    if (distance < 1e9) {
      EXPECT_GT(same, first.size() / 2) << "queries among near points alone";
    }
  }
}

/// Two corners on a line through the third but for their last digits, of which rounding takes some from the edges.
TEST_P(Scales, CircumcentresOfThinTrianglesAreRight) {
  std::mt19937_64 engine(9);
  const auto number = [&](int bits) { return static_cast<std::int64_t>(engine() >> (64 - bits)); };
  std::size_t thin = 0;
  for (int round = 0; round < 200; ++round) {
    const std::int64_t along[2] = {number(20) + 1, number(20) + 1}, third[2] = {number(3), number(3)};
    const std::int64_t steps[2] = {number(36) + 1, -number(36) - 1};
    std::int64_t far[2][2], edges[2][2];  // 57 digits, of which the last four are 0
    for (int i : {0, 1})
      for (int k : {0, 1}) far[i][k] = along[k] * steps[i] / 16 * 16, edges[i][k] = far[i][k] - third[k];
    const auto& [u, v] = edges;
    const __int128 cross = static_cast<__int128>(u[0]) * v[1] - static_cast<__int128>(u[1]) * v[0];
    if (cross == 0) continue;
    const auto square = [](const std::int64_t* e) {
      return static_cast<long double>(e[0]) * e[0] + static_cast<long double>(e[1]) * e[1];
    };
    const long double d = 2 * static_cast<long double>(cross), x = (v[1] * square(u) - u[1] * square(v)) / d + third[0],
                      y = (u[0] * square(v) - v[0] * square(u)) / d + third[1];
    for (const int exponent : {0, -530, 500}) {  // the latter two take the wide variant
      SCOPED_TRACE(testing::Message() << "round " << round << " by 2^" << exponent);
      Points xy;
      for (const std::int64_t* corner : std::initializer_list<const std::int64_t*>{far[0], far[1], third})
        xy.insert(xy.end(), {static_cast<double>(corner[0]), static_cast<double>(corner[1])});
      const Doubles center = mesh_of(times(xy, std::ldexp(1.0, exponent))).queries.circumcenters();
      ASSERT_EQ(center.size(), 2U);
      const long double bound = std::hypot(x, y) * 1e-12L;
      ASSERT_LE(std::abs(std::ldexp(static_cast<long double>(center[0]), -exponent) - x), bound);
      ASSERT_LE(std::abs(std::ldexp(static_cast<long double>(center[1]), -exponent) - y), bound);
    }
    ++thin;
  }
  EXPECT_GT(thin, 150U);
}

TEST_P(Scales, CircumcentresDoNotDependOnTheCornerThatIsFirst) {
  const Points near{0.31, 0.93, 0.22, 0.19, 0.69, 0.78, 0.84, 0.17};
  const Points far{1e16, 0.3, -0.6e16, 0.2e16};
  for (const Points& xy : {joined(near, far), joined(far, near)}) {
    const auto circles = mesh_of(xy).queries.largest_empty_circles(1);
    ASSERT_EQ(circles.size(), 1U);
    EXPECT_NEAR(circles[0].x, 0.53771322, 1e-8);
    EXPECT_NEAR(circles[0].y, 0.41910981, 1e-8);
    EXPECT_NEAR(circles[0].radius, 0.39170524, 1e-8);
  }
}

TEST_P(Scales, CirclesOfAnyDouble) {
  auto small = mesh_of({0, 0, 1e-200, 0, 0, 1e-200, 1, 1});
  EXPECT_EQ(small.queries.circumcenters(), (Doubles{0.5e-200, 0.5e-200, 0.5, 0.5}));
  EXPECT_EQ(small.queries.outline(infinity).triangles.size(), 2U);
  EXPECT_EQ(small.queries.outline(1e-200).triangles, std::vector<std::int32_t>{0});
  auto large = mesh_of({0, 0, 1e200, 0, 0, 1e200, 1e-60, 1e-60});
  const auto circles = large.queries.largest_empty_circles(5);
  ASSERT_EQ(circles.size(), 1U);
  EXPECT_DOUBLE_EQ(circles[0].radius, std::sqrt(0.5) * 1e200);
  auto largest = mesh_of({-1.7e308, 0, 1.7e308, 0, 0, 1.7e308, 0, 0});
  EXPECT_EQ(largest.queries.circumcenters(), (Doubles{-0.85e308, 0.85e308, 0.85e308, 0.85e308}));
}

TEST_P(Scales, CellsOfAnySize) {
  const Points xy = random(30);
  const auto expected = mesh_of(xy).queries.voronoi_polygons({0.0625, 0.125, 0.875, 1});
  for (const int exponent : {-900, -700, -500, 500, 700, 1022}) {
    SCOPED_TRACE(exponent);
    const double factor = std::ldexp(1, exponent);
    auto scaled = mesh_of(times(xy, factor));
    const auto cells = scaled.queries.voronoi_polygons({0.0625 * factor, 0.125 * factor, 0.875 * factor, factor});
    EXPECT_EQ(cells.begin, expected.begin);
    EXPECT_EQ(cells.xy, times(expected.xy, factor));
  }
  // Near points among far ones, in a box of either.
  auto mixed = mesh_of(joined(times(xy, 0x1p-600), {-1, -1, 2, -1, 0, 2}));
  const auto near = mixed.queries.voronoi_polygons({0.0625 * 0x1p-600, 0.125 * 0x1p-600, 0.875 * 0x1p-600, 0x1p-600});
  EXPECT_TRUE(std::equal(expected.begin.begin(), expected.begin.end(), near.begin.begin()));
  Points found = times(near.xy, 0x1p600), wanted = expected.xy;  // cells on the hull of the near points begin elsewhere
  std::ranges::sort(found);
  std::ranges::sort(wanted);
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], wanted[i], 1e-14);
  for (const double least : {0.0, 1e-300}) {
    const auto all = mesh_of({-1.7e308, 0, 1.7e308, 0, 0, 1.7e308, 0, least})
                         .queries.voronoi_polygons({-1.7e308, -1.7e308, 1.7e308, 1.7e308});
    for (std::size_t v = 0; v < 4; ++v) EXPECT_GE(all.begin[v + 1] - all.begin[v], 4U) << v << " " << least;
    EXPECT_TRUE(std::ranges::all_of(all.xy, [](double v) { return std::abs(v) <= 1.7e308; }));
  }
}

TEST_P(Scales, AnEdgeAsLongAsTheBoundIsKept) {
  std::size_t kept = 0;
  for (int m = 2; m < 12; ++m)
    for (int n = 1; n < m; ++n)
      for (const double factor : {1.0, 3.0, 0x1p-300, 0x1p300}) {
        const double a = (m * m - n * n) * factor, b = 2 * m * n * factor, c = (m * m + n * n) * factor;
        auto triangle = mesh_of({0, 0, a, 0, 0, b});
        EXPECT_EQ(triangle.queries.outline(infinity, c).triangles.size(), 1U) << a << " " << b << " " << c;
        EXPECT_EQ(triangle.queries.outline(infinity, std::nextafter(c, 0)).triangles.size(), 0U);
        const Grid grid{0, 0, a / 4, b / 4, 4, 4};
        const Doubles values{1, 1, 1};
        for (const Interpolation method : {Interpolation::linear, Interpolation::natural}) {
          const auto cells = triangle.queries.rasterize(grid, values, method, c);
          kept += static_cast<std::size_t>(std::ranges::count(cells, 1.0));
          const auto none = triangle.queries.rasterize(grid, values, method, std::nextafter(c, 0));
          EXPECT_TRUE(std::ranges::all_of(none, [](double v) { return std::isnan(v); }));
        }
      }
  EXPECT_GE(kept, 2U * 4U * 55U * 6U);
  auto wide = mesh_of({0, 0, 5, 0, 0, 12, 1e-200, 1e-200});
  EXPECT_EQ(wide.queries.outline(infinity, 13).triangles.size(), 3U);
  EXPECT_EQ(wide.queries.outline(infinity, 12.5).triangles.size(), 2U);
}

TEST_P(Scales, CentresOnTheHullAreInIt) {
  for (int i = 1; i < 20; ++i)
    for (int j = 1; j < 20; ++j) {
      const double a = i / 10.0, b = j / 10.0;
      for (const Points& xy : {Points{0, 0, a, 0, 0, b}, Points{7, 9, 7 - a, 9, 7, 9 - b},
                               Points{0, 0, 0.6 * a, 0.8 * a, -0.8 * b, 0.6 * b}}) {
        const auto circles = mesh_of(xy).queries.largest_empty_circles(3);
        ASSERT_EQ(circles.size(), 1U) << a << " " << b;
        EXPECT_NEAR(circles[0].radius, std::hypot(a, b) / 2, 1e-12);
      }
      EXPECT_EQ(mesh_of({0, 0, a, 0, a / 2, 0.1 * a}).queries.largest_empty_circles(3).size(), 0U) << "obtuse";
    }
}

TEST_P(Scales, ZoomedRastersHaveNoGaps) {
  auto square = mesh_of({-9.9e5, -2.31e6, 3e5, 7e5, -7e5, 3e5, 7e5, -3e5});
  const Doubles values{0, 1, 2, 3};
  for (const double half : {5e-8, 5e-10, 5e-11, 5e-12}) {
    const auto cells = square.queries.rasterize({-half, -half, half / 50, half / 50, 100, 100}, values);
    EXPECT_EQ(std::ranges::count_if(cells, [](double v) { return std::isnan(v); }), 0) << half;
  }
  auto triangle = mesh_of({0, 0, 1, 0, 0, 1});
  for (const double step : {1e-300, 1e-310, 5e-324})
    EXPECT_EQ(triangle.queries.rasterize({0.25, 0.25, step, step, 2, 2}, Doubles{0, 1, 2}), Doubles(4, 0.75)) << step;
  // Centres that are subnormal numbers are rounded.
  const double u = std::numeric_limits<double>::denorm_min();
  auto smallest = mesh_of({-3 * u, -3 * u, 3 * u, -3 * u, 3 * u, 3 * u, -3 * u, 3 * u});
  const Grid grid{-9 * u, -3 * u, 5 * u, u, 4, 26};
  const auto cells = smallest.queries.rasterize(grid, values);
  const auto one_by_one = smallest.queries.interpolate(values, centers(grid));
  for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_EQ(std::isnan(cells[i]), std::isnan(one_by_one[i])) << i;
}

TEST_P(Scales, AVertexOfAThinTriangleHasItsValue) {
  const Points xy{-1e-128, -1e-85, -1e43, -1e75, -1e25, -1e57};
  EXPECT_EQ(mesh_of(xy).queries.interpolate(Doubles{5, 6, 7}, xy), (Doubles{5, 6, 7}));
}

/// Weights of eighths in a triangle of 2^-51 at most across, in sets that take the narrow and the wide variant.
TEST_P(Scales, ThinTrianglesKeepTheirAreasBesideAnyDouble) {
  for (const double other : {0.0, 1e-60, 1e-300})
    for (const int exponent : {0, -900, 900}) {
      SCOPED_TRACE(testing::Message() << other << " by 2^" << exponent);
      const Points xy{0, 0, 0.5, 0.5 + 0x1p-51, 1, 1, other, 1};
      auto mesh = mesh_of(times(xy, std::ldexp(1.0, exponent)));
      for (int k = 1; k < 4; ++k) {
        const Points at = times({0.25, 0.25 + k * 0x1p-54}, std::ldexp(1.0, exponent));
        EXPECT_DOUBLE_EQ(mesh.queries.interpolate(Doubles{0, 1, 0, 0}, at).at(0), k / 8.0);
        EXPECT_DOUBLE_EQ(mesh.queries.interpolate(Doubles{1, 0, 0, 0}, at).at(0), 0.75 - k / 16.0);
      }
    }
}

/// Seen from the two small corners, the third is in the direction of (1, 1).
TEST_P(Scales, WeightsBesideACornerThatIsAnyFactorAway) {
  const double u = std::numeric_limits<double>::denorm_min();
  for (const double far : {0x1p-900, 0x1p-600, 1.0, 0x1p600, 1.7e308})
    for (const double near : {u, 0x1p-1030, 0x1p-1010}) {
      SCOPED_TRACE(testing::Message() << far << " " << near);
      auto mesh = mesh_of({0, 4 * near, 4 * near, 0, far, far});
      const Points at{2 * near, 4 * near, 3 * near, 3 * near, 3 * near, 1 * near, 0, 4 * near};
      const auto found = mesh.queries.interpolate(Doubles{1, 2, 3}, at);
      for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i], (Doubles{1.25, 1.5, 1.75, 1})[i], 1e-15) << i;
    }
}

TEST_P(Scales, RastersOfAllDoublesHaveNoGaps) {
  const double most = 1.7e308;
  for (const Points& xy : {Points{-most, -most, most, -most, 0, most, 0.1 * most, -1e-300},
                           Points{-most, -most, most, -most, most, most, -most, most},
                           Points{-most, 0.9 * most, -0.9 * most, -most, most, -0.95 * most, 0, most}}) {
    auto all = mesh_of(xy);
    const Doubles values{0, 1, 2, 3};
    const Grid grid{-0.5 * most, -0.5 * most, most / 32, most / 16, 30, 14};
    const auto cells = all.queries.rasterize(grid, values);
    const auto one_by_one = all.queries.interpolate(values, centers(grid));
    std::size_t inside = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!std::isnan(one_by_one[i])) ++inside;
      ASSERT_EQ(std::isnan(cells[i]), std::isnan(one_by_one[i])) << "cell " << i;
      if (!std::isnan(cells[i])) {
        ASSERT_DOUBLE_EQ(cells[i], one_by_one[i]) << "cell " << i;
      }
    }
    EXPECT_GT(inside, 200U);
  }
}

TEST_P(Scales, NaturalNeighboursOfTinyValues) {
  const Points asked = times(random(400), 0x1p-60);
  auto mesh = mesh_of(joined(times(random(50), 0x1p-60), {-1, -1, 1, -1, 0, 1}));
  Doubles values = random(27);
  values.resize(53);
  const auto expected = mesh.queries.interpolate(values, asked, Interpolation::natural);
  for (const int exponent : {-900, -960, -1000, 500}) {
    SCOPED_TRACE(exponent);
    const double factor = std::ldexp(1, exponent);
    EXPECT_EQ(mesh.queries.interpolate(times(values, factor), asked, Interpolation::natural), times(expected, factor));
  }
}

TEST_P(Scales, CellsOfPointsOneSubnormalApartDoNotOverlap) {
  const double u = std::numeric_limits<double>::denorm_min();
  for (const double apart : {1.0, 2.0, 3.0, 4.0}) {
    SCOPED_TRACE(apart);
    const auto cells = mesh_of({0, 0, apart * u, 0, 0, apart * u, apart * u, apart * u, 1, 1, -1, 0.5, 0.5, -1})
                           .queries.voronoi_polygons({-5 * u, -5 * u, 8 * u, 8 * u});
    double area = 0;
    for (std::size_t v = 0; v < 7; ++v)
      for (std::size_t i = cells.begin[v]; i < cells.begin[v + 1]; ++i) {
        const std::size_t j = i + 1 < cells.begin[v + 1] ? i + 1 : cells.begin[v];
        const auto in_units = [&](std::size_t k) { return cells.xy[k] / u; };
        area += (in_units(2 * i) * in_units(2 * j + 1) - in_units(2 * i + 1) * in_units(2 * j)) / 2;
      }
    EXPECT_NEAR(area, 13 * 13, std::fmod(apart, 2) == 0 ? 0 : 2 * 13) << "but for the rounding of two lines";
  }
}

CADT_ON_MAIN_BACKENDS(Scales);

}  // namespace
}  // namespace cadt::test
