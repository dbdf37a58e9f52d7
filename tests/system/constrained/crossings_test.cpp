// SPDX-License-Identifier: Apache-2.0
// Segments that cross, on every back end: the pairs of brute force, and the exact mesh of the host's own way, by
// implicit points and one vertex after the other, that is compared with CGAL's elsewhere (exact_crossings_test.cpp).
#include <cadt/constrained.hpp>
#include <cadt/errors.hpp>

#include "common/constraints/exact_mesh/exact_triangulation.hpp"
#include "tests/support/backends.hpp"
#include "tests/support/exact_mesh.hpp"
#include "tests/support/families.hpp"
#include "tests/system/constrained/resident_check.hpp"
#include "tests/unit/constraints/segment_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace cadt::test {
namespace {

class Crossings : public BackendTest {
 protected:
  [[nodiscard]] static bool has_doubles() { return Triangulator(GetParam().options()).device().fp64; }

  /// Sets are taken one of so many: launches take long on OpenCL devices that are processors.
  [[nodiscard]] static std::size_t every() { return GetParam().backend == Backend::opencl ? 7 : 1; }

  /// Whether the mesh was made with rounded crossings, and certified.
  bool check(const SegmentSet& set) const {
    SCOPED_TRACE(set.name);
    ConstraintOptions constraints;
    constraints.crossing = Crossing::exact;
    Options options = GetParam().options();
    options.tuning.kernel_times = true;
    const ConstrainedTriangulation mesh = triangulate_constrained(set.xy, set.segments, constraints, options);
    const auto& kernels = mesh.mesh().statistics().kernels;
    const bool certified = std::ranges::find(kernels, "cadt_certify_places", &KernelTime::name) != kernels.end();
    if (mesh.mesh().dimension() < 2) return certified;

    const Triangulation delaunay = triangulate(set.xy);
    const ExactMesh exact = triangulate_with_crossings(set.xy, set.segments, delaunay, 1);
    std::vector<std::uint32_t> flags;
    const Triangulation expected = triangulation_of(delaunay, exact, exact.added_xy, flags);
    EXPECT_TRUE(std::ranges::equal(mesh.mesh().triangles(), expected.triangles()));
    EXPECT_TRUE(std::ranges::equal(mesh.mesh().neighbors(), expected.neighbors()));
    EXPECT_TRUE(std::ranges::equal(mesh.mesh().hull(), expected.hull()));
    EXPECT_TRUE(std::ranges::equal(mesh.mesh().duplicates(), expected.duplicates()));
    EXPECT_TRUE(std::ranges::equal(mesh.edge_flags(), flags));
    EXPECT_TRUE(std::ranges::equal(mesh.chain_offsets(), exact.offsets));
    EXPECT_TRUE(std::ranges::equal(mesh.chain_vertices(), exact.vertices));
    EXPECT_TRUE(std::ranges::equal(mesh.added_points(), exact.added_xy));
    EXPECT_TRUE(std::ranges::equal(mesh.added_parents(), exact.parents));
    EXPECT_EQ(mesh.rounded_valid(), exact.rounded_valid);
    EXPECT_EQ(mesh.mesh().number_of_points(), expected.number_of_points());
    for (const Check& found : verify(set.xy, set.segments, mesh, constraints, {.threads = 1}).checks)
      if (found.name == "constraints" || mesh.rounded_valid()) {
        EXPECT_TRUE(found.passed) << found.name << ": " << found.what;
      }
    constraints.domain = set.segments.size() % 2 == 0 ? Domain::layers : Domain::seeds;
    if (constraints.domain == Domain::seeds) constraints.holes = {{0.5, 0.5}};
    expect_same_in_device_memory(GetParam().options(), set.xy, set.segments, constraints);
    return certified;
  }

