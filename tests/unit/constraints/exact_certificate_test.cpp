// SPDX-License-Identifier: Apache-2.0
// The triangulation with exact crossings is certified with GMP's fractions, which suits any doubles.
#include "tests/support/exact_mesh.hpp"
#include "tests/unit/constraints/segment_sets.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace cadt::test {
namespace {

struct Exact {
  mpq_class x, y;
  friend bool operator<(const Exact& a, const Exact& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }
  friend bool operator==(const Exact& a, const Exact& b) { return a.x == b.x && a.y == b.y; }
};

int turn(const Exact& a, const Exact& b, const Exact& c) {
  return sgn(mpq_class((a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x)));
}

/// Whether d is inside the circle of a, b, c, with the greatest of the four raised most: the sign of the determinant of
/// the lifted points, then those of its cofactors in that order.
bool inside(const Exact& a, const Exact& b, const Exact& c, const Exact& d) {
  const mpq_class ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
  const int circle =
      sgn(mpq_class((ax * ax + ay * ay) * (bx * cy - cx * by) + (bx * bx + by * by) * (cx * ay - ax * cy) +
                    (cx * cx + cy * cy) * (ax * by - bx * ay)));
  if (circle != 0) return circle > 0;
  const std::array<std::pair<const Exact*, int>, 4> cofactors = {
      std::pair{&a, turn(d, b, c)}, {&b, turn(a, d, c)}, {&c, turn(a, b, d)}, {&d, -turn(a, b, c)}};
  std::array<std::pair<const Exact*, int>, 4> order = cofactors;
  std::sort(order.begin(), order.end(), [](const auto& p, const auto& q) { return *q.first < *p.first; });
  for (const auto& [point, cofactor] : order)
    if (cofactor != 0) return cofactor > 0;
  return false;
}

void certify(const SegmentSet& set) {
  const ExactMesh mesh = triangulate_with_crossings(set.xy, set.segments, triangulate(set.xy), 1);
  std::vector<Exact> place;
  for (std::size_t i = 0; i < set.xy.size(); i += 2) place.push_back({set.xy[i], set.xy[i + 1]});
  const std::size_t n = place.size();
  for (const auto& [i, j] : mesh.parents) {
    const auto& s = set.segments[static_cast<std::size_t>(i)];
    const auto& t = set.segments[static_cast<std::size_t>(j)];
    const Exact a = place[static_cast<std::size_t>(s[0])], b = place[static_cast<std::size_t>(s[1])];
    const Exact c = place[static_cast<std::size_t>(t[0])], d = place[static_cast<std::size_t>(t[1])];
    const mpq_class ux = b.x - a.x, uy = b.y - a.y, vx = d.x - c.x, vy = d.y - c.y;
    const mpq_class along = ((c.x - a.x) * vy - (c.y - a.y) * vx) / (ux * vy - uy * vx);
    place.push_back({a.x + along * ux, a.y + along * uy});
  }
  // All crossings are there, each once
  std::set<Exact> distinct(place.begin(), place.begin() + static_cast<std::ptrdiff_t>(n)), crossings;
  for (const auto& [i, j] : crossings_by_brute_force(set)) {
    const auto& s = set.segments[static_cast<std::size_t>(i)];
    const auto& t = set.segments[static_cast<std::size_t>(j)];
    const Exact a = place[static_cast<std::size_t>(s[0])], b = place[static_cast<std::size_t>(s[1])];
    const Exact c = place[static_cast<std::size_t>(t[0])], d = place[static_cast<std::size_t>(t[1])];
    const mpq_class ux = b.x - a.x, uy = b.y - a.y, vx = d.x - c.x, vy = d.y - c.y;
    const mpq_class along = ((c.x - a.x) * vy - (c.y - a.y) * vx) / (ux * vy - uy * vx);
    crossings.insert({a.x + along * ux, a.y + along * uy});
  }
  ASSERT_EQ(std::set<Exact>(place.begin() + static_cast<std::ptrdiff_t>(n), place.end()), crossings) << set.name;
  ASSERT_EQ(place.size() - n, crossings.size()) << set.name;
  distinct.insert(crossings.begin(), crossings.end());

  // Triangles are counterclockwise, edges have two sides but for the hull, which is convex; so no two triangles
  // overlap, and as many triangles as there have to be leave no vertex out.
  std::map<std::array<std::int32_t, 2>, std::array<std::size_t, 2>> edges;  // directed: triangle, number of the edge
  for (std::size_t t = 0; t < mesh.edge_flags.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = mesh.triangles[3 * t + (k + 1) % 3], b = mesh.triangles[3 * t + (k + 2) % 3];
      ASSERT_TRUE(edges.emplace(std::array{a, b}, std::array{t, k}).second) << set.name;
    }
  const auto at = [&](std::int32_t v) -> const Exact& { return place[static_cast<std::size_t>(v)]; };
  std::map<std::int32_t, std::int32_t> hull;
  for (const auto& [edge, where] : edges) {
    const auto [t, k] = where;
    const std::int32_t apex = mesh.triangles[3 * t + k];
    if (k == 0) {
      ASSERT_GT(turn(at(edge[0]), at(edge[1]), at(apex)), 0) << set.name;
    }
    const auto other = edges.find({edge[1], edge[0]});
    ASSERT_EQ(mesh.neighbors[3 * t + k], other == edges.end() ? -1 : static_cast<std::int32_t>(other->second[0]))
        << set.name;
    const bool constrained = (mesh.edge_flags[t] >> k & 1) != 0;
    if (other == edges.end()) {
      ASSERT_TRUE(hull.emplace(edge[0], edge[1]).second) << set.name;
      continue;
    }
    const auto [u, j] = other->second;
    ASSERT_EQ((mesh.edge_flags[u] >> j & 1) != 0, constrained) << set.name;
    ASSERT_FALSE(!constrained && inside(at(edge[0]), at(edge[1]), at(apex), at(mesh.triangles[3 * u + j]))) << set.name;
  }
  for (const auto& [a, b] : hull) {
    ASSERT_TRUE(hull.count(b)) << set.name;
    for (const Exact& p : distinct) ASSERT_GE(turn(at(a), at(b), p), 0) << set.name;
  }
  if (!mesh.triangles.empty()) {
    ASSERT_EQ(mesh.edge_flags.size(), 2 * distinct.size() - 2 - hull.size()) << set.name;
  }

  // Chains: constrained edges from one end to the other, and no other edge is constrained
  std::set<std::array<std::int32_t, 2>> walls;
  ASSERT_EQ(mesh.offsets.size(), set.segments.size() + 1);
  for (std::size_t s = 0; s < set.segments.size(); ++s) {
    const auto first = static_cast<std::size_t>(mesh.offsets[s]), last = static_cast<std::size_t>(mesh.offsets[s + 1]);
    const Exact &a = at(set.segments[s][0]), &b = at(set.segments[s][1]);
    ASSERT_EQ(first == last, a == b) << set.name;
    if (first == last) continue;
    ASSERT_TRUE(at(mesh.vertices[first]) == a && at(mesh.vertices[last - 1]) == b) << set.name;
    for (std::size_t i = first; i < last; ++i) {
      ASSERT_EQ(turn(a, b, at(mesh.vertices[i])), 0) << set.name;
      if (i == first) continue;
      ASSERT_EQ(at(mesh.vertices[i - 1]) < at(mesh.vertices[i]), a < b) << set.name;
      walls.insert({mesh.vertices[i - 1], mesh.vertices[i]});
      walls.insert({mesh.vertices[i], mesh.vertices[i - 1]});
    }
  }
  if (mesh.triangles.empty()) return;
  std::size_t constrained = 0;
  for (const auto& [edge, where] : edges) {
    const bool flag = (mesh.edge_flags[where[0]] >> where[1] & 1) != 0;
    ASSERT_EQ(flag, walls.count(edge) != 0) << set.name;
    constrained += flag;
  }
  ASSERT_EQ(constrained + static_cast<std::size_t>(std::count_if(hull.begin(), hull.end(),
                                                                 [&](const auto& edge) {
                                                                   return walls.count({edge.first, edge.second}) != 0;
                                                                 })),
            walls.size())
      << set.name;
}

TEST(ExactCrossings, SmallSetsAreCertified) {
  for (const SegmentSet& set : small_segment_sets()) certify(set);
}

}  // namespace
}  // namespace cadt::test
