// SPDX-License-Identifier: Apache-2.0
// The special cases that ConstrainedTriangulation promises, one by one.
#include <cadt/cadt.hpp>
#include <cadt/constrained.hpp>

#include "tests/system/constrained/constrained_check.hpp"
#include "tests/system/constrained/legal_segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace cadt::test {
namespace {

using Chain = std::vector<std::int32_t>;

Chain chain(const ConstrainedTriangulation& mesh, std::size_t s) {
  const auto offsets = mesh.chain_offsets();
  const auto vertices = mesh.chain_vertices();
  return {vertices.begin() + offsets[s], vertices.begin() + offsets[s + 1]};
}

std::vector<std::int32_t> sources(const ConstrainedTriangulation& mesh, Segment edge) {
  const auto edges = mesh.constrained_edges();
  const auto at = std::ranges::find(edges, edge);
  if (at == edges.end()) return {};
  const auto e = static_cast<std::size_t>(at - edges.begin());
  const auto all = mesh.edge_sources();
  return {all.begin() + mesh.source_offsets()[e], all.begin() + mesh.source_offsets()[e + 1]};
}

void expect_points(const PointsView& points, const Points& expected) {
  ASSERT_EQ(2 * points.size(), expected.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points.x(i), expected[2 * i]);
    EXPECT_EQ(points.y(i), expected[2 * i + 1]);
  }
}

using SpecialCases = ConstrainedTest;

/// A square of 4 with its corners, two points inside, and a duplicate of the first corner.
const Points square = {0, 0, 4, 0, 4, 4, 0, 4, 1, 2, 3, 1, 0, 0};

TEST_P(SpecialCases, NoPointsOneAndTwo) {
  const ConstrainedTriangulation none = triangulated({}, {});
  EXPECT_EQ(none.mesh().number_of_triangles(), 0U);
  EXPECT_EQ(none.chain_offsets().size(), 1U);
  EXPECT_TRUE(none.constrained_edges().empty());
  EXPECT_EQ(none.number_inside(), 0U);
  const ConstrainedTriangulation one = triangulated({5, 5}, {{0, 0}});
  EXPECT_EQ(chain(one, 0), Chain());
  EXPECT_TRUE(std::ranges::equal(one.degenerate_segments(), Chain{0}));
  const ConstrainedTriangulation two = triangulated({5, 5, 6, 5}, {{1, 0}, {1, 1}, {0, 1}});
  EXPECT_EQ(two.mesh().dimension(), 1);
  EXPECT_EQ(chain(two, 0), (Chain{1, 0}));
  EXPECT_EQ(chain(two, 2), (Chain{0, 1}));
  EXPECT_TRUE(std::ranges::equal(two.degenerate_segments(), Chain{1}));
  EXPECT_EQ(sources(two, {0, 1}), (Chain{-1, 2}));
  const ConstrainedTriangulation same = triangulated({5, 5, 5, 5}, {{0, 1}, {1, 0}});
  EXPECT_TRUE(std::ranges::equal(same.degenerate_segments(), (Chain{0, 1})));
}

TEST_P(SpecialCases, BadIndex) {
  const std::vector<Points> sets = {{}, {0, 0}, {0, 0, 1, 1, 2, 2}, square};
  for (const Points& xy : sets) {
    const auto n = static_cast<std::int32_t>(xy.size() / 2);
    for (const std::int32_t bad :
         {n, n + 1, -1, -n - 1, std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min()}) {
      for (const bool first : {false, true}) {
        SCOPED_TRACE(std::to_string(bad) + " of " + std::to_string(n) + (first ? ", the first end" : ""));
        const std::int32_t good = 0;
        std::vector<Segment> segments;
        if (n > 0) segments = {{0, n - 1}, {n - 1, 0}};
        const std::size_t expected = segments.size();
        segments.push_back(first ? Segment{bad, good} : Segment{n > 0 ? good : bad, bad});
        segments.push_back({bad, bad});
        try {
          static_cast<void>(triangulated(xy, segments));
          ADD_FAILURE() << "no error";
        } catch (const InputError& error) {
          EXPECT_EQ(error.index(), expected) << error.what();
          const std::int32_t named = n > 0 ? bad : first ? bad : segments[expected][0];
          EXPECT_EQ(error.what(), "segment " + std::to_string(expected) + " ends at point " + std::to_string(named) +
                                      ", but there are " + std::to_string(n) + " points");
        }
      }
    }
  }
}