  void expect_pairs(const SegmentSet& set) const {
    SCOPED_TRACE(set.name);
    std::vector<Segment> found;
    try {
      (void)triangulate_constrained(set.xy, set.segments, {}, GetParam().options());
    } catch (const CrossingError& e) {
      found.assign(e.pairs().begin(), e.pairs().end());
    }
    EXPECT_EQ(found, crossings_by_brute_force(set));
  }
};

TEST_P(Crossings, PairsOfSmallSets) {
  const std::vector<SegmentSet> sets = small_segment_sets();
  for (std::size_t i = 0; i < sets.size(); i += every()) expect_pairs(sets[i]);
}

TEST_P(Crossings, ExactMeshesOfSmallSets) {
  int certified = 0, others = 0;
  const std::vector<SegmentSet> sets = small_segment_sets();
  for (std::size_t i = 0; i < sets.size(); i += every()) check(sets[i]) ? ++certified : ++others;
  // Several segments through one place, and places that rounding moves to one, are left to the host.
  const int few = 20 / static_cast<int>(every());
  EXPECT_GT(others, few);
  EXPECT_GT(certified, has_doubles() ? few : -1);
}

TEST_P(Crossings, OnAGridInDeviceMemory) {
  ConstraintOptions constraints;
  constraints.crossing = Crossing::grid;
  const std::vector<SegmentSet> sets = small_segment_sets();
  for (std::size_t i = 0; i < sets.size(); i += every()) {
    SCOPED_TRACE(sets[i].name);
    constraints.grid = i % 2 == 0 ? 0.25 : 1;
    constraints.domain = i % 3 == 0 ? Domain::hull : Domain::layers;
    expect_same_in_device_memory(GetParam().options(), sets[i].xy, sets[i].segments, constraints);
  }
}

TEST_P(Crossings, RandomSegments) {
  for (std::uint64_t seed = 1; seed <= 12; seed += every()) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SegmentSet set = random_segments(seed, 40 * seed, 0.4);
    expect_pairs(set);
    EXPECT_EQ(check(set), has_doubles());
  }
}

/// So many that some of them are looked at first: they need not be left to the sweep, or, as spokes that a square
/// crosses, they are.
TEST_P(Crossings, ManySegments) {
  const SegmentSet set = random_segments(13, 5000, 0.02);
  expect_pairs(set);
  EXPECT_EQ(check(set), has_doubles());
  SegmentSet wheel{"wheel", {0, 0, -0.3, -0.3, 0.3, -0.3, 0.3, 0.3, -0.3, 0.3}, {{1, 2}, {2, 3}, {3, 4}, {4, 1}}};
  for (std::int32_t i = 0; i < 6000; ++i) {
    const double angle = 6.28318530717958648 * (i + 0.123) / 6000;
    wheel.xy.insert(wheel.xy.end(), {std::cos(angle), std::sin(angle)});
    wheel.segments.push_back({0, 5 + i});
  }
  expect_pairs(wheel);
}

/// Crossings with the same x come in the order of y, upwards or downwards.
TEST_P(Crossings, OnVerticalSegments) {
  for (const double down : {-1.0, 1.0}) {
    SegmentSet set{"vertical", {1.0, -9.0 * down, 1.0, 9.0 * down}, {{0, 1}}};
    for (const double y : {-3.0, 5.0, 1.0, -6.5}) {
      const auto v = static_cast<std::int32_t>(set.xy.size() / 2);
      set.xy.insert(set.xy.end(), {0.0, y, 2.5, y + 0.3});
      set.segments.push_back({v, v + 1});
    }
    EXPECT_EQ(check(set), has_doubles());
  }
}

/// Crossings on the axes have a coordinate of 0, which no bound on a rounding error is small enough for.
TEST_P(Crossings, CoordinatesThatOnlyWholeNumbersFind) {
  SegmentSet set{"stars around the origin", {}, {}};
  for (int i = 1; i <= 40; ++i) {
    const double x = i + 1.0 / 3, y = std::cos(i) * 7;
    const auto v = static_cast<std::int32_t>(set.xy.size() / 2);
    set.xy.insert(set.xy.end(), {-x, y, x, -y, -x, 9.0 + i, x, 9.0 + i});
    set.segments.push_back({v, v + 1});  // all through the origin
    set.segments.push_back({v + 2, v + 3});
  }
  set.xy.insert(set.xy.end(), {0.0, -60.0, 0.0, 60.0});
  set.segments.push_back(
      {static_cast<std::int32_t>(set.xy.size() / 2 - 2), static_cast<std::int32_t>(set.xy.size() / 2 - 1)});
  check(set);
  std::erase_if(set.segments, [](const Segment& s) { return s[0] % 4 == 0 && s[1] == s[0] + 1 && s[0] < 160; });
  EXPECT_EQ(check(set), has_doubles());
}

