// SPDX-License-Identifier: Apache-2.0
// Crossings that the device rounds: to the nearest doubles, or it says that it is not certain.
#include "common/constraints/exact/implicit_point.hpp"
#include "common/driver/device_text.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace cadt::test {
namespace {

using exact::Point;

class RoundedCrossing : public testing::Test {
 protected:
  /// Rounds where a b and c d cross, and compares with whole numbers. \pre they cross
  void expect(const Point& a, const Point& b, const Point& c, const Point& d) {
    device_text::cadt_point place;
    const auto of = [](const Point& p) { return device_text::cadt_point{p.x, p.y}; };
    ++(device_text::cadt_round_crossing(of(a), of(b), of(c), of(d), &place) != 0 ? certain : unsure);
    const std::array<exact::Line, 2> lines = {exact::Line{a, b}, exact::Line{c, d}};
    const exact::Place expected = exact::ImplicitPoints(lines).crossing(0, 1);
    if (unsure == before_) {
      EXPECT_EQ(place.x, expected.x);
      EXPECT_EQ(place.y, expected.y);
    }
    before_ = unsure;
  }
  double random(double low, double high) { return std::uniform_real_distribution<double>(low, high)(bits_); }

  int certain = 0, unsure = 0;

 private:
  std::mt19937_64 bits_{1};
  int before_ = 0;
};

TEST_F(RoundedCrossing, OfRandomSegments) {
  for (int i = 0; i < 20000; ++i) {
    const double unit = std::ldexp(1.0, static_cast<int>(random(-200, 200)));
    expect({unit * random(-1, 0), unit * random(-1, 1)}, {unit * random(0.5, 1), unit * random(-1, 1)},
           {unit * random(0, 0.5), unit * random(-9, -2)}, {unit * random(0, 0.5), unit * random(2, 9)});
  }
  EXPECT_EQ(unsure, 0);
}

/// The crossing with a vertical segment is by little before or behind the middle of two doubles.
TEST_F(RoundedCrossing, NearTheMiddleOfTwoDoubles) {
  for (int i = 0; i < 20000; ++i) {
    const double y = random(1, 2), next = std::nextafter(y, 3.0);
    const double left = 1 - std::ldexp(std::floor(random(-3, 4)), -static_cast<int>(random(30, 53)));
    expect({left, y}, {3.0, next}, {2.0, 0.0}, {2.0, 9.0});
  }
  EXPECT_GT(unsure, 100);
  EXPECT_GT(certain, 100);
}

/// Almost parallel: the denominator is small against what it is computed from.
TEST_F(RoundedCrossing, OfAlmostParallelSegments) {
  for (int i = 0; i < 20000; ++i) {
    const double tilt = std::ldexp(random(1, 2), -static_cast<int>(random(1, 50)));
    const double x = random(1, 9), y = random(1, 9);
    expect({-x, -y}, {x, y}, {-x, -y * (1 + tilt)}, {x * random(0.9, 1), y * (1 + tilt)});
  }
  EXPECT_GT(certain, 15000);
}

/// Beyond the range in which nothing over- or underflows, and at 0.
TEST_F(RoundedCrossing, LeavesTheExtremesToWholeNumbers) {
  constexpr double large = 1e300, tiny = std::numeric_limits<double>::denorm_min();
  expect({-large, -large}, {large, large}, {-large, large}, {large, -large / 3});
  expect({-9 * tiny, -9 * tiny}, {9 * tiny, 8 * tiny}, {-9 * tiny, 9 * tiny}, {9 * tiny, -7 * tiny});
  expect({-1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}, {1.0, -1.0});
  EXPECT_EQ(unsure, 3);
}

}  // namespace
}  // namespace cadt::test
