// SPDX-License-Identifier: Apache-2.0
// Each mistake in a mesh of nodes is found by the check that is for it.
#include "tests/unit/tiles/tiles_support.hpp"
#include "tiles/verify_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <new>

namespace cadt::tiles {
namespace {

/// A mesh in nodes whose links are as they are.
class TamperedMesh : public NodeMesh {
 public:
  TamperedMesh(const CollectedMesh& mesh) : tree_(mesh.tree()) {  // NOLINT: implicit
    for (std::uint32_t i = 0; i < tree_.size(); ++i) {
      const NodeArrays n = mesh.node(i);
      nodes.push_back({.xy = {n.xy.begin(), n.xy.end()},
                       .ids = {n.ids.begin(), n.ids.end()},
                       .triangles = {n.triangles.begin(), n.triangles.end()},
                       .neighbors = {n.neighbors.begin(), n.neighbors.end()},
                       .links = {n.links.begin(), n.links.end()},
                       .duplicates = {n.duplicates.begin(), n.duplicates.end()}});
    }
  }
  [[nodiscard]] const TileTree& tree() const noexcept override { return tree_; }
  [[nodiscard]] std::uint64_t first_id() const noexcept override { return 0; }
  [[nodiscard]] NodeArrays node(std::uint32_t i) const override {
    const Node& n = nodes[i];
    return {.xy = n.xy,
            .ids = n.ids,
            .triangles = n.triangles,
            .neighbors = n.neighbors,
            .links = n.links,
            .duplicates = n.duplicates,
            .owner = {}};
  }
  struct Node {
    std::vector<double> xy;
    std::vector<std::uint64_t> ids;
    std::vector<std::int32_t> triangles, neighbors;
    std::vector<TriangleId> links;
    std::vector<DuplicateId> duplicates;
  };
  std::vector<Node> nodes;

