// SPDX-License-Identifier: Apache-2.0
// find_crossings against all pairs, and the arrangement that it comes from.
#include "common/constraints/crossings/crossings.hpp"
#include "common/constraints/crossings/sweep.hpp"
#include "tests/unit/constraints/segment_sets.hpp"

#include <gtest/gtest.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <string>

namespace cadt::test {
namespace {

using Pairs = std::vector<std::array<std::int32_t, 2>>;

Pairs pairs_of(const SegmentSet& set, unsigned threads = 1) {
  Options options;
  options.threads = threads;
  return find_crossings(set.xy, set.segments, options);
}

TEST(Crossings, EqualAllPairs) {
  std::size_t found = 0;
  for (const SegmentSet& set : small_segment_sets()) {
    const Pairs expected = crossings_by_brute_force(set);
    ASSERT_EQ(pairs_of(set), expected) << set.name;
    found += expected.size();
  }
  EXPECT_GT(found, 10000U);
}

TEST(Crossings, ByHand) {
  // two copies of a diagonal, the other one, a contact, a shared end, and one through the crossing's place
  const std::vector<double> xy = {0, 0, 4, 4, 0, 4, 4, 0, 1, 1, 1, 5, 0, 2, 4, 2};
  const std::vector<Segment> segments = {{0, 1}, {2, 3}, {1, 0}, {4, 5}, {0, 2}, {6, 7}};
  EXPECT_EQ(find_crossings(xy, segments), (Pairs{{0, 1}, {0, 5}, {1, 2}, {1, 3}, {1, 5}, {2, 5}, {3, 5}}));
  const auto all = constraints::arrange(xy, segments, 1);
  ASSERT_EQ(all.crossings.size(), 3U);  // (1, 2), (1, 3) and (2, 2)
  EXPECT_EQ(all.parents, (Pairs{{3, 5}, {1, 3}, {0, 1}}));
  EXPECT_EQ(all.crossings[2].x, 2);
  EXPECT_EQ(all.crossings[2].y, 2);
  EXPECT_EQ(all.member_offsets, (std::vector<std::int64_t>{0, 2, 4, 7}));
}

TEST(Crossings, APointAtTheCrossingTakesItAway) {
  const std::vector<Segment> segments = {{0, 1}, {2, 3}};
  EXPECT_EQ(find_crossings(std::vector<double>{0, 0, 2, 2, 0, 2, 2, 0}, segments).size(), 1U);
  EXPECT_EQ(find_crossings(std::vector<double>{0, 0, 2, 2, 0, 2, 2, 0, 1, 1}, segments).size(), 0U);
  const double beside = std::nextafter(1.0, 2.0);
  EXPECT_EQ(find_crossings(std::vector<double>{0, 0, 2, 2, 0, 2, 2, 0, 1, beside}, segments).size(), 1U);
  EXPECT_EQ(find_crossings(std::vector<double>{0, 0, 2, 2, 0, 2, 2, 0, beside, beside}, segments).size(), 1U);
  // a crossing at (1/3, 1/3), which no double is
  const std::vector<double> third = {0, 0, 1, 1, 1, -1, 0, 1, 1.0 / 3, 1.0 / 3};
  EXPECT_EQ(find_crossings(third, segments).size(), 1U);
}

TEST(Crossings, AreStoppedByTheCallerWhoHearsOfThem) {
  const SegmentSet set = random_segments(7, 300, 0.5);
  for (const unsigned threads : {1U, 3U}) {
    Options options;
    cadt::stop_source source;
    std::size_t told = 0;
    options.threads = threads;
    options.stop = source.get_token();
    options.progress = [&](const Progress& progress) {
      EXPECT_EQ(progress.phase, "cross");
      ++told;
      source.request_stop();
    };
    EXPECT_THROW((void)find_crossings(set.xy, set.segments, options), Cancelled);
    EXPECT_EQ(told, 1U);
  }
}

/// Neither in another rounding nor where tiny numbers are 0: there they would be missed.
TEST(Crossings, NoAnswerWithoutIeeeArithmetic) {
  const std::vector<double> tiny = {0, 0, 15e-324, 15e-324, 0, 15e-324, 15e-324, 0};
  const std::vector<Segment> segments = {{0, 1}, {2, 3}};
  const auto refused = [&] {
    try {
      (void)find_crossings(tiny, segments);
      return std::string();
    } catch (const Error& error) {
      return std::string(error.what());
    }
  };
  const int before = std::fegetround();
  ASSERT_EQ(std::fesetround(FE_TOWARDZERO), 0);
  const std::string rounded = refused();
  std::fesetround(before);
  EXPECT_NE(rounded.find("IEEE"), std::string::npos) << rounded;
#ifdef __SSE2__
  const unsigned mode = _mm_getcsr();
  for (const unsigned flag : {0x8000U, 0x0040U}) {  // flush to zero, denormals are zero
    _mm_setcsr(mode | flag);
    const std::string flushed = refused();
    _mm_setcsr(mode);
    EXPECT_NE(flushed.find("IEEE"), std::string::npos) << flag;
  }
#endif
  EXPECT_EQ(find_crossings(tiny, segments).size(), 1U);
}

TEST(Crossings, OrderAndDirectionDoNotMatter) {
  std::mt19937_64 random(7);
  for (const SegmentSet& set : small_segment_sets()) {
    const Pairs expected = pairs_of(set);
    const std::size_t n = set.xy.size() / 2, m = set.segments.size();
    std::vector<std::size_t> place(n), order(m);
    std::iota(place.begin(), place.end(), 0U);
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(place.begin(), place.end(), random);
    std::shuffle(order.begin(), order.end(), random);
    SegmentSet moved{set.name, std::vector<double>(2 * n), {}};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 2; ++k) moved.xy[2 * place[i] + k] = set.xy[2 * i + k];
    for (const std::size_t s : order) {
      Segment segment = set.segments[s];
      for (std::int32_t& end : segment) end = static_cast<std::int32_t>(place[static_cast<std::size_t>(end)]);
      if (random() % 2 != 0) std::swap(segment[0], segment[1]);
      moved.segments.push_back(segment);
    }
    Pairs found = pairs_of(moved);
    for (auto& pair : found) {
      for (std::int32_t& s : pair) s = static_cast<std::int32_t>(order[static_cast<std::size_t>(s)]);
      std::sort(pair.begin(), pair.end());
    }
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found, expected) << set.name;
  }
}