TEST_P(SpecialCases, ConstantsThatThereAreNot) {
  const Points xy = uniform_points(20, 4);
  const std::vector<Segment> segments = {{0, 1}};
  ConstraintOptions crossing, domain;
  crossing.crossing = static_cast<Crossing>(9);
  domain.domain = static_cast<Domain>(-1);
  for (const auto& [options, name] : {std::pair(crossing, "crossing"), std::pair(domain, "domain")}) {
    try {
      (void)triangulate_constrained(std::span<const double>(xy), segments, options, GetParam().options());
      ADD_FAILURE() << name;
    } catch (const OptionError& error) {
      EXPECT_EQ(error.option(), name);
    }
  }
}

TEST_P(SpecialCases, HolesAndRegionsWithoutSeeds) {
  const Points xy = uniform_points(20, 4);
  const std::vector<Segment> segments = {{0, 1}};
  const auto refused = [&](const ConstraintOptions& options) -> std::string {
    try {
      (void)triangulate_constrained(std::span<const double>(xy), segments, options, GetParam().options());
    } catch (const OptionError& error) {
      return error.what();
    }
    return "";
  };
  for (const Domain domain : {Domain::hull, Domain::outer, Domain::even_odd, Domain::nonzero, Domain::layers}) {
    EXPECT_EQ(refused({.domain = domain, .holes = {{0, 0}}}),
              "ConstraintOptions::holes: these are for Domain::seeds: set it as the domain, or leave them out");
    EXPECT_EQ(refused({.domain = domain, .regions = {{0, 0, 1}}}),
              "ConstraintOptions::regions: these are for Domain::seeds: set it as the domain, or leave them out");
  }
  EXPECT_EQ(refused({.domain = Domain::seeds, .holes = {{0, 0}}, .regions = {{0, 0, 1}}}), "");
}

TEST_P(SpecialCases, WithoutSegmentsTheMeshIsThatOfTriangulate) {
  const std::vector<Points> sets = {square, uniform_points(500), grid_points(9, 9), {0, 0, 1, 1, 2, 2}, {3, 3}};
  for (const Points& xy : sets) {
    const Triangulation plain = triangulate(std::span<const double>(xy), GetParam().options());
    const ConstrainedTriangulation mesh = check(xy, {});
    EXPECT_EQ(mesh.mesh().hash(), plain.hash());
    EXPECT_EQ(mesh.hash(), plain.hash());
    EXPECT_TRUE(std::ranges::equal(mesh.mesh().triangles(), plain.triangles()));
    EXPECT_TRUE(std::ranges::all_of(mesh.edge_flags(), [](std::uint32_t flags) { return flags == 0; }));
    // Segments of no length are none, too.
    const ConstrainedTriangulation other = check(xy, {{0, 0}});
    EXPECT_EQ(other.hash(), plain.hash());
    EXPECT_TRUE(std::ranges::equal(other.degenerate_segments(), Chain{0}));
  }
}

TEST_P(SpecialCases, EndsAtEqualPointsAreThoseOfTheRepresentative) {
  const ConstrainedTriangulation mesh = check(square, {{6, 2}, {0, 2}, {2, 6}, {0, 6}});
  EXPECT_EQ(mesh.hash(), check(square, {{0, 2}}).hash());
  EXPECT_EQ(chain(mesh, 0), (Chain{0, 2}));
  EXPECT_EQ(chain(mesh, 2), (Chain{2, 0}));
  EXPECT_TRUE(std::ranges::equal(mesh.degenerate_segments(), Chain{3}));
  EXPECT_EQ(sources(mesh, {0, 2}), (Chain{-3, 0, 1}));
}

TEST_P(SpecialCases, ZeroMinusZeroIsAPoint) {
  const Points xy = {0.0, 0.0, -0.0, 0.0, 2, 1, 1, -3, 0.0, -0.0};
  const ConstrainedTriangulation mesh = check(xy, {{1, 2}, {0, 4}, {4, 3}});
  EXPECT_EQ(chain(mesh, 0), (Chain{0, 2}));
  EXPECT_EQ(chain(mesh, 1), Chain());
}

