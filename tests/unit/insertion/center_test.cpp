// SPDX-License-Identifier: Apache-2.0
// On which side of a ray from the centre of the first triangle a point is. The centre is known rounded only, and where
// points are as near to it as that, the sign of the rounded numbers is often wrong: then the filter must not decide.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include "common/insertion/locate.dev.h"
#pragma GCC diagnostic pop

/// The mesh as walks see it: three points, and their centre as the driver computes it.
struct Triangle {
  explicit Triangle(std::array<cadt_point, 3> corners) : points(corners) {
    mesh.points = points.data();
    mesh.second = 1;
    mesh.third = 2;
    for (const cadt_point& p : points) {
      mesh.center.x += p.x / 3;
      mesh.center.y += p.y / 3;
    }
    cadt_counters_clear(&counters);
  }
  std::int32_t sign(cadt_point a, cadt_point b) { return cadt_around_center(&mesh, a, b, &counters); }
  std::int32_t exact(cadt_point a, cadt_point b) const {
    return cadt_orientation_centroid_exact(points[0], points[1], points[2], a, b);
  }
  /// What rounded numbers say without a bound.
  std::int32_t rounded(cadt_point a, cadt_point b) const {
    const double ux = a.x - mesh.center.x, uy = a.y - mesh.center.y, vx = b.x - mesh.center.x, vy = b.y - mesh.center.y;
    const double det = ux * vy - uy * vx;
    return (det > 0) - (det < 0);
  }

  std::array<cadt_point, 3> points;
  cadt_locked_mesh mesh{};
  cadt_counters counters;
};

TEST(Center, SignsAreExactBesideIt) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  int misleading = 0, decided = 0, all = 0;
  for (int i = 0; i < 200; ++i) {
    Triangle triangle({{{unit(random), unit(random)}, {unit(random), unit(random)}, {unit(random), unit(random)}}});
    const cadt_point c = triangle.mesh.center;
    for (int k = 0; k < 200; ++k) {
      // From a place of the last bit away to a hundredth, in every direction; the other point anywhere.
      const double distance = std::ldexp(1.0, -(k % 50) - 5), angle = 6.283185307179586 * unit(random);
      const cadt_point a{c.x + distance * std::cos(angle), c.y + distance * std::sin(angle)};
      // On the line through both, on either side, and off it by some last bits.
      const double t = 2 * unit(random) - 1, off = std::ldexp(2 * unit(random) - 1, -(k % 40) - 13);
      const cadt_point b{c.x + t * std::cos(angle) - off * std::sin(angle),
                         c.y + t * std::sin(angle) + off * std::cos(angle)};
      const std::uint32_t before = triangle.counters.count[CADT_COUNT_EXACT_ORIENTATIONS];
      const std::int32_t expected = triangle.exact(a, b), sign = triangle.sign(a, b);
      ASSERT_EQ(sign, expected) << i << " " << k;
      ASSERT_EQ(triangle.sign(b, a), -expected) << i << " " << k;
      decided += triangle.counters.count[CADT_COUNT_EXACT_ORIENTATIONS] == before;
      misleading += triangle.rounded(a, b) != expected;
      ++all;
    }
  }
  EXPECT_GT(misleading, all / 50) << "rounded numbers are hardly ever wrong here: the bound has nothing to do";
  EXPECT_GT(decided, all / 50) << "the filter never decides";
}

// Three times a coordinate less three others is six times as large as the largest of them, and has a sign: for each
// number of bits the integers must be as long as that, up to what the narrow build takes.
TEST(Center, IntegersAreLongEnoughForEveryNumberOfBits) {
  for (int bits = 2; bits < 240; ++bits) {
    const double k = std::ldexp(1.0, bits) - std::ldexp(1.0, std::max(0, bits - 53));  // as many ones as there are
    const cadt_point c{-k, 0}, a{k, 0}, b{-k, 1};                                      // from c: (6 k, 0) and (0, 3)
    ASSERT_EQ(cadt_orientation_centroid_exact(c, c, c, a, b), 1) << bits;
    ASSERT_EQ(cadt_orientation_centroid_exact(c, c, c, b, a), -1) << bits;
    const cadt_point d{0, -k}, e{0, k}, f{1, -k};
    ASSERT_EQ(cadt_orientation_centroid_exact(d, d, d, f, e), 1) << bits;
    ASSERT_EQ(cadt_orientation_centroid_exact(d, d, d, e, f), -1) << bits;
    ASSERT_EQ(cadt_orientation_centroid_exact(d, d, d, e, e), 0) << bits;
  }
}

}  // namespace
