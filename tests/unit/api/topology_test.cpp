// SPDX-License-Identifier: Apache-2.0
// Edges, stars and half-edges, against what the triangles alone say.
#include "tests/unit/api/meshes.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace cadt::test {
namespace {

using Edge = std::array<std::int32_t, 2>;

/// Directed edges and the triangle on the left of each.
std::map<Edge, std::int32_t> left_triangles(const Triangulation& mesh) {
  std::map<Edge, std::int32_t> left;
  for (std::size_t t = 0; t < mesh.number_of_triangles(); ++t) {
    const auto [a, b, c] = mesh.triangle(t);
    for (const Edge edge : {Edge{a, b}, Edge{b, c}, Edge{c, a}})
      EXPECT_TRUE(left.emplace(edge, static_cast<std::int32_t>(t)).second);
  }
  return left;
}

TEST(Topology, EdgesAreThoseOfTheTriangles) {
  for_each_mesh([](const Points&, const Triangulation& mesh) {
    std::set<Edge> expected;
    for (std::size_t t = 0; t < mesh.number_of_triangles(); ++t) {
      const auto v = mesh.triangle(t);
      for (std::size_t k = 0; k < 3; ++k)
        expected.insert({std::min(v[k], v[(k + 1) % 3]), std::max(v[k], v[(k + 1) % 3])});
    }
    const auto found = edges(mesh);
    EXPECT_TRUE(std::ranges::equal(found, expected));
    EXPECT_EQ(found.empty(), mesh.dimension() < 2);
    if (found.empty()) return;
    const std::size_t vertices = mesh.number_of_points() - mesh.duplicates().size();
    EXPECT_EQ(found.size(), 3 * vertices - 3 - mesh.hull().size());
    EXPECT_EQ(vertices + mesh.number_of_triangles(), found.size() + 1);  // Euler
  });
}

TEST(Topology, StarsAreCounterclockwiseAndComplete) {
  for_each_mesh([](const Points&, const Triangulation& mesh) {
    const auto left = left_triangles(mesh);
    const CompressedRows neighbors = vertex_neighbors(mesh), triangles = incident_triangles(mesh);
    ASSERT_EQ(neighbors.indptr.size(), mesh.number_of_points() + 1);
    ASSERT_EQ(triangles.indptr.size(), mesh.number_of_points() + 1);
    EXPECT_EQ(neighbors.indices.size(), 2 * edges(mesh).size());
    EXPECT_EQ(triangles.indices.size(), 3 * mesh.number_of_triangles());
    std::map<std::int32_t, std::int32_t> after_on_hull;
    for (std::size_t i = 0; i < mesh.hull().size(); ++i)
      after_on_hull[mesh.hull()[i]] = mesh.hull()[(i + 1) % mesh.hull().size()];
    for (std::size_t p = 0; p < mesh.number_of_points(); ++p) {
      const auto v = static_cast<std::int32_t>(p);
      const auto around = neighbors[p], at = triangles[p];
      EXPECT_EQ(std::set(around.begin(), around.end()).size(), around.size()) << p;
      if (around.empty()) {
        EXPECT_TRUE(at.empty());
        EXPECT_TRUE(mesh.dimension() < 2 || mesh.duplicate_of(p) >= 0) << p;
        continue;
      }
      const auto hull = after_on_hull.find(v);
      const bool inner = hull == after_on_hull.end();
      ASSERT_EQ(around.size(), at.size() + (inner ? 0 : 1)) << p;
      EXPECT_EQ(around.front(), inner ? *std::ranges::min_element(around) : hull->second) << p;
      for (std::size_t i = 0; i < at.size(); ++i) {
        ASSERT_EQ(left.at({v, around[i]}), at[i]) << p;
        ASSERT_EQ(left.at({around[(i + 1) % around.size()], v}), at[i]) << p;
      }
      if (!inner) {
        EXPECT_EQ(left.count({v, around.back()}), 0u) << p;
      }
    }
  });
}

TEST(Topology, HalfEdgesArePairs) {
  for_each_mesh([](const Points&, const Triangulation& mesh) {
    const auto left = left_triangles(mesh);
    const auto twins = half_edges(mesh);
    const auto v = mesh.triangles();
    const auto end = [&](std::size_t e) { return v[e % 3 == 2 ? e - 2 : e + 1]; };
    ASSERT_EQ(twins.size(), v.size());
    std::size_t outside = 0;
    for (std::size_t e = 0; e < twins.size(); ++e) {
      if (twins[e] < 0) {
        ++outside;
        EXPECT_EQ(left.count({end(e), v[e]}), 0u);
        continue;
      }
      const auto twin = static_cast<std::size_t>(twins[e]);
      ASSERT_LT(twin, twins.size());
      EXPECT_EQ(twins[twin], static_cast<std::int64_t>(e));
      EXPECT_EQ(v[twin], end(e));
      EXPECT_EQ(end(twin), v[e]);
    }
    EXPECT_EQ(outside, mesh.hull().size());
  });
}

TEST(Topology, DoesNotDependOnTheOrderOfTriangles) {
  const Points xy = uniform_points(3000);
  const Triangulation mesh = triangulate(xy, one_thread());
  std::vector<std::int32_t> turned(mesh.triangles().begin(), mesh.triangles().end());
  std::reverse(turned.begin(), turned.end());  // another order, and clockwise
  for (std::size_t i = 0; i < turned.size(); i += 3) std::swap(turned[i], turned[i + 1]);
  const Triangulation other = Triangulation::adopt(xy, turned);
  ASSERT_NE(other.triangle(0), mesh.triangle(0));
  EXPECT_EQ(edges(other), edges(mesh));
  EXPECT_EQ(vertex_neighbors(other).indices, vertex_neighbors(mesh).indices);
  EXPECT_EQ(other.hash(), mesh.hash());
}

}  // namespace
}  // namespace cadt::test
