// SPDX-License-Identifier: Apache-2.0
// The builder's predicates against GMP: every stage, every range.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tests/unit/predicates/device_predicates.hpp"
#include "tests/unit/verify/truth.hpp"

namespace cadt::test {
namespace {

using Four = std::array<PlanePoint, 4>;

truth::Point exact(PlanePoint p) { return {p.x, p.y}; }

struct Seen {
  int filtered = 0, exact = 0, ties = 0;
};

/// Both builds on one case. Incircle is asked for the counterclockwise triangle only.
void check(Four p, bool narrow, Seen& seen) {
  const int orientation = truth::orientation(exact(p[0]), exact(p[1]), exact(p[2]));
  if (orientation < 0) std::swap(p[0], p[1]);
  const bool triangle = truth::orientation(exact(p[0]), exact(p[1]), exact(p[2])) != 0;
  const int incircle = triangle ? truth::incircle_perturbed(exact(p[0]), exact(p[1]), exact(p[2]), exact(p[3])) : 0;
  for (const bool wide : {false, true}) {
    if (!wide && !narrow) continue;
    const Signs s = wide ? wide_signs(p[0], p[1], p[2], p[3]) : narrow_signs(p[0], p[1], p[2], p[3]);
    ASSERT_EQ(s.orientation, std::abs(orientation)) << (wide ? "wide" : "narrow");
    if (triangle) {
      ASSERT_EQ(s.incircle, incircle) << (wide ? "wide" : "narrow");
    }
    if (s.tie)
      ++seen.ties;
    else if (s.exact_incircle)
      ++seen.exact;
    else
      ++seen.filtered;
  }
}

bool distinct(const Four& p) {
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a + 1; b < 4; ++b)
      if (p[a].x == p[b].x && p[a].y == p[b].y) return false;
  return true;
}

double scaled(double v, int exponent) { return std::ldexp(v, exponent); }

TEST(DevicePredicates, RandomPointsPassTheFilter) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  Seen seen;
  for (int i = 0; i < 5000; ++i) {
    Four p;
    for (auto& q : p) q = {unit(random), unit(random)};
    ASSERT_NO_FATAL_FAILURE(check(p, true, seen));
  }
  EXPECT_GT(seen.filtered, 9900);
}

TEST(DevicePredicates, LatticePointsAreTiesAndNearTies) {
  std::mt19937_64 random(2);
  std::uniform_int_distribution<int> small(0, 7);
  Seen seen;
  for (int i = 0; i < 40000; ++i) {
    Four p;
    for (auto& q : p) q = {small(random) / 16.0, small(random) / 16.0};
    if (!distinct(p)) continue;
    ASSERT_NO_FATAL_FAILURE(check(p, true, seen));
  }
  EXPECT_GT(seen.ties, 1000);
}

// Long mantissas and wide spans: the limbs decide.
TEST(DevicePredicates, AlmostCocircularPointsNeedLongIntegers) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(0, 6.283185307179586);
  std::uniform_int_distribution<int> nudge(-2, 2), shift(-60, 0);
  Seen seen;
  for (int i = 0; i < 20000; ++i) {
    Four p;
    const double x0 = std::ldexp(angle(random) / 7, shift(random)), y0 = std::ldexp(angle(random) / 7, shift(random));
    const double radius = std::ldexp(1.0, shift(random) / 3 - 4);
    for (auto& q : p) {
      const double a = angle(random);
      q = {x0 / 4 + radius * std::cos(a), y0 / 4 + radius * std::sin(a)};
      for (int n = nudge(random); n != 0; n += n > 0 ? -1 : 1) q.x = std::nextafter(q.x, n > 0 ? 2.0 : -2.0);
    }
    ASSERT_NO_FATAL_FAILURE(check(p, true, seen));
  }
  EXPECT_GT(seen.exact, 1000);
}

// Corners of rectangles and others on one circle, as integers of up to 61 bits with differences of up to 62, a unit in
// the last place off or not: the 256-bit path with the largest numbers it can meet, of either sign.
TEST(DevicePredicates, LongestIntegersOfTheMiddlePath) {
  std::mt19937_64 random(6);
  const double top = (0x1p53 - 1) * 0x1p8;
  const std::vector<double> ends = {top, 0x1p60, 0x1p60 + 0x1p8, 0x1.921fb54442d18p59, 0x1p31, 3.0, 1.0, 0.0};
  Seen seen;
  for (int i = 0; i < 40000; ++i) {
    const auto end = [&] { return ends[random() % ends.size()] * (random() & 1 ? 1 : -1); };
    const double x0 = end(), y0 = end(), x1 = end(), y1 = end();
    Four p;
    p[0] = {x0, y0}, p[1] = {x1, y0}, p[2] = {x1, y1}, p[3] = {x0, y1};
    if (random() % 4 == 0) p[1] = {-x0, -y0}, p[2] = {-y0, x0}, p[3] = {y0, -x0};  // a circle around the origin
    const auto nudge = [&](double& v) { v = std::nextafter(v, random() & 1 ? 0x1p61 : -0x1p61); };
    if (random() & 1) nudge(random() & 1 ? p[random() % 4].x : p[random() % 4].y);
    for (auto& q : p) q = {scaled(q.x, -62), scaled(q.y, -62)};
    if (!distinct(p)) continue;
    ASSERT_NO_FATAL_FAILURE(check(p, true, seen));
  }
  EXPECT_GT(seen.ties, 1000);
  EXPECT_GT(seen.exact, 1000);
}

