// SPDX-License-Identifier: Apache-2.0
// Snap rounding against all pairs of segments and pixels, with whole numbers.
#include "common/constraints/grid/snap_rounding.hpp"
#include "common/constraints/crossings/arrangement.hpp"
#include "tests/unit/constraints/segment_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace cadt::test {
namespace {

using constraints::snap_segments;
using constraints::SnappedSegments;
using Place = std::array<double, 2>;
using Chain = std::vector<Place>;

Place place(const std::vector<double>& xy, std::int32_t i) {
  return {xy[2 * static_cast<std::size_t>(i)], xy[2 * static_cast<std::size_t>(i) + 1]};
}

std::vector<Chain> chains(const SnappedSegments& snapped) {
  std::vector<Chain> all(snapped.offsets.size() - 1);
  for (std::size_t s = 0; s < all.size(); ++s)
    for (std::int64_t i = snapped.offsets[s]; i < snapped.offsets[s + 1]; ++i)
      all[s].push_back(place(snapped.xy, snapped.vertices[static_cast<std::size_t>(i)]));
  return all;
}

/// The edges of the chains, each once.
std::vector<Segment> edges(const SnappedSegments& snapped) {
  std::set<Segment> all;
  for (std::size_t s = 0; s + 1 < snapped.offsets.size(); ++s)
    for (std::int64_t i = snapped.offsets[s]; i + 1 < snapped.offsets[s + 1]; ++i) {
      const auto [low, high] =
          std::minmax(snapped.vertices[static_cast<std::size_t>(i)], snapped.vertices[static_cast<std::size_t>(i) + 1]);
      all.insert({low, high});
    }
  return {all.begin(), all.end()};
}

/// Edges have nothing in common but their ends, and no other point lies on one.
void expect_planar(const SnappedSegments& snapped, const std::string& name) {
  const auto all = constraints::arrange(snapped.xy, edges(snapped), 1);
  EXPECT_TRUE(all.crossings.empty()) << name;
  EXPECT_EQ(all.wall_offsets.size() - 1, all.segments.size()) << name << ": edges overlap";
  EXPECT_EQ(all.chain_vertices.size(), 2 * all.segments.size()) << name << ": a point lies on an edge";
}

// Reference: coordinates are whole, sides of pixels are multiples of 1/2, and parameters along a segment fractions.
__extension__ typedef __int128 Whole;
struct Fraction {
  Whole up, down;  // down > 0
};
bool less(const Fraction& a, const Fraction& b) { return a.up * b.down < b.up * a.down; }
bool same(const Fraction& a, const Fraction& b) { return a.up * b.down == b.up * a.down; }
Whole floor(Whole up, Whole down) { return up / down - (up % down != 0 && (up < 0) != (down < 0)); }

/// Where a segment enters pixel (x, y), if it passes it.
bool enters(const std::array<Whole, 4>& s, Whole x, Whole y, Whole g, Fraction& in) {
  Fraction low{0, 1}, high{1, 1};
  bool low_open = false, high_open = false;
  for (std::size_t k = 0; k < 2; ++k) {
    const Whole from = (2 * (k == 0 ? x : y) - 1) * g, to = from + 2 * g, a = 2 * s[k], d = 2 * (s[k + 2] - s[k]);
    if (d == 0) {
      if (a < from || a >= to) return false;
      continue;
    }
    const bool up = d > 0;  // a + t d >= from and a + t d < to
    const Fraction first{(up ? from - a : a - to), up ? d : -d}, last{(up ? to - a : a - from), up ? d : -d};
    if (less(low, first) || same(low, first)) low_open = same(low, first) ? low_open || !up : !up, low = first;
    if (less(last, high) || same(last, high)) high_open = same(last, high) ? high_open || up : up, high = last;
  }
  in = low;
  return less(low, high) || (same(low, high) && !low_open && !high_open);
}

std::vector<Chain> chains_by_brute_force(const SegmentSet& set, std::int64_t width) {
  const Whole g = width;
  std::vector<std::array<Whole, 4>> s;
  for (const Segment& segment : set.segments) {
    const Place a = place(set.xy, segment[0]), b = place(set.xy, segment[1]);
    s.push_back(
        {static_cast<Whole>(a[0]), static_cast<Whole>(a[1]), static_cast<Whole>(b[0]), static_cast<Whole>(b[1])});
  }
  std::set<std::array<std::int64_t, 2>> hot;
  const auto add = [&](Whole x, Whole y, Whole w) {
    hot.insert({static_cast<std::int64_t>(floor(2 * x + g * w, 2 * g * w)),
                static_cast<std::int64_t>(floor(2 * y + g * w, 2 * g * w))});
  };
  for (std::size_t i = 0; i < set.xy.size(); i += 2)
    add(static_cast<Whole>(set.xy[i]), static_cast<Whole>(set.xy[i + 1]), 1);
  for (const auto& [i, j] : crossings_by_brute_force(set)) {
    const auto &p = s[static_cast<std::size_t>(i)], &q = s[static_cast<std::size_t>(j)];
    const Whole ux = p[2] - p[0], uy = p[3] - p[1], vx = q[2] - q[0], vy = q[3] - q[1];
    Whole w = ux * vy - uy * vx, t = (q[0] - p[0]) * vy - (q[1] - p[1]) * vx;
    if (w < 0) w = -w, t = -t;
    add(p[0] * w + t * ux, p[1] * w + t * uy, w);
  }
  std::vector<Chain> all(s.size());
  for (std::size_t i = 0; i < s.size(); ++i) {
    std::vector<std::pair<Fraction, Place>> passed;
    Fraction in;
    for (const auto& [x, y] : hot)
      if (enters(s[i], x, y, g, in))
        passed.emplace_back(in, Place{static_cast<double>(x * width), static_cast<double>(y * width)});
    std::sort(passed.begin(), passed.end(), [&](const auto& a, const auto& b) {
      if (!same(a.first, b.first)) return less(a.first, b.first);
      // where a segment runs through a corner, from the pixel that it is in for one point only to the next
      const Whole dx = s[i][2] - s[i][0], dy = s[i][3] - s[i][1];
      const double along =
          static_cast<double>(dx) * (b.second[0] - a.second[0]) + static_cast<double>(dy) * (b.second[1] - a.second[1]);
      return along > 0;
    });
    if (passed.size() > 1)
      for (const auto& p : passed) all[i].push_back(p.second);
  }
  return all;
}

TEST(SnapRounding, EqualsAllPairsOfSegmentsAndPixels) {
  std::size_t passed = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed)
    for (const std::int64_t width : {1, 2, 3, 4, 10}) {
      const SegmentSet set = lattice_segments(seed, 6 + static_cast<int>(seed % 40), 8 + seed % 20, 1, 1);
      const SnappedSegments snapped = snap_segments(set.xy, set.segments, static_cast<double>(width), 1);
      ASSERT_EQ(chains(snapped), chains_by_brute_force(set, width)) << set.name << ", width " << width;
      expect_planar(snapped, set.name);
      ASSERT_TRUE(std::is_sorted(snapped.parents.begin(), snapped.parents.end())) << set.name;
      passed += snapped.vertices.size();
    }
  EXPECT_GT(passed, 50000U);
}

