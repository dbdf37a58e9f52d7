// SPDX-License-Identifier: Apache-2.0
// Circumcentres beside whole numbers, and where doubles are stretched.
#include "common/triangle/circumcenter.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace cadt {
namespace {

using Whole = __int128;

/// For corners that are whole numbers up to 2^30: the centre as an exact quotient, rounded twice.
struct Quotient {
  Whole x, y, divisor;
};
Quotient exact_center(const Corner& a, const Corner& b, const Corner& c) {
  const auto whole = [](double v) { return static_cast<Whole>(v); };
  const Whole bx = whole(b[0] - a[0]), by = whole(b[1] - a[1]), cx = whole(c[0] - a[0]), cy = whole(c[1] - a[1]);
  const Whole bb = bx * bx + by * by, cc = cx * cx + cy * cy, divisor = 2 * (bx * cy - by * cx);
  return {whole(a[0]) * divisor + cy * bb - by * cc, whole(a[1]) * divisor + bx * cc - cx * bb, divisor};
}
double rounded(Whole value, Whole divisor) {
  return static_cast<double>(static_cast<long double>(value) / static_cast<long double>(divisor));
}

double radius(const Circumcenter& center, const Corner& corner) {
  return std::hypot(center.x - corner[0], center.y - corner[1]);
}

constexpr double unit = std::numeric_limits<double>::epsilon();

void expect_center(const Corner& a, const Corner& b, const Corner& c) {
  const Quotient exact = exact_center(a, b, c);
  const Circumcenter found = circumcenter(a, b, c);
  const double x = rounded(exact.x, exact.divisor), y = rounded(exact.y, exact.divisor);
  const double size = radius(found, a) + std::abs(a[0]) + std::abs(a[1]);
  EXPECT_NEAR(found.x, x, 12 * unit * size);
  EXPECT_NEAR(found.y, y, 12 * unit * size);
  EXPECT_EQ(found.value({7, 7, 7}), 7);
  EXPECT_NEAR(found.value({a[0], b[0], c[0]}), x, 12 * unit * size);
  EXPECT_NEAR(found.value({a[1], b[1], c[1]}), y, 12 * unit * size);
  const auto linear = [](const Corner& p) { return 3 * p[0] - 5 * p[1] + 7; };
  EXPECT_NEAR(found.value({linear(a), linear(b), linear(c)}),
              rounded(3 * exact.x - 5 * exact.y + 7 * exact.divisor, exact.divisor), 64 * unit * (size + 1));
}

TEST(Circumcenter, OfRandomTrianglesIsThatOfWholeNumbers) {
  std::mt19937_64 random(7);
  const auto below = [&](std::int64_t n) {
    return static_cast<double>(static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(n)));
  };
  for (int i = 0; i < 20000; ++i) {
    const Corner a{below(1 << 20), below(1 << 20)};
    const Corner b{a[0] + below(1 << (i % 20 + 1)), a[1] - below(1 << (i % 20 + 1))};
    const Corner c{a[0] - below(1 << (i / 20 % 20 + 1)), below(1 << 20)};
    if (exact_center(a, b, c).divisor == 0) continue;
    for (const auto& [p, q, r] : {std::array{a, b, c}, {b, c, a}, {c, a, b}, {a, c, b}}) expect_center(p, q, r);
  }
}

TEST(Circumcenter, OfSliversHasTheRightSignedArea) {
  // Collinear but for one unit in 2^30: products of 60 bits that cancel.
  for (int i = 1; i < 200; ++i) {
    const double n = (1 << 30) - i;
    expect_center({0, 0}, {n, n - 1}, {std::floor(n / 2), std::floor(n / 2) + 1});
    expect_center({0, 0}, {n, n + 1}, {n - 1, n});
    expect_center({n, n}, {n + 1, n}, {0, 1});
  }
}

