// SPDX-License-Identifier: Apache-2.0
// Cavities of all sizes that are filled by random insertion, which otherwise long ones are that do not divide well.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <cadt/constrained.hpp>

#include "tests/support/families.hpp"

namespace {

#define CADT_CHAIN_WORK 1
#define CADT_CHAIN_SMALL 1
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/constraints/insert/segment_cavity.dev.h"
#pragma GCC diagnostic pop

using cadt::ConstrainedTriangulation;
using cadt::Segment;
using cadt::test::Random;
using Triangles = std::set<std::array<std::int32_t, 3>>;

/// A set of points and edges, and one that is inserted between the first two points.
struct Set {
  std::vector<double> xy = {};
  std::vector<Segment> segments = {};

  std::int32_t add(double x, double y) {
    xy.insert(xy.end(), {x, y});
    return static_cast<std::int32_t>(xy.size() / 2) - 1;
  }
};

Triangles triangles_of(const ConstrainedTriangulation& mesh) {
  Triangles all;
  const std::span<const std::int32_t> corners = mesh.mesh().triangles();
  for (std::size_t i = 0; i < corners.size(); i += 3) all.insert({corners[i], corners[i + 1], corners[i + 2]});
  return all;
}

/// The cavity of the edge in the mesh without it, which is then filled.
class Cavity {
 public:
  explicit Cavity(const Set& set) {
    const ConstrainedTriangulation mesh = cadt::triangulate_constrained(set.xy, set.segments);
    all_ = triangles_of(mesh);
    for (std::size_t i = 0; i < set.xy.size(); i += 2) points_.push_back({set.xy[i], set.xy[i + 1]});
    const std::span<const std::int32_t> corners = mesh.mesh().triangles(), neighbors = mesh.mesh().neighbors();
    const auto corner = [&](std::size_t t, std::size_t k) { return corners[3 * t + k % 3]; };
    const auto side = [&](std::int32_t v) {
      return cadt_orientation(points_[0], points_[1], points_[static_cast<std::size_t>(v)], &counters_);
    };
    std::size_t t = 0, k = 0;
    const auto leaves = [&] { return corner(t, k) == 0 && side(corner(t, k + 1)) < 0 && side(corner(t, k + 2)) > 0; };
    while (t < corners.size() / 3 && !leaves()) t += (k = (k + 1) % 3) == 0 ? 1 : 0;
    if (t == corners.size() / 3) return;  // it is an edge already, or a vertex lies on it
    std::vector<std::int32_t> upper = {corner(t, k + 2)}, lower = {corner(t, k + 1)};
    for (;;) {
      std::array<std::int32_t, 3> triangle = {corner(t, 0), corner(t, 1), corner(t, 2)};
      std::ranges::rotate(triangle, std::ranges::min_element(triangle));
      all_.erase(triangle);
      const auto next = static_cast<std::size_t>(neighbors[3 * t + k]);
      std::size_t j = 0;
      while (neighbors[3 * next + j] != static_cast<std::int32_t>(t)) ++j;
      const std::int32_t apex = corner(t = next, j), s = apex == 1 ? 0 : side(apex);
      if (s > 0) upper.push_back(apex);
      if (s < 0) lower.push_back(apex);
      if (s == 0) {
        whole_ = apex == 1;
        triangle = {corner(t, 0), corner(t, 1), corner(t, 2)};
        std::ranges::rotate(triangle, std::ranges::min_element(triangle));
        all_.erase(triangle);
        break;
      }
      k = (j + (s > 0 ? 1 : 2)) % 3;
    }
    middle_ = static_cast<cadt_u32>(upper.size()) + 1;
    vertex_.push_back(0);
    for (const std::int32_t v : upper) vertex_.push_back(static_cast<cadt_u32>(v));
    vertex_.push_back(1);
    for (std::size_t i = lower.size(); i-- > 0;) vertex_.push_back(static_cast<cadt_u32>(lower[i]));
    vertex_.push_back(0);
  }

  [[nodiscard]] bool is_one() const { return whole_; }