// Rounded corners of small regular polygons: differences are exact where the coordinates have too many bits, and the
// determinant is far below the sizes of its terms. Near the axes, where coordinates are finer, it is not.
TEST(DevicePredicates, CornersOfSmallPolygons) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> place(0, 1);
  Seen seen;
  for (int i = 0; i < 20000; ++i) {
    const double radius = scaled(1 + place(random), -12), angle = std::numbers::pi / 6;
    const double x = i % 3 == 0 ? scaled(place(random), -8 - i % 20) : place(random), y = place(random);
    Four p;
    for (PlanePoint& q : p) {
      const double turn = angle * static_cast<double>(random() % 12);
      q = {x + radius * std::cos(turn), y + radius * std::sin(turn)};
    }
    if (!distinct(p)) continue;
    ASSERT_NO_FATAL_FAILURE(check(p, true, seen)) << i;
  }
  EXPECT_GT(seen.exact, 1000);
  EXPECT_GT(seen.ties, 1000);
}

TEST(DevicePredicates, NarrowBuildTakesItsWholeWindow) {
  std::mt19937_64 random(4);
  std::uniform_int_distribution<int> bits(1, 240);
  std::uniform_int_distribution<std::uint64_t> mantissa(0, (std::uint64_t{1} << 53) - 1);
  Seen seen;
  for (int i = 0; i < 20000; ++i) {
    Four p;
    for (auto& q : p) {
      const auto coordinate = [&] {
        const int e = bits(random);
        const double v = std::ldexp(static_cast<double>(mantissa(random)), -53 - e + 1);
        // cut to multiples of 2^-240
        return std::ldexp(std::trunc(std::ldexp(v, 240)), -240) * (random() & 1 ? 1 : -1);
      };
      q = {coordinate(), coordinate()};
    }
    ASSERT_NO_FATAL_FAILURE(check(p, true, seen));
  }
}

TEST(DevicePredicates, WideBuildTakesEveryDouble) {
  std::mt19937_64 random(5);
  Seen seen;
  const double largest = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  const std::vector<double> extremes = {0,       least,    -least,      3 * least,   2.2250738585072014e-308,
                                        1e-300,  1,        -1,          1 + 0x1p-52, 1e300,
                                        largest, -largest, largest / 2, 0x1p1023,    -0x1p-1000};
  for (int i = 0; i < 4000; ++i) {
    Four p;
    for (auto& q : p) {
      const auto coordinate = [&] {
        if (random() & 1) return extremes[random() % extremes.size()];
        for (;;) {
          const std::uint64_t bits = random();
          double v;
          std::memcpy(&v, &bits, sizeof v);
          if (std::isfinite(v)) return v;
        }
      };
      q = {coordinate(), coordinate()};
    }
    if (!distinct(p)) continue;
    ASSERT_NO_FATAL_FAILURE(check(p, false, seen));
  }
}

TEST(DevicePredicates, CentroidOrientationIsExact) {
  std::mt19937_64 random(6);
  std::uniform_int_distribution<int> small(-9, 9);
  int zeros = 0;
  for (int i = 0; i < 20000; ++i) {
    PlanePoint p[5];
    for (auto& q : p) q = {small(random) / 32.0, small(random) / 32.0};
    // tripled: the centroid becomes a lattice point
    const PlanePoint c{p[0].x + p[1].x + p[2].x, p[0].y + p[1].y + p[2].y};
    const int expected = truth::orientation(exact(c), {3 * p[3].x, 3 * p[3].y}, {3 * p[4].x, 3 * p[4].y});
    zeros += expected == 0;
    ASSERT_EQ(narrow_around_centroid(p[0], p[1], p[2], p[3], p[4]), expected);
    ASSERT_EQ(wide_around_centroid(p[0], p[1], p[2], p[3], p[4]), expected);
    for (auto& q : p) q = {scaled(q.x, 1000), scaled(q.y, 1000)};
    ASSERT_EQ(wide_around_centroid(p[0], p[1], p[2], p[3], p[4]), expected);
  }
  EXPECT_GT(zeros, 100);
}

// Fixtures: index, coordinates, sign of the determinant.
void check_fixture(const std::string& name, std::size_t points) {
  const auto folder = truth::hard_data();
  if (folder.empty()) GTEST_SKIP() << "no test data: set CADT_DATA_DIR";
  std::ifstream file(folder / name);
  ASSERT_TRUE(file) << name;
  int cases = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string word;
    std::vector<double> v;
    while (words >> word) v.push_back(std::strtod(word.c_str(), nullptr));
    if (v.size() != 2 * points + 2) continue;
    Four p{};
    for (std::size_t i = 0; i < points; ++i) p[i] = {v[1 + 2 * i], v[2 + 2 * i]};
    Seen seen;
    ASSERT_NO_FATAL_FAILURE(check(p, false, seen)) << name << " case " << v[0];
    ++cases;
  }
  EXPECT_GE(cases, 500);
}
TEST(DevicePredicates, ClassicOrientationFixtures) { check_fixture("predicates_pscico_orient2d.txt", 3); }
TEST(DevicePredicates, ClassicIncircleFixtures) { check_fixture("predicates_pscico_incircle.txt", 4); }
TEST(DevicePredicates, ThresholdOrientationFixtures) { check_fixture("gen_threshold_orient2d.txt", 3); }
TEST(DevicePredicates, ThresholdIncircleFixtures) { check_fixture("gen_threshold_incircle.txt", 4); }

}  // namespace
}  // namespace cadt::test