TEST(SnapRounding, EqualsAllPairsInLargeCoordinates) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SegmentSet set = lattice_segments(seed, 1 << 20, 40, 1, 1);
    for (double& v : set.xy) v -= 0x1p19;
    for (const std::int64_t width : {1, 1000, 1 << 14, 1 << 17}) {
      const SnappedSegments snapped = snap_segments(set.xy, set.segments, static_cast<double>(width), 1);
      ASSERT_EQ(chains(snapped), chains_by_brute_force(set, width)) << set.name << ", width " << width;
      expect_planar(snapped, set.name);
    }
  }
}

TEST(SnapRounding, HalvesGoUpwards) {
  const std::vector<double> xy = {0.5, -0.5, 1.5, 2.5, -1.5, 0.49999999999999994};
  const SnappedSegments snapped = snap_segments(xy, {}, 1, 1);
  EXPECT_EQ(snapped.xy, (std::vector<double>{1, 0, 2, 3, -1, 0}));
  EXPECT_EQ(snap_segments(std::vector<double>{0.3, 0.1}, {}, 0.25, 1).xy, (std::vector<double>{0.25, 0}));
}

TEST(SnapRounding, ByHand) {
  // crossings at (5/3, 5/3) and (3, 0.6)...; the lower end of the third is near the first segment
  const std::vector<double> xy = {0, 0, 10, 0, 0, 1, 10, -1, 3, 5};
  const std::vector<Segment> segments = {{0, 1}, {3, 2}, {4, 4}};
  const SnappedSegments snapped = snap_segments(xy, segments, 1, 1);
  EXPECT_EQ(snapped.offsets, (std::vector<std::int64_t>{0, 3, 6, 6}));
  EXPECT_EQ(snapped.vertices, (std::vector<std::int32_t>{0, 5, 1, 3, 5, 2}));
  EXPECT_EQ(place(snapped.xy, 5), (Place{5, 0}));
  EXPECT_EQ(snapped.parents, (std::vector<std::array<std::int32_t, 2>>{{0, 1}}));
}

