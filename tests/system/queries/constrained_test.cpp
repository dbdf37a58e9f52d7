// SPDX-License-Identifier: Apache-2.0
// Queries of meshes with segments: right, or refused.
#include <cadt/constrained.hpp>

#include "tests/support/backends.hpp"
#include "tests/system/constrained/legal_segments.hpp"
#include "tests/system/queries/brute_force.hpp"
#include "tests/system/resident/resident.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cadt::test {
namespace {

class ConstrainedQueries : public BackendTest {
 protected:
  [[nodiscard]] Options options() const { return GetParam().options(); }
};

/// `set` with the mesh of another triangulation of its points.
Asked with_mesh(Asked set, const ConstrainedTriangulation& mesh) {
  set.mesh = mesh.mesh();
  return set;
}

TEST_P(ConstrainedQueries, LocateEqualsBruteForce) {
  std::size_t not_delaunay = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Asked plain("", uniform_points(150, seed));
    const auto segments = legal_segments(plain.xy, 60, seed);
    const ConstrainedTriangulation mesh = triangulate_constrained(plain.xy, segments, {}, options());
    const Asked set = with_mesh(plain, mesh);
    not_delaunay += count_differing(mesh.mesh(), plain.mesh);
    MeshQueries queries(std::span<const double>(set.xy), mesh, options());
    const auto found = queries.locate(set.queries);
    for (std::size_t q = 0; q < set.size(); ++q)
      ASSERT_EQ(found[q], containing(set, set.queries[2 * q], set.queries[2 * q + 1])) << "query " << q;
  }
  EXPECT_GT(not_delaunay, 200U);
}

/// Two straight banks of a ditch, far from each other along it: without them, triangles would bridge it.
struct Ditch {
  Points xy;
  std::vector<double> z;
  std::vector<Segment> banks;
  [[nodiscard]] static double height(double y) { return std::min(std::abs(y - 0.5), 0.125); }
  Ditch() {
    const auto add = [&](double x, double y) {
      xy.insert(xy.end(), {x, y});
      z.push_back(height(y));
    };
    for (const double y : {0.0, 0.375, 0.5, 0.625, 1.0}) {
      add(0, y);
      add(1, y);
    }
    for (std::int32_t line = 1; line < 4; ++line) banks.push_back({2 * line, 2 * line + 1});
    Random random(5);
    for (int i = 0; i < 60; ++i) {
      const double x = random.uniform(), y = 0.375 * random.uniform();
      add(x, i % 2 == 0 ? y : 1 - y);
    }
  }
};

TEST_P(ConstrainedQueries, BreaklinesShapeRasters) {
  const Ditch ditch;
  const Grid grid{0, 0, 1.0 / 64, 1.0 / 64, 64, 64};
  const auto worst = [&](MeshQueries&& queries) {
    const auto cells = queries.rasterize(grid, ditch.z);
    double error = 0;
    for (std::size_t j = 0; j < grid.rows; ++j)
      for (std::size_t i = 0; i < grid.columns; ++i) {
        const double y = (static_cast<double>(j) + 0.5) / 64;
        error = std::max(error, std::abs(cells[j * grid.columns + i] - Ditch::height(y)));
      }
    return error;
  };
  const std::span<const double> xy(ditch.xy);
  EXPECT_GT(worst(MeshQueries(xy, triangulate(xy, options()), options())), 0.01);
  const auto mesh = triangulate_constrained(xy, ditch.banks, {}, options());
  EXPECT_LT(worst(MeshQueries(xy, mesh, options())), 1e-12);
  // cell by cell, where each triangle is found
  MeshQueries queries(xy, mesh, options());
  for (const double y : {0.01, 0.4, 0.499, 0.6, 0.99})
    EXPECT_NEAR(queries.interpolate(ditch.z, Points{0.3, y}).front(), Ditch::height(y), 1e-12) << y;
}