/// Mirrored in x, in y and in the diagonal the same segments cross.
TEST(Crossings, SymmetriesDoNotMatter) {
  for (const SegmentSet& set : small_segment_sets()) {
    const Pairs expected = pairs_of(set);
    for (int symmetry = 1; symmetry < 8; ++symmetry) {
      SegmentSet other = set;
      for (std::size_t i = 0; i < other.xy.size(); i += 2) {
        if ((symmetry & 1) != 0) other.xy[i] = -other.xy[i];
        if ((symmetry & 2) != 0) other.xy[i + 1] = -other.xy[i + 1];
        if ((symmetry & 4) != 0) std::swap(other.xy[i], other.xy[i + 1]);
      }
      ASSERT_EQ(pairs_of(other), expected) << set.name << " symmetry " << symmetry;
    }
  }
}

/// Slabs of one point each find what one sweep finds.
TEST(Crossings, SlabsOfOnePointFindTheSame) {
  for (const SegmentSet& set : small_segment_sets()) {
    const auto all = constraints::sort_segments(set.xy, set.segments);
    const auto points = static_cast<std::int32_t>(all.points.size());
    if (points == 0) continue;
    std::vector<std::int32_t> starts(all.points.size() + 1, 0);
    for (const auto& s : all.segments) ++starts[static_cast<std::size_t>(s[0]) + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::atomic<std::size_t> vertices = all.points.size();
    const auto whole = constraints::sweep_slab(all, starts, 0, points, vertices);
    std::size_t crossing = 0, contact = 0;
    for (std::int32_t r = 0; r < points; ++r) {
      const auto slab = constraints::sweep_slab(all, starts, r, r + 1, vertices);
      const auto first = static_cast<std::int32_t>(crossing);
      for (const auto& c : slab.contacts) {
        ASSERT_LT(contact, whole.contacts.size()) << set.name;
        const auto& expected = whole.contacts[contact++];
        ASSERT_EQ(all.segments[static_cast<std::size_t>(c.wall)][0] > r, false) << set.name << " slab " << r;
        ASSERT_EQ(c.vertex < 0 ? c.vertex - first : c.vertex, expected.vertex) << set.name << " slab " << r;
      }
      crossing += slab.crossings.size();
    }
    ASSERT_EQ(crossing, whole.crossings.size()) << set.name;
    ASSERT_EQ(contact, whole.contacts.size()) << set.name;
  }
}

/// Those of all slabs together, before there is memory for all of them.
TEST(Crossings, TooManyAreRefusedWhenTheyAreFound) {
  const std::vector<double> xy = {0, 0, 3, 0, 1, -1, 1, 1, 2, -1, 2, 1};
  const std::vector<Segment> segments = {{0, 1}, {2, 3}, {4, 5}};
  const auto all = constraints::sort_segments(xy, segments);
  const std::vector<std::int32_t> starts = {0, 1, 2, 2, 3, 3, 3};
  std::atomic<std::size_t> vertices = max_points() - 2;
  EXPECT_EQ(constraints::sweep_slab(all, starts, 0, 6, vertices).crossings.size(), 2U);
  EXPECT_EQ(vertices, max_points());
  vertices = max_points() - 1;
  EXPECT_THROW(constraints::sweep_slab(all, starts, 0, 6, vertices), LimitError);
}

/// Chains have every point on their segments and every crossing with others, in order.
TEST(Crossings, ChainsHaveWhatLiesOnSegments) {
  for (const SegmentSet& set : small_segment_sets()) {
    const auto all = constraints::arrange(set.xy, set.segments, 1);
    const exact::ImplicitPoints exact(all.lines);
    std::size_t crossings = 0;
    for (std::size_t s = 0; s < all.segments.size(); ++s) {
      std::size_t on = 0;
      for (std::size_t p = 0; p < all.points.size(); ++p) {
        const auto [a, b] = all.lines[s];
        on += verifier::orientation(a, b, all.points[p]) == 0 && !verifier::lexicographic_less(all.points[p], a) &&
              !verifier::lexicographic_less(b, all.points[p]);
      }
      const auto first = static_cast<std::size_t>(all.segment_first[s]);
      const auto last = static_cast<std::size_t>(all.segment_last[s]) + 1;
      ASSERT_EQ(all.chain_vertices[first], all.segments[s][0]) << set.name;
      ASSERT_EQ(all.chain_vertices[last - 1], all.segments[s][1]) << set.name;
      std::size_t points = 0;
      for (std::size_t i = first; i < last; ++i) {
        const auto p = all.place(all.chain_vertices[i]);
        points += static_cast<std::size_t>(all.chain_vertices[i]) < all.points.size();
        ASSERT_EQ(exact.orientation(exact::explicit_place(all.lines[s].a), exact::explicit_place(all.lines[s].b), p),
                  0);
        if (i > first) {
          ASSERT_LT(exact.compare(all.place(all.chain_vertices[i - 1]), p), 0) << set.name;
        }
      }
      ASSERT_EQ(points, on) << set.name << " segment " << s;
      crossings += last - first - points;
    }
    EXPECT_GE(crossings, all.members.size()) << set.name;
    for (std::size_t c = 0; c < all.crossings.size(); ++c) {
      if (c > 0) {
        ASSERT_LT(exact.compare(all.crossings[c - 1], all.crossings[c]), 0) << set.name;
      }
      for (auto m = static_cast<std::size_t>(all.member_offsets[c]);
           m < static_cast<std::size_t>(all.member_offsets[c + 1]); ++m)
        ASSERT_EQ(static_cast<std::size_t>(all.chain_vertices[static_cast<std::size_t>(all.members[m].position)]),
                  all.points.size() + c)
            << set.name;
    }
  }
}

/// From each point of a lattice to two near ones.
SegmentSet short_lattice_segments(std::int32_t side) {
  SegmentSet set{"short segments of a lattice", {}, {}};
  for (std::int32_t i = 0; i < side * side; ++i) {
    set.xy.insert(set.xy.end(), {1.0 * (i % side), 1.0 * (i / side)});
    for (const std::int32_t to : {i + 2 * side + 3, i + side - 1})
      if (to < side * side) set.segments.push_back({i, to});
  }
  return set;
}

TEST(Crossings, ThreadsDoNotMatter) {
  for (const SegmentSet& set : {random_segments(1, 6000, 0.02), short_lattice_segments(95)}) {
    const auto one = constraints::arrange(set.xy, set.segments, 1);
    for (const unsigned threads : {2U, 5U}) {
      const auto more = constraints::arrange(set.xy, set.segments, threads);
      EXPECT_EQ(more.parents, one.parents) << set.name;
      EXPECT_EQ(more.chain_vertices, one.chain_vertices) << set.name;
      EXPECT_EQ(more.member_offsets, one.member_offsets) << set.name;
    }
    EXPECT_GT(one.crossings.size(), 1000U);
  }
}

TEST(Crossings, SayWhichInputIsWrong) {
  const std::vector<double> xy = {0, 0, 1, 1};
  for (const std::int32_t bad : {-1, 2}) try {
      (void)find_crossings(xy, std::vector<Segment>{{0, 1}, {0, bad}});
      ADD_FAILURE() << bad;
    } catch (const InputError& error) {
      EXPECT_EQ(error.index(), 1U);
    }
  for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")}) try {
      (void)find_crossings(std::vector<double>{0, 0, 1, bad}, std::vector<Segment>{{0, 1}});
      ADD_FAILURE() << bad;
    } catch (const InputError& error) {
      EXPECT_EQ(error.index(), 1U);
    }
}

