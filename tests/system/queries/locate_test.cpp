// SPDX-License-Identifier: Apache-2.0
#include "tests/support/backends.hpp"
#include "tests/support/oracle.hpp"
#include "tests/system/queries/brute_force.hpp"

#include <algorithm>
#include <cmath>

namespace cadt::test {
namespace {

class Locate : public BackendTest {};

TEST_P(Locate, EqualsBruteForceInExactArithmetic) {
  std::size_t on_something = 0, outside = 0;
  for_each_set(2000, [&](const Asked& set) {
    SCOPED_TRACE(set.name);
    MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
    for (const Points& where : {set.queries, near_queries(set)}) {  // by the wide kernels, and most by the narrow ones
      const auto found = queries.locate(where);
      ASSERT_EQ(found.size(), where.size() / 2);
      for (std::size_t q = 0; q < found.size(); ++q) {
        const std::int32_t expected = containing(set, where[2 * q], where[2 * q + 1]);
        ASSERT_EQ(found[q], expected) << "query " << q << ": " << where[2 * q] << " " << where[2 * q + 1];
        expected < 0 ? ++outside : ++on_something;
      }
    }
  });
  EXPECT_GT(on_something, 1000u);
  EXPECT_GT(outside, 1000u);
}

#if CADT_TEST_CGAL
TEST_P(Locate, EqualsTheFacesOfCgal) {
  const Points xy = uniform_points(3000, 71), where = uniform_points(5000, 72);
  const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
  MeshQueries queries(std::span<const double>(xy), mesh, GetParam().options());
  const auto found = queries.locate(where);
  const LocatedFaces expected = cgal_locate(xy, where);
  std::size_t inside = 0;
  for (std::size_t q = 0; q < found.size(); ++q) {
    Triangle mine = {-1, -1, -1};
    if (found[q] >= 0) std::copy_n(&mesh.triangles()[3 * static_cast<std::size_t>(found[q])], 3, mine.begin());
    ASSERT_EQ(mine, expected.faces[q]) << q;
    inside += found[q] >= 0 ? 1 : 0;
  }
  EXPECT_GT(inside, 4900u);
}
#endif

TEST_P(Locate, OneQueryAtATimeAndAllTogetherAreTheSame) {
  const Asked set("", uniform_points(700, 5));
  MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
  const auto together = queries.locate(set.queries);
  for (std::size_t q = 0; q < set.size(); q += 7)
    EXPECT_EQ(queries.locate(std::span(set.queries).subspan(2 * q, 2)), std::vector{together[q]});
  EXPECT_TRUE(queries.locate(std::span<const double>()).empty());
}

TEST_P(Locate, BarycentricCoordinatesGiveThePointBack) {
  for_each_set(1500, [&](const Asked& set) {
    if (!narrow(set)) return;
    SCOPED_TRACE(set.name);
    MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
    const Points asked = near_queries(set);
    const Located found = queries.locate_barycentric(asked);
    ASSERT_EQ(found.triangles, queries.locate(asked));
    ASSERT_EQ(found.barycentric.size(), asked.size() / 2 * 3);
    for (std::size_t q = 0; q < asked.size() / 2; ++q) {
      const double* w = &found.barycentric[3 * q];
      if (found.triangles[q] < 0) {
        EXPECT_TRUE(std::isnan(w[0]) && std::isnan(w[1]) && std::isnan(w[2]));
        continue;
      }
      double at[2] = {0, 0}, size = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v =
            static_cast<std::size_t>(set.mesh.triangles()[3 * static_cast<std::size_t>(found.triangles[q]) + k]);
        ASSERT_GE(w[k], 0);
        for (std::size_t axis = 0; axis < 2; ++axis) {
          at[axis] += w[k] * set.xy[2 * v + axis];
          size = std::max(size, std::abs(set.xy[2 * v + axis]));
        }
        if (set.xy[2 * v] == asked[2 * q] && set.xy[2 * v + 1] == asked[2 * q + 1]) {
          EXPECT_EQ(w[k], 1);
        }
      }
      ASSERT_NEAR(w[0] + w[1] + w[2], 1, 1e-15);
      ASSERT_NEAR(at[0], asked[2 * q], 1e-13 * size) << "query " << q;
      ASSERT_NEAR(at[1], asked[2 * q + 1], 1e-13 * size) << "query " << q;
    }
  });
}

TEST_P(Locate, FloatsAndSeparateArraysAreTheSamePoints) {
  const Points lattice = grid_points(12, 9);
  const std::vector<float> floats(lattice.begin(), lattice.end());
  const Triangulation mesh = triangulate(std::span<const double>(lattice), GetParam().options());
  Points queries;
  Random random(3);
  for (int i = 0; i < 200; ++i) queries.push_back(std::floor(random.uniform() * 40) / 4);
  const std::vector<float> float_queries(queries.begin(), queries.end());
  std::vector<double> x, y;
  for (std::size_t i = 0; i < queries.size(); i += 2) x.push_back(queries[i]), y.push_back(queries[i + 1]);
  MeshQueries doubles(std::span<const double>(lattice), mesh, GetParam().options());
  MeshQueries singles(std::span<const float>(floats), mesh, GetParam().options());
  const auto expected = doubles.locate(queries);
  EXPECT_EQ(doubles.locate(float_queries), expected);
  EXPECT_EQ(singles.locate(queries), expected);
  EXPECT_EQ(doubles.locate(PointsView(std::span<const double>(x), std::span<const double>(y))), expected);
}

TEST_P(Locate, FarClustersAndEqualPoints) {
  // Nearly all points in one cell of the coarse keys, and a thousand times the same point.
  Points xy = scaled(uniform_points(3000, 9), -30);
  xy.insert(xy.end(), {-1, -1, 1, -1, 1, 1, -1, 1});
  for (int i = 0; i < 1000; ++i) xy.insert(xy.end(), {xy[20], xy[21]});
  const Asked set("", xy);
  MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
  const auto found = queries.locate(set.queries);
  for (std::size_t q = 0; q < found.size(); ++q)
    ASSERT_EQ(found[q], containing(set, set.queries[2 * q], set.queries[2 * q + 1])) << q;
}

TEST_P(Locate, WithoutTrianglesEverythingIsOutside) {
  for (const Points& xy : {Points{}, Points{1, 1}, Points{0, 0, 1, 1, 2, 2, 3, 3}, Points{1, 1, 1, 1}}) {
    const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
    MeshQueries queries(std::span<const double>(xy), mesh, GetParam().options());
    const Points where = {1, 1, 0.5, 0.25};
    EXPECT_EQ(queries.locate(where), (std::vector<std::int32_t>{-1, -1}));
    EXPECT_EQ(queries.within_hull(where), (std::vector<std::uint8_t>{0, 0}));
    EXPECT_EQ(queries.nearest_vertices(where, 2), (std::vector<std::int32_t>{-1, -1, -1, -1}));
    EXPECT_TRUE(std::isnan(queries.interpolate(std::vector<double>(xy.size() / 2, 1.0), where).at(1)));
    EXPECT_EQ(queries.voronoi().cell_begin, std::vector<std::uint32_t>(xy.size() / 2 + 1, 0));
  }
}

CADT_ON_MAIN_BACKENDS(Locate);

}  // namespace
}  // namespace cadt::test
