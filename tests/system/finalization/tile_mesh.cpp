// SPDX-License-Identifier: Apache-2.0
#include "tests/system/finalization/tile_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

namespace cadt::test {
namespace {

struct NodePart {
  Part part;
  std::vector<TriangleId> links;
  std::vector<std::uint64_t> ids;  // of the node's points
};

LinkedTriangle rotated(LinkedTriangle t) {
  const auto first = std::min_element(t.vertices.begin(), t.vertices.end()) - t.vertices.begin();
  std::rotate(t.vertices.begin(), t.vertices.begin() + first, t.vertices.end());
  std::rotate(t.across.begin(), t.across.begin() + first, t.across.end());
  return t;
}

std::array<std::uint64_t, 3> smallest_first(std::array<std::uint64_t, 3> v) {
  std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
  return v;
}

class Tiling {
 public:
  Tiling(Triangulator& triangulator, const Points& xy, const TileOptions& options)
      : triangulator_(triangulator), xy_(xy), options_(options) {}

  TiledMesh run() {
    std::vector<std::size_t> all(xy_.size() / 2);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    Open open;
    if (options_.flat) {
      std::vector<Open> children;
      leaves(all, TileBox{}, children);
      if (nodes_.size() > 1) open = join(children, TileBox{});
    } else {
      open = build(all, TileBox{});
    }
    if (!open.ids.empty() || !open.sides.empty()) throw std::logic_error("the root leaves something open");
    resolve();
    return std::move(mesh_);
  }

 private:
  using Indices = std::vector<std::size_t>;

  Open build(const Indices& points, const TileBox& box) {
    const auto cut = split(points, box);
    if (!cut) return leaf(points, box);
    std::vector<Open> children;
    children.push_back(build(cut->low, cut->low_box));
    children.push_back(build(cut->high, cut->high_box));
    return join(children, box);
  }

  void leaves(const Indices& points, const TileBox& box, std::vector<Open>& to) {
    const auto cut = split(points, box);
    if (!cut) {
      to.push_back(leaf(points, box));
      return;
    }
    leaves(cut->low, cut->low_box, to);
    leaves(cut->high, cut->high_box, to);
  }

  struct Cut {
    Indices low, high;
    TileBox low_box, high_box;
  };

  std::optional<Cut> split(const Indices& points, const TileBox& box) const {
    if (points.size() <= options_.tile_points) return std::nullopt;
    std::array<double, 2> width{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto [low, high] = std::ranges::minmax(points, {}, [&](std::size_t p) { return xy_[2 * p + axis]; });
      width[axis] = xy_[2 * high + axis] / 2 - xy_[2 * low + axis] / 2;
    }
    for (std::size_t axis : {std::size_t{width[1] > width[0]}, std::size_t{width[1] <= width[0]}}) {
      std::vector<double> values;
      for (std::size_t p : points) values.push_back(xy_[2 * p + axis]);
      std::ranges::sort(values);
      const auto above = std::ranges::upper_bound(values, values.front());
      if (above == values.end()) continue;
      const double at = std::max(values[values.size() / 2], *above);
      Cut cut{{}, {}, box, box};
      (axis == 0 ? cut.low_box.max_x : cut.low_box.max_y) = at;
      (axis == 0 ? cut.high_box.min_x : cut.high_box.min_y) = at;
      for (std::size_t p : points) (xy_[2 * p + axis] < at ? cut.low : cut.high).push_back(p);
      return cut;
    }
    return std::nullopt;
  }

  Open leaf(const Indices& points, const TileBox& box) {
    Points xy;
    std::vector<std::uint64_t> ids;
    for (std::size_t p : points) {
      xy.insert(xy.end(), {xy_[2 * p], xy_[2 * p + 1]});
      ids.push_back(options_.first_id + p);
    }
    ++mesh_.leaves;
    FinishedNode node =
        finish_leaf(triangulator_, std::span<const double>(xy), ids, box, static_cast<std::uint32_t>(nodes_.size()));
    return keep(std::move(node), std::move(ids), points.size(), box);
  }