/// Flat segments above an edge of the hull, whose crossing is so near to it that it may be rounded to the outside.
TEST_P(Crossings, AtTheHull) {
  int certified = 0, others = 0;
  for (std::uint64_t seed = 1; seed <= 60; seed += every()) {
    SegmentSet set{"seed " + std::to_string(seed), {}, {}};
    Random random(seed);
    const double x = random.uniform(1, 3), y = random.uniform(0.1, 1), up = random.uniform(1, 4);
    const double t = random.uniform(0.6, 0.9);
    // The lowest doubles above the line from (0, 0) to (x, y), or one or two higher.
    const auto above = [&](double part) {
      double v = y * part * (1 - 1e-15);
      while (exact_orientation({0, 0}, {x, y}, {x * part, v}) <= 0) v = std::nextafter(v, 9.0);
      for (int i = 0; i < static_cast<int>(seed % 3); ++i) v = std::nextafter(v, 9.0);
      return v;
    };
    set.xy = {0.0, 0.0, x, y, x * t, above(t), x * (1 - t), above(1 - t), x / 2, up};
    set.segments = {{0, 2}, {1, 3}};
    check(set) ? ++certified : ++others;
  }
  EXPECT_GT(others, 0);
  EXPECT_GT(certified, has_doubles() ? 0 : -1);
}

/// A hole between a piece of a segment and the same piece with its crossing rounded, on the side of the exact one.
TEST_P(Crossings, SeedBesideARoundedPiece) {
  const SegmentSet set{
      "", {0, 0, 10, 0, 10, 10, 0, 10, 0, 8, 10, 5, 5, 0, 8, 10}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {6, 7}}};
  ConstraintOptions constraints;
  constraints.crossing = Crossing::exact;
  constraints.domain = Domain::seeds;
  constraints.holes = {{5.940366972477064, 6.217889908256881}};
  constraints.regions = {{5.940366972477064, 6.217889908256881, 3}};
  const ConstrainedTriangulation mesh =
      triangulate_constrained(set.xy, set.segments, constraints, GetParam().options());
  for (std::size_t t = 0; t < mesh.inside().size(); ++t) {
    const auto corners = mesh.mesh().triangle(t);
    const bool above = std::ranges::find(corners, 3) != corners.end();  // with the point at (0, 10)
    EXPECT_EQ(mesh.inside()[t], above ? 0 : 1) << t;
  }
  EXPECT_EQ(mesh.number_inside() + 2, mesh.inside().size());
  expect_same_in_device_memory(GetParam().options(), set.xy, set.segments, constraints);
}

/// Two segments, and where they cross, rounded: the end of the first piece of either.
struct RoundedCross {
  SegmentSet set;
  double x, y;
};
RoundedCross random_cross(std::uint64_t seed) {
  RoundedCross cross{{"seed " + std::to_string(seed), {}, {{0, 1}, {2, 3}}}, 0, 0};
  Random random(seed);
  const double turn = random.uniform(0, 6);
  const double far = seed % 2 == 0 ? 0 : 400000;  // rounding moves a crossing by more there
  for (int i = 0; i < 4; ++i) {                   // ends of the first, then of the second
    const double angle = turn + (i % 2 == 0 ? 0 : 3.14159) + (i < 2 ? 0 : 1.5708) + random.uniform(-0.2, 0.2);
    const double length = random.uniform(0.9, 1.1);
    cross.set.xy.insert(cross.set.xy.end(), {length * std::cos(angle) + 3 + far, length * std::sin(angle) + 2 + far});
  }
  const std::array<Segment, 1> pairs = {Segment{0, 1}};
  const Triangulation delaunay = triangulate(cross.set.xy);
  const ExactMesh exact = triangulate_with_crossings(cross.set.xy, cross.set.segments, delaunay, 1);
  EXPECT_TRUE(std::ranges::equal(exact.parents, pairs));
  cross.x = exact.added_xy.at(0);
  cross.y = exact.added_xy.at(1);
  return cross;
}

