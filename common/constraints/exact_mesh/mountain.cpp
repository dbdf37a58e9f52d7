// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/exact_mesh/mountain.hpp"

#include <cadt/errors.hpp>

#include <utility>

namespace cadt::constraints {
namespace {

using exact::Place;

class Mountain {
 public:
  Mountain(const exact::ImplicitPoints& exact, std::span<const Place> chain) : exact_(exact), chain_(chain) {}

  MountainMesh triangulate() {
    cut_ears();
    legalize();
    return std::move(mesh_);
  }

 private:
  struct Edge {
    std::int32_t triangle, k;
  };
  /// A vertex of the rest of the chain, and what is beyond the edge to it from the one before.
  struct Link {
    std::int32_t vertex;
    Edge beyond;
  };

  [[nodiscard]] const Place& at(std::int32_t v) const { return chain_[static_cast<std::size_t>(v)]; }
  [[nodiscard]] std::array<std::int32_t, 3>& vertices(std::int32_t t) {
    return mesh_.triangles[static_cast<std::size_t>(t)];
  }
  [[nodiscard]] std::array<std::int32_t, 3>& neighbors(std::int32_t t) {
    return mesh_.neighbors[static_cast<std::size_t>(t)];
  }
  void join(Edge a, Edge b) {
    neighbors(a.triangle)[static_cast<std::size_t>(a.k)] = b.triangle;
    if (b.triangle >= 0) neighbors(b.triangle)[static_cast<std::size_t>(b.k)] = a.triangle;
  }

  /// Each convex vertex but the ends of the base is an ear.
  void cut_ears() {
    std::vector<Link> rest;
    for (std::int32_t v = 0; v < static_cast<std::int32_t>(chain_.size()); ++v) {
      rest.push_back({v, {-1, -1}});
      while (rest.size() > 2) {
        const Link &a = rest[rest.size() - 3], &b = rest[rest.size() - 2], &c = rest[rest.size() - 1];
        if (exact_.orientation(at(a.vertex), at(c.vertex), at(b.vertex)) <= 0) break;
        const auto t = static_cast<std::int32_t>(mesh_.triangles.size());
        mesh_.triangles.push_back({a.vertex, c.vertex, b.vertex});
        mesh_.neighbors.push_back({-1, -1, -1});
        join({t, 0}, c.beyond);
        join({t, 1}, b.beyond);
        const Link last{c.vertex, {t, 2}};
        rest.resize(rest.size() - 2);
        rest.push_back(last);
      }
    }
    if (rest.size() != 2) throw InternalError("triangles with crossings of segments: a chain is beyond its base");
  }

  /// All edges, until all are legal.
  void legalize() {
    std::vector<Edge> suspects;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh_.triangles.size()); ++t) suspects.push_back({t, 2});
    while (!suspects.empty()) {
      const auto [t, k] = suspects.back();
      suspects.pop_back();
      const auto i = static_cast<std::size_t>(k);
      const std::int32_t u = neighbors(t)[i];
      if (u < 0) continue;
      std::size_t j = 0;
      while (neighbors(u)[j] != t) ++j;
      const auto [p, a, b] = std::array{vertices(t)[i], vertices(t)[(i + 1) % 3], vertices(t)[(i + 2) % 3]};
      const std::int32_t q = vertices(u)[j];
      if (exact_.incircle_perturbed(at(p), at(a), at(b), at(q)) <= 0) continue;
      const std::int32_t bp = neighbors(t)[(i + 1) % 3], pa = neighbors(t)[(i + 2) % 3],
                         aq = neighbors(u)[(j + 1) % 3], qb = neighbors(u)[(j + 2) % 3];
      vertices(t) = {p, a, q};
      neighbors(t) = {aq, u, pa};
      vertices(u) = {p, q, b};
      neighbors(u) = {qb, bp, t};
      replace(aq, u, t);
      replace(bp, t, u);
      suspects.insert(suspects.end(), {{t, 0}, {t, 2}, {u, 0}, {u, 1}});
    }
  }
  void replace(std::int32_t t, std::int32_t from, std::int32_t to) {
    if (t < 0) return;
    for (std::int32_t& other : neighbors(t))
      if (other == from) {
        other = to;
        return;
      }
  }

  const exact::ImplicitPoints& exact_;
  const std::span<const Place> chain_;
  MountainMesh mesh_;
};

}  // namespace

bool is_mountain(std::span<const Place> chain) {
  bool x_up = true, x_down = true, y_up = true, y_down = true;
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const Place &a = chain[i - 1], &b = chain[i];
    x_up = x_up && a.x < b.x;
    x_down = x_down && a.x > b.x;
    y_up = y_up && a.y < b.y;
    y_down = y_down && a.y > b.y;
  }
  return x_up || x_down || y_up || y_down;
}

MountainMesh triangulate_mountain(const exact::ImplicitPoints& exact, std::span<const Place> chain) {
  return Mountain(exact, chain).triangulate();
}

}  // namespace cadt::constraints