TEST_P(SpecialCases, RepeatedAndOverlapping) {
  Drawing drawing;
  for (int i = 0; i <= 10; ++i) drawing.add(i, 3 * i);  // on a line
  for (int i = 0; i < 10; ++i) drawing.add(i + 0.5, 3 * i + (i % 2 == 0 ? 4 : -1));
  drawing.segments = {{0, 6}, {4, 10}, {10, 0}, {3, 5}, {5, 3}, {3, 5}};
  const ConstrainedTriangulation mesh = check(drawing.xy, drawing.segments);
  EXPECT_EQ(chain(mesh, 0), (Chain{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(chain(mesh, 2), (Chain{10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0}));
  EXPECT_EQ(sources(mesh, {4, 5}), (Chain{-5, -3, 0, 1, 3, 5}));
  EXPECT_EQ(sources(mesh, {6, 7}), (Chain{-3, 1}));
}

TEST_P(SpecialCases, PointsOnASegmentDivideIt) {
  Drawing drawing;
  drawing.add(0, 0);
  drawing.add(7, 7);
  for (int i = 1; i < 7; ++i) drawing.add(i % 2 == 0 ? i : i + 0.25, i);  // every second lies on it
  drawing.join(0, 1);
  const ConstrainedTriangulation mesh = check(drawing.xy, drawing.segments);
  EXPECT_EQ(chain(mesh, 0), (Chain{0, 3, 5, 7, 1}));
  EXPECT_EQ(mesh.constrained_edges().size(), 4U);
}

TEST_P(SpecialCases, DanglingIsolatedAndHull) {
  Drawing drawing;
  drawing.xy = uniform_points(200, 3);
  const std::int32_t n = 200;
  drawing.xy.insert(drawing.xy.end(),
                    {-1, -1, 2, -1, 2, 2, -1, 2, -0.5, -0.5, 1.5, -0.4, 0.25, 0.5, 0.75, 0.5, 0.5, -1});
  drawing.segments = {{n, n + 1}, {n + 1, n + 2}, {n + 2, n + 3}, {n + 3, n}};  // the hull, its lower side with a point
  drawing.segments.push_back({n + 4, n + 5});                                   // apart from all others
  drawing.segments.push_back({n + 6, n + 7});                                   // loose, inside
  drawing.segments.push_back({n + 6, n + 4});                                   // a branch
  const ConstrainedTriangulation mesh = check(drawing.xy, drawing.segments);
  EXPECT_EQ(chain(mesh, 0), (Chain{n, n + 8, n + 1}));
  EXPECT_EQ(mesh.number_of_regions(), 1U);
}

TEST_P(SpecialCases, AllPointsOnALine) {
  const std::vector<Points> lines = {
      {3, 0, 1, 0, 2, 0, 0, 0, 2, 0}, {0, 3, 0, 1, 0, 2, 0, 0, 0, 2}, {3, -9, 1, -3, 2, -6, 0, 0, 2, -6}};
  for (const Points& xy : lines) {
    const std::vector<Segment> segments = {{0, 3}, {3, 4}, {2, 2}, {4, 2}, {1, 0}};
    const ConstrainedTriangulation mesh = check(xy, segments);
    EXPECT_EQ(mesh.mesh().dimension(), 1);
    EXPECT_EQ(chain(mesh, 0), (Chain{0, 2, 1, 3}));
    EXPECT_EQ(chain(mesh, 1), (Chain{3, 1, 2}));
    EXPECT_EQ(chain(mesh, 4), (Chain{1, 2, 0}));
    EXPECT_TRUE(std::ranges::equal(mesh.degenerate_segments(), (Chain{2, 3})));
    EXPECT_EQ(mesh.constrained_edges().size(), 3U);
    EXPECT_TRUE(mesh.edge_flags().empty());
    EXPECT_EQ(mesh.number_inside(), 0U);
    EXPECT_EQ(mesh.number_of_regions(), 0U);
  }
}

TEST_P(SpecialCases, CrossingAtAPointIsNone) {
  check({0, 0, 2, 2, 0, 2, 2, 0, 1, 1}, {{0, 1}, {2, 3}});
  try {
    static_cast<void>(triangulated({0, 0, 2, 2, 0, 2, 2, 0, 1, 1.0000000000000002}, {{0, 1}, {2, 3}, {1, 0}, {1, 1}}));
    ADD_FAILURE() << "no error";
  } catch (const CrossingError& error) {
    EXPECT_EQ(error.pairs(), (std::vector<std::array<std::int32_t, 2>>{{0, 1}, {1, 2}}));
  }
}

/// The points that a mesh keeps are its vertices: with crossings those of the input and the added ones, on a grid those
/// that have moved.
TEST_P(SpecialCases, PointsAreKeptWhereTheyAreVertices) {
  const Points cross = {0, 0, 10, 0, 10, 10, 0, 10, 3.25, 3.75};
  for (const KeepPoints how : {KeepPoints::no, KeepPoints::copy, KeepPoints::view}) {
    for (const Crossing crossing : {Crossing::error, Crossing::exact, Crossing::grid}) {
      SCOPED_TRACE(std::to_string(static_cast<int>(how)) + ", " + std::to_string(static_cast<int>(crossing)));
      Triangulator triangulator(GetParam().options());
      if (crossing == Crossing::grid && !triangulator.device().fp64) continue;
      triangulator.options().keep_points = how;
      ConstraintOptions constraints;
      constraints.crossing = crossing;
      constraints.grid = 1;
      const std::vector<Segment> segments = {{0, 2}, {1, 3}};
      std::vector<double> xy = cross;
      const std::size_t count = crossing == Crossing::error ? 1 : 2;
      const ConstrainedTriangulation mesh =
          triangulator.triangulate_constrained(xy, std::span(segments).first(count), constraints);
      const PointsView kept = mesh.mesh().points();
      if (how == KeepPoints::no) {
        EXPECT_EQ(kept.size(), 0U);
        continue;
      }
      Points expected = cross;
      if (crossing == Crossing::exact) expected.insert(expected.end(), {5, 5});
      if (crossing == Crossing::grid) expected = {0, 0, 10, 0, 10, 10, 0, 10, 3, 4, 5, 5};
      EXPECT_EQ(kept.x_data() == xy.data(), how == KeepPoints::view && crossing == Crossing::error);
      if (crossing != Crossing::error) xy.assign(xy.size(), 7);
      expect_points(kept, expected);
    }
  }
}

/// Crossings that are equal once they are rounded are made one by one, on the host.
TEST_P(SpecialCases, PointsAreKeptWithCrossingsThatRoundToOnePlace) {
  const Points xy = {0, 0, 3, 3, 0, 3, 3, 0, 0, std::nextafter(1.5, 0), 3, 1.5};
  const std::vector<Segment> segments = {{0, 1}, {2, 3}, {4, 5}};
  ConstraintOptions constraints;
  constraints.crossing = Crossing::exact;
  Triangulator triangulator(GetParam().options());
  if (!triangulator.device().fp64) GTEST_SKIP() << "takes no doubles";
  for (const KeepPoints how : {KeepPoints::copy, KeepPoints::view}) {
    triangulator.options().keep_points = how;
    const ConstrainedTriangulation mesh = triangulator.triangulate_constrained(xy, segments, constraints);
    Points expected = xy;
    expected.insert(expected.end(), mesh.added_points().begin(), mesh.added_points().end());
    EXPECT_EQ(expected.size(), 18U);
    expect_points(mesh.mesh().points(), expected);
  }
}

/// Pieces that cross none of the constrained edges of the Delaunay mesh, but one another.
TEST_P(SpecialCases, CrossingOfInsertedSegments) {
  const Points xy = uniform_points(400, 5);
  Random random(9);
  int refused = 0;
  for (int round = 0; round < 30; ++round) {
    std::vector<Segment> segments;
    for (int i = 0; i < 2 + round / 3; ++i)
      segments.push_back({static_cast<std::int32_t>(random.below(400)), static_cast<std::int32_t>(random.below(400))});
    std::vector<std::array<std::int32_t, 2>> expected;
    for (std::size_t i = 0; i < segments.size(); ++i)
      for (std::size_t j = i + 1; j < segments.size(); ++j)
        if (crosses(xy, segments[i], segments[j]))
          expected.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)});
    if (expected.empty()) {
      check(xy, segments);
      continue;
    }
    ++refused;
    try {
      static_cast<void>(triangulated(xy, segments));
      ADD_FAILURE() << "no error";
    } catch (const CrossingError& error) {
      EXPECT_EQ(error.pairs(), expected);
    }
  }
  EXPECT_GT(refused, 10);
}

