// SPDX-License-Identifier: Apache-2.0
// What a sample tells of the points in sorted order, as the host compiles it (common/points/point_profile.dev.h).
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#define CADT_WIDE 0
namespace {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/points/duplicates.dev.h"
#pragma GCC diagnostic pop

using Points = std::vector<cadt_point>;
constexpr std::uint32_t n = 12000, samples = CADT_POINT_SAMPLES;
/// Counts of cadt_unique_flags.
struct Shapes {
  std::uint32_t unused, equal, beside, on_circle, circles, mirrored, lines, on_hull;
};

Shapes shapes_of(const Points& points) {
  const auto count = static_cast<std::uint32_t>(points.size());
  std::vector<std::uint32_t> keys(count), flags(count);
  std::array<std::uint32_t, CADT_ORDER_WORDS> totals{};
  cadt_unique_flags(0, 1, points.data(), keys.data(), flags.data(), count, count, 1, totals.data());
  return {totals[0], totals[1], totals[2], totals[3], totals[4], totals[5], totals[6], totals[7]};
}

TEST(Shapes, OfRandomPoints) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  Points points;
  for (std::uint32_t i = 0; i < n; ++i) points.push_back({unit(random), unit(random)});
  const Shapes s = shapes_of(points);
  EXPECT_GT(s.beside, 0U);
  EXPECT_EQ(s.equal + s.on_circle + s.circles + s.mirrored + s.lines, 0U);
  EXPECT_LT(s.on_hull, samples / 20);
}

TEST(Shapes, OfALine) {
  Points points;
  for (std::uint32_t i = 0; i < n; ++i) points.push_back({3.0 * i / 65536, 2.0 * i / 65536});
  EXPECT_EQ(shapes_of(points).beside, 0U);
  points[n / CADT_POINT_SAMPLES * 5].y += 1e-3;
  EXPECT_GT(shapes_of(points).beside, 0U);
}

TEST(Shapes, OfAPolygon) {
  Points points;
  for (std::uint32_t i = 0; i < n; ++i)
    points.push_back({std::cos(2 * std::numbers::pi * i / n), std::sin(2 * std::numbers::pi * i / n)});
  EXPECT_GT(shapes_of(points).on_circle, samples * 9 / 10);
  EXPECT_GT(shapes_of(points).on_hull, samples * 19 / 20);
}

TEST(Shapes, OfCurves) {
  Points parabola, spiral, twice;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double x = i / 6000.0 - 1, turn = std::sqrt(1.0 * i), angle = 4 * std::numbers::pi * i / n;
    parabola.push_back({x, x * x});
    spiral.push_back({turn * std::cos(turn), turn * std::sin(turn)});
    twice.push_back({(i < n / 2 ? 1 : 2) * std::cos(angle), (i < n / 2 ? 1 : 2) * std::sin(angle)});
  }
  EXPECT_EQ(shapes_of(parabola).on_circle, 0U);
  EXPECT_GT(shapes_of(parabola).on_hull, samples * 19 / 20);
  EXPECT_LT(shapes_of(spiral).on_hull, samples * 3 / 10);  // the last turn
  EXPECT_LT(shapes_of(twice).on_hull, samples * 6 / 10);   // the outer circle
  EXPECT_EQ(shapes_of(Points(n, {1, 2})).on_hull, 0U);
}

TEST(Shapes, OfSquaresAndRays) {
  for (const double turn : {0.0, 0.3}) {
    Points squares, rays;
    const double c = std::cos(turn), s = std::sin(turn);
    for (std::uint32_t i = 0; i < n; ++i) {
      const double x = i / 4 % 100 + (i % 4 == 1 || i % 4 == 2 ? 0.5 : 0), y = i / 400 + (i % 4 > 1 ? 0.5 : 0);
      squares.push_back({(c * x - s * y) / 256, (s * x + c * y) / 256});
      rays.push_back({3.0 * (i % 100) / 4096 + i / 100, (turn > 0 ? 2.0 : 0.0) * (i % 100) / 4096});
    }
    const Shapes square = shapes_of(squares), ray = shapes_of(rays);
    if (turn == 0.0) {  // along an axis
      EXPECT_GT(square.mirrored, 200U);
      EXPECT_EQ(ray.lines, 0U);
    } else {
      EXPECT_GT(square.circles, 60U);
      EXPECT_GT(ray.lines, 500U);
    }
  }
}

}  // namespace
