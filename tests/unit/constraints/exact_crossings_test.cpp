// SPDX-License-Identifier: Apache-2.0
// The triangulation with exact crossings against CGAL over an exact kernel.
#include "common/constraints/crossings/arrangement.hpp"
#include "common/verify/host/exact_sign.hpp"
#include "tests/support/exact_mesh.hpp"
#include "tests/support/oracle_constrained.hpp"
#include "tests/support/sanitizers.hpp"
#include "tests/unit/constraints/segment_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace cadt::test {
namespace {

using Edges = std::vector<std::array<std::int32_t, 2>>;

ExactMesh mesh_of(const SegmentSet& set, unsigned threads = 1) {
  return triangulate_with_crossings(set.xy, set.segments, triangulate(set.xy), threads);
}

std::vector<Triangle> triangles(const ExactMesh& mesh) {
  std::vector<Triangle> all;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    all.push_back({mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]});
  make_canonical(all);
  return all;
}

/// The edges with a flag, which both triangles must have.
Edges constrained(const ExactMesh& mesh) {
  std::map<std::array<std::int32_t, 2>, std::pair<int, int>> count;  // of triangles, and of flags
  for (std::size_t t = 0; t < mesh.edge_flags.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t a = mesh.triangles[3 * t + (k + 1) % 3], b = mesh.triangles[3 * t + (k + 2) % 3];
      auto& [sides, flags] = count[{std::min(a, b), std::max(a, b)}];
      ++sides;
      flags += static_cast<int>(mesh.edge_flags[t] >> k & 1);
    }
  Edges all;
  for (const auto& [edge, sides] : count) {
    EXPECT_TRUE(sides.second == 0 || sides.second == sides.first);
    if (sides.second != 0) all.push_back(edge);
  }
  return all;
}

/// Neighbours share an edge and know each other.
void expect_connected(const ExactMesh& mesh, const std::string& name) {
  for (std::size_t i = 0; i < mesh.neighbors.size(); ++i) {
    const std::int32_t other = mesh.neighbors[i];
    if (other < 0) continue;
    const std::size_t t = i / 3, k = i % 3;
    const std::int32_t a = mesh.triangles[3 * t + (k + 1) % 3], b = mesh.triangles[3 * t + (k + 2) % 3];
    bool shared = false;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t u = 3 * static_cast<std::size_t>(other);
      shared |= mesh.neighbors[u + j] == static_cast<std::int32_t>(t) && mesh.triangles[u + (j + 1) % 3] == b &&
                mesh.triangles[u + (j + 2) % 3] == a;
    }
    ASSERT_TRUE(shared) << name << " triangle " << t;
  }
}

/// The edges of the chains.
Edges edges_of_chains(const ExactMesh& mesh) {
  std::set<std::array<std::int32_t, 2>> all;
  for (std::size_t s = 0; s + 1 < mesh.offsets.size(); ++s)
    for (auto i = static_cast<std::size_t>(mesh.offsets[s]); i + 1 < static_cast<std::size_t>(mesh.offsets[s + 1]); ++i)
      all.insert({std::min(mesh.vertices[i], mesh.vertices[i + 1]), std::max(mesh.vertices[i], mesh.vertices[i + 1])});
  return {all.begin(), all.end()};
}

void expect_as_cgal(const SegmentSet& set) {
  const ExactMesh mesh = mesh_of(set);
  const CrossedOracleMesh expected = cgal_constrained_plus(set.xy, set.segments, mesh.parents);
  ASSERT_EQ(expected.unknown, 0U) << set.name;
  ASSERT_EQ(mesh.added_xy, expected.added_xy) << set.name;
  ASSERT_EQ(triangles(mesh), expected.triangles) << set.name;
  if (!mesh.triangles.empty()) {
    ASSERT_EQ(constrained(mesh), expected.constrained) << set.name;
    ASSERT_EQ(edges_of_chains(mesh), expected.constrained) << set.name;
  }
  expect_connected(mesh, set.name);
}