TEST(Circumcenter, LosesNothingInDifferences) {
  // b - a = (1 + d, 1) and c - a = (2 + d, 2) are no doubles, and twice the area is d.
  const double d = std::ldexp(1, -54);
  for (const auto& [p, q, r] : {std::array<Corner, 3>{{{-d, 0}, {1, 1}, {2, 2}}}, {{{1, 1}, {2, 2}, {-d, 0}}}}) {
    const Circumcenter found = circumcenter(p, q, r);
    EXPECT_NEAR(found.x, -2 / d, 8 * unit / d);
    EXPECT_NEAR(found.y, 2 / d, 8 * unit / d);
  }
}

TEST(Circumcenter, IsScaledExactly) {
  const Corner a{0.125, 0.5}, b{0.875, 0.25}, c{0.375, 0.9375};
  const Circumcenter one = circumcenter(a, b, c);
  for (const int exponent : {-900, -300, 300, 900, 1022}) {
    const auto at = [&](const Corner& p) { return Corner{std::ldexp(p[0], exponent), std::ldexp(p[1], exponent)}; };
    const Circumcenter found = circumcenter(at(a), at(b), at(c));
    EXPECT_EQ(found.x, std::ldexp(one.x, exponent)) << exponent;
    EXPECT_EQ(found.y, std::ldexp(one.y, exponent)) << exponent;
    EXPECT_EQ(found.value({5, 1, -2}), one.value({5, 1, -2})) << exponent;
    EXPECT_EQ(one.value({std::ldexp(0.75, exponent), std::ldexp(0.25, exponent), std::ldexp(-0.5, exponent)}),
              std::ldexp(one.value({0.75, 0.25, -0.5}), exponent));
  }
}

TEST(Circumcenter, IsNeverNotANumber) {
  using Limits = std::numeric_limits<double>;
  const double values[] = {0, Limits::denorm_min(), -Limits::min(), 1, -1, 1e300, Limits::max(), -Limits::max()};
  std::mt19937_64 random(3);
  const auto any = [&] { return values[random() % std::size(values)]; };
  for (int i = 0; i < 100000; ++i) {
    const Corner a{any(), any()}, b{any(), any()}, c{any(), any()};
    if (a == b || b == c || c == a) continue;
    const Circumcenter found = circumcenter(a, b, c);
    EXPECT_FALSE(std::isnan(found.x) || std::isnan(found.y))
        << a[0] << " " << a[1] << ", " << b[0] << " " << b[1] << ", " << c[0] << " " << c[1];
    EXPECT_FALSE(std::isnan(found.value({any(), any(), any()})));
  }
  // A right angle between sides of 2^1023 and 2^-1074: the middle of the longest side.
  const Circumcenter right = circumcenter({0, 0}, {std::ldexp(1, 1020), 0}, {0, Limits::denorm_min()});
  EXPECT_EQ(right.x, std::ldexp(1, 1019));
}

/// Weights of the corners would be infinite, with sums that are not.
TEST(Circumcenter, ContinuesValuesOfSlivers) {
  const Circumcenter flat = circumcenter({0, 0}, {1, 1e-300}, {2.5, 2e-300});
  EXPECT_NEAR(flat.value({0, 1, 2.5}), 4.25, 16 * unit);
  EXPECT_EQ(flat.value({3, 3, 3}), 3);
  EXPECT_EQ(flat.value({0, 0, 1}), std::numeric_limits<double>::infinity());
  const double d = std::ldexp(1, -54);
  for (const auto& [p, q, r] : {std::array<Corner, 3>{{{-d, 0}, {1, 1}, {2, 2}}}, {{{2, 2}, {-d, 0}, {1, 1}}}}) {
    const Circumcenter found = circumcenter(p, q, r);
    EXPECT_NEAR(found.value({p[0], q[0], r[0]}), -2 / d, 8 * unit / d);
    EXPECT_NEAR(found.value({p[0] + p[1], q[0] + q[1], r[0] + r[1]}), found.x + found.y, 16 * unit / d);
  }
}

TEST(Circumcenter, BeyondTheLargestDoubleIsInfinite) {
  const double m = std::numeric_limits<double>::max();
  const Circumcenter found = circumcenter({-m, 0}, {0, -m * 1e-16}, {m, 0});
  EXPECT_EQ(found.y, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(std::isnan(found.x));
}

}  // namespace
}  // namespace cadt
