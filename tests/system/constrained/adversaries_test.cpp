// SPDX-License-Identifier: Apache-2.0
// What makes other algorithms slow, or wrong: the mesh of CGAL for small sets, and for large ones bounds of launches,
// memory and time that quadratic ones do not keep.
#include "tests/system/constrained/adversaries.hpp"
#include "tests/system/constrained/legal_segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>

namespace cadt::test {
namespace {

class Adversaries : public ConstrainedTest {
 protected:
  struct Cost {
    double seconds = 0;
    Statistics statistics;
    std::size_t chains = 0;
  };
  [[nodiscard]] Cost cost(const Drawing& d) const {
    const auto begin = std::chrono::steady_clock::now();
    const ConstrainedTriangulation mesh = triangulated(d.xy, d.segments);
    Cost cost;
    cost.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    cost.statistics = mesh.statistics();
    cost.chains = mesh.chain_vertices().size();
    const VerifyReport report = verify(d.xy, d.segments, mesh);
    EXPECT_TRUE(report.ok) << report.summary();
    return cost;
  }
};

TEST_P(Adversaries, Small) {
  for (const Adversary& adversary : adversaries()) {
    for (const int n : {12, 40, 300, 1000}) {
      SCOPED_TRACE(adversary.name + " of " + std::to_string(n));
      const Drawing d = adversary.make(n);
      check(d.xy, d.segments);
    }
  }
}

TEST_P(Adversaries, LargeOnesTakeNoQuadraticTime) {
  const int n = GetParam().backend == Backend::opencl ? 20000 : 50000;
  for (const Adversary& adversary : adversaries()) {
    SCOPED_TRACE(adversary.name);
    const Drawing tenth = adversary.make(n / 10), d = adversary.make(n);
    Cost small = cost(tenth), large = cost(d);
    // Quadratic: 100 times. (What takes less than 2 s is not measured well, nor is a processor that stands for a GPU:
    // it is the lanes of its groups one after the other, of which small sets need few.)
    const bool timed = std::getenv("CADT_OPENCL_AS_GPU") == nullptr;
    const auto too_slow = [&] { return timed && large.seconds >= 2 && large.seconds >= 40 * small.seconds; };
    for (int again = 0; again < 3 && too_slow(); ++again) {  // other tests run beside it
      small = cost(tenth);
      large = cost(d);
    }
    EXPECT_FALSE(too_slow()) << large.seconds << " s, a tenth of it " << small.seconds << " s";
    // Beside those of the Delaunay mesh. Each time that what is left halves takes some 20 launches, and on GPUs some
    // more for long chains. CPUs take few long pieces at a time.
    const std::uint64_t few_at_a_time = GetParam().backend == Backend::cuda ? 0 : d.segments.size() / 8;
    const std::uint64_t plain = triangulate(d.xy, GetParam().options()).statistics().launches;
    EXPECT_LT(large.statistics.launches, plain + 600 + static_cast<std::uint64_t>(200 * std::log2(n)) + few_at_a_time);
    EXPECT_LT(large.statistics.segment_retries, 16 * d.segments.size());
    EXPECT_LT(large.statistics.bytes_device_peak, 1000 * (d.points() + d.segments.size()) + 16 * large.chains);
  }
}

/// On one thread each run is the same. Tried along with others each time, the long segment of these combs loses in
/// hundreds of them: 18,191 launches.
TEST(AdversariesOnOneThread, ALongPieceThatMeetsShortOnes) {
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  const auto comb = std::ranges::find(adversaries(), "comb", &Adversary::name);
  ASSERT_NE(comb, adversaries().end());
  for (const int n : {50000, 100000}) {
    const Drawing d = comb->make(n);
    const ConstrainedTriangulation mesh = triangulate_constrained(d.xy, d.segments, ConstraintOptions{}, options);
    EXPECT_LT(mesh.statistics().launches, 3000U);
  }
}

/// Parallel segments that one crosses. The mesh of rounded places is not taken where they are long and close together,
/// and crossings that are inserted one behind the other then change all triangles that are left: 50 times as long.
TEST(AdversariesOnOneThread, CrossingsAlongASegment) {
  constexpr int n = 24000;
  const auto seconds = [](double distance, double height) {
    std::vector<double> xy = {-distance, 0, n * distance, 0};
    std::vector<Segment> segments = {{0, 1}};
    for (int i = 0; i < n; ++i) {
      const double x = (i + 0.5) * distance;
      xy.insert(xy.end(), {x, height, x, -height});
      segments.push_back({2 * i + 2, 2 * i + 3});
    }
    Options options;
    options.backend = Backend::host;
    options.threads = 1;
    ConstraintOptions constraints;
    constraints.crossing = Crossing::exact;
    const auto begin = std::chrono::steady_clock::now();
    const ConstrainedTriangulation mesh = triangulate_constrained(xy, segments, constraints, options);
    EXPECT_EQ(mesh.added_parents().size(), std::size_t{n});
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const double short_ones = seconds(1, 1), long_ones = seconds(1.0 / n, 100);
  EXPECT_LT(long_ones, 20 * short_ones + 2) << short_ones;
}

TEST_P(Adversaries, UlpsAroundASegment) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const Drawing d = ulps_around_segment(seed);
    check(d.xy, d.segments);
  }
}

TEST_P(Adversaries, SubnormalAndLargestCoordinates) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    for (const int range : {1, 2, 3}) {
      SCOPED_TRACE(std::to_string(seed) + " in range " + std::to_string(range));
      const Drawing d = extreme_points(seed, (range & 1) != 0, (range & 2) != 0);
      const std::vector<Segment> segments = legal_segments(d.xy, 60, seed);
      const ConstrainedTriangulation mesh = triangulated(d.xy, segments);
      const VerifyReport report = verify(d.xy, segments, mesh);
      EXPECT_TRUE(report.ok) << report.summary();
      std::vector<Segment> turned = segments;
      std::ranges::reverse(turned);
      for (Segment& s : turned) std::swap(s[0], s[1]);
      EXPECT_EQ(triangulated(d.xy, turned).hash(), mesh.hash());
    }
  }
}

CADT_ON_MAIN_BACKENDS(Adversaries);

}  // namespace
}  // namespace cadt::test
