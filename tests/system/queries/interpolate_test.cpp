// SPDX-License-Identifier: Apache-2.0
#include "tests/support/backends.hpp"
#include "tests/system/queries/brute_force.hpp"

#include <cmath>

namespace cadt::test {
namespace {

class Interpolate : public BackendTest {
 protected:
  /// Two linear functions at each point; `size` is their range.
  static std::vector<double> linear(const Points& at, double scale) {
    std::vector<double> values;
    for (std::size_t i = 0; i < at.size(); i += 2) {
      values.push_back(2 * (at[i] / scale) - 3 * (at[i + 1] / scale) + 0.5);
      values.push_back(0.25 * (at[i + 1] / scale));
    }
    return values;
  }
  static double largest(const Points& xy) {
    double size = 0;
    for (const double value : xy) size = std::max(size, std::abs(value));
    return size == 0 ? 1 : size;
  }
};

TEST_P(Interpolate, LinearFunctionsAreReproduced) {
  std::size_t compared = 0;
  for (const Interpolation method : {Interpolation::linear, Interpolation::natural})
    for_each_set(1500, [&](const Asked& set) {
      const Points asked = near_queries(set);
      if (set.mesh.number_of_triangles() == 0 || !narrow(set)) return;
      SCOPED_TRACE(set.name + " " + std::string(to_string(method)));
      const double size = largest(set.xy);
      MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
      const auto where = queries.locate(asked);
      const auto found = queries.interpolate(linear(set.xy, size), asked, method);
      const auto expected = linear(asked, size);
      ASSERT_EQ(found.size(), asked.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (where[i / 2] < 0) {
          ASSERT_TRUE(std::isnan(found[i]));
          continue;
        }
        ++compared;
        ASSERT_NEAR(found[i], expected[i], 1e-10)
            << "query " << i / 2 << ": " << asked[i / 2 * 2] << " " << asked[i / 2 * 2 + 1];
      }
    });
  EXPECT_GT(compared, 1000u);
}

TEST_P(Interpolate, ValuesStayBetweenThoseOfTheVertices) {
  for_each_set(1500, [&](const Asked& set) {
    const Points asked = near_queries(set);
    if (set.mesh.number_of_triangles() == 0 || !narrow(set)) return;
    SCOPED_TRACE(set.name);
    MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
    std::vector<double> values(set.xy.size() / 2);
    Random random(values.size());
    for (double& value : values) value = random.uniform();
    for (const Interpolation method : {Interpolation::linear, Interpolation::natural})
      for (const double found : queries.interpolate(values, asked, method)) {
        ASSERT_FALSE(found < -1e-6 || found > 1 + 1e-6) << found << ' ' << to_string(method);
      }
  });
}

TEST_P(Interpolate, ValuesOfVerticesAreKept) {
  const Asked set("", uniform_points(800, 21));
  MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
  std::vector<double> values(800);
  Random random(5);
  for (double& value : values) value = random.normal() * 1e6;
  for (const Interpolation method : {Interpolation::linear, Interpolation::nearest, Interpolation::natural})
    EXPECT_EQ(queries.interpolate(values, set.xy, method), values) << to_string(method);
}

TEST_P(Interpolate, NaturalNeighboursAreSibsons) {
  // The weights of the centre of a unit square's corners are equal; moved along the axis of a rectangle they are those
  // of the areas that the new cell takes.
  const Points xy = {0, 0, 4, 0, 4, 4, 0, 4};
  const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
  MeshQueries queries(std::span<const double>(xy), mesh, GetParam().options());
  // Seen from (1, 2): the cell is x from -1.25 to 2.25 at y = 2 between lines to the corners. By hand: the bisectors
  // with (0, 0) and (0, 4) meet the old bisector y = 2 at x = (1 + 4 - 4) / 2 - ..., so areas are those of the four
  // pieces.
  const auto share = [&](double px, double py) {
    std::vector<double> weights;
    for (std::size_t of = 0; of < 4; ++of) {
      std::vector<double> values(4, 0.0);
      values[of] = 1;
      weights.push_back(queries.interpolate(values, Points{px, py}, Interpolation::natural).at(0));
    }
    return weights;
  };
  for (const double w : share(2, 2)) EXPECT_NEAR(w, 0.25, 1e-15);
  const auto left = share(1, 2);
  EXPECT_NEAR(left[0], left[3], 1e-15);
  EXPECT_NEAR(left[1], left[2], 1e-15);
  EXPECT_NEAR(left[1] + left[2], 0.25, 1e-15);  // the centroid is the point
  EXPECT_NEAR(left[0] + left[1] + left[2] + left[3], 1, 1e-15);
}

/// Sibson's weights from clipped Voronoi cells with and without the query, which shares no text with the kernel for
/// them.
TEST_P(Interpolate, NaturalNeighboursAreTheAreasThatACellTakes) {
  const Points xy = uniform_points(60, 33);
  const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
  MeshQueries queries(std::span<const double>(xy), mesh, GetParam().options());
  const Box box{-1e3, -1e3, 1e3, 1e3};
  const auto areas = [&](MeshQueries& of, std::size_t n) {
    const VoronoiPolygons cells = of.voronoi_polygons(box);
    std::vector<double> area(n, 0.0);
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t i = cells.begin[p]; i < cells.begin[p + 1]; ++i) {
        const std::size_t j = i + 1 < cells.begin[p + 1] ? i + 1 : cells.begin[p];
        area[p] += 0.5 * (cells.xy[2 * i] * cells.xy[2 * j + 1] - cells.xy[2 * i + 1] * cells.xy[2 * j]);
      }
    return area;
  };
  const auto before = areas(queries, 60);
  const Points where = {0.5, 0.5, 0.31, 0.62, 0.7, 0.4};
  for (std::size_t q = 0; q < where.size(); q += 2) {
    Points more = xy;
    more.insert(more.end(), {where[q], where[q + 1]});
    const Triangulation with = triangulate(std::span<const double>(more), GetParam().options());
    MeshQueries then(std::span<const double>(more), with, GetParam().options());
    const auto after = areas(then, 61);
    for (std::size_t p = 0; p < 60; ++p) {
      std::vector<double> values(60, 0.0);
      values[p] = 1;
      const double weight = queries.interpolate(values, Points{where[q], where[q + 1]}, Interpolation::natural).at(0);
      EXPECT_NEAR(weight, (before[p] - after[p]) / after[60], 1e-6) << p;
    }
  }
}

TEST_P(Interpolate, OutsideIsNanOrTheNearestVertex) {
  const Points xy = {0, 0, 1, 0, 0, 1};
  const std::vector<double> values = {1, 2, 3};
  const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
  MeshQueries queries(std::span<const double>(xy), mesh, GetParam().options());
  const Points where = {-5, -5, 3, 0.1, 0.25, 0.25};
  for (const Interpolation method : {Interpolation::linear, Interpolation::nearest, Interpolation::natural}) {
    const auto nan = queries.interpolate(values, where, method),
               near = queries.interpolate(values, where, method, Outside::nearest);
    EXPECT_TRUE(std::isnan(nan[0]) && std::isnan(nan[1]) && !std::isnan(nan[2]));
    EXPECT_EQ(near[0], 1);
    EXPECT_EQ(near[1], 2);
    EXPECT_EQ(near[2], nan[2]);
  }
}

TEST_P(Interpolate, WideCoordinatesHaveNoNaturalNeighbours) {
  const Points xy = {0, 0, 1e-200, 0, 1, 1e-180, 1, 1};
  const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
  MeshQueries queries(std::span<const double>(xy), mesh, GetParam().options());
  const std::vector<double> values = {1, 2, 3, 4};
  EXPECT_NEAR(queries.interpolate(values, Points{1, 0.5}).at(0), 3.5, 1e-12);
  EXPECT_THROW((void)queries.interpolate(values, Points{0.5, 0.25}, Interpolation::natural), InputError);
}

CADT_ON_MAIN_BACKENDS(Interpolate);

}  // namespace
}  // namespace cadt::test