/// CGAL's intervals lose what underflows: there it finds other crossings. SmallSetsAreCertified has these sets, too.
bool suits_cgal(const SegmentSet& set) {
  return std::all_of(set.xy.begin(), set.xy.end(),
                     [](double v) { return v == 0 || (std::abs(v) > 1e-40 && std::abs(v) < 1e40); });
}

TEST(ExactCrossings, SmallSetsEqualCgal) {
  std::size_t compared = 0;
  for (const SegmentSet& set : small_segment_sets()) {
    if (!suits_cgal(set)) continue;
    expect_as_cgal(set);
    ++compared;
  }
  EXPECT_GT(compared, 100U);
}

TEST(ExactCrossings, RandomSetsEqualCgal) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    expect_as_cgal(random_segments(seed, 500, 0.1));
    expect_as_cgal(random_segments(seed, 60, 2.0));
    expect_as_cgal(lattice_segments(seed, 20, 40, 1, 1));
    expect_as_cgal(lattice_segments(seed, 8, 60, 1, 0.1));
  }
}

/// Coordinates of maps, and segments of a few thousand last places: what is rounded is far from what is exact, and the
/// error bounds of filters are of the size of the values.
TEST(ExactCrossings, FarFromTheOriginEqualCgal) {
  for (const double side : {1000.0, 1e-3, 0x1p-18}) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      SegmentSet set = random_segments(seed, 120, 0.7);
      set.name += ", far from the origin";
      for (std::size_t i = 0; i < set.xy.size(); i += 2) {
        set.xy[i] = 400000 + side * set.xy[i];
        set.xy[i + 1] = 5600000 + side * set.xy[i + 1];
      }
      expect_as_cgal(set);
    }
  }
}

/// A square of lines: each unit cell has four vertices on a circle, and they are crossings.
TEST(ExactCrossings, CrossingsOnCirclesEqualCgal) {
  for (const double unit : {1.0, 0.1, 1.0 / 3}) {
    SegmentSet set{"grid of lines", {}, {}};
    for (std::int32_t i = 0; i < 12; ++i) {
      const double k = unit * i, most = unit * 20;
      set.xy.insert(set.xy.end(), {-most, k, most, k, k, -most, k, most});
      set.segments.push_back({4 * i, 4 * i + 1});
      set.segments.push_back({4 * i + 3, 4 * i + 2});
    }
    expect_as_cgal(set);
    for (std::int32_t i = 0; i < 12; ++i) {  // and turned, so that places are no doubles
      for (std::size_t k = 0; k < 4; ++k) {
        double &x = set.xy[8 * static_cast<std::size_t>(i) + 2 * k],
               &y = set.xy[8 * static_cast<std::size_t>(i) + 2 * k + 1];
        const double turned = x - 3 * y;
        y = 3 * x + y;
        x = turned;
      }
    }
    expect_as_cgal(set);
  }
}

TEST(ExactCrossings, ByHand) {
  const std::vector<double> xy = {0, 0, 2, 2, 0, 2, 2, 0};
  const std::vector<Segment> segments = {{0, 1}, {3, 2}, {1, 1}};
  const ExactMesh mesh = triangulate_with_crossings(xy, segments, triangulate(xy), 1);
  EXPECT_EQ(triangles(mesh), (std::vector<Triangle>{{0, 3, 4}, {0, 4, 2}, {1, 2, 4}, {1, 4, 3}}));
  EXPECT_EQ(mesh.added_xy, (std::vector<double>{1, 1}));
  EXPECT_EQ(mesh.parents, (Edges{{0, 1}}));
  EXPECT_EQ(mesh.offsets, (std::vector<std::int64_t>{0, 3, 6, 6}));
  EXPECT_EQ(mesh.vertices, (std::vector<std::int32_t>{0, 4, 1, 3, 4, 2}));
  EXPECT_TRUE(mesh.rounded_valid);
}

