// SPDX-License-Identifier: Apache-2.0
// The verifier of meshes whose points have moved to a grid, and of seeds beside crossings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/constraints/mesh_copy.hpp"
#include "tests/unit/constraints/segment_sets.hpp"

namespace cadt::test {
namespace {

using Data = ConstrainedTriangulation::Data;

ConstraintOptions on_grid(double width) {
  ConstraintOptions options;
  options.crossing = Crossing::grid;
  options.grid = width;
  return options;
}

ConstrainedTriangulation made(const SegmentSet& set, const ConstraintOptions& constraints) {
  Options host;
  host.backend = Backend::host;
  host.threads = 1;
  return triangulate_constrained(set.xy, set.segments, constraints, host);
}

/// The names of the checks that fail, and what they say.
std::string failures(const SegmentSet& set, const ConstrainedTriangulation& mesh, const ConstraintOptions& options) {
  const VerifyReport report = verify(set.xy, set.segments, mesh, options);
  std::string names;
  for (const Check& check : report.checks)
    if (!check.passed) names += (names.empty() ? "" : "; ") + check.name + ": " + check.what;
  EXPECT_EQ(report.ok, names.empty());
  return names;
}

TEST(VerifyGrid, CorrectMeshes) {
  for (const SegmentSet& set : small_segment_sets()) {
    SCOPED_TRACE(set.name);
    double most = 0;
    for (const double v : set.xy) most = std::max(most, std::abs(v));
    if (most == 0) continue;
    const double unit = std::exp2(std::floor(std::log2(most)));
    for (const double part : {0x1p-3, 0x1p-12, 0x1p-40, 0.3, 0.001}) {
      const double width = unit * part;
      if (!(width > 0) || !std::isfinite(4 * most)) continue;
      EXPECT_EQ(failures(set, made(set, on_grid(width)), on_grid(width)), "") << width;
    }
  }
  // All ends on the sides of cells, and segments through their corners.
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const SegmentSet set = lattice_segments(seed, 12, 12, 0.5, 0.5);
    for (const double width : {1.0, 0.5, 3.0}) EXPECT_EQ(failures(set, made(set, on_grid(width)), on_grid(width)), "");
  }
}

TEST(VerifyGrid, AnotherRuleOrWidth) {
  const SegmentSet set = random_segments(4, 60, 0.4);
  const ConstrainedTriangulation mesh = made(set, on_grid(0x1p-8));
  ASSERT_GT(mesh.added_points().size(), 20U);
  EXPECT_EQ(failures(set, mesh, on_grid(0x1p-8)), "");
  for (const double width : {0x1p-7, 0x1p-9, 3.0, 0x1p-1074, 0.0, -1.0, std::nan("")})
    EXPECT_TRUE(failures(set, mesh, on_grid(width)).starts_with("constraints: ")) << width;
  ConstraintOptions exact;
  exact.crossing = Crossing::exact;
  for (const ConstraintOptions& other : {ConstraintOptions(), exact})
    EXPECT_EQ(failures(set, mesh, other),
              "constraints: points have moved to a grid, and the rule of crossings is another");
  EXPECT_EQ(failures(set, made(set, exact), on_grid(0x1p-8)),
            "constraints: the rule is a grid, and no point has moved");
}

TEST(VerifyGrid, OtherPoints) {
  const SegmentSet set = random_segments(4, 60, 0.4);
  const ConstrainedTriangulation mesh = made(set, on_grid(0x1p-8));
  for (std::size_t i = 0; i < set.xy.size(); ++i) {
    SegmentSet other = set;
    other.xy[i] += 0x1p-8;
    EXPECT_EQ(failures(other, mesh, on_grid(0x1p-8)),
              "constraints: point " + std::to_string(i / 2) + " has not moved to the centre of its cell");
  }
  auto data = copy_of(mesh);
  data->added[0] += 0x1p-20;
  EXPECT_EQ(failures(set, ConstrainedTriangulation(std::move(data)), on_grid(0x1p-8)),
            "constraints: point " + std::to_string(set.xy.size() / 2) + " is not on the grid");
}

/// The lower side of a cell is part of it, the upper one is not.
TEST(VerifyGrid, PointsOnTheSidesOfCells) {
  for (const double width : {1.0, 0.1, 0x1p-1074, 0x1p1010, 1e-310}) {
    for (const double k : {-7.0, 0.0, 1.0, 1000.0}) {
      const double side = width == 0x1p-1074 ? k * width : (k + 0.5) * width;
      const SegmentSet set{"", {side, side, side + 5 * width, side, side, side + 9 * width}, {{0, 1}}};
      const ConstrainedTriangulation mesh = made(set, on_grid(width));
      EXPECT_EQ(failures(set, mesh, on_grid(width)), "") << width << " " << k;
      if (width != 1.0 && width != 0x1p1010) continue;  // else sides are no doubles
      SegmentSet below = set, above = set;
      below.xy[0] = std::nextafter(side, -std::numeric_limits<double>::infinity());
      EXPECT_EQ(failures(below, mesh, on_grid(width)), "constraints: point 0 has not moved to the centre of its cell");
      above.xy[1] = std::nextafter(side + width, -std::numeric_limits<double>::infinity());
      EXPECT_EQ(failures(above, mesh, on_grid(width)), "") << width << " " << k;
      above.xy[1] = side + width;
      EXPECT_EQ(failures(above, mesh, on_grid(width)), "constraints: point 0 has not moved to the centre of its cell");
    }
  }
}

/// A segment past a corner of the cell of point 2, whose last copy goes from end to end by that vertex, or back and
/// forth.
void expect_other_ways_refused(const std::vector<double>& xy, const Segment& copy, bool meets) {
  const SegmentSet set{"", xy, {{0, 1}, {0, 2}, {2, 1}, copy}};
  const ConstrainedTriangulation mesh = made(set, on_grid(1));
  EXPECT_EQ(failures(set, mesh, on_grid(1)), "");
  const auto begin = static_cast<std::size_t>(mesh.chain_offsets()[3]);
  const auto chain = mesh.chain_vertices().subspan(begin);
  EXPECT_EQ(std::ranges::find(chain, 2) != chain.end(), meets);
  if (meets) return;
  const auto with = [&](const std::vector<std::int32_t>& way) {
    auto data = copy_of(mesh);
    data->chain_vertices.resize(begin);
    data->chain_vertices.insert(data->chain_vertices.end(), way.begin(), way.end());
    data->chain_offsets[4] = static_cast<std::int64_t>(data->chain_vertices.size());
    return failures(set, ConstrainedTriangulation(std::move(data)), on_grid(1));
  };
  EXPECT_EQ(with({copy[0], 2, copy[1]}),
            "constraints: the chain of segment 3 at vertex 2 is in a cell that the segment does not meet");
  EXPECT_NE(with({copy[0], copy[1], copy[0], copy[1]}).find("has another direction"), std::string::npos);
}

TEST(VerifyGrid, ChainsThroughOtherCells) {
  struct Case {
    const char* corner;
    double ax, ay, bx, by;
    bool meets;
  };
  for (const Case& c : {Case{"upper left", 0, -4, 9, 5, false}, Case{"lower right", 1, -5, 10, 4, false},
                        Case{"upper right", 1, 5, 10, -4, false}, Case{"lower left", 0, 4, 9, -5, true},
                        Case{"none", 0, -6, 9, 9, false}}) {
    SCOPED_TRACE(c.corner);
    for (const Segment& copy : {Segment{0, 1}, Segment{1, 0}})
      expect_other_ways_refused({c.ax, c.ay, c.bx, c.by, 5, 0}, copy, c.meets);
  }
}

/// Between a piece of a segment and the same piece with its crossing rounded.
TEST(VerifySeeds, BesideACrossing) {
  const double x = 5.940366972477064, y = 6.217889908256881;
  const SegmentSet set{
      "", {0, 0, 10, 0, 10, 10, 0, 10, 0, 8, 10, 5, 5, 0, 8, 10}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {6, 7}}};
  ASSERT_EQ(exact_orientation({0, 8}, {10, 5}, {x, y}), 1);
  ConstraintOptions options;
  options.crossing = Crossing::exact;
  options.domain = Domain::seeds;
  options.holes = {{x, y}};
  options.regions = {{x, y, 7}};
  const ConstrainedTriangulation mesh = made(set, options);
  ASSERT_EQ(mesh.added_points().size(), 2U);
  ASSERT_EQ(exact_orientation({0, 8}, {mesh.added_points()[0], mesh.added_points()[1]}, {x, y}), -1);
  EXPECT_EQ(failures(set, mesh, options), "");
  std::size_t eaten = 0;
  for (std::size_t t = 0; t < mesh.inside().size(); ++t) {
    const auto corners = mesh.mesh().triangle(t);
    const bool above_left =
        std::ranges::all_of(corners, [](std::int32_t v) { return v == 3 || v == 4 || v == 7 || v == 8; });
    EXPECT_EQ(mesh.inside()[t], above_left ? 0 : 1) << t;
    EXPECT_EQ(mesh.region_attribute()[static_cast<std::size_t>(mesh.region()[t])], above_left ? 7 : 0);
    eaten += above_left ? 1 : 0;
  }
  EXPECT_EQ(eaten, 2U);
  // As the rounded triangles have it: the verifier says no.
  ConstraintOptions below = options;
  below.holes = {{x, y - 0.001}};
  below.regions = {{x, y - 0.001, 7}};
  EXPECT_TRUE(failures(set, made(set, below), options).starts_with("regions: "));
}

}  // namespace
}  // namespace cadt::test