/// Crossings are rounded to places where edges without a constraint are not Delaunay: at 2^52 by whole units.
TEST_P(ConstrainedQueries, EdgesBesideRoundedCrossingsMayNotBeDelaunay) {
  constexpr double o = 4503599627370496;
  std::vector<double> xy;
  for (const double v : {8., 6., 3., 0., 8., 8., 7., 5., 6., 5., 9., 0., 1., 6., 5., 1.}) xy.push_back(o + v);
  const std::vector<Segment> segments = {{3, 7}, {6, 2}, {5, 4}};
  ConstraintOptions exact;
  exact.crossing = Crossing::exact;
  const auto mesh = triangulate_constrained(std::span<const double>(xy), segments, exact, options());
  ASSERT_GT(mesh.added_points().size(), 0U);
  MeshQueries queries(std::span<const double>(xy), mesh, options());
  const Points where = {o + 9, o + 4};
  const auto error = thrown<NotDelaunay>([&] { (void)queries.nearest_vertex(where); });
  ASSERT_NE(error, nullptr);
  const auto edge = static_cast<std::size_t>(error->edge());
  EXPECT_FALSE(mesh.is_constrained(edge / 3, edge % 3));
  EXPECT_EQ(queries.locate(where).size(), 1U);
}

TEST_P(ConstrainedQueries, WhatTakesADelaunayMeshIsRefused) {
  const Ditch ditch;
  const std::span<const double> xy(ditch.xy);
  const auto mesh = triangulate_constrained(xy, ditch.banks, {}, options());
  MeshQueries queries(xy, mesh, options());
  const Points where = {0.5, 0.5};
  const auto refused = [&](const auto& call) {
    const auto error = thrown<NotDelaunay>(call);
    ASSERT_NE(error, nullptr);
    const auto edge = static_cast<std::size_t>(error->edge());
    ASSERT_TRUE(mesh.is_constrained(edge / 3, edge % 3));
    const auto at = [&](std::int32_t v) {
      return std::array{ditch.xy[2 * static_cast<std::size_t>(v)], ditch.xy[2 * static_cast<std::size_t>(v) + 1]};
    };
    const auto t = mesh.mesh().triangle(edge / 3);
    const auto across = mesh.mesh().triangle(static_cast<std::size_t>(mesh.mesh().neighbor(edge / 3, edge % 3)));
    const auto beyond = *std::ranges::find_if(across, [&](auto v) { return std::ranges::find(t, v) == t.end(); });
    EXPECT_GT(exact_in_circle(at(t[0]), at(t[1]), at(t[2]), at(beyond)), 0);
  };
  refused([&] { (void)queries.nearest_vertex(where); });
  refused([&] { (void)queries.nearest_vertices(where, 3); });
  refused([&] { (void)queries.interpolate(ditch.z, where, Interpolation::nearest); });
  refused([&] { (void)queries.interpolate(ditch.z, where, Interpolation::natural); });
  refused([&] { (void)queries.interpolate(ditch.z, where, Interpolation::linear, Outside::nearest); });
  refused([&] { (void)queries.rasterize({0, 0, 1, 1, 1, 1}, ditch.z, Interpolation::natural); });
  refused([&] { (void)queries.voronoi(); });
  refused([&] { (void)queries.voronoi_polygons({0, 0, 1, 1}); });
  refused([&] { (void)queries.largest_empty_circles(1); });
  EXPECT_EQ(queries.locate(where).size(), 1U);  // and then it goes on
  EXPECT_EQ(queries.circumcenters().size(), 2 * mesh.mesh().number_of_triangles());
  EXPECT_GT(queries.outline(10).triangles.size(), 0U);
  // The same as arrays.
  const MeshView arrays{.triangles = mesh.mesh().triangles(),
                        .neighbors = mesh.mesh().neighbors(),
                        .hull = {},
                        .duplicates = {},
                        .has_duplicates = false,
                        .edge_flags = mesh.edge_flags()};
  MeshQueries of_arrays(xy, arrays, options());
  refused([&] { (void)of_arrays.nearest_vertex(where); });
}