// Each of these would take hours if all pairs of boxes that overlap were looked at.

TEST(CrossingsOfAdversaries, AHub) {
  SegmentSet set = random_segments(3, 100000, 1e-3);
  for (std::int32_t i = 0; i < 100000; ++i) set.segments[static_cast<std::size_t>(i)] = {0, 2 * i + 1};
  EXPECT_EQ(pairs_of(set, 2).size(), 0U);
}

TEST(CrossingsOfAdversaries, TheSameSegment) {
  SegmentSet set{"", {0, 0, 5, 7, 0, 7, 7, 0, 1, 4}, {}};
  for (int i = 0; i < 100000; ++i) set.segments.push_back(i % 2 != 0 ? Segment{0, 1} : Segment{1, 0});
  set.segments.push_back({2, 3});
  EXPECT_EQ(pairs_of(set, 2).size(), 100000U);
}

/// Walls: each segment overlaps the next, and one that only touches is apart.
TEST(Crossings, OverlapsMakeWalls) {
  const std::vector<double> xy = {0, 0, 2, 2, 1, 1, 4, 4, 3, 3, 5, 5, 9, 9, 3, 2, 2, 3};
  const std::vector<Segment> segments = {{0, 1}, {3, 2}, {4, 5}, {5, 6}, {7, 8}};
  const auto all = constraints::arrange(xy, segments, 1);
  EXPECT_EQ(all.wall_offsets, (std::vector<std::int64_t>{0, 3, 4, 5}));
  ASSERT_EQ(all.crossings.size(), 1U);
  EXPECT_EQ(all.parents, (Pairs{{1, 4}}));
  EXPECT_EQ(constraints::crossing_pairs(all), (Pairs{{1, 4}}));
}

