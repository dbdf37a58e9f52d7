// SPDX-License-Identifier: Apache-2.0
// The properties that each generated set is named for.
#include <cadt/io/generate.hpp>

#include "io/generate/relief.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace {

using cadt::io::generate;
using cadt::io::PointSet;

std::set<std::pair<double, double>> distinct(const PointSet& set) {
  std::set<std::pair<double, double>> out;
  for (std::size_t i = 0; i < set.size(); ++i) out.insert({set.xy[2 * i], set.xy[2 * i + 1]});
  return out;
}

double radius(const PointSet& set, std::size_t i) { return std::hypot(set.xy[2 * i], set.xy[2 * i + 1]); }

TEST(Circles, OffsetsStayWithinEpsilonOfTheCircle) {
  const cadt::io::GenerateOptions options{.n = 3000, .seed = 9, .k = 12, .radius = 0.3, .epsilon = 1e-3};
  const PointSet set = generate("circles", options);
  ASSERT_EQ(set.size(), 12u * 16u * 16u);  // 16 = round(sqrt(3000 / 12))
  double largest = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const std::size_t circle = i / 12;
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i % 12) / 12.0;
    const double dx = 16.0 * set.xy[2 * i] - (static_cast<double>(circle % 16) + 0.5 + 0.3 * std::cos(angle));
    const double dy = 16.0 * set.xy[2 * i + 1] - (static_cast<double>(circle / 16) + 0.5 + 0.3 * std::sin(angle));
    largest = std::max({largest, std::fabs(dx), std::fabs(dy)});
    mean += (dx + dy) / static_cast<double>(2 * set.size());
  }
  EXPECT_LE(largest, 1e-3 + 1e-12);
  EXPECT_GT(largest, 0.99e-3);
  EXPECT_NEAR(mean, 0.0, 3e-5);
}

TEST(Circles, WithoutOffsetAndWithoutPointsToACircle) {
  const PointSet exact = generate("circles", {.n = 800, .k = 8, .epsilon = 0.0});
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double cx = 0.1 * (static_cast<double>(i / 8 % 10) + 0.5), cy = 0.1 * (static_cast<double>(i / 80) + 0.5);
    EXPECT_NEAR(std::hypot(exact.xy[2 * i] - cx, exact.xy[2 * i + 1] - cy), 0.035, 1e-15);
  }
  EXPECT_THROW(static_cast<void>(generate("circles", {.n = 800, .k = 0})), std::invalid_argument);
}

TEST(Concentric, IntegerPointsExactlyOnTheirCircles) {
  const PointSet set = generate("concentric", {.n = 1080});
  std::map<std::int64_t, int> on_circle;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const auto x = static_cast<std::int64_t>(set.xy[2 * i]), y = static_cast<std::int64_t>(set.xy[2 * i + 1]);
    ASSERT_EQ(static_cast<double>(x), set.xy[2 * i]);
    ASSERT_EQ(static_cast<double>(y), set.xy[2 * i + 1]);
    ++on_circle[x * x + y * y];
  }
  ASSERT_EQ(on_circle.size(), 10u);
  for (const auto& [square, count] : on_circle) {
    EXPECT_EQ(count, 108) << square;
    EXPECT_EQ(square % (1105 * 1105), 0);
  }
  EXPECT_EQ(distinct(set).size(), 1080u);
}

TEST(Grid, IntegersInANearSquare) {
  const PointSet set = generate("grid", {.n = 1000});
  EXPECT_EQ(distinct(set).size(), 1000u);
  for (const double v : set.xy) {
    EXPECT_EQ(v, std::floor(v));
    EXPECT_TRUE(v >= 0.0 && v <= 31.0);
  }
}

TEST(Tilted, KeepsTheDistancesOfTheGrid) {
  const PointSet grid = generate("grid", {.n = 400});
  const PointSet tilted = generate("tilted", {.n = 400});
  for (std::size_t i = 0; i < 400; ++i) EXPECT_NEAR(radius(tilted, i), radius(grid, i), 1e-13);
  EXPECT_NE(tilted.xy[2], grid.xy[2]);
}

TEST(Hex, SixNeighboursAtUnitDistance) {
  const PointSet set = generate("hex", {.n = 100});
  const std::size_t centre = 55;
  int near = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    const double d = std::hypot(set.xy[2 * i] - set.xy[2 * centre], set.xy[2 * i + 1] - set.xy[2 * centre + 1]);
    if (i != centre && d < 1.5) {
      EXPECT_NEAR(d, 1.0, 1e-12);
      ++near;
    }
  }
  EXPECT_EQ(near, 6);
}

TEST(Collinear, ExactlyOnOneLineAndAllDistinct) {
  for (const std::size_t n : {777, 1024}) {
    const PointSet set = generate("collinear", {.n = n, .seed = 12});
    for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(2.0 * set.xy[2 * i], 3.0 * set.xy[2 * i + 1]);
    EXPECT_EQ(distinct(set).size(), n);
    EXPECT_FALSE(std::is_sorted(set.xy.begin(), set.xy.end()));
  }
}

TEST(Ngon, UnitCircle) {
  const PointSet set = generate("ngon", {.n = 500});
  for (std::size_t i = 0; i < 500; ++i) EXPECT_NEAR(radius(set, i), 1.0, 1e-15);
  EXPECT_EQ(distinct(set).size(), 500u);
}