TEST(SnapRounding, SegmentsOfOnePixelVanish) {
  const std::vector<double> xy = {0.1, 0.1, 0.2, 0.3, 5, 5, -0.4, 0.4};
  const SnappedSegments snapped = snap_segments(xy, std::vector<Segment>{{0, 1}, {1, 2}, {3, 0}}, 1, 1);
  EXPECT_EQ(snapped.offsets, (std::vector<std::int64_t>{0, 0, 2, 2}));
  EXPECT_EQ(snapped.vertices, (std::vector<std::int32_t>{0, 2}));  // the lowest point of the pixel
}

/// A point beside a long segment stays on its side, or comes to lie on it.
TEST(SnapRounding, PlanarForAnyInput) {
  for (const SegmentSet& set : small_segment_sets()) {
    double most = 0;
    for (const double v : set.xy) most = std::max(most, std::abs(v));
    if (most == 0) continue;
    for (const double cells : {3.0, 20.0, 1000.0, 0x1p23}) {
      const double width = std::max(most / cells, std::numeric_limits<double>::denorm_min());
      if (!std::isfinite(most + width)) continue;
      const SnappedSegments snapped = snap_segments(set.xy, set.segments, width, 1);
      expect_planar(snapped, set.name + ", cells " + std::to_string(cells));
      for (std::size_t i = 0; i < set.xy.size(); ++i)
        ASSERT_LE(std::abs(snapped.xy[i] - set.xy[i]), width * 0.5000001) << set.name;
    }
  }
}

TEST(SnapRounding, OrderDirectionAndThreadsDoNotMatter) {
  std::mt19937_64 random(11);
  for (const SegmentSet& set : {random_segments(5, 10000, 0.02), lattice_segments(6, 300, 100, 1, 1)}) {
    const double width = set.xy.size() > 10000 ? 0x1p-10 : 3;
    const SnappedSegments first = snap_segments(set.xy, set.segments, width, 1);
    SegmentSet moved = set;
    std::vector<std::size_t> order(set.segments.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), random);
    for (std::size_t s = 0; s < order.size(); ++s) {
      moved.segments[s] = set.segments[order[s]];
      if (s % 2 != 0) std::swap(moved.segments[s][0], moved.segments[s][1]);
    }
    const SnappedSegments second = snap_segments(moved.xy, moved.segments, width, 3);
    const std::vector<Chain> expected = chains(first);
    std::vector<Chain> found = chains(second);
    for (std::size_t s = 0; s < order.size(); ++s) {
      if (s % 2 != 0) std::reverse(found[s].begin(), found[s].end());
      ASSERT_EQ(found[s], expected[order[s]]);
    }
    EXPECT_EQ(first.parents.size(), second.parents.size());
    EXPECT_GT(first.parents.size(), 50U);
  }
}

TEST(SnapRounding, RefusesGrids) {
  const std::vector<double> xy = {0, 0, 0x1p30, 1};
  const auto refused = [&](double grid) {
    try {
      (void)snap_segments(xy, {}, grid, 1);
    } catch (const OptionError& error) {
      return error.option() == "grid" && std::string(error.what()).starts_with("ConstraintOptions::grid: ");
    }
    return false;
  };
  for (const double grid :
       {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan(""), 0x1p-22, 0x1p-30, 0.1, 1e308})
    EXPECT_TRUE(refused(grid)) << grid;
  for (const double grid : {0x1p-21, 3.0, 1.5, 100.1}) EXPECT_FALSE(refused(grid)) << grid;
}

TEST(SnapRounding, TakesTheWidthThatAnErrorNames) {
  const std::vector<double> xy = {0, 0, 0x1p27, 1};
  for (const double grid : {1e-3, 1e-4, 1e-5, 3e-7}) {
    try {
      (void)snap_segments(xy, {}, grid, 1);
      ADD_FAILURE() << grid;
    } catch (const OptionError& error) {
      const std::string what = error.what(), before = "such as ";
      const double named = std::stod(what.substr(what.find(before) + before.size()));
      EXPECT_GE(named, grid);
      EXPECT_LT(named, 2 * grid);
      EXPECT_NO_THROW((void)snap_segments(xy, {}, named, 1)) << what;
    }
  }
}

}  // namespace
}  // namespace cadt::test
