// SPDX-License-Identifier: Apache-2.0
#include "io/picture/field.hpp"

#include "tests/unit/picture/meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace {

using namespace cadt::io::picture;
using cadt::test::Mesh;

double total(const Ink& ink) {
  double sum = 0.0;
  for (const float a : ink.amounts()) sum += static_cast<double>(a);
  return sum;
}

TEST(Field, TrianglesOfASquareCoverEachOfItsPixelsAndNoOther) {
  Field field(40, 40);
  const Point2f a{10, 10}, b{30, 10}, c{30, 30}, d{10, 30};
  field.add({a, b, c}, {1, 1, 1}, 1.0f);
  field.add({a, c, d}, {1, 1, 1}, 1.0f);
  field.finish();
  for (std::size_t y = 0; y < 40; ++y) {
    for (std::size_t x = 0; x < 40; ++x) {
      const bool inside = x >= 10 && x < 30 && y >= 10 && y < 30;
      EXPECT_EQ(field.covered(y * 40 + x), inside) << x << ' ' << y;
    }
  }
}

TEST(Field, InterpolatesAPlaneExactlyInAnyOrderOfCorners) {
  const auto plane = [](Point2f p) { return 0.25f * p.x - 0.5f * p.y + 3.0f; };
  const Point2f p[3] = {{3.2f, 2.1f}, {33.9f, 11.7f}, {12.4f, 36.3f}};
  const std::size_t order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (const auto& o : order) {
    Field field(40, 40);
    const Point2f q[3] = {p[o[0]], p[o[1]], p[o[2]]};
    field.add(q, {plane(q[0]), plane(q[1]), plane(q[2])}, 1.0f);
    field.finish();
    int seen = 0;
    for (std::size_t i = 0; i < 1600; ++i) {
      if (!field.covered(i)) continue;
      ++seen;
      const Point2f centre{static_cast<float>(i % 40) + 0.5f, static_cast<float>(i / 40) + 0.5f};
      EXPECT_NEAR(field.value(i), plane(centre), 1e-3f);
    }
    EXPECT_NEAR(seen, 480.8, 8.0);  // area of the triangle
    const auto [gx, gy] = field.gradient(16, 16);
    EXPECT_NEAR(gx, 0.25f, 1e-3f);
    EXPECT_NEAR(gy, -0.5f, 1e-3f);
  }
}

TEST(Field, TrianglesBelowAPixelAverage) {
  Field field(4, 4);
  // 16 small squares of two triangles in pixel (1, 2): half of them 0, half of them 8.
  for (int i = 0; i < 16; ++i) {
    const float x = 1.0f + 0.25f * static_cast<float>(i % 4), y = 2.0f + 0.25f * static_cast<float>(i / 4);
    const float v = i % 2 == 0 ? 0.0f : 8.0f;
    field.add({{x, y}, {x + 0.25f, y}, {x + 0.25f, y + 0.25f}}, {v, v, v}, 1.0f);
    field.add({{x, y}, {x + 0.25f, y + 0.25f}, {x, y + 0.25f}}, {v, v, v}, 1.0f);
  }
  field.finish();
  EXPECT_TRUE(field.covered(9));
  EXPECT_GT(field.value(9), 1.0f);
  EXPECT_LT(field.value(9), 7.0f);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(field.covered(i), i == 9) << i;
}

TEST(Ink, AmountIsTheLengthOfTheLine) {
  const std::pair<Point2f, Point2f> lines[] = {{{10.0f, 10.0f}, {90.0f, 10.0f}},   {{10.3f, 80.2f}, {12.9f, 7.7f}},
                                               {{15.0f, 15.0f}, {80.0f, 80.0f}},   {{50.2f, 50.4f}, {50.4f, 50.3f}},
                                               {{90.5f, 20.25f}, {20.75f, 60.1f}}, {{30.0f, 30.0f}, {30.0f, 30.0f}}};
  for (const auto& [a, b] : lines) {
    Ink ink(100, 100);
    ink.line(a, b, 1, 0);
    EXPECT_NEAR(total(ink), std::hypot(b.x - a.x, b.y - a.y), 1e-3);
  }
}

TEST(Ink, LineLiesOnItsPixels) {
  Ink ink(100, 100);
  ink.line({20.0f, 30.5f}, {60.0f, 30.5f}, 1, 0);  // through the centres of row 30
  for (std::size_t x = 0; x < 100; ++x) {
    EXPECT_NEAR(ink.amounts()[30 * 100 + x], x >= 20 && x < 60 ? 1.0f : 0.0f, 1e-4f) << x;
  }
}

TEST(Ink, StrideKeepsTheExpectedAmount) {
  Ink ink(1000, 100);
  for (std::uint32_t key = 0; key < 500; ++key) ink.line({10.0f, 50.0f}, {990.0f, 50.0f}, 37, key);
  EXPECT_NEAR(total(ink), 500.0 * 980.0, 0.02 * 500.0 * 980.0);
}

TEST(Ink, LinesOutsideAreCut) {
  Ink ink(10, 10);
  ink.line({-100.0f, 5.5f}, {100.0f, 5.5f}, 1, 0);
  EXPECT_NEAR(total(ink), 10.0, 0.1);
  ink.line({std::nanf(""), 5.0f}, {3.0f, 3.0f}, 1, 0);
  EXPECT_NEAR(total(ink), 10.0, 0.1);
}

TEST(Ink, BlurIsAMean) {
  Ink ink(50, 50);
  ink.dot({25.5f, 20.5f});
  const auto blurred = ink.blurred(3);
  EXPECT_NEAR(blurred[20 * 50 + 25], 1.0f / 49.0f, 1e-6f);
  EXPECT_NEAR(blurred[17 * 50 + 28], 1.0f / 49.0f, 1e-6f);
  EXPECT_NEAR(blurred[16 * 50 + 25], 0.0f, 1e-6f);
  EXPECT_NEAR(std::accumulate(blurred.begin(), blurred.end(), 0.0), 1.0, 1e-5);
}

TEST(Edges, EachEdgeOnce) {
  const Mesh mesh = cadt::test::lattice(7);
  std::multiset<std::pair<std::size_t, std::size_t>> seen;
  for_each_edge(mesh.scene(), [&](std::size_t u, std::size_t v) { seen.insert(std::minmax(u, v)); });
  EXPECT_EQ(seen.size(), 6u * 7u * 2u + 6u * 6u);  // rows, columns, diagonals
  for (const auto& e : seen) EXPECT_EQ(seen.count(e), 1u);
}

TEST(Edges, LongEdgesByTheHundredThousandKeepTheirInkWithinTheBudget) {
  // 200,000 edges of 2,000 pixels each are 400 million steps: 50 times the budget.
  const Mesh mesh = cadt::test::fan(200'000, 0.2);
  std::vector<Point2f> position;
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < mesh.xy.size(); i += 2) {
    position.push_back(
        {static_cast<float>(20.0 + 1960.0 * mesh.xy[i]), static_cast<float>(20.0 + 400.0 * mesh.xy[i + 1])});
  }
  for_each_edge(mesh.scene(), [&](std::size_t u, std::size_t v) {
    length += static_cast<double>(std::hypot(position[u].x - position[v].x, position[u].y - position[v].y));
  });
  const Ink ink = edge_ink(mesh.scene(), position, 2000, 140);
  EXPECT_NEAR(total(ink), length, 0.02 * length);
}

}  // namespace