  Open join(std::vector<Open>& children, const TileBox& box) {
    std::vector<std::uint64_t> ids;
    for (const Open& child : children) ids.insert(ids.end(), child.ids.begin(), child.ids.end());
    std::ranges::sort(ids);
    FinishedNode node = finish_join(triangulator_, children, box, static_cast<std::uint32_t>(nodes_.size()));
    return keep(std::move(node), std::move(ids), 0, box);
  }

  Open keep(FinishedNode node, std::vector<std::uint64_t> ids, std::size_t leaf_points, const TileBox& box) {
    if (options_.tamper) options_.tamper(node);
    mesh_.sums += node.sums;
    const Hash128 hash = node.part.hash();
    mesh_.sums.hash.high += hash.high;
    mesh_.sums.hash.low += hash.low;
    mesh_.duplicates.insert(mesh_.duplicates.end(), node.duplicates.begin(), node.duplicates.end());
    if (leaf_points != 0 && !box.is_plane())
      mesh_.open_of_root_n.push_back(static_cast<double>(node.open.ids.size()) /
                                     std::sqrt(static_cast<double>(leaf_points)));
    messages_.insert(messages_.end(), node.messages.begin(), node.messages.end());
    nodes_.push_back({node.part.download(), std::move(node.links), std::move(ids)});
    ++mesh_.nodes;
    return std::move(node.open);
  }

  std::array<std::uint64_t, 3> vertices(std::size_t node, std::size_t t) const {
    const NodePart& from = nodes_.at(node);
    std::array<std::uint64_t, 3> v{};
    for (std::size_t k = 0; k < 3; ++k) v[k] = from.ids.at(static_cast<std::size_t>(from.part.triangles.at(3 * t + k)));
    return v;
  }

  void resolve() {
    for (const Link& m : messages_) {
      TriangleId& link = nodes_.at(node_of(m.triangle)).links.at(m.row);
      if (link != pending_triangle) throw std::logic_error("a link is told twice");
      link = m.across;
    }
    for (std::size_t node = 0; node < nodes_.size(); ++node) {
      const Part& part = nodes_[node].part;
      for (std::size_t t = 0; t < part.triangles.size() / 3; ++t) {
        LinkedTriangle triangle{vertices(node, t), {}};
        for (std::size_t k = 0; k < 3; ++k) {
          const std::int32_t n = part.neighbors[3 * t + k];
          if (n == -1) continue;
          if (n >= 0) {
            triangle.across[k] = smallest_first(vertices(node, static_cast<std::size_t>(n)));
            continue;
          }
          const TriangleId id = nodes_[node].links.at(static_cast<std::size_t>(-2 - n));
          if (id == pending_triangle) throw std::logic_error("a link was never told");
          if (id != outside_hull) triangle.across[k] = smallest_first(vertices(node_of(id), local_of(id)));
        }
        mesh_.triangles.push_back(rotated(triangle));
      }
    }
    std::ranges::sort(mesh_.triangles);
    std::ranges::sort(mesh_.duplicates, {}, &DuplicateId::point);
  }

  Triangulator& triangulator_;
  const Points& xy_;
  const TileOptions& options_;
  std::vector<NodePart> nodes_;
  std::vector<Link> messages_;
  TiledMesh mesh_;
};

}  // namespace

TiledMesh triangulate_by_tiles(Triangulator& triangulator, const Points& xy, const TileOptions& options) {
  return Tiling(triangulator, xy, options).run();
}

std::vector<LinkedTriangle> linked_triangles(const Triangulation& mesh, std::uint64_t first_id) {
  const auto v = mesh.triangles(), n = mesh.neighbors();
  const auto vertices = [&](std::size_t t) {
    std::array<std::uint64_t, 3> result{};
    for (std::size_t k = 0; k < 3; ++k) result[k] = first_id + static_cast<std::uint64_t>(v[3 * t + k]);
    return result;
  };
  std::vector<LinkedTriangle> result;
  for (std::size_t t = 0; t < mesh.number_of_triangles(); ++t) {
    LinkedTriangle triangle{vertices(t), {}};
    for (std::size_t k = 0; k < 3; ++k)
      if (n[3 * t + k] >= 0) triangle.across[k] = smallest_first(vertices(static_cast<std::size_t>(n[3 * t + k])));
    result.push_back(rotated(triangle));
  }
  std::ranges::sort(result);
  return result;
}

}  // namespace cadt::test
