// SPDX-License-Identifier: Apache-2.0
// Implicit points and their predicates against GMP's fractions.
#include "common/constraints/crossings/arrangement.hpp"
#include "common/constraints/grid/pixel_grid.hpp"
#include "tests/unit/constraints/segment_sets.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace cadt::test {
namespace {

using exact::ImplicitPoints;
using exact::Line;
using exact::Place;

struct Fraction {
  mpq_class x, y;
};

Fraction crossing(const Line& s, const Line& t) {
  const mpq_class ax = s.a.x, ay = s.a.y, cx = t.a.x, cy = t.a.y;
  const mpq_class ux = s.b.x - ax, uy = s.b.y - ay, vx = t.b.x - cx, vy = t.b.y - cy;
  const mpq_class along = ((cx - ax) * vy - (cy - ay) * vx) / (ux * vy - uy * vx);
  return {ax + along * ux, ay + along * uy};
}
Fraction fraction(const std::vector<Line>& lines, const Place& p) {
  if (p.first < 0) return {p.x, p.y};
  return crossing(lines[static_cast<std::size_t>(p.first)], lines[static_cast<std::size_t>(p.second)]);
}
int orientation(const Fraction& a, const Fraction& b, const Fraction& c) {
  return sgn(mpq_class((a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x)));
}
int incircle(const Fraction& a, const Fraction& b, const Fraction& c, const Fraction& d) {
  const mpq_class ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
  return sgn(mpq_class((ax * ax + ay * ay) * (bx * cy - cx * by) + (bx * bx + by * by) * (cx * ay - ax * cy) +
                       (cx * cx + cy * cy) * (ax * by - bx * ay)));
}
int compare(const Fraction& a, const Fraction& b) {
  const int x = sgn(mpq_class(a.x - b.x));
  return x != 0 ? x : sgn(mpq_class(a.y - b.y));
}

/// Whether no double is nearer, and the double is even if another one is as near.
bool is_nearest(const mpq_class& exact, double rounded) {
  const mpq_class error = abs(exact - mpq_class(rounded));
  const auto even = [](double v) {
    return std::fmod(std::abs(v) / std::numeric_limits<double>::denorm_min(), 2.0) == 0;
  };
  for (const double to : {-1.0, 1.0}) {
    const double other = std::nextafter(rounded, to * std::numeric_limits<double>::infinity());
    if (std::isinf(other)) continue;
    const mpq_class distance = abs(exact - mpq_class(other));
    if (distance < error) return false;
    int exponent = 0;
    const double mantissa = std::frexp(rounded, &exponent);
    const bool subnormal = std::abs(rounded) < std::numeric_limits<double>::min();
    if (distance == error && !(subnormal ? even(rounded) : std::fmod(std::ldexp(mantissa, 53), 2.0) == 0)) return false;
  }
  return true;
}

struct Places {
  std::vector<Line> lines;
  std::vector<Place> all;  // points and crossings
};
Places places_of(const SegmentSet& set) {
  auto found = constraints::arrange(set.xy, set.segments, 1);
  Places places{std::move(found.lines), std::move(found.crossings)};
  for (std::size_t i = 0; i < places.all.size() && i < found.points.size(); ++i)
    places.all.push_back(exact::explicit_place(found.points[i]));
  return places;
}

int sign(int v) { return (v > 0) - (v < 0); }

TEST(ImplicitPoints, AreRoundedToNearest) {
  std::size_t exact_ones = 0, rounded_ones = 0;
  for (const SegmentSet& set : small_segment_sets()) {
    const Places places = places_of(set);
    for (const Place& p : places.all) {
      if (p.first < 0) continue;
      const Fraction f = fraction(places.lines, p);
      ASSERT_TRUE(is_nearest(f.x, p.x)) << set.name << " " << f.x.get_d() << " " << p.x;
      ASSERT_TRUE(is_nearest(f.y, p.y)) << set.name << " " << f.y.get_d() << " " << p.y;
      ASSERT_EQ(sgn(mpq_class(f.x - mpq_class(p.x))), p.rest_x) << set.name;
      ASSERT_EQ(sgn(mpq_class(f.y - mpq_class(p.y))), p.rest_y) << set.name;
      (p.is_double() ? exact_ones : rounded_ones)++;
    }
  }
  EXPECT_GT(exact_ones, 100U);
  EXPECT_GT(rounded_ones, 1000U);
}

TEST(ImplicitPoints, HalvesGoToTheEvenDouble) {
  exact::Arena arena;
  const exact::Arithmetic of(arena);
  const auto rounded = [&](double a, double b, double divisor) {
    return exact::round_quotient(of.add(of.number(a), of.number(b)), of.number(divisor), arena);
  };
  EXPECT_EQ(rounded(1, 0x1p-53, 1).value, 1);
  EXPECT_EQ(rounded(1, 0x1p-53, 1).rest, 1);
  EXPECT_EQ(rounded(1, 0x3p-53, 1).value, 1 + 0x2p-52);
  EXPECT_EQ(rounded(1, 0x3p-53, 1).rest, -1);
  EXPECT_EQ(rounded(-1, -0x3p-53, 1).rest, 1);
  EXPECT_EQ(rounded(1, 0x1p-53 + 0x1p-90, 1).value, 1 + 0x1p-52);
  EXPECT_EQ(rounded(1, 0x1p-1074, 1).rest, 1);
  EXPECT_EQ(rounded(0x1p-1074, 0, 2).value, 0);
  EXPECT_EQ(rounded(0x1p-1074, 0, -2).rest, -1);
  EXPECT_EQ(rounded(0x3p-1074, 0, 2).value, 0x2p-1074);
  EXPECT_EQ(rounded(0x1p-1074, 0, 1e300).value, 0);
  EXPECT_EQ(rounded(0x1p-1022, -0x1p-1074, 1).value, 0x1p-1022 - 0x1p-1074);
  EXPECT_EQ(rounded(1e308, 0, -3).value, -1e308 / 3);
}

TEST(ImplicitPoints, FloorOfQuotients) {
  for (const double whole : {-3.0, -1.0, 0.0, 1.0, 4096.0, -0x1p40}) {
    exact::Arena arena;
    const exact::Arithmetic of(arena);
    EXPECT_EQ(exact::floor_quotient(of.number(whole * 0.75), of.number(0.75), arena), whole);
    EXPECT_EQ(exact::floor_quotient(of.number(whole * 0.75), of.number(-0.75), arena), -whole);
  }
  std::mt19937_64 random(3);
  for (int i = 0; i < 20000; ++i) {
    exact::Arena arena;
    const exact::Arithmetic of(arena);
    const double a =
        std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())), static_cast<int>(random() % 40) - 60);
    const double b = static_cast<double>(static_cast<std::int64_t>(random() % 2001) - 1000) * 0x1p-4;
    if (b == 0) continue;
    const double c = static_cast<double>(random() % 64);
    const exact::Number dividend = of.add(of.number(a), of.multiply(of.number(b), of.number(c)));
    const mpq_class exact = (mpq_class(a) + mpq_class(b) * c) / mpq_class(b);
    mpz_class floor;
    mpz_fdiv_q(floor.get_mpz_t(), exact.get_num_mpz_t(), exact.get_den_mpz_t());
    ASSERT_EQ(exact::floor_quotient(dividend, of.number(b), arena), floor.get_si()) << a << " " << b << " " << c;
  }
}