/// ConstrainedTriangulation::mesh() does not say which edges are constrained.
TEST_P(ConstrainedQueries, AMeshWithoutItsSegmentsIsExamined) {
  const Ditch ditch;
  const std::span<const double> xy(ditch.xy);
  const auto mesh = triangulate_constrained(xy, ditch.banks, {}, options());
  MeshQueries of_banks(xy, mesh.mesh(), options());
  const Points where = {0.5, 0.5};
  EXPECT_NE(thrown<NotDelaunay>([&] { (void)of_banks.nearest_vertex(where); }), nullptr);
  EXPECT_NE(thrown<NotDelaunay>([&] { (void)of_banks.voronoi_polygons({0, 0, 1, 1}); }), nullptr);
  EXPECT_EQ(of_banks.locate(where).size(), 1U);
  MeshQueries of_none(xy, triangulate_constrained(xy, {}, {}, options()).mesh(), options());
  EXPECT_EQ(of_none.nearest_vertex(where),
            MeshQueries(xy, triangulate(xy, options()), options()).nearest_vertex(where));
  ConstraintOptions exact;
  exact.crossing = Crossing::exact;
  const Points cross = {0, 0, 4, 4, 0, 4, 4, 0, 2, 1.9};
  const std::vector<Segment> segments = {{0, 1}, {2, 3}};
  const auto crossed = triangulate_constrained(cross, segments, exact, options());
  Points all(cross);
  all.insert(all.end(), crossed.added_points().begin(), crossed.added_points().end());
  MeshQueries of_crossed(all, crossed.mesh(), options());
  (void)of_crossed.locate(where);
}

TEST_P(ConstrainedQueries, SegmentsThatAreDelaunayEdgesChangeNothing) {
  const Asked set("", uniform_points(300, 4));
  const auto all = edges(set.mesh);
  const ConstrainedTriangulation mesh =
      triangulate_constrained(set.xy, std::vector<Segment>(all.begin(), all.end()), {}, options());
  MeshQueries queries(std::span<const double>(set.xy), mesh, options());
  MeshQueries plain(std::span<const double>(set.xy), set.mesh, options());
  EXPECT_EQ(queries.nearest_vertices(set.queries, 4), plain.nearest_vertices(set.queries, 4));
  EXPECT_EQ(queries.voronoi().cells, plain.voronoi().cells);
}

TEST_P(ConstrainedQueries, CrossingsHaveValuesOfTheirOwn) {
  const Points xy = {0, 0, 2, 2, 0, 2, 2, 0};
  const std::vector<Segment> segments = {{0, 1}, {2, 3}};
  ConstraintOptions how;
  how.crossing = Crossing::exact;
  const auto exact = triangulate_constrained(xy, segments, how, options());
  MeshQueries queries(std::span<const double>(xy), exact, options());
  EXPECT_EQ(queries.number_of_points(), 5U);
  const std::vector<double> heights = {0, 0, 0, 0, 1};
  EXPECT_DOUBLE_EQ(queries.interpolate(heights, Points{1, 0.5}).front(), 0.5);
  EXPECT_THROW((void)queries.interpolate(std::vector<double>(4), Points{1, 1}), InputError);
  EXPECT_THROW(MeshQueries(std::span<const double>(xy).subspan(2), exact, options()), InputError);

  // On a grid points have moved: a corner at (0.1, 0) is at (0, 0).
  const Points near = {0.1, 0, 2, 2, 0, 2, 2, 0};
  how.crossing = Crossing::grid;
  how.grid = 1;
  const auto snapped = triangulate_constrained(near, segments, how, options());
  MeshQueries moved(std::span<const double>(near), snapped, options());
  EXPECT_EQ(moved.number_of_points(), 5U);
  EXPECT_DOUBLE_EQ(moved.interpolate(heights, Points{0.5, 0}).front(), 0);
  EXPECT_GE(moved.locate(Points{0.05, 0.01}).front(), 0);
}

/// Segments almost on one line each, whose crossings are so close to each other that doubles cannot hold their order.
struct Bundle {
  Points xy;
  std::vector<Segment> segments;

  explicit Bundle(std::uint64_t seed) {
    Random random(seed);
    for (std::int32_t i = 0; i < 12; ++i) {
      for (const double side : {-1.0, 1.0}) {
        const double x = 1 + random.uniform();
        xy.insert(xy.end(), {side * x, 1 + std::ldexp(static_cast<double>(random.below(8)), -52)});
      }
      segments.push_back({2 * i, 2 * i + 1});
    }
  }
};