 private:
  TileTree tree_;
};

TamperedMesh mesh_of(const std::vector<double>& xy, std::uint64_t tile_points) {
  Nodes nodes = nodes_of(xy, tile_points);
  return CollectedMesh(nodes.plan.tree, std::move(nodes.nodes));
}

/// The checks that fail, separated by blanks.
std::string failed(const NodeMesh& mesh) {
  std::string names;
  for (const Check& check : verify(mesh).checks)
    if (!check.passed) names += (names.empty() ? "" : " ") + check.name;
  return names;
}

bool fails(const NodeMesh& mesh, const char* check) {
  return (" " + failed(mesh) + " ").find(std::string(" ") + check + " ") != std::string::npos;
}

class VerifyTiles : public testing::Test {
 protected:
  std::vector<double> xy_ = points_of("uniform", 400);
  TamperedMesh mesh_ = mesh_of(xy_, 60);
  TamperedMesh::Node& leaf_ = mesh_.nodes[0];
  TamperedMesh::Node& root_ = mesh_.nodes.back();
};

struct Nothing {
  void merge(const Nothing& /*other*/) {}
};

TEST(ReduceTiles, FailuresOfHelpers) {
  // Two blocks: neither thread gets through both of them.
  const auto fail = [](std::size_t /*i*/, Nothing& /*mine*/) { throw std::bad_alloc(); };
  EXPECT_THROW((void)verification::reduce<Nothing>(std::size_t{1} << 15, 2, fail), std::bad_alloc);
}

TEST_F(VerifyTiles, PassesWhatIsRight) {
  EXPECT_EQ(failed(mesh_), "");
  const VerifyReport report = verify(mesh_);
  EXPECT_EQ(report.edges_examined, (3 * report.triangles_examined - report.hull_vertices) / 2) << "all inner edges";
  for (const char* name : {"grid", "duplicates", "collinear", "concentric", "parabola"})
    EXPECT_EQ(failed(mesh_of(points_of(name, 300), 40)), "") << name;
  EXPECT_EQ(failed(mesh_of({}, 3)), "");
}

TEST_F(VerifyTiles, VertexOutOfRange) {
  root_.triangles[4] = static_cast<std::int32_t>(root_.ids.size());
  EXPECT_TRUE(fails(mesh_, "range"));
  root_.triangles[4] = -1;
  EXPECT_TRUE(fails(mesh_, "range"));
  root_.triangles[4] = root_.triangles[3];
  EXPECT_TRUE(fails(mesh_, "range"));
}

TEST_F(VerifyTiles, Orientation) {
  std::swap(leaf_.triangles[0], leaf_.triangles[1]);
  std::swap(leaf_.neighbors[0], leaf_.neighbors[1]);
  EXPECT_TRUE(fails(mesh_, "orientation"));
}

TEST_F(VerifyTiles, NeighbourWithinANode) {
  const auto inner =
      std::find_if(leaf_.neighbors.begin(), leaf_.neighbors.end(), [](std::int32_t n) { return n >= 0; });
  *inner = *inner == 0 ? 1 : 0;
  EXPECT_TRUE(fails(mesh_, "neighbors"));
}

TEST_F(VerifyTiles, SwappedLinks) {
  ASSERT_GE(leaf_.links.size(), 2U);
  std::swap(leaf_.links[0], leaf_.links[1]);
  EXPECT_TRUE(fails(mesh_, "neighbors"));
}

TEST_F(VerifyTiles, LinkToNowhere) {
  for (const TriangleId wrong : {pending_triangle, triangle_id(9999, 0), triangle_id(0, 1 << 20), outside_hull}) {
    TamperedMesh mesh = mesh_;
    *std::find_if(mesh.nodes[0].links.begin(), mesh.nodes[0].links.end(),
                  [](TriangleId id) { return id != outside_hull; }) = wrong;
    EXPECT_TRUE(fails(mesh, "neighbors")) << wrong;
  }
}

TEST_F(VerifyTiles, RowThatNoEdgeHas) {
  leaf_.links.push_back(leaf_.links.front());
  EXPECT_TRUE(fails(mesh_, "neighbors"));
}

TEST_F(VerifyTiles, DroppedTriangleOfTheRoot) {
  root_.triangles.resize(root_.triangles.size() - 3);
  root_.neighbors.resize(root_.neighbors.size() - 3);
  EXPECT_TRUE(fails(mesh_, "neighbors"));
  EXPECT_TRUE(fails(mesh_, "euler"));
}

/// Turns the edge between triangle t and its neighbour across corner k within a node, if both triangles stay
/// counterclockwise.
bool flip(TamperedMesh& mesh, TamperedMesh::Node& node, std::size_t t, std::size_t k) {
  const std::int32_t other = node.neighbors[3 * t + k];
  if (other < 0) return false;
  const auto u = static_cast<std::size_t>(other);
  std::size_t m = 0;
  while (node.neighbors[3 * u + m] != static_cast<std::int32_t>(t)) ++m;
  const auto v = [&](std::size_t i, std::size_t c) -> std::int32_t& { return node.triangles[3 * i + c % 3]; };
  const auto n = [&](std::size_t i, std::size_t c) -> std::int32_t& { return node.neighbors[3 * i + c % 3]; };
  const std::int32_t a = v(t, k), b = v(t, k + 1), c = v(t, k + 2), d = v(u, m);
  const auto at = [&](std::int32_t p) {
    return std::array{node.xy[2 * static_cast<std::size_t>(p)], node.xy[2 * static_cast<std::size_t>(p) + 1]};
  };
  if (exact_orientation(at(a), at(b), at(d)) <= 0 || exact_orientation(at(a), at(d), at(c)) <= 0) return false;
  const std::int32_t ab = n(t, k + 2), ca = n(t, k + 1), bd = n(u, m + 1), dc = n(u, m + 2);
  const std::array<std::int32_t, 6> corners{a, b, d, a, d, c};
  const std::array<std::int32_t, 6> across{bd, other, ab, dc, ca, static_cast<std::int32_t>(t)};
  for (std::size_t i = 0; i < 3; ++i) {
    v(t, i) = corners[i], n(t, i) = across[i];
    v(u, i) = corners[3 + i], n(u, i) = across[3 + i];
  }
  const auto index = static_cast<std::uint32_t>(&node - mesh.nodes.data());
  const auto redirect = [&](std::int32_t neighbor, std::size_t from, std::size_t to) {
    if (neighbor >= 0) {
      for (std::size_t i = 0; i < 3; ++i)
        if (n(static_cast<std::size_t>(neighbor), i) == static_cast<std::int32_t>(from))
          n(static_cast<std::size_t>(neighbor), i) = static_cast<std::int32_t>(to);
    } else if (neighbor != -1) {
      const TriangleId id = node.links[static_cast<std::size_t>(-2 - neighbor)];
      for (TriangleId& link : mesh.nodes[node_of(id)].links)
        if (link == triangle_id(index, from)) link = triangle_id(index, to);
    }
  };
  redirect(bd, u, t);
  redirect(ca, t, u);
  return true;
}

TEST_F(VerifyTiles, IllegalEdge) {
  bool flipped = false;
  for (std::size_t e = 0; e < leaf_.neighbors.size() && !flipped; ++e) flipped = flip(mesh_, leaf_, e / 3, e % 3);
  ASSERT_TRUE(flipped);
  EXPECT_EQ(failed(mesh_), "delaunay") << "all else is right";
}

TEST_F(VerifyTiles, TieThatIsDecidedInAnotherWay) {
  TamperedMesh mesh = mesh_of(points_of("grid", 400), 60);
  std::string outcome;
  for (std::uint32_t i = 0; i < mesh.nodes.size() && outcome != "ties"; ++i) {
    for (std::size_t e = 0; e < mesh.nodes[i].neighbors.size() && outcome != "ties"; ++e) {
      TamperedMesh changed = mesh;
      if (flip(changed, changed.nodes[i], e / 3, e % 3)) outcome = failed(changed);
    }
  }
  EXPECT_EQ(outcome, "ties");
}

TEST_F(VerifyTiles, Points) {
  const auto check = [&](const std::function<void(TamperedMesh&)>& change) {
    TamperedMesh mesh = mesh_;
    change(mesh);
    EXPECT_TRUE(fails(mesh, "vertices")) << failed(mesh);
  };
  check([](TamperedMesh& m) { m.nodes[0].ids[1] = m.nodes[0].ids[0]; });
  check([](TamperedMesh& m) { m.nodes[0].ids.back() = 400; });
  check([](TamperedMesh& m) { m.nodes[0].xy[0] = 1e9; });
  check([](TamperedMesh& m) { m.nodes[0].ids.pop_back(), m.nodes[0].xy.resize(2 * m.nodes[0].ids.size()); });
  check([](TamperedMesh& m) { m.nodes[0].duplicates.push_back({m.nodes[0].ids[3], m.nodes[0].ids[1]}); });
  check([](TamperedMesh& m) { m.nodes.back().ids[0] += 1; });
  check([](TamperedMesh& m) { m.nodes.back().xy[1] = std::nextafter(m.nodes.back().xy[1], 9.0); });
}

TEST_F(VerifyTiles, Duplicates) {
  const TamperedMesh right = mesh_of(points_of("duplicates", 300), 50);
  std::uint32_t i = 0;
  while (right.nodes[i].duplicates.empty()) ++i;
  TamperedMesh mesh = right;
  mesh.nodes[i].duplicates.erase(mesh.nodes[i].duplicates.begin());
  EXPECT_TRUE(fails(mesh, "vertices"));
  mesh = right;
  mesh.nodes[i].duplicates[0].representative += 1;
  EXPECT_TRUE(fails(mesh, "vertices"));
}

TEST_F(VerifyTiles, MeshWithoutTriangles) {
  for (TamperedMesh::Node& node : mesh_.nodes) node.triangles.clear(), node.neighbors.clear(), node.links.clear();
  EXPECT_TRUE(fails(mesh_, "vertices")) << "the points are on no line";
}

}  // namespace
}  // namespace cadt::tiles