/// A vertex so near to the circle of a crossing and two ends that an edge is legal with the rounded place and illegal
/// with the exact one, or the other way round.
TEST_P(Crossings, CircleThroughACrossing) {
  int certified = 0, others = 0, far = 0;
  for (std::uint64_t seed = 1; seed <= 80; seed += every()) {
    auto [set, x, y] = random_cross(seed);
    const double ax = set.xy[0] - x, ay = set.xy[1] - y, bx = set.xy[4] - x, by = set.xy[5] - y;
    const double a = ax * ax + ay * ay, b = bx * bx + by * by, area = 2 * (ax * by - ay * bx);
    // Opposite of the crossing.
    const double px = x + 2 * (by * a - ay * b) / area, py = y + 2 * (ax * b - bx * a) / area;
    set.xy.insert(set.xy.end(), {px, py});
    const bool right = check(set);
    ++(right ? certified : others);
    if (!right && x > 1000) ++far;
  }
  EXPECT_GT(others, 0);
  // The exact mesh of the host has the filter in common with the certificate, so a wrong bound does not show in it.
  if (every() == 1) {
    EXPECT_GT(far, 0);
  }
  EXPECT_GT(certified, has_doubles() ? 0 : -1);
}

/// A vertex at the rounded place of a crossing: it is not the crossing.
TEST_P(Crossings, VertexAtARoundedCrossing) {
  for (std::uint64_t seed = 1; seed <= 10; seed += every()) {
    auto [set, x, y] = random_cross(seed);
    set.xy.insert(set.xy.end(), {x, y});
    EXPECT_FALSE(check(set));
  }
}

/// The first segment runs above the line x = y, and is on it if it ends at the rounded place of the crossing.
TEST_P(Crossings, VertexOnARoundedPiece) {
  SegmentSet set{"a vertex below a segment",
                 {1.0, 1.0, 3.0, std::nextafter(3.0, 4.0), 1.25, 0.5, 1.25, 2.0, 1.125, 1.125, 1.5, 3.0},
                 {{0, 1}, {2, 3}}};
  EXPECT_FALSE(check(set));
}

/// Vertices between exact and rounded pieces, with segments of their own that the rounded ones may cross.
TEST_P(Crossings, VerticesBesideRoundedPieces) {
  int certified = 0, others = 0;
  for (std::uint64_t seed = 1; seed <= 40; seed += every()) {
    auto [set, x, y] = random_cross(seed);
    Random random(seed);
    const double side = random.uniform(-1, 1);
    for (int i = 0; i < 3; ++i) {
      const double t = random.uniform(0.1, 0.9), vx = x + t * (set.xy[0] - x), vy = y + t * (set.xy[1] - y);
      const auto v = static_cast<std::int32_t>(set.xy.size() / 2);
      set.xy.insert(set.xy.end(), {vx, vy});
      if (seed % 2 == 0) continue;
      set.xy.insert(set.xy.end(), {vx - 0.05 * side * (set.xy[1] - y), vy + 0.05 * side * (set.xy[0] - x)});
      set.segments.push_back({v, v + 1});
    }
    check(set) ? ++certified : ++others;
  }
  EXPECT_GT(others, 0);
  EXPECT_GT(certified, has_doubles() ? 0 : -1);
}

/// So many segments through the same triangles that a sweep finds them.
TEST_P(Crossings, BundleThroughTheSameTriangles) {
  SegmentSet set{"bundle", {}, {}};
  Random random(4);
  const int count = 900;
  for (int i = 0; i < count; ++i) {
    const auto v = static_cast<std::int32_t>(set.xy.size() / 2);
    set.xy.insert(set.xy.end(),
                  {0.0, i * 1e-6 + random.uniform(0, 1) * 1e-7, 1.0, i * 1e-6 + random.uniform(0, 1) * 1e-5});
    set.segments.push_back({v, v + 1});
  }
  for (int i = 0; i < 2000; ++i) set.xy.insert(set.xy.end(), {random.uniform(0, 1), random.uniform(0, 1) - 0.5});
  expect_pairs(set);
}

