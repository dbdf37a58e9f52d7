// SPDX-License-Identifier: Apache-2.0
#include "tests/support/backends.hpp"
#include "tests/system/queries/brute_force.hpp"

#include <cmath>
#include <cstring>

namespace cadt::test {
namespace {

class Rasterize : public BackendTest {
 protected:
  static bool same(const std::vector<double>& a, const std::vector<double>& b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))) return false;
    return true;
  }
  static std::vector<double> some_values(std::size_t n) {
    std::vector<double> values(n);
    Random random(n);
    for (double& value : values) value = random.normal();
    return values;
  }
};

TEST_P(Rasterize, EachCellIsTheValueAtItsCentre) {
  std::size_t cells = 0, sets = 0;
  for_each_set(600, [&](const Asked& set) {
    const std::size_t n = set.xy.size() / 2;
    double low[2] = {set.xy[0], set.xy[1]}, high[2] = {set.xy[0], set.xy[1]};
    for (std::size_t i = 0; i < set.xy.size(); ++i) {
      low[i % 2] = std::min(low[i % 2], set.xy[i]);
      high[i % 2] = std::max(high[i % 2], set.xy[i]);
    }
    const double width = high[0] - low[0], height = high[1] - low[1];
    if (!std::isfinite(4 * width) || !std::isfinite(4 * height) || width / 64 == 0 || height / 64 == 0) return;
    if (set.mesh.number_of_triangles() == 0 || ++sets % 3 != 0) return;
    SCOPED_TRACE(set.name);
    MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
    const auto values = some_values(n);
    // One that has the points on centres of cells, a fine one, a coarse one, and one upside down beside the mesh.
    for (const Grid& grid : {Grid{low[0] - width / 32, low[1] - height / 32, width / 16, height / 16, 18, 18},
                             Grid{low[0] - width / 7, low[1] - height / 5, width / 91, height / 73, 110, 97},
                             Grid{low[0] - width, high[1] + height, width, -height, 3, 3}}) {
      const auto raster = queries.rasterize(grid, values);
      ASSERT_TRUE(same(raster, queries.interpolate(values, centers(grid))));
      for (const double cell : raster) cells += std::isnan(cell) ? 0 : 1;
    }
  });
  EXPECT_GT(cells, 10000u);
}

TEST_P(Rasterize, NearestAndNaturalToo) {
  const Asked set("", uniform_points(300, 8));
  MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
  const auto values = some_values(300);
  const Grid grid{-0.1, 1.1, 0.05, -0.04, 24, 30};
  for (const Interpolation method : {Interpolation::nearest, Interpolation::natural})
    EXPECT_TRUE(same(queries.rasterize(grid, values, method), queries.interpolate(values, centers(grid), method)));
}

TEST_P(Rasterize, PartsOfAGridAreThoseOfTheWhole) {
  // The hull ends on centres of cells: they are outside if they are rounded otherwise.
  const Grid whole{500000.3, 5400000.7, 0.1, -0.1, 140, 60};
  for (const double column : {65.0, 131.0, 136.0}) {
    const double width = whole.x0 + (column + 0.5) * whole.dx - whole.x0, height = 6;
    Points xy = {0, 0, 1, 0, 0, 1, 1, 1};
    const Points inside = uniform_points(300, 5);
    xy.insert(xy.end(), inside.begin(), inside.end());
    for (std::size_t i = 0; i < xy.size(); i += 2) {
      xy[i] = whole.x0 + xy[i] * width;
      xy[i + 1] = whole.y0 - xy[i + 1] * height;
    }
    const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
    MeshQueries queries(std::span<const double>(xy), mesh, GetParam().options());
    const auto values = some_values(304);
    for (const Interpolation method : {Interpolation::linear, Interpolation::natural}) {
      const auto raster = queries.rasterize(whole, values, method);
      EXPECT_FALSE(std::isnan(raster[30 * whole.columns + static_cast<std::size_t>(column)]));
      for (std::size_t row = 0; row < whole.rows; row += 25) {
        for (std::size_t first = 0; first < whole.columns; first += 33) {
          Grid part = whole;
          part.first_row = row, part.first_column = first;
          part.rows = std::min<std::size_t>(25, whole.rows - row);
          part.columns = std::min<std::size_t>(33, whole.columns - first);
          std::vector<double> expected;
          for (std::size_t j = row; j < row + part.rows; ++j) {
            const auto from = raster.begin() + static_cast<std::ptrdiff_t>(j * whole.columns + first);
            expected.insert(expected.end(), from, from + static_cast<std::ptrdiff_t>(part.columns));
          }
          ASSERT_TRUE(same(queries.rasterize(part, values, method), expected)) << column << " " << row << " " << first;
        }
      }
    }
  }
}

TEST_P(Rasterize, LongEdgesLeaveHoles) {
  Points xy = uniform_points(500, 4);
  xy.insert(xy.end(), {3, 0.5, 3.1, 0.5, 3, 0.6});
  const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
  MeshQueries queries(std::span<const double>(xy), mesh, GetParam().options());
  const Grid grid{-0.5, -0.5, 0.05, 0.05, 80, 40};
  const auto values = some_values(503);
  const auto where = queries.locate(centers(grid));
  for (const Interpolation method : {Interpolation::linear, Interpolation::natural}) {
    const auto raster = queries.rasterize(grid, values, method, 0.5), all = queries.rasterize(grid, values, method);
    std::size_t dropped = 0, kept = 0;
    for (std::size_t i = 0; i < raster.size(); ++i) {
      if (where[i] < 0) {
        EXPECT_TRUE(std::isnan(raster[i]));
        continue;
      }
      bool is_long = false;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto a = static_cast<std::size_t>(mesh.triangles()[3 * static_cast<std::size_t>(where[i]) + k]),
                   b = static_cast<std::size_t>(mesh.triangles()[3 * static_cast<std::size_t>(where[i]) + (k + 1) % 3]);
        is_long = is_long || std::hypot(xy[2 * a] - xy[2 * b], xy[2 * a + 1] - xy[2 * b + 1]) > 0.5;
      }
      ASSERT_EQ(std::isnan(raster[i]), is_long) << i;
      if (!is_long) {
        ASSERT_EQ(raster[i], all[i]);
      }
      ++(is_long ? dropped : kept);
    }
    EXPECT_GT(dropped, 50u);
    EXPECT_GT(kept, 300u);
  }
}

TEST_P(Rasterize, ACellOnAnEdgeBelongsToOneTriangle) {
  // A centre lies on the edge between a triangle that is too long and one that is not: the lower one decides.
  for (const bool long_one_first : {true, false}) {
    Points xy = {0, 0, 2, 0, 2, 2, 0, 2};
    xy.insert(long_one_first ? xy.begin() : xy.end(), {10, 1});
    const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
    MeshQueries queries(std::span<const double>(xy), mesh, GetParam().options());
    const auto raster =
        queries.rasterize({1.5, 0.5, 1, 1, 1, 1}, std::vector<double>(5, 7.0), Interpolation::linear, 5);
    EXPECT_EQ(queries.locate(Points{2, 1}), std::vector<std::int32_t>{long_one_first ? 0 : 1});
    EXPECT_EQ(std::isnan(raster.at(0)), long_one_first);
  }
}

CADT_ON_MAIN_BACKENDS(Rasterize);

}  // namespace
}  // namespace cadt::test