TEST(ImplicitPoints, PredicatesEqualThoseOfFractions) {
  std::mt19937_64 random(5);
  std::size_t zeros[2] = {0, 0}, filtered[2] = {0, 0}, equal = 0;
  for (const SegmentSet& set : small_segment_sets()) {
    const Places places = places_of(set);
    if (places.all.empty()) continue;
    const ImplicitPoints points(places.lines);
    const bool wide = set.name.starts_with("subnormal");
    for (int i = 0; i < (wide ? 20 : 200); ++i) {
      Place p[4];
      Fraction f[4];
      for (int k = 0; k < 4; ++k) {
        p[k] = places.all[random() % places.all.size()];
        f[k] = fraction(places.lines, p[k]);
      }
      ASSERT_EQ(sign(points.compare(p[0], p[1])), compare(f[0], f[1])) << set.name;
      equal += compare(f[0], f[1]) == 0;
      const int side = orientation(f[0], f[1], f[2]), circle = incircle(f[0], f[1], f[2], f[3]);
      zeros[0] += side == 0;
      zeros[1] += circle == 0;
      ASSERT_EQ(points.orientation(p[0], p[1], p[2]), side) << set.name;
      ASSERT_EQ(exact::stage::orientation_exact(points, p[0], p[1], p[2]), side) << set.name;
      ASSERT_EQ(points.incircle(p[0], p[1], p[2], p[3]), circle) << set.name;
      ASSERT_EQ(exact::stage::incircle_exact(points, p[0], p[1], p[2], p[3]), circle) << set.name;
      if (const int s = exact::stage::orientation_filter(p[0], p[1], p[2]); s != exact::stage::unsure) {
        ASSERT_EQ(s, side) << set.name;
        ++filtered[0];
      }
      if (const int s = exact::stage::incircle_filter(p[0], p[1], p[2], p[3]); s != exact::stage::unsure) {
        ASSERT_EQ(s, circle) << set.name;
        ++filtered[1];
      }
    }
  }
  EXPECT_GT(zeros[0], 1000U);
  EXPECT_GT(zeros[1], 1000U);
  EXPECT_GT(filtered[0], 5000U);
  EXPECT_GT(filtered[1], 5000U);
  EXPECT_GT(equal, 100U);
}