/// Crossings within less than a last place of one another: the exact mesh is right, the rounded one cannot be.
TEST(ExactCrossings, SayWhenRoundingTurnsTriangles) {
  SegmentSet set{"three segments almost through one place", {}, {}};
  set.xy = {0, 0, 1, 1, 0, 1, 1, 0, 0, 0.5, 1, 0.5 + 0x1p-52, 0.25, 0, 0.75, 1};
  set.segments = {{0, 1}, {2, 3}, {4, 5}, {6, 7}};
  const ExactMesh mesh = mesh_of(set);
  EXPECT_FALSE(mesh.rounded_valid);
  expect_as_cgal(set);
  const SegmentSet easy = random_segments(3, 50, 0.5);
  const ExactMesh valid = mesh_of(easy);
  EXPECT_TRUE(valid.rounded_valid);
  EXPECT_GT(valid.parents.size(), 20U);
}

TEST(ExactCrossings, OrderDirectionAndThreadsDoNotMatter) {
  std::mt19937_64 random(13);
  for (const SegmentSet& set : {random_segments(8, 300, 0.2), lattice_segments(9, 12, 40, 1, 1)}) {
    const ExactMesh first = mesh_of(set);
    std::vector<std::size_t> order(set.segments.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), random);
    SegmentSet moved = set;
    for (std::size_t s = 0; s < order.size(); ++s) {
      moved.segments[s] = set.segments[order[s]];
      if (s % 2 != 0) std::swap(moved.segments[s][0], moved.segments[s][1]);
    }
    const ExactMesh second = mesh_of(moved, 3);
    // the same places in another order
    const auto n = static_cast<std::int32_t>(set.xy.size() / 2);
    ASSERT_EQ(first.parents.size(), second.parents.size());
    std::map<std::array<double, 2>, std::int32_t> places;
    for (std::size_t i = 0; i < first.parents.size(); ++i)
      places[{first.added_xy[2 * i], first.added_xy[2 * i + 1]}] = n + static_cast<std::int32_t>(i);
    ASSERT_EQ(places.size(), first.parents.size());
    const auto number = [&](std::int32_t v) {
      if (v < n) return v;
      const auto i = 2 * static_cast<std::size_t>(v - n);
      return places.at({second.added_xy[i], second.added_xy[i + 1]});
    };
    std::vector<Triangle> found;
    for (const Triangle& t : triangles(second)) found.push_back({number(t[0]), number(t[1]), number(t[2])});
    make_canonical(found);
    EXPECT_EQ(found, triangles(first));
    for (std::size_t s = 0; s < order.size(); ++s) {
      std::vector<std::int32_t> chain(second.vertices.begin() + second.offsets[s],
                                      second.vertices.begin() + second.offsets[s + 1]);
      for (std::int32_t& v : chain) v = number(v);
      if (s % 2 != 0) std::reverse(chain.begin(), chain.end());
      const std::vector<std::int32_t> expected(first.vertices.begin() + first.offsets[order[s]],
                                               first.vertices.begin() + first.offsets[order[s] + 1]);
      ASSERT_EQ(chain, expected);
    }
  }
}

TEST(ExactCrossings, PointsOnALineHaveChainsAlone) {
  const std::vector<double> xy = {0, 0, 1, 1, 2, 2, 3, 3};
  const ExactMesh mesh = triangulate_with_crossings(xy, std::vector<Segment>{{3, 0}}, triangulate(xy), 1);
  EXPECT_TRUE(mesh.triangles.empty());
  EXPECT_EQ(mesh.vertices, (std::vector<std::int32_t>{3, 2, 1, 0}));
}

/// A hub, and segments that pass it: no more than the edges at the other ends are looked at.
TEST(ExactCrossingsOfAdversaries, AHubThatSegmentsPass) {
  SegmentSet set{"", {0, 0}, {}};
  for (std::int32_t i = 0; i < 100000; ++i) {
    set.xy.insert(set.xy.end(), {-1e5, 1.0 * i - 3e4, 1e5, 3e4 - 1.0 * i});
    set.segments.push_back({2 * i + 1, 2 * i + 2});
  }
  const ExactMesh mesh = mesh_of(set);
  EXPECT_EQ(constrained(mesh).size(), 200000U);
}

