// SPDX-License-Identifier: Apache-2.0
#include "tests/support/backends.hpp"
#include "tests/system/queries/brute_force.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace cadt::test {
namespace {

class Voronoi : public BackendTest {
 protected:
  static std::size_t at(std::span<const std::int32_t> list, std::size_t i) { return static_cast<std::size_t>(list[i]); }
};

TEST_P(Voronoi, CellsAreTheTrianglesAroundEachVertex) {
  for_each_set(600, [&](const Asked& set) {
    SCOPED_TRACE(set.name);
    MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
    const VoronoiDiagram diagram = queries.voronoi();
    const std::size_t n = set.xy.size() / 2, triangles = set.mesh.number_of_triangles();
    ASSERT_EQ(diagram.vertices.size(), 2 * triangles);
    ASSERT_EQ(diagram.cell_begin.size(), n + 1);
    ASSERT_EQ(diagram.cells.size(), 3 * triangles);
    std::vector<std::size_t> incident(n, 0);
    for (const std::int32_t v : set.mesh.triangles()) ++incident[static_cast<std::size_t>(v)];
    const std::set<std::int32_t> hull(set.mesh.hull().begin(), set.mesh.hull().end());
    for (std::size_t v = 0; v < n; ++v) {
      const std::size_t size = diagram.cell_begin[v + 1] - diagram.cell_begin[v];
      ASSERT_EQ(size, incident[v]);
      std::set<std::int32_t> different;
      for (std::size_t i = 0; i < size; ++i) {
        const std::size_t t = at(diagram.cells, diagram.cell_begin[v] + i);
        different.insert(diagram.cells[diagram.cell_begin[v] + i]);
        // v is vertex k of t; the next triangle counterclockwise is across the edge from v to the vertex before it
        const auto corners = set.mesh.triangles().subspan(3 * t, 3);
        const auto k =
            static_cast<std::size_t>(std::ranges::find(corners, static_cast<std::int32_t>(v)) - corners.begin());
        ASSERT_LT(k, 3u);
        const std::int32_t next = set.mesh.neighbors()[3 * t + (k + 1) % 3];
        const std::int32_t around =
            hull.contains(static_cast<std::int32_t>(v)) ? -1 : diagram.cells[diagram.cell_begin[v]];
        ASSERT_EQ(next, i + 1 < size ? diagram.cells[diagram.cell_begin[v] + i + 1] : around);
      }
      ASSERT_EQ(different.size(), size);
      if (size != 0 && !hull.contains(static_cast<std::int32_t>(v))) {
        ASSERT_EQ(diagram.cells[diagram.cell_begin[v]], *different.begin()) << "not from the lowest on";
      }
    }
  });
}

TEST_P(Voronoi, EdgesHaveBothGenerators) {
  for_each_set(600, [&](const Asked& set) {
    SCOPED_TRACE(set.name);
    MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
    const VoronoiDiagram diagram = queries.voronoi();
    const std::size_t triangles = set.mesh.number_of_triangles(), edges = diagram.edge_points.size() / 2;
    ASSERT_EQ(diagram.edge_vertices.size(), 2 * edges);
    ASSERT_EQ(2 * edges, triangles == 0 ? 0 : 3 * triangles + set.mesh.hull().size());
    std::set<std::array<std::int32_t, 2>> different;
    for (std::size_t e = 0; e < edges; ++e) {
      const std::int32_t u = diagram.edge_points[2 * e], v = diagram.edge_points[2 * e + 1];
      ASSERT_TRUE(different.insert({std::min(u, v), std::max(u, v)}).second);
      const std::size_t t = at(diagram.edge_vertices, 2 * e);
      const auto corners = set.mesh.triangles().subspan(3 * t, 3);
      const auto k = static_cast<std::size_t>(std::ranges::find(corners, u) - corners.begin());
      ASSERT_LT(k, 3u);
      ASSERT_EQ(corners[(k + 1) % 3], v) << "the first triangle is not on the left";
      ASSERT_EQ(set.mesh.neighbors()[3 * t + (k + 2) % 3], diagram.edge_vertices[2 * e + 1]);
    }
  });
}

TEST_P(Voronoi, CircumcentresAreAsFarFromAllThree) {
  const Asked set("", uniform_points(1200, 77));
  MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
  const auto centers = queries.circumcenters();
  ASSERT_EQ(centers.size(), 2 * set.mesh.number_of_triangles());
  for (std::size_t t = 0; t < set.mesh.number_of_triangles(); ++t) {
    double distance[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t v = at(set.mesh.triangles(), 3 * t + k);
      distance[k] = std::hypot(centers[2 * t] - set.xy[2 * v], centers[2 * t + 1] - set.xy[2 * v + 1]);
    }
    ASSERT_NEAR(distance[1], distance[0], 1e-9 * (1 + distance[0] * distance[0])) << t;
    ASSERT_NEAR(distance[2], distance[0], 1e-9 * (1 + distance[0] * distance[0])) << t;
  }
}

TEST_P(Voronoi, AreasOfClippedCellsSumToTheBox) {
  std::size_t sets = 0;
  for_each_set(1500, [&](const Asked& set) {
    double low[2] = {set.xy[0], set.xy[1]}, high[2] = {set.xy[0], set.xy[1]};
    for (std::size_t i = 0; i < set.xy.size(); ++i) {
      low[i % 2] = std::min(low[i % 2], set.xy[i]);
      high[i % 2] = std::max(high[i % 2], set.xy[i]);
    }
    const double width = high[0] - low[0], height = high[1] - low[1];
    const double largest = std::max({std::abs(low[0]), std::abs(low[1]), std::abs(high[0]), std::abs(high[1])});
    // Corners of cells are doubles: where the points are a few units in the last place apart, so are the corners.
    if (set.mesh.number_of_triangles() == 0 || !narrow(set) || std::min(width, height) < 1e-5 * largest) return;
    SCOPED_TRACE(set.name);
    ++sets;
    MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
    for (const double margin : {0.3, -0.2}) {
      const Box box{low[0] - margin * width, low[1] - margin * height, high[0] + margin * width,
                    high[1] + margin * height};
      const VoronoiPolygons cells = queries.voronoi_polygons(box);
      ASSERT_EQ(cells.begin.size(), set.xy.size() / 2 + 1);
      ASSERT_EQ(cells.begin.back() * std::size_t{2}, cells.xy.size());
      double area = 0;
      for (std::size_t p = 0; p + 1 < cells.begin.size(); ++p) {
        double twice = 0;
        for (std::size_t i = cells.begin[p]; i < cells.begin[p + 1]; ++i) {
          const std::size_t j = i + 1 < cells.begin[p + 1] ? i + 1 : cells.begin[p];
          const double ax = cells.xy[2 * i] - box.min_x, ay = cells.xy[2 * i + 1] - box.min_y;
          const double bx = cells.xy[2 * j] - box.min_x, by = cells.xy[2 * j + 1] - box.min_y;
          twice += ax * by - ay * bx;
          ASSERT_GE(ax, -1e-9 * width);
          ASSERT_LE(ax, (1 + 1e-9) * (box.max_x - box.min_x));
        }
        ASSERT_GE(twice, -1e-9 * width * height) << "clockwise: " << p;
        area += 0.5 * twice;
      }
      const double whole = (box.max_x - box.min_x) * (box.max_y - box.min_y);
      ASSERT_NEAR(area, whole, 1e-9 * whole) << "margin " << margin;
    }
  });
  EXPECT_GT(sets, 20u);
}

TEST_P(Voronoi, LargestEmptyCirclesAreEmptyAndTheLargest) {
  const Asked set("", uniform_points(900, 6));
  MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
  const auto centers = queries.circumcenters();
  const auto inside = queries.locate(centers);
  std::vector<double> radii;
  for (std::size_t t = 0; t < set.mesh.number_of_triangles(); ++t) {
    const std::size_t v = at(set.mesh.triangles(), 3 * t);
    if (inside[t] >= 0)
      radii.push_back(std::hypot(centers[2 * t] - set.xy[2 * v], centers[2 * t + 1] - set.xy[2 * v + 1]));
  }
  std::ranges::sort(radii, std::greater<>());
  for (const std::size_t k : {std::size_t{1}, std::size_t{10}, radii.size(), radii.size() + 5,
                              (std::size_t{1} << 63) - 128, ~std::size_t{0}}) {
    const auto circles = queries.largest_empty_circles(k);
    ASSERT_EQ(circles.size(), std::min(k, radii.size()));
    for (std::size_t i = 0; i < circles.size(); ++i) {
      ASSERT_NEAR(circles[i].radius, radii[i], 1e-12);
      if (i > 10) continue;
      for (std::size_t p = 0; p < set.xy.size(); p += 2)
        ASSERT_GE(std::hypot(set.xy[p] - circles[i].x, set.xy[p + 1] - circles[i].y), circles[i].radius * (1 - 1e-12));
    }
  }
}

TEST_P(Voronoi, OutlineKeepsSmallTriangles) {
  const Asked set("", uniform_points(900, 12));
  MeshQueries queries(std::span<const double>(set.xy), set.mesh, GetParam().options());
  const auto t = set.mesh.triangles();
  const auto length = [&](std::size_t i, std::size_t j) {
    return std::hypot(set.xy[2 * at(t, i)] - set.xy[2 * at(t, j)], set.xy[2 * at(t, i) + 1] - set.xy[2 * at(t, j) + 1]);
  };
  constexpr double max_radius = 0.03, max_edge = 0.05;
  const Outline outline = queries.outline(max_radius, max_edge);
  std::vector<std::int32_t> expected;
  std::multiset<std::array<std::int32_t, 2>> sides;
  for (std::size_t i = 0; i < t.size(); i += 3) {
    const double a = length(i + 1, i + 2), b = length(i + 2, i), c = length(i, i + 1), s = (a + b + c) / 2;
    const double radius = a * b * c / (4 * std::sqrt(s * (s - a) * (s - b) * (s - c)));
    ASSERT_GT(std::abs(radius - max_radius), 1e-12);
    if (radius > max_radius || std::max({a, b, c}) > max_edge) continue;
    expected.push_back(static_cast<std::int32_t>(i / 3));
    for (std::size_t k = 0; k < 3; ++k) sides.insert({t[i + k], t[i + (k + 1) % 3]});
  }
  EXPECT_EQ(outline.triangles, expected);
  EXPECT_GT(expected.size(), 200u);
  EXPECT_LT(expected.size(), t.size() / 3 - 200);
  std::set<std::array<std::int32_t, 2>> boundary, found;
  for (const auto& side : sides)
    if (!sides.contains({side[1], side[0]})) boundary.insert(side);
  for (std::size_t i = 0; i < outline.edges.size(); i += 2) found.insert({outline.edges[i], outline.edges[i + 1]});
  EXPECT_EQ(found, boundary);
  EXPECT_EQ(2 * found.size(), outline.edges.size());
  const double all = std::numeric_limits<double>::infinity();
  EXPECT_EQ(queries.outline(all, all).triangles.size(), t.size() / 3);
  EXPECT_TRUE(queries.outline(0, all).triangles.empty());
}

CADT_ON_MAIN_BACKENDS(Voronoi);

}  // namespace
}  // namespace cadt::test