/// Widths that put a side of a pixel next to a crossing.
TEST(ImplicitPoints, PixelsOfCrossingsNextToTheirSides) {
  const auto expect = [](double width, const mpq_class& v, std::int64_t pixel, const std::string& name) {
    const mpq_class place = v / mpq_class(width) + mpq_class(0.5);
    mpz_class floor;
    mpz_fdiv_q(floor.get_mpz_t(), place.get_num_mpz_t(), place.get_den_mpz_t());
    ASSERT_EQ(pixel, floor.get_si()) << name << ", width " << width;
  };
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const SegmentSet set = random_segments(seed, 60, 0.6);
    const Places places = places_of(set);
    const ImplicitPoints points(places.lines);
    for (const Place& p : places.all) {
      const Fraction f = fraction(places.lines, p);
      for (const double k : {0.5, 1.5, 2.5, 6.5, 100.5})
        for (const double v : {p.x, p.y}) {
          const double width = std::abs(v) / k;
          if (!(width > 1e-10)) continue;
          const constraints::Pixel pixel = constraints::PixelGrid(width).pixel_of(p, points);
          expect(width, f.x, pixel.x, set.name);
          expect(width, f.y, pixel.y, set.name);
        }
    }
  }
}

/// Places that differ by less than their rounded coordinates show: filters must not decide.
TEST(ImplicitPoints, CrossingsThatRoundToTheSameDouble) {
  std::mt19937_64 random(9);
  std::size_t same = 0;
  for (int round = 0; round < 6000; ++round) {
    std::vector<Line> lines;
    for (int i = 0; i < 6; ++i) {
      const double x = 0.1 + static_cast<double>(random() % 3) * 0x1p-56,
                   y = 0.7 + static_cast<double>(random() % 3) * 0x1p-53;
      lines.push_back({{x, 0.1 + 0.01 * i}, {y, 0.9 + 0.03 * i * i}});
      lines.push_back({{0, 0.5 + static_cast<double>(random() % 3) * 0x1p-53},
                       {1, 0.4 + static_cast<double>(random() % 3) * 0x1p-53}});
    }
    const ImplicitPoints points(lines);
    Place p[4];
    Fraction f[4];
    for (int k = 0; k < 4; ++k) {
      p[k] = points.crossing(static_cast<std::int32_t>(2 * (random() % 6)),
                             static_cast<std::int32_t>(2 * (random() % 6) + 1));
      f[k] = fraction(lines, p[k]);
    }
    same += p[0].x == p[1].x && p[0].rest_x == p[1].rest_x && cmp(f[0].x, f[1].x) != 0;
    ASSERT_EQ(sign(points.compare(p[0], p[1])), compare(f[0], f[1]));
    ASSERT_EQ(points.orientation(p[0], p[1], p[2]), orientation(f[0], f[1], f[2]));
    ASSERT_EQ(points.incircle(p[0], p[1], p[2], p[3]), incircle(f[0], f[1], f[2], f[3]));
  }
  EXPECT_GT(same, 20U);
}

}  // namespace
}  // namespace cadt::test