/// Several segments through one place, and others along each other: the host finds the crossings, and the mesh is that
/// of rounded places all the same.
TEST_P(Crossings, SeveralAtOnePlace) {
  SegmentSet set{"lattice", {}, {}};
  const auto add = [&](double x, double y, double u, double v) {
    const auto first = static_cast<std::int32_t>(set.xy.size() / 2);
    set.xy.insert(set.xy.end(), {x, y, u, v});
    set.segments.push_back({first, first + 1});
  };
  for (int i = 0; i < 9; ++i) {
    add(-1, i + 0.25, 9, i + 0.25);
    add(i + 0.25, -1, i + 0.25, 9);
  }
  add(-0.5, -0.5, 8.5, 8.5);
  add(8.625, 8.625, 0.5, 0.5);
  add(-1, 9.5, 9.5, -1);
  set.segments.push_back(set.segments[3]);
  set.segments.push_back({set.segments[4][1], set.segments[4][0]});
  set.xy.insert(set.xy.end(), {2.25, 2.25, 3, 3, 2.25, 2.25});  // at a crossing, on the diagonals, and a duplicate
  EXPECT_EQ(check(set), has_doubles());
  expect_pairs(set);
}

/// Where the device has no memory for the crossings that the host finds, the host makes the mesh with its own. (Pieces
/// are so close that probes of long ones find triangles beyond their ends, too.)
TEST_P(Crossings, WithoutMemoryForThemOnTheDevice) {
  SegmentSet set{"all cross", {}, {}};
  constexpr int n = 300;
  for (int i = 0; i < n; ++i) {
    const auto v = static_cast<std::int32_t>(set.xy.size() / 2);
    set.xy.insert(set.xy.end(), {0, 1.0 * i, 1000, n - i + 1.0 / (i + 2)});
    set.segments.push_back({v, v + 1});
  }
  ConstraintOptions constraints;
  constraints.crossing = Crossing::exact;
  Options options = GetParam().options();
  const ConstrainedTriangulation expected = triangulate_constrained(set.xy, set.segments, constraints, options);
  EXPECT_EQ(expected.added_parents().size(), std::size_t{n * (n - 1) / 2});
  options.max_memory = std::size_t{6} << 20;
  const ConstrainedTriangulation mesh = triangulate_constrained(set.xy, set.segments, constraints, options);
  EXPECT_EQ(mesh.hash(), expected.hash());
  EXPECT_LE(mesh.statistics().bytes_device_peak, options.max_memory);
}

/// A hatch and one slanted segment across it: with exact places alone, each triangle of a fan takes as long as the fan.
TEST_P(Crossings, HatchIsDoneInRoundedPlaces) {
  if (!has_doubles()) GTEST_SKIP() << "the host makes the mesh with exact places alone";
  constexpr std::int32_t n = 3000;
  SegmentSet set{"hatch", {}, {}};
  for (std::int32_t i = 0; i < n; ++i) {
    const double s = i * 1e-3;
    set.xy.insert(set.xy.end(), {s, -s, s + n, n - s});
    set.segments.push_back({2 * i, 2 * i + 1});
  }
  set.xy.insert(set.xy.end(), {n / 4 + 0.3, 0, n / 4 - 0.31, n / 2});
  set.segments.push_back({2 * n, 2 * n + 1});
  ConstraintOptions constraints;
  constraints.crossing = Crossing::exact;
  Options options = GetParam().options();
  options.tuning.kernel_times = true;
  const ConstrainedTriangulation mesh = triangulate_constrained(set.xy, set.segments, constraints, options);
  EXPECT_EQ(mesh.added_parents().size(), std::size_t{n});
  const auto& kernels = mesh.mesh().statistics().kernels;
  EXPECT_NE(std::ranges::find(kernels, "cadt_certify_places", &KernelTime::name), kernels.end());
  EXPECT_TRUE(verify(set.xy, set.segments, mesh, constraints, {.threads = 1}).ok);
}

CADT_ON_MAIN_BACKENDS(Crossings);

}  // namespace
}  // namespace cadt::test