/// Ends a call that takes longer than it should.
class Deadline {
 public:
  explicit Deadline(double seconds) {
    if (CADT_SANITIZED) seconds *= 10;
    options_.stop = source_.get_token();
    options_.progress = [this, seconds, begin = std::chrono::steady_clock::now()](const Progress&) {
      ++told;
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > seconds)
        source_.request_stop();
    };
  }
  [[nodiscard]] constraints::StopCheck check() const { return constraints::StopCheck(options_, 0); }
  std::size_t told = 0;

 private:
  cadt::stop_source source_;
  Options options_;
};

/// Spokes of a wheel that a square crosses. Inserted one beside the other, each would cross the edges behind all that
/// are still to come: minutes for these.
TEST(ExactCrossingsOfAdversaries, SpokesOfAWheel) {
  constexpr std::int32_t spokes = 16000;
  SegmentSet set{"", {}, {}};
  for (std::int32_t i = 0; i < spokes; ++i) {
    const double angle = 6.28318530717958648 * (i + 0.123) / spokes;
    set.xy.insert(set.xy.end(), {std::cos(angle), std::sin(angle)});
    set.segments.push_back({i, spokes});
  }
  set.xy.insert(set.xy.end(), {0, 0, -0.3, -0.3, 0.3, -0.3, 0.3, 0.3, -0.3, 0.3});
  for (std::int32_t k = 0; k < 4; ++k) set.segments.push_back({spokes + 1 + k, spokes + 1 + (k + 1) % 4});
  const Deadline deadline(30);
  const ExactMesh mesh = triangulate_with_crossings(set.xy, set.segments, triangulate(set.xy), 1, deadline.check());
  EXPECT_EQ(mesh.parents.size(), static_cast<std::size_t>(spokes));
  EXPECT_EQ(constrained(mesh).size(), static_cast<std::size_t>(3 * spokes + 4));
}

/// Along one edge between two rows all triangles have their apex next to an end.
TEST(ExactCrossingsOfAdversaries, AnEdgeBetweenTwoRows) {
  constexpr std::int32_t count = 60000;
  for (const double bent : {0.0, 1e-6}) {
    SegmentSet set{"", {-1, 0.5, count, 0.5}, {{0, 1}}};
    for (std::int32_t i = 0; i < count; ++i)
      set.xy.insert(set.xy.end(), {1.0 * i, 0, 1.0 * i, 1 + bent * i * (count - i)});
    const Deadline deadline(4);
    const ExactMesh mesh = triangulate_with_crossings(set.xy, set.segments, triangulate(set.xy), 1, deadline.check());
    EXPECT_EQ(constrained(mesh), (Edges{{0, 1}}));
    expect_connected(mesh, "rows");
  }
}

/// The same in every direction, where rows are not straight or go back, and of crossings.
TEST(ExactCrossings, SidesThatDoNotDivideEqualCgal) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> shift(0, 0.3);
  for (const int kind : {0, 1, 2, 3, 4, 5, 6}) {
    SegmentSet set{"rows, kind " + std::to_string(kind), {-2, 0.5, 1700, 0.5}, {{0, 1}}};
    for (std::int32_t i = 0; i < 1700; ++i) {
      const double x = i, up = 1 + (kind == 1 ? 1e-4 * x * (1700 - x) : kind == 2 ? shift(random) : 0);
      const auto v = static_cast<std::int32_t>(set.xy.size() / 2);
      if (kind == 3 && i % 3 != 0) continue;
      if (kind == 4) {
        set.xy.insert(set.xy.end(), {x, 0, x, 0.75, x, 1});
        set.segments.push_back({v + 1, v + 2});
      } else if (kind == 3) {
        set.xy.insert(set.xy.end(), {x, 0, x, 0.8, x + 1, 1.3, x + 1, 0.8 + shift(random), x, 1.3});
        set.segments.insert(set.segments.end(), {{v + 1, v + 2}, {v + 3, v + 4}});
      } else if (kind == 5) {  // slanted teeth
        set.xy.insert(set.xy.end(), {x, 1, x - 2, 3, x - 0.3, 1.8, x + 0.5, 0.4});
        set.segments.push_back({v, v + 1});
      } else if (kind == 6) {  // two columns below the ends
        set.xy.insert(set.xy.end(), {-2 + 0.1 * shift(random), -x - 1, 1700 + 0.1 * shift(random), -x - 1});
        if (i == 0) set.xy.insert(set.xy.end(), {850, 900});
      } else {
        set.xy.insert(set.xy.end(), {x, 1 - up, x, up});
      }
    }
    expect_as_cgal(set);
    for (std::size_t i = 0; i < set.xy.size(); i += 2) set.xy[i] = -set.xy[i];
    expect_as_cgal(set);
    for (std::size_t i = 0; i < set.xy.size(); i += 2) std::swap(set.xy[i], set.xy[i + 1]);
    expect_as_cgal(set);
  }
}