// A segment through many triangles is not walked along at once, so nobody knows of the points on it: it is divided
// at one of them, and then again.
TEST_P(SpecialCases, PointsOnALongSegment) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto n = static_cast<std::int32_t>(100 + random.below(400));
    Points xy;
    for (std::int32_t i = 0; i < n; ++i) xy.insert(xy.end(), {random.uniform(0, 1), random.uniform(0, 0.3)});
    xy.insert(xy.end(), {-0.1, 0.15, 1.1, 0.15});
    const double first = random.uniform(0, 1), step = seed % 3 == 0 ? 0.1 : 0.01;
    for (std::uint64_t i = 0; i < 1 + seed % 4; ++i) xy.insert(xy.end(), {first + step * static_cast<double>(i), 0.15});
    check(xy, {{n, n + 1}});
  }
}

// On GPUs one team inserts the last pieces. Here one of them has become an edge by what others have inserted, and is
// found to be one in the turn in which the other one, which crosses it, is inserted.
TEST_P(SpecialCases, CrossingOfWhatHasBecomeAnEdge) {
  const Points xy = {0, 6, 6, 0, 2, 2, 7, 4, 2, 4, 3, 3, 3, 7, 5, 6, 7, 2};
  const std::vector<Segment> segments = {{1, 1}, {6, 8}, {5, 2}, {8, 4}, {6, 5}, {6, 6}};
  for (int round = 0; round < 6; ++round) {
    std::vector<Segment> in_order(segments);
    std::ranges::rotate(in_order, in_order.begin() + round);
    try {
      static_cast<void>(triangulated(xy, in_order));
      ADD_FAILURE() << "no error";
    } catch (const CrossingError& error) {
      EXPECT_EQ(error.pairs().size(), 1U);
    }
  }
}