TEST_P(ConstrainedQueries, TrianglesThatAreTurnedOverAreRefused) {
  ConstraintOptions how;
  how.crossing = Crossing::exact;
  std::size_t invalid = 0;
  for (std::uint64_t seed = 1; seed <= 40 && invalid == 0; ++seed) {
    const auto [xy, segments] = Bundle(seed);
    const auto mesh = triangulate_constrained(xy, segments, how, options());
    if (mesh.rounded_valid()) continue;
    ++invalid;
    const auto error = thrown<InvalidMesh>([&] { MeshQueries(std::span<const double>(xy), mesh, options()); });
    ASSERT_NE(error, nullptr);
    EXPECT_EQ(error->check(), "orientation");
    EXPECT_GE(error->first(), 0);
    Points all(xy);
    all.insert(all.end(), mesh.added_points().begin(), mesh.added_points().end());
    EXPECT_NE(thrown<InvalidMesh>([&] { MeshQueries(all, mesh.mesh(), options()); }), nullptr);
  }
  EXPECT_GT(invalid, 0U);
}

CADT_ON_MAIN_BACKENDS(ConstrainedQueries);

class ConstrainedOnDevice : public ResidentTest {};

TEST_P(ConstrainedOnDevice, IsAskedThere) {
  const Ditch ditch;
  Triangulator triangulator(options());
  const DevicePoints points = upload(ditch.xy);
  const std::span<const std::int32_t> words(ditch.banks.front().data(), 2 * ditch.banks.size());
  const DeviceArray banks{memory->upload(words), words.size()};
  const DeviceTriangulation mesh = triangulator.triangulate_constrained(points, banks);
  MeshQueries queries(triangulator, points, mesh);
  const Points where = {0.3, 0.4, 0.6, 0.499};
  const DeviceArray z{memory->upload(std::span<const double>(ditch.z)), ditch.z.size()};
  const std::vector<double> none(2);
  const DeviceArray results{memory->upload(std::span<const double>(none)), 2};
  (void)queries.interpolate(z, upload(where), results);
  const auto found = memory->download<double>(results.memory, 2);
  EXPECT_NEAR(found[0], 0.1, 1e-12);
  EXPECT_NEAR(found[1], 0.001, 1e-12);
  EXPECT_THROW((void)queries.interpolate(z, upload(where), results, Interpolation::nearest), NotDelaunay);
  EXPECT_THROW((void)queries.voronoi(DeviceVoronoi{}), NotDelaunay);
}

TEST_P(ConstrainedOnDevice, CrossingsAreVertices) {
  ConstraintOptions how;
  how.crossing = Crossing::exact;
  Triangulator triangulator(options());
  const auto make = [&](const DevicePoints& points, const std::vector<Segment>& segments) {
    const std::span<const std::int32_t> words(segments.front().data(), 2 * segments.size());
    return triangulator.triangulate_constrained(points, {memory->upload(words), words.size()}, how);
  };
  const Points xy = {0, 0, 2, 2, 0, 2, 2, 0}, where = {1, 0.5};
  const DevicePoints points = upload(xy);
  const DeviceTriangulation mesh = make(points, {{0, 1}, {2, 3}});
  EXPECT_THROW(MeshQueries(triangulator, points, mesh), InputError);
  MeshQueries queries(triangulator, {.x = mesh.all_points(), .size = mesh.number_of_points()}, mesh);
  const std::vector<double> heights = {0, 0, 0, 0, 1}, none(1);
  const DeviceArray z{memory->upload(std::span<const double>(heights)), 5};
  const DeviceArray results{memory->upload(std::span<const double>(none)), 1};
  (void)queries.interpolate(z, upload(where), results);
  EXPECT_DOUBLE_EQ(memory->download<double>(results.memory, 1).front(), 0.5);

  std::size_t invalid = 0;
  for (std::uint64_t seed = 1; seed <= 40 && invalid == 0; ++seed) {
    const Bundle bundle(seed);
    const DeviceTriangulation turned = make(upload(bundle.xy), bundle.segments);
    if (turned.rounded_valid()) continue;
    ++invalid;
    const DevicePoints all{.x = turned.all_points(), .size = turned.number_of_points()};
    const auto error = thrown<InvalidMesh>([&] { MeshQueries(triangulator, all, turned); });
    ASSERT_NE(error, nullptr);
    EXPECT_EQ(error->check(), "orientation");
  }
  EXPECT_GT(invalid, 0U);
}

CADT_ON_MAIN_BACKENDS(ConstrainedOnDevice);

}  // namespace
}  // namespace cadt::test