/// Slanted teeth above an edge: its side goes back again and again, and takes no quadratic time.
TEST(ExactCrossingsOfAdversaries, AnEdgeBelowSlantedTeeth) {
  constexpr std::int32_t count = 40000;
  SegmentSet set{"", {-10, 0.95, count + 5, 0.95}, {{0, 1}}};
  for (std::int32_t i = 0; i < count; ++i) {
    const auto v = static_cast<std::int32_t>(set.xy.size() / 2);
    set.xy.insert(set.xy.end(), {1.0 * i, 1, i - 2.0, 3, i - 0.3, 1.8, i + 0.5, 0.9});
    set.segments.push_back({v, v + 1});
  }
  const Deadline deadline(4);
  const ExactMesh mesh = triangulate_with_crossings(set.xy, set.segments, triangulate(set.xy), 1, deadline.check());
  EXPECT_EQ(constrained(mesh).size(), set.segments.size());
  expect_connected(mesh, "teeth");
}

/// Of a side that takes long, however it is filled, the caller hears all the while.
TEST(ExactCrossingsOfAdversaries, ALongSideIsHeardOf) {
  constexpr std::int32_t count = 200000;
  SegmentSet set{"", {-1, 0.5, count, 0.5}, {{0, 1}}};
  for (std::int32_t i = 0; i < count; ++i) set.xy.insert(set.xy.end(), {1.0 * i, 0, 1.0 * i, 1});
  const Triangulation delaunay = triangulate(set.xy);
  const Deadline none(1e9);
  const auto begin = std::chrono::steady_clock::now();
  (void)triangulate_with_crossings(set.xy, set.segments, delaunay, 1, none.check());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_GE(static_cast<double>(none.told), seconds / 0.1) << seconds;  // at most each 0.05 s
}

/// All segments from the first point of a line to each other one: it is known what they have before it is listed.
TEST(ExactCrossings, ChainsThatAreTooLongAreRefusedAtOnce) {
  constexpr std::int32_t count = 93000;  // more than 2^32 vertices along segments
  SegmentSet set{"", {}, {}};
  for (std::int32_t i = 0; i <= count; ++i) {
    set.xy.insert(set.xy.end(), {1.0 * i, 0.0});
    if (i > 0) set.segments.push_back({0, i});
  }
  const constraints::Arrangement in = constraints::arrange(set.xy, set.segments, 1);
  EXPECT_THROW((void)constraints::divide_segments(in, set.segments), LimitError);
}

TEST(ExactCrossings, AreStoppedByTheCallerWhoHearsOfThem) {
  const SegmentSet set = random_segments(7, 300, 0.5);
  for (const unsigned threads : {1U, 3U}) {
    Options options;
    cadt::stop_source source;
    std::size_t told = 0;
    options.stop = source.get_token();
    options.progress = [&](const Progress& progress) {
      EXPECT_EQ(progress.phase, "cross");
      EXPECT_EQ(progress.fraction, 0.5);
      ++told;
      source.request_stop();
    };
    EXPECT_THROW((void)triangulate_with_crossings(set.xy, set.segments, triangulate(set.xy), threads,
                                                  constraints::StopCheck(options, 0.5)),
                 Cancelled);
    EXPECT_EQ(told, 1U);
  }
}

}  // namespace
}  // namespace cadt::test