/// A long segment crosses a constrained edge at the side of a cavity that is filled in the launch before: the flag of
/// the edge goes along.
TEST_P(SpecialCases, CrossingOfAnEdgeBesideACavity) {
  Points xy = uniform_points(8000, 6);
  xy.insert(xy.end(), {-0.1, 0.5, 1.1, 0.51});
  const Segment across = {8000, 8001};
  const Triangulation plain = triangulate(std::span<const double>(xy), GetParam().options());
  const auto place = [&](std::int32_t v) {
    const auto i = 2 * static_cast<std::size_t>(v);
    return std::array<double, 2>{xy[i], xy[i + 1]};
  };
  int tried = 0;
  for (std::size_t t = 0; t < plain.number_of_triangles() && tried < 40; ++t) {
    const std::array<std::int32_t, 3> v = plain.triangle(t);
    for (std::size_t k = 0; k < 3; ++k) {
      // The edge between the other two corners, and the diagonal from one of them across the next edge.
      const std::int32_t next = plain.neighbor(t, (k + 1) % 3);
      const Segment edge = {v[(k + 1) % 3], v[(k + 2) % 3]};
      if (next < 0 || !crosses(xy, across, edge)) continue;
      for (const std::int32_t w : plain.triangle(static_cast<std::size_t>(next))) {
        const Segment diagonal = {edge[0], w};
        if (std::ranges::find(v, w) != v.end() || crosses(xy, across, diagonal)) continue;
        if (exact_orientation(place(edge[0]), place(edge[1]), place(w)) <= 0 ||
            exact_orientation(place(edge[0]), place(w), place(v[k])) <= 0)
          continue;
        ++tried;
        try {
          static_cast<void>(triangulated(xy, {across, edge, diagonal}));
          ADD_FAILURE() << "no error";
        } catch (const CrossingError& error) {
          EXPECT_EQ(error.pairs(), (std::vector<std::array<std::int32_t, 2>>{{0, 1}}));
        }
      }
    }
  }
  EXPECT_GT(tried, 20);
}

CADT_ON_MAIN_BACKENDS(SpecialCases);

}  // namespace
}  // namespace cadt::test
