// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/exact_mesh/mountain.hpp"

#include <cadt/errors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cadt::constraints {
namespace {

using exact::Place;

class Mountain {
 public:
  Mountain(const exact::ImplicitPoints& exact, std::span<const Place> chain) : exact_(exact), chain_(chain) {}

  MountainMesh triangulate() {
    cut_ears();
    // The chain that is left after all rounds, then with the ears of the last round, and so on: vertices that are
    // evenly spread flip few edges.
    auto end = static_cast<std::int32_t>(mesh_.triangles.size());
    for (std::size_t round = rounds_.size(); round-- > 0; end = rounds_[round]) legalize(rounds_[round], end);
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

  /// Whether b, between a and c, is convex: an ear, unless it is an end of the base.
  [[nodiscard]] bool is_ear(const Link& a, const Link& b, const Link& c) const {
    return exact_.orientation(at(a.vertex), at(c.vertex), at(b.vertex)) > 0;
  }
  /// The triangle of an ear; what is then beyond the edge from a to c.
  Edge cut(const Link& a, const Link& b, const Link& c) {
    const auto t = static_cast<std::int32_t>(mesh_.triangles.size());
    mesh_.triangles.push_back({a.vertex, c.vertex, b.vertex});
    mesh_.neighbors.push_back({-1, -1, -1});
    join({t, 0}, c.beyond);
    join({t, 1}, b.beyond);
    return {t, 2};
  }

  /// First rounds of ears that are not next to each other; then, where few are left at a time, one after the other.
  void cut_ears() {
    constexpr int most_rounds = 32;
    std::vector<Link> chain, rest;
    for (std::int32_t v = 0; v < static_cast<std::int32_t>(chain_.size()); ++v) chain.push_back({v, {-1, -1}});
    for (int round = 0; round < most_rounds; ++round) {
      rounds_.push_back(static_cast<std::int32_t>(mesh_.triangles.size()));
      rest.assign(1, chain[0]);
      for (std::size_t i = 1; i < chain.size(); ++i) {
        if (i + 1 < chain.size() && is_ear(rest.back(), chain[i], chain[i + 1])) {
          chain[i + 1].beyond = cut(rest.back(), chain[i], chain[i + 1]);
          ++i;
        }
        rest.push_back(chain[i]);
      }
      std::swap(chain, rest);
    }
    rounds_.push_back(static_cast<std::int32_t>(mesh_.triangles.size()));
    rest.clear();
    for (const Link& link : chain) {
      rest.push_back(link);
      for (std::size_t n = rest.size(); n > 2 && is_ear(rest[n - 3], rest[n - 2], rest[n - 1]); n = rest.size()) {
        rest[n - 1].beyond = cut(rest[n - 3], rest[n - 2], rest[n - 1]);
        rest.erase(rest.end() - 2);
      }
    }
    if (rest.size() != 2) throw InternalError("triangles with crossings of segments: a chain is beyond its base");
  }

  /// All edges between triangles from `first` on, until all are legal; at first those of triangles below `end` may not
  /// be.
  void legalize(std::int32_t first, std::int32_t end) {
    std::vector<Edge> suspects;
    for (std::int32_t t = first; t < end; ++t) suspects.push_back({t, 2});
    while (!suspects.empty()) {
      const auto [t, k] = suspects.back();
      suspects.pop_back();
      const auto i = static_cast<std::size_t>(k);
      const std::int32_t u = neighbors(t)[i];
      if (u < first) continue;  // beyond the chain, or of a round that comes later
      std::size_t j = 0;
      while (neighbors(u)[j] != t) ++j;
      const auto [p, a, b] = std::array{vertices(t)[i], vertices(t)[(i + 1) % 3], vertices(t)[(i + 2) % 3]};
      const std::int32_t q = vertices(u)[j];
      if (exact_.incircle_perturbed(at(p), at(a), at(b), at(q)) <= 0) continue;
      const std::int32_t bp = neighbors(t)[(i + 1) % 3], pa = neighbors(t)[(i + 2) % 3], aq = neighbors(u)[(j + 1) % 3],
                         qb = neighbors(u)[(j + 2) % 3];
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
  std::vector<std::int32_t> rounds_;  // first triangle of each
};

}  // namespace

bool is_mountain(std::span<const Place> chain) {
  using Vector = std::array<double, 2>;
  const auto edge = [&](std::size_t i) -> Vector {
    const double x = chain[i].x - chain[i - 1].x, y = chain[i].y - chain[i - 1].y, length = std::abs(x) + std::abs(y);
    return {x / length, y / length};
  };
  const auto cross = [](const Vector& a, const Vector& b) { return a[0] * b[1] - a[1] * b[0]; };
  Vector left = edge(1), right = left;  // those that turn furthest
  double most = 0, shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < chain.size(); ++i) {
    most = std::max({most, std::abs(chain[i - 1].x), std::abs(chain[i - 1].y)});
    shortest = std::min(shortest, std::abs(chain[i].x - chain[i - 1].x) + std::abs(chain[i].y - chain[i - 1].y));
    const Vector e = edge(i);
    if (cross(left, e) > 0) left = e;
    if (cross(right, e) < 0) right = e;
  }
  if (!(shortest > 1e-9 * most)) return false;  // places are rounded
  const bool narrow = left[0] * right[0] + left[1] * right[1] > 0;
  const Vector up =
      narrow ? Vector{left[0] + right[0], left[1] + right[1]} : Vector{left[1] - right[1], right[0] - left[0]};
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const Vector e = edge(i);
    const double x = up[0] * e[0], y = up[1] * e[1];
    if (!(x + y > 1e-5 * (std::abs(x) + std::abs(y)))) return false;
  }
  return true;
}

MountainMesh triangulate_mountain(const exact::ImplicitPoints& exact, std::span<const Place> chain) {
  return Mountain(exact, chain).triangulate();
}

}  // namespace cadt::constraints
