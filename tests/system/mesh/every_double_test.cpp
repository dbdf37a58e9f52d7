// SPDX-License-Identifier: Apache-2.0
// Every finite double is taken, from 2^-1074 to the largest one, in any mixture: the mesh is exact. NaN and infinities
// are refused with the index of the first (limits_test.cpp, batch_test.cpp).
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>

namespace cadt::test {
namespace {

using Reals = std::span<const double>;
constexpr double largest = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();

class EveryDouble : public BackendTest {
 protected:
  /// The mesh, which is exact, and whether it took the arithmetic for any exponents.
  Triangulation check(const Points& xy, bool wide) const {
    Triangulation mesh = triangulate(Reals(xy), GetParam().options());
    EXPECT_TRUE(same_mesh(mesh, expected_mesh(xy)));
    EXPECT_TRUE(verified(xy, mesh));
    EXPECT_EQ(mesh.statistics().wide_arithmetic, wide);
    return mesh;
  }
  /// Number of triangles.
  std::size_t count(const Points& xy, bool wide) const { return check(xy, wide).number_of_triangles(); }
};

/// Points with integers of 8 bits: ties, rows, and others; not one is lost by a power of two.
Points small_integers() {
  Points xy = grid_points(5, 5);
  Random random(3);
  for (int i = 0; i < 40; ++i) xy.push_back(static_cast<double>(random.below(256)));
  return xy;
}

// A power of two changes nothing: subnormal, normal, and up to the largest numbers.
TEST_P(EveryDouble, APowerOfTwoChangesNothing) {
  const Points xy = small_integers();
  const Hash128 hash = triangulate(Reals(xy), GetParam().options()).hash();
  for (int exponent = -1074; exponent <= 1016; exponent += 55) {
    const Triangulation mesh = triangulate(Reals(scaled(xy, exponent)), GetParam().options());
    EXPECT_EQ(mesh.hash(), hash) << "2^" << exponent;
    EXPECT_FALSE(mesh.statistics().wide_arithmetic) << "2^" << exponent;
  }
}

// 240 binades are narrow, one more is wide, wherever they are; the mesh does not change there.
TEST_P(EveryDouble, WhereTheNarrowArithmeticEnds) {
  for (const int top : {-833, -1, 0, 1, 700, 1024}) {
    for (const int span : {239, 240, 241, 242}) {
      Points xy = scaled(uniform_points(40, 5), top - 1);
      for (double& v : xy) v = std::ldexp(std::trunc(std::ldexp(v, 60 - top)), top - 60);
      xy[7] = std::ldexp(1.0, top - span);                   // the lowest bit
      xy[8] = std::ldexp(1.0, top) * (1 - 0x1p-53);          // below 2^top
      xy[11] = xy[7], xy[12] = std::ldexp(3.0, top - span);  // a near point
      if (std::ldexp(1.0, top - span) < 0x1p-1074) continue;
      if (std::ldexp(1.0, top) == HUGE_VAL) xy[8] = largest;
      check(xy, span > 240);
    }
  }
}

TEST_P(EveryDouble, SmallestOnes) {
  const double u = least;
  EXPECT_EQ(count({0, 0, u, 0, 0, u, u, u, 2 * u, u}, false), 3u);
  EXPECT_EQ(count({u, u, -u, u, -u, -u, u, -u, 0, 0, 2 * u, 0, 0, -2 * u}, false), 6u);
  EXPECT_EQ(count({0x1p-1022, 0, 0x1p-1022 - u, u, 0, 0x1p-1022, 0, 0}, false), 2u);
  EXPECT_EQ(triangulate(Reals(Points{0, 0, u, u, 3 * u, 3 * u}), GetParam().options()).dimension(), 1);
}

TEST_P(EveryDouble, LargestOnes) {
  const double m = largest;
  EXPECT_EQ(count({m, m, -m, m, -m, -m, m, -m}, false), 2u);
  EXPECT_EQ(count({m, m, -m, m, -m, -m, m, -m, 0, 0, 1, 1, m / 2, -m / 3}, true), 8u);
  EXPECT_EQ(count({m, 0, -m, 0, 0, m, 0, -m, 0x1p970, 0x1p970}, false), 4u);
  EXPECT_EQ(count({m, m, std::nextafter(m, 0), m, m, std::nextafter(m, 0), -m, -m}, false), 2u);
}

TEST_P(EveryDouble, SmallestBesideLarge) {
  const double u = least, m = largest;
  EXPECT_EQ(count({0, 0, 1, 0, 0, 1, u, u, 1, u, .5, .5}, true), 6u);
  EXPECT_EQ(count({u, 0, -u, 0, m, 0, -m, 0, 0, u, 0, -m}, true), 6u);
  // all but on a line: one is off by the least there is
  EXPECT_EQ(count({-m, 0, m, 0, 0, u}, true), 1u);
  EXPECT_EQ(count({-1, 0, 1, 0, 0, u, 0, -u}, true), 2u);
  EXPECT_EQ(triangulate(Reals(Points{-m, 0, m, 0, u, 0}), GetParam().options()).dimension(), 1);
}

TEST_P(EveryDouble, MixturesOfMagnitudes) {
  for (const int span : {250, 600, 1000}) {
    Points xy;
    Random random(static_cast<std::uint64_t>(span));
    for (int i = 0; i < 120; ++i) {
      const auto sign = [&] { return random.below(2) ? 1.0 : -1.0; };
      const auto exponent = [&] { return static_cast<int>(random.below(static_cast<std::size_t>(2 * span))) - span; };
      xy.push_back(sign() * std::ldexp(1 + random.uniform(), exponent()));
      xy.push_back(sign() * std::ldexp(1 + random.uniform(), exponent()));
    }
    check(xy, true);
  }
  const double a = 1e-300, b = 1e300;
  check({a, a, -a, a, -a, -a, a, -a, b, b, -b, b, -b, -b, b, -b, 0, 0, 1, 0, 0, 1, -1, 0, 0, -1}, true);
}
CADT_ON_EVERY_BACKEND(EveryDouble);

}  // namespace
}  // namespace cadt::test