  /// All triangles, after both sides have been filled.
  Triangles fill() {
    const auto count = static_cast<cadt_u32>(vertex_.size());
    std::vector<cadt_u32> triangle(count), edge(count, CADT_NONE), outer(count), piece(count);
    for (cadt_u32 x = 0; x < count; ++x) triangle[x] = x;  // two of them are nobody's
    const cadt_rings rings = {vertex_.data(), triangle.data(), edge.data(), outer.data(), piece.data(), count};
    std::vector<cadt_u32> corners(3 * std::size_t{count}, CADT_NONE), across(3 * std::size_t{count}, CADT_NONE),
        flags(count, 7);
    std::vector<cadt_u32> of_vertex(points_.size());
    const cadt_segment_mesh mesh = {points_.data(), corners.data(), across.data(), flags.data(), of_vertex.data()};
    cadt_u32 base = CADT_NONE, words[CADT_SEGMENTS_WORDS] = {};
    for (const cadt_chain chain :
         {cadt_chain{0, middle_, CADT_NONE, 0}, cadt_chain{middle_, count - 1, CADT_NONE, 0}}) {
      // Once to see whether it can be, into what the second time finds there.
      if (cadt_fill_at_random(&mesh, &rings, &chain, &counters_) == CADT_NONE) ++refused;
      cadt_fill_chain(&mesh, &rings, chain, &base, words, &counters_);
    }
    EXPECT_EQ(words[CADT_SEGMENTS_BROKEN], 0U);
    for (cadt_u32 x = 1; x + 1 < count; ++x) {
      if (x == middle_) continue;
      std::array<std::int32_t, 3> one{};
      for (std::size_t k = 0; k < 3; ++k) {
        one[k] = static_cast<std::int32_t>(corners[3 * x + k]);
        const cadt_u32 half_edge = CADT_HALF_EDGE(x, static_cast<cadt_u32>(k)), other = across[3 * x + k];
        EXPECT_LT(corners[3 * x + k], points_.size());
        if (std::ranges::count(edge, half_edge) != 0) continue;  // linked later with what is beyond
        EXPECT_EQ(across[3 * CADT_TRIANGLE_OF(other) + CADT_EDGE_OF(other)], half_edge);
      }
      std::ranges::rotate(one, std::ranges::min_element(one));
      all_.insert(one);
    }
    // Each edge of the ring is known by the half-edge inside, the base by its flag alone.
    for (cadt_u32 x = 0; x + 1 < count; ++x) {
      const cadt_u32 t = CADT_TRIANGLE_OF(edge[x]), k = CADT_EDGE_OF(edge[x]);
      EXPECT_EQ(corners[3 * t + CADT_NEXT(k)], vertex_[x + 1]);
      EXPECT_EQ(corners[3 * t + CADT_PREV(k)], vertex_[x]);
    }
    cadt_u32 flagged = 0;
    for (cadt_u32 x = 1; x + 1 < count; ++x)
      if (x != middle_) flagged += static_cast<cadt_u32>(std::popcount(flags[x]));
    EXPECT_EQ(flagged, 2U);
    return all_;
  }

  int refused = 0;

 private:
  Triangles all_;
  std::vector<cadt_point> points_;
  std::vector<cadt_u32> vertex_;
  cadt_u32 middle_ = 0;
  bool whole_ = false;
  cadt_counters counters_{};
};

/// How often a side could not be filled.
int expect_filled(const Set& set, const std::string& name) {
  SCOPED_TRACE(name);
  Cavity cavity(set);
  if (!cavity.is_one()) return 0;
  Set with = set;
  with.segments.push_back({0, 1});
  EXPECT_EQ(cavity.fill(), triangles_of(cadt::triangulate_constrained(with.xy, with.segments)));
  return cavity.refused;
}

TEST(RandomInsertion, OfPointsAnywhereAndInARow) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    Set set;
    set.add(0, 0.5);
    set.add(100, 0.5);
    const double height = std::pow(10.0, static_cast<double>(random.below(6)) - 3);
    for (std::size_t i = 0, n = 5 + random.below(100); i < n; ++i) {
      const double x = 1 + 98 * random.uniform(), y = 0.5 + height * (random.uniform() - 0.5);
      set.add(random.below(2) == 0 ? std::round(x) : x, random.below(2) == 0 ? std::round(y) : y);
    }
    EXPECT_EQ(expect_filled(set, std::to_string(seed)), 0);
  }
}

Set slanted_teeth(Random& random) {
  Set teeth;
  teeth.add(-10, 0.5);
  teeth.add(60, 0.5);
  for (int i = 0; i < 40; ++i) {
    const std::int32_t root = teeth.add(i, 0.53 + 0.05 * random.uniform()),
                       tip = teeth.add(i - 2.0, 3 + random.uniform());
    if (random.below(4) != 0) teeth.segments.push_back({root, tip});
    teeth.add(i - 0.3, 1.8);
    if (random.below(2) == 0) teeth.add(i + 0.5, 0.3 * random.uniform());
  }
  return teeth;
}

Set columns_below(Random& random) {
  Set columns;
  columns.add(-1, 0.5);
  columns.add(2, 0.5);
  columns.add(0.5, 1);
  for (int i = 0; i < 30; ++i) {
    columns.add(-1 + 1e-3 * random.uniform(), 0.5 * (i + random.uniform()) / 31);
    columns.add(2 - 1e-3 * random.uniform(), 0.5 * (i + random.uniform()) / 31);
  }
  return columns;
}

/// Chains that go back, or come to a vertex twice.
TEST(RandomInsertion, OfTeethAndColumns) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    EXPECT_EQ(expect_filled(slanted_teeth(random), "teeth " + std::to_string(seed)), 0);
    EXPECT_EQ(expect_filled(columns_below(random), "columns " + std::to_string(seed)), 0);
  }
}

/// Distances that are rounded once are all the same here.
TEST(RandomInsertion, OfPointsWithinAnUlp) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    Set set;
    const double ends[4] = {0.1 * random.uniform(), 0.3, 7.7, 0.3 + 3 * random.uniform()};
    set.add(ends[0], ends[1]);
    set.add(ends[2], ends[3]);
    for (int i = 0; i < 60; ++i) {
      const double part = random.uniform(), to = random.below(2) == 0 ? -1e9 : 1e9;
      double x = ends[0] + part * (ends[2] - ends[0]), y = ends[1] + part * (ends[3] - ends[1]);
      for (std::size_t k = random.below(3); k > 0; --k) x = std::nextafter(x, to), y = std::nextafter(y, -to);
      set.add(x, y);
    }
    EXPECT_EQ(expect_filled(set, std::to_string(seed)), 0);
  }
}

/// Distances that are no numbers: a side is divided after all, over what the attempt has left.
TEST(RandomInsertion, OfTeethWhoseDistancesOverflowIsGivenUp) {
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    Set teeth = slanted_teeth(random);
    for (double& x : teeth.xy) x = std::ldexp(x, 700);
    refused += expect_filled(teeth, std::to_string(seed));
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
