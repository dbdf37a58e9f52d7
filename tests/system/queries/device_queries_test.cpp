// SPDX-License-Identifier: Apache-2.0
// Queries, values and results in device memory, against those of the host.
#include "tests/system/queries/brute_force.hpp"
#include "tests/system/resident/resident.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace cadt::test {
namespace {

class DeviceQueries : public ResidentTest {
 protected:
  static constexpr std::int32_t untouched = 123456789;
  static bool same(const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
      if (!(a[i] == b[i] || (std::isnan(a[i]) && std::isnan(b[i])))) return false;
    return a.size() == b.size();
  }
  template <class T>
  [[nodiscard]] DeviceArray array(std::size_t size, T value = static_cast<T>(untouched)) const {
    return {memory->upload(std::span<const T>(std::vector<T>(size + 1, value))), size};
  }
};

TEST_P(DeviceQueries, EqualThoseOfTheHost) {
  const Asked set("", uniform_points(1000, 3));
  std::vector<double> values(1000);
  Random random(9);
  for (double& value : values) value = random.normal();
  Triangulator triangulator(options());
  const Points queries = near_queries(set);  // natural neighbours take no far ones
  const DevicePoints points = upload(set.xy), where = upload(queries);
  const DeviceTriangulation mesh = triangulator.triangulate(points);
  MeshQueries resident(triangulator, points, mesh);
  MeshQueries host(std::span<const double>(set.xy), set.mesh, GetParam().options());
  const std::size_t n = where.size;

  const DeviceArray triangles = array<std::int32_t>(n), weights = array<double>(3 * n),
                    vertices = array<std::int32_t>(4 * n);
  EXPECT_EQ(resident.locate_barycentric(where, triangles, weights), n);
  EXPECT_EQ(memory->download<std::int32_t>(triangles.memory, n), host.locate(queries));
  EXPECT_EQ(memory->download<std::int32_t>(triangles.memory, n + 1).back(), untouched);
  EXPECT_TRUE(same(memory->download<double>(weights.memory, 3 * n), host.locate_barycentric(queries).barycentric));
  EXPECT_EQ(resident.nearest_vertices(where, 4, vertices), 4 * n);
  EXPECT_EQ(memory->download<std::int32_t>(vertices.memory, 4 * n), host.nearest_vertices(queries, 4));

  const DeviceArray on_device{memory->upload(std::span<const double>(values)), values.size()};
  const Grid grid{-0.1, -0.1, 0.02, 0.03, 60, 40};
  for (const Interpolation method : {Interpolation::linear, Interpolation::nearest, Interpolation::natural}) {
    const DeviceArray results = array<double>(n), cells = array<double>(grid.cells());
    EXPECT_EQ(resident.interpolate(on_device, where, results, method), n);
    EXPECT_TRUE(same(memory->download<double>(results.memory, n), host.interpolate(values, queries, method)));
    EXPECT_EQ(resident.rasterize(grid, on_device, cells, method), grid.cells());
    EXPECT_TRUE(same(memory->download<double>(cells.memory, grid.cells()), host.rasterize(grid, values, method)));
    EXPECT_EQ(memory->download<double>(cells.memory, grid.cells() + 1).back(), double{untouched});
  }
  const DeviceArray centers = array<double>(2 * mesh.number_of_triangles());
  EXPECT_EQ(resident.circumcenters(centers), 2 * mesh.number_of_triangles());
  EXPECT_TRUE(same(memory->download<double>(centers.memory, centers.size), host.circumcenters()));

  const VoronoiDiagram expected = host.voronoi();
  const std::size_t edges = expected.edge_points.size() / 2;
  const DeviceVoronoi diagram{array<double>(expected.vertices.size()), array<std::uint32_t>(1001),
                              array<std::int32_t>(expected.cells.size()), array<std::int32_t>(2 * edges),
                              array<std::int32_t>(2 * edges)};
  EXPECT_EQ(resident.voronoi(diagram), edges);
  EXPECT_TRUE(same(memory->download<double>(diagram.vertices.memory, expected.vertices.size()), expected.vertices));
  EXPECT_EQ(memory->download<std::uint32_t>(diagram.cell_begin.memory, 1001), expected.cell_begin);
  EXPECT_EQ(memory->download<std::int32_t>(diagram.cells.memory, expected.cells.size()), expected.cells);
  EXPECT_EQ(memory->download<std::int32_t>(diagram.edge_points.memory, 2 * edges), expected.edge_points);
  EXPECT_EQ(memory->download<std::int32_t>(diagram.edge_vertices.memory, 2 * edges), expected.edge_vertices);
  // each alone
  EXPECT_EQ(resident.voronoi({{}, {}, {}, array<std::int32_t>(2 * edges), {}}), edges);
  EXPECT_EQ(resident.voronoi({{}, array<std::uint32_t>(1001), {}, {}, {}}), 0u);
  EXPECT_EQ(resident.voronoi(DeviceVoronoi{}), 0u);
}

TEST_P(DeviceQueries, WhatIsTooSmallStaysAsItIs) {
  const Asked set("", uniform_points(300, 3));
  Triangulator triangulator(options());
  const DevicePoints points = upload(set.xy), where = upload(set.queries);
  const DeviceTriangulation mesh = triangulator.triangulate(points);
  MeshQueries resident(triangulator, points, mesh);
  const std::size_t n = set.size();
  const DeviceArray small = array<std::int32_t>(n - 1), one_less = array<double>(3 * n - 1);
  const auto refused = [&](const auto& call) {
    const auto error = thrown<InputError>(call);
    ASSERT_NE(error, nullptr);
    EXPECT_NE(std::string(error->what()).find("are needed"), std::string::npos) << error->what();
  };
  refused([&] { (void)resident.locate(where, small); });
  refused([&] { (void)resident.locate_barycentric(where, array<std::int32_t>(n), one_less); });
  refused([&] { (void)resident.nearest_vertices(where, 2, array<std::int32_t>(2 * n - 1)); });
  refused([&] { (void)resident.circumcenters(array<double>(2 * mesh.number_of_triangles() - 1)); });
  refused([&] { (void)resident.voronoi({array<double>(2 * mesh.number_of_triangles() - 1), {}, {}, {}, {}}); });
  refused([&] { (void)resident.voronoi({{}, {}, array<std::int32_t>(3 * mesh.number_of_triangles()), {}, {}}); });
  refused([&] { (void)resident.voronoi({{}, {}, {}, {}, array<std::int32_t>(100)}); });
  EXPECT_EQ(memory->download<std::int32_t>(small.memory, n), std::vector<std::int32_t>(n, untouched));
  EXPECT_THROW((void)resident.locate(where, {nullptr, n}), InputError);
  EXPECT_THROW((void)resident.interpolate(array<double>(299), where, array<double>(n)), InputError);
  EXPECT_THROW((void)resident.rasterize({0, 0, 1, 1, 3, 3}, array<double>(300), array<double>(8)), InputError);
  // and then it works
  EXPECT_EQ(resident.locate(where, array<std::int32_t>(n)), n);
}

TEST_P(DeviceQueries, AnotherMeshIsRefused) {
  const Points xy = uniform_points(200, 1);
  Triangulator one(options()), other(options());
  const DevicePoints points = upload(xy);
  const DeviceTriangulation mesh = one.triangulate(points);
  EXPECT_THROW(MeshQueries(other, points, mesh), InputError);
  DevicePoints fewer = points;
  fewer.size = 199;
  EXPECT_THROW(MeshQueries(one, fewer, mesh), InputError);
}

TEST_P(DeviceQueries, TheMeshGoesWhereItIsWanted) {
  const Asked set("", uniform_points(500, 13));
  Triangulator triangulator(options());
  const DevicePoints points = upload(set.xy);
  const std::size_t m = set.mesh.number_of_triangles();
  const std::vector<std::int32_t> expected(set.mesh.triangles().begin(), set.mesh.triangles().end()),
      across(set.mesh.neighbors().begin(), set.mesh.neighbors().end());
  const DeviceArray triangles = array<std::int32_t>(3000), neighbors = array<std::int32_t>(3 * m);
  EXPECT_EQ(triangulator.triangulate(points, triangles, neighbors), m);
  EXPECT_EQ(memory->download<std::int32_t>(triangles.memory, 3 * m), expected);
  EXPECT_EQ(memory->download<std::int32_t>(triangles.memory, 3 * m + 1).back(), untouched);
  EXPECT_EQ(memory->download<std::int32_t>(neighbors.memory, 3 * m), across);
  EXPECT_EQ(memory->download<std::int32_t>(neighbors.memory, 3 * m + 1).back(), untouched);
  EXPECT_EQ(triangulator.triangulate(points, array<std::int32_t>(3 * m), {}), m);

  std::vector<std::int32_t> to(3000, untouched), beside(3 * m, untouched);
  EXPECT_EQ(triangulator.triangulate(std::span<const double>(set.xy), to, beside), m);
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), to.begin()));
  EXPECT_EQ(to[3 * m], untouched);
  EXPECT_EQ(beside, across);

  // too small, in either place: nothing is written
  const DeviceArray small = array<std::int32_t>(3 * m - 1);
  std::ranges::fill(to, untouched);
  beside.resize(3 * m - 1);
  const auto refused = [&](const auto& call) {
    const auto error = thrown<InputError>(call);
    ASSERT_NE(error, nullptr);
    EXPECT_EQ(error->index(), m - 1);
  };
  refused([&] { (void)triangulator.triangulate(points, small, {}); });
  refused([&] { (void)triangulator.triangulate(points, triangles, small); });
  refused([&] { (void)triangulator.triangulate(std::span<const double>(set.xy), to, beside); });
  EXPECT_EQ(memory->download<std::int32_t>(small.memory, 3 * m), std::vector<std::int32_t>(3 * m, untouched));
  EXPECT_EQ(to, std::vector<std::int32_t>(3000, untouched));
  EXPECT_THROW((void)triangulator.triangulate(points, {nullptr, 3000}, {}), InputError);
  EXPECT_EQ(triangulator.triangulate(DevicePoints{.x = points.x, .size = 2}, triangles, {}), 0u);
}

TEST_P(DeviceQueries, AMeshThatKeepsItsPointsNeedsNothingElse) {
  std::optional<MeshQueries> queries;
  const Points where = {0.5, 0.5, 0.1, 0.9};
  std::vector<std::int32_t> expected;
  {
    const Points xy = uniform_points(400, 8);
    Options keeping = GetParam().options();
    EXPECT_THROW(MeshQueries(triangulate(std::span<const double>(xy), keeping), keeping), InputError);
    keeping.keep_points = KeepPoints::copy;
    const Triangulation mesh = triangulate(std::span<const double>(xy), keeping);
    queries.emplace(mesh, keeping);
    expected = MeshQueries(std::span<const double>(xy), mesh, keeping).locate(where);
  }
  EXPECT_EQ(queries->locate(where), expected);
}

CADT_ON_MAIN_BACKENDS(DeviceQueries);

}  // namespace
}  // namespace cadt::test