TEST(Kuzmin, MedianRadiusIsTheRootOfThree) {
  const PointSet set = generate("kuzmin", {.n = 100'000});
  std::vector<double> r;
  for (std::size_t i = 0; i < set.size(); ++i) r.push_back(radius(set, i));
  std::nth_element(r.begin(), r.begin() + 50'000, r.end());
  EXPECT_NEAR(r[50'000], std::sqrt(3.0), 0.03);
}

TEST(Gaussian, UnitVarianceInBothCoordinates) {
  const PointSet set = generate("gaussian", {.n = 100'000});
  double xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    xx += set.xy[2 * i] * set.xy[2 * i] * 1e-5;
    yy += set.xy[2 * i + 1] * set.xy[2 * i + 1] * 1e-5;
    xy += set.xy[2 * i] * set.xy[2 * i + 1] * 1e-5;
  }
  EXPECT_NEAR(xx, 1.0, 0.02);
  EXPECT_NEAR(yy, 1.0, 0.02);
  EXPECT_NEAR(xy, 0.0, 0.02);
}

TEST(Line, HalfOfThePointsCloseToTheLine) {
  const PointSet set = generate("line", {.n = 10'000});
  int close = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    EXPECT_TRUE(set.xy[2 * i] > 0.0 && set.xy[2 * i] <= 1.0);
    close += set.xy[2 * i] < 0.002 ? 1 : 0;
  }
  EXPECT_NEAR(close, 5'000, 200);
}

TEST(Parabola, Squares) {
  const PointSet set = generate("parabola", {.n = 100});
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(set.xy[2 * i + 1], set.xy[2 * i] * set.xy[2 * i]);
}

TEST(Spiral, RadiusIsTheRootOfTheNumber) {
  const PointSet set = generate("spiral", {.n = 100});
  for (std::size_t i = 0; i < 100; ++i) EXPECT_NEAR(radius(set, i), std::sqrt(static_cast<double>(i + 1)), 1e-14);
}

TEST(Clusters, EveryHundredthPointIsOfOneCluster) {
  const PointSet set = generate("clusters", {.n = 1000});
  for (std::size_t i = 100; i < 1000; ++i) {
    EXPECT_LT(std::hypot(set.xy[2 * i] - set.xy[2 * i - 200], set.xy[2 * i + 1] - set.xy[2 * i - 199]), 2e-5);
  }
  EXPECT_GT(std::fabs(set.xy[0] - set.xy[2]) + std::fabs(set.xy[1] - set.xy[3]), 1e-4);
}

TEST(Skewed, OneInAThousandOutsideOfTheCell) {
  const PointSet set = generate("skewed", {.n = 10'000});
  int outside = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    outside += std::fabs(set.xy[2 * i] - 0.5) > 1.1e-12 || std::fabs(set.xy[2 * i + 1] - 0.5) > 1.1e-12 ? 1 : 0;
  }
  EXPECT_EQ(outside, 10);
}

TEST(TwoClusters, AtDistance) {
  const PointSet set = generate("two-clusters", {.n = 100});
  for (std::size_t i = 0; i < 100; ++i) {
    const double base = i % 2 == 0 ? 0.0 : 1e12;
    EXPECT_TRUE(set.xy[2 * i] >= base && set.xy[2 * i] <= base + 1.0);
    EXPECT_TRUE(set.xy[2 * i + 1] >= base && set.xy[2 * i + 1] <= base + 1.0);
  }
}

TEST(Duplicates, HalfOfThePoints) { EXPECT_EQ(distinct(generate("duplicates", {.n = 1000})).size(), 500u); }

TEST(Ring, ThinAnnulus) {
  const PointSet set = generate("ring", {.n = 1000});
  for (std::size_t i = 0; i < 1000; ++i) {
    const double r = std::hypot(set.xy[2 * i] - 0.5, set.xy[2 * i + 1] - 0.5);
    EXPECT_TRUE(r > 0.45 - 1e-12 && r < 0.451 + 1e-12) << r;
  }
}

TEST(Terrain, ContinuousWithMountains) {
  const cadt::io::generate_detail::Relief relief(4);
  double low = 1e9, high = -1e9;
  for (int i = 0; i < 40'000; ++i) {
    const double x = (i % 200) / 200.0, y = (i / 200) / 200.0;  // NOLINT: whole rows
    const double h = relief(x, y);
    low = std::min(low, h);
    high = std::max(high, h);
    EXPECT_NEAR(relief(x + 1e-7, y - 1e-7), h, 1e-5) << x << ' ' << y;
  }
  EXPECT_GT(high - low, 0.04);
  EXPECT_LT(high - low, 0.5);
  const PointSet set = generate("terrain", {.n = 50, .seed = 4});
  EXPECT_EQ(set.height[17], relief(set.xy[34], set.xy[35]));
}

TEST(Contours, HeightsAreLevelsOfTheRelief) {
  const PointSet set = generate("contours", {.n = 20'000, .seed = 2});
  const cadt::io::generate_detail::Relief relief(2);
  const std::set<double> levels(set.height.begin(), set.height.end());
  EXPECT_LT(levels.size(), 300u);
  EXPECT_GT(levels.size(), 5u);
  const double interval = (*levels.rbegin() - *levels.begin()) / static_cast<double>(levels.size() - 1);
  double previous = *levels.begin() - interval;
  for (const double level : levels) {
    EXPECT_NEAR(level - previous, interval, 1e-9);
    previous = level;
  }
  std::vector<double> off;
  for (std::size_t i = 0; i < set.size(); ++i) {
    off.push_back(std::fabs(relief(set.xy[2 * i], set.xy[2 * i + 1]) - set.height[i]));
  }
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[10'000], 0.1 * interval) << "median";
  EXPECT_GT(off.back(), 0.0) << "crossings are interpolated";
}

}  // namespace
