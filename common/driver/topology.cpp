// SPDX-License-Identifier: Apache-2.0
#include <cadt/topology.hpp>

#include <algorithm>
#include <string>

namespace cadt {
namespace {

constexpr std::size_t next3(std::size_t k) { return k == 2 ? 0 : k + 1; }
constexpr std::size_t previous3(std::size_t k) { return k == 0 ? 2 : k - 1; }

constexpr std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

/// Which vertex of triangle t this is.
std::size_t corner(std::span<const std::int32_t> triangles, std::size_t t, std::int32_t vertex) {
  const auto* v = triangles.data() + 3 * t;
  return v[0] == vertex ? 0 : (v[1] == vertex ? 1 : 2);
}

/// Stable sort of pairs by one of their words, which are below `bound`.
void sort_by(std::vector<std::array<std::int32_t, 2>>& pairs, std::size_t which, std::size_t bound) {
  std::vector<std::size_t> place(bound + 1, 0);
  for (const auto& pair : pairs) ++place[index(pair[which]) + 1];
  for (std::size_t i = 1; i <= bound; ++i) place[i] += place[i - 1];
  std::vector<std::array<std::int32_t, 2>> sorted(pairs.size());
  for (const auto& pair : pairs) sorted[place[index(pair[which])]++] = pair;
  pairs = std::move(sorted);
}

/// The triangles at each vertex, counterclockwise.
class VertexStars {
 public:
  explicit VertexStars(const Triangulation& mesh)
      : points_(mesh.number_of_points()), triangles_(mesh.triangles()), neighbors_(mesh.neighbors()) {
    // A triangle of each vertex: on the hull the first counterclockwise, else the one with the lowest next vertex.
    first_.assign(points_, -1);
    degree_.assign(points_, 0);
    on_hull_.assign(points_, 0);
    for (std::size_t t = 0; t < triangles_.size() / 3; ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t v = index(triangles_[3 * t + k]);
        ++degree_[v];
        const bool hull = neighbors_[3 * t + previous3(k)] < 0;  // the edge from v to the next vertex
        if (on_hull_[v] != 0) continue;
        if (hull) {
          on_hull_[v] = 1;
        } else if (first_[v] >= 0 && triangles_[3 * t + next3(k)] >= after(index(first_[v]), v)) {
          continue;
        }
        first_[v] = static_cast<std::int32_t>(t);
      }
  }

  [[nodiscard]] bool on_hull(std::size_t v) const { return on_hull_[v] != 0; }
  [[nodiscard]] std::size_t degree(std::size_t v) const { return degree_[v]; }
  [[nodiscard]] std::size_t points() const { return points_; }

  /// Calls `visit(v, t, right)` for each triangle at each vertex v, with its vertex that comes after v, and `last(v,
  /// left)` on the hull, with the neighbour behind the last triangle. \throws InternalError if the triangles at a
  /// vertex are not connected
  template <class Visit, class Last>
  void walk(const Visit& visit, const Last& last) const {
    for (std::size_t v = 0; v < points_; ++v) {
      std::int32_t t = first_[v];
      for (std::size_t i = 0; i < degree_[v]; ++i) {
        if (t < 0 || (i > 0 && t == first_[v]))
          throw InternalError("the triangles at point " + std::to_string(v) + " are not connected");
        const std::size_t at = index(t), k = corner(triangles_, at, static_cast<std::int32_t>(v));
        visit(v, at, triangles_[3 * at + next3(k)]);
        t = neighbors_[3 * at + next3(k)];  // beyond the edge from v to the vertex before
        if (t < 0) last(v, triangles_[3 * at + previous3(k)]);
      }
    }
  }

 private:
  [[nodiscard]] std::int32_t after(std::size_t t, std::size_t v) const {
    return triangles_[3 * t + next3(corner(triangles_, t, static_cast<std::int32_t>(v)))];
  }

  std::size_t points_;
  std::span<const std::int32_t> triangles_, neighbors_;
  std::vector<std::int32_t> first_;
  std::vector<std::size_t> degree_;
  std::vector<std::uint8_t> on_hull_;
};

}  // namespace

std::vector<std::array<std::int32_t, 2>> edges(const Triangulation& mesh) {
  const auto triangles = mesh.triangles(), neighbors = mesh.neighbors();
  std::vector<std::array<std::int32_t, 2>> result;
  result.reserve((triangles.size() + mesh.hull().size()) / 2);
  for (std::size_t t = 0; t < triangles.size() / 3; ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t beyond = neighbors[3 * t + k];
      if (beyond >= 0 && index(beyond) < t) continue;
      const std::int32_t a = triangles[3 * t + next3(k)], b = triangles[3 * t + previous3(k)];
      result.push_back({std::min(a, b), std::max(a, b)});
    }
  sort_by(result, 1, mesh.number_of_points());
  sort_by(result, 0, mesh.number_of_points());
  return result;
}

CompressedRows vertex_neighbors(const Triangulation& mesh) {
  const VertexStars around(mesh);
  CompressedRows rows;
  rows.indptr.assign(around.points() + 1, 0);
  for (std::size_t v = 0; v < around.points(); ++v)
    rows.indptr[v + 1] = rows.indptr[v] + around.degree(v) + (around.on_hull(v) ? 1 : 0);
  rows.indices.reserve(rows.indptr.back());
  around.walk([&](std::size_t, std::size_t, std::int32_t right) { rows.indices.push_back(right); },
              [&](std::size_t, std::int32_t left) { rows.indices.push_back(left); });
  return rows;
}

CompressedRows incident_triangles(const Triangulation& mesh) {
  const VertexStars around(mesh);
  CompressedRows rows;
  rows.indptr.assign(around.points() + 1, 0);
  for (std::size_t v = 0; v < around.points(); ++v) rows.indptr[v + 1] = rows.indptr[v] + around.degree(v);
  rows.indices.reserve(rows.indptr.back());
  around.walk([&](std::size_t, std::size_t t, std::int32_t) { rows.indices.push_back(static_cast<std::int32_t>(t)); },
              [](std::size_t, std::int32_t) {});
  return rows;
}

std::vector<std::int64_t> half_edges(const Triangulation& mesh) {
  const auto triangles = mesh.triangles(), neighbors = mesh.neighbors();
  std::vector<std::int64_t> result(triangles.size(), -1);
  for (std::size_t e = 0; e < result.size(); ++e) {
    const std::size_t t = e / 3, k = e % 3;
    const std::int32_t beyond = neighbors[3 * t + previous3(k)];
    if (beyond < 0) continue;
    // There it starts where this one ends.
    const std::size_t other = index(beyond);
    result[e] = static_cast<std::int64_t>(3 * other + corner(triangles, other, triangles[3 * t + next3(k)]));
  }
  return result;
}

}  // namespace cadt
