// SPDX-License-Identifier: Apache-2.0
// One mesh of all nodes, in the order of Order::canonical.
#include "tiles/mesh_directory.hpp"

#include <cadt/errors.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace cadt::tiles {
namespace {

/// Its first vertex is the smallest, as in a node: ids ascend with the numbers of the node's points.
struct Triangle {
  std::array<std::int32_t, 3> vertices, neighbors;
  std::int32_t number;  // before sorting
};

[[noreturn]] void contradiction(const std::string& what) {
  throw InvalidMesh("neighbors", -1, what + "; see: cadt verify");
}

class Merge {
 public:
  explicit Merge(const NodeMesh& mesh) : mesh_(mesh), tree_(mesh.tree()) {
    std::uint64_t base = 0;
    for (std::uint32_t i = 0; i < tree_.size(); ++i) {
      base_.push_back(base);
      base += mesh_.node(i).number_of_triangles();
    }
    base_.push_back(base);
    const std::uint64_t points = tree_.number_of_points();
    if (points > max_points()) {
      throw LimitError("one mesh of " + std::to_string(points) + " points and " + std::to_string(base) +
                           " triangles does not fit 32-bit indices: leave it in tiles",
                       static_cast<std::size_t>(points), max_points());
    }
    if (base > 2 * points) contradiction("it has more than two triangles a point");
  }

  MergedMesh operator()() {
    merged_.xy.resize(2 * tree_.number_of_points());
    triangles_.reserve(base_.back());
    for (std::uint32_t i = 0; i < tree_.size(); ++i) add_node(i);
    std::sort(merged_.duplicates.begin(), merged_.duplicates.end(),
              [](const Duplicate& a, const Duplicate& b) { return a.point < b.point; });
    sort_triangles();
    walk_hull();
    return std::move(merged_);
  }

 private:
  [[nodiscard]] std::int32_t index(std::uint64_t id) const {
    id -= mesh_.first_id();
    if (id >= tree_.number_of_points()) contradiction("an index is not one of the input");
    return static_cast<std::int32_t>(id);
  }
  [[nodiscard]] std::int32_t dense(TriangleId id) const {
    const std::uint32_t node = node_of(id);
    if (node >= tree_.size() || local_of(id) >= base_[node + 1] - base_[node]) contradiction("a link leads nowhere");
    return static_cast<std::int32_t>(base_[node] + local_of(id));
  }

  void add_node(std::uint32_t i) {
    const NodeArrays node = mesh_.node(i);
    if (tree_.node(i).is_leaf()) {
      for (std::size_t p = 0; p < node.number_of_points(); ++p) {
        const auto to = static_cast<std::size_t>(index(node.ids[p]));
        merged_.xy[2 * to] = node.xy[2 * p], merged_.xy[2 * to + 1] = node.xy[2 * p + 1];
      }
      for (const DuplicateId& d : node.duplicates)
        merged_.duplicates.push_back({index(d.point), index(d.representative)});
    }
    for (std::size_t t = 0; t < node.number_of_triangles(); ++t) {
      Triangle triangle{.vertices = {}, .neighbors = {}, .number = static_cast<std::int32_t>(triangles_.size())};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(node.triangles[3 * t + k]);
        if (v >= node.number_of_points()) contradiction("a vertex is not a point of its node");
        triangle.vertices[k] = index(node.ids[v]);
        triangle.neighbors[k] = neighbor(i, node, node.neighbors[3 * t + k]);
      }
      triangles_.push_back(triangle);
    }
  }

  [[nodiscard]] std::int32_t neighbor(std::uint32_t i, const NodeArrays& node, std::int32_t local) const {
    if (local >= 0) return dense(triangle_id(i, static_cast<std::uint64_t>(local)));
    if (local == -1) return -1;
    const auto row = static_cast<std::size_t>(-2 - std::int64_t{local});
    if (row >= node.links.size()) contradiction("a neighbour is in no row of the links");
    return node.links[row] == outside_hull ? -1 : dense(node.links[row]);
  }

  void sort_triangles() {
    std::sort(triangles_.begin(), triangles_.end(),
              [](const Triangle& a, const Triangle& b) { return a.vertices < b.vertices; });
    std::vector<std::int32_t> rank(triangles_.size());
    for (std::size_t t = 0; t < rank.size(); ++t)
      rank[static_cast<std::size_t>(triangles_[t].number)] = static_cast<std::int32_t>(t);
    merged_.triangles.reserve(3 * rank.size());
    merged_.neighbors.reserve(3 * rank.size());
    for (const Triangle& t : triangles_) {
      merged_.triangles.insert(merged_.triangles.end(), t.vertices.begin(), t.vertices.end());
      for (const std::int32_t n : t.neighbors)
        merged_.neighbors.push_back(n < 0 ? n : rank[static_cast<std::size_t>(n)]);
    }
    triangles_ = {};
  }

  void walk_hull() {
    std::vector<std::pair<std::int32_t, std::int32_t>> next;  // of each vertex of the hull
    for (std::size_t e = 0; e < merged_.neighbors.size(); ++e) {
      if (merged_.neighbors[e] >= 0) continue;
      const std::size_t t = e - e % 3;
      next.emplace_back(merged_.triangles[t + (e + 1) % 3], merged_.triangles[t + (e + 2) % 3]);
    }
    if (next.empty()) return;
    std::sort(next.begin(), next.end());
    std::int32_t at = next.front().first;
    do {
      merged_.hull.push_back(at);
      const auto edge = std::lower_bound(next.begin(), next.end(), std::pair(at, std::int32_t{0}));
      if (edge == next.end() || edge->first != at || merged_.hull.size() > next.size())
        contradiction("its boundary is no loop");
      at = edge->second;
    } while (at != next.front().first);
  }

  const NodeMesh& mesh_;
  const TileTree& tree_;
  std::vector<std::uint64_t> base_;
  std::vector<Triangle> triangles_;
  MergedMesh merged_;
};

}  // namespace

MergedMesh merge(const NodeMesh& mesh) { return Merge(mesh)(); }

}  // namespace cadt::tiles