TEST(CrossingsOfAdversaries, NestedOnOneLine) {
  SegmentSet set{"", {0.5, 2e5, 1e5, -1.0}, {{0, 1}}};
  for (std::int32_t i = 0; i < 100000; ++i) {
    set.xy.insert(set.xy.end(), {1.0 * i, 1.0 * i, 3e5 - i, 3e5 - i});
    set.segments.push_back({2 * i + 2, 2 * i + 3});
  }
  std::size_t expected = 0;  // the line from (0.5, 2e5) to (1e5, -1) meets y = x at about 66,667
  for (std::int32_t i = 0; i < 100000; ++i) expected += i <= 66666;
  EXPECT_EQ(pairs_of(set, 2).size(), expected);
}

TEST(CrossingsOfAdversaries, ACombOfLongSegments) {
  SegmentSet set{"", {}, {}};
  for (std::int32_t i = 0; i < 100000; ++i) {
    set.xy.insert(set.xy.end(), {1.0 * i, -1.0 * i, 1e6 + i, 1e6 - i});
    set.segments.push_back({2 * i, 2 * i + 1});
  }
  EXPECT_EQ(pairs_of(set, 2).size(), 0U);
  set.xy.insert(set.xy.end(), {5e5, 5e5 + 0.5, 5e5 + 1000, 5e5 - 999.5});
  set.segments.push_back({200000, 200001});
  EXPECT_EQ(pairs_of(set, 2).size(), 1000U);
}

TEST(CrossingsOfAdversaries, ASegmentThroughManyPoints) {
  SegmentSet set{"", {-1.0, -0.5, 100000.0, 50000.0}, {{0, 1}}};
  for (std::int32_t i = 0; i < 100000; ++i) {
    set.xy.insert(set.xy.end(), {1.0 * i, 0.5 * i});
    if (i > 0) set.segments.push_back({i + 1, i + 2});
  }
  const auto all = constraints::arrange(set.xy, set.segments, 2);
  EXPECT_EQ(all.crossings.size(), 0U);
  EXPECT_EQ(all.segment_last[0] - all.segment_first[0], 100001);
}

TEST(CrossingsOfAdversaries, ManyThroughOnePoint) {
  SegmentSet set{"", {0, 0}, {}};
  for (std::int32_t i = 0; i < 50000; ++i) {
    set.xy.insert(set.xy.end(), {-1e5, 1.0 * i - 3e4, 1e5, 3e4 - 1.0 * i});
    set.segments.push_back({2 * i + 1, 2 * i + 2});
  }
  const auto all = constraints::arrange(set.xy, set.segments, 2);
  EXPECT_EQ(all.crossings.size(), 0U);
  EXPECT_EQ(all.chain_vertices.size(), 150000U);
  SegmentSet open{"", {set.xy.begin() + 2, set.xy.end()}, {}};
  for (std::int32_t i = 0; i < 50000; ++i) open.segments.push_back({2 * i, 2 * i + 1});
  const auto crossed = constraints::arrange(open.xy, open.segments, 2);
  EXPECT_EQ(crossed.crossings.size(), 1U);
  EXPECT_EQ(crossed.members.size(), 50000U);
}

}  // namespace
}  // namespace cadt::test
