// SPDX-License-Identifier: Apache-2.0
// The verifier's predicates for callers.
#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace cadt {
namespace {

using Place = std::array<double, 2>;

TEST(ExactPredicates, Orientation) {
  const Place a{0, 0}, b{1, 0}, c{0, 1};
  EXPECT_EQ(exact_orientation(a, b, c), 1);
  EXPECT_EQ(exact_orientation(a, c, b), -1);
  EXPECT_EQ(exact_orientation(a, b, {7, 0}), 0);
  // One unit in the last place beside the line, where doubles see nothing.
  const Place far{3e300, 3e300};
  EXPECT_EQ(exact_orientation({-1e-300, -1e-300}, far, {1, 1}), 0);
  EXPECT_EQ(exact_orientation({-1e-300, -1e-300}, far, {1, std::nextafter(1.0, 2.0)}), 1);
  EXPECT_EQ(exact_orientation({-1e-300, -1e-300}, far, {std::nextafter(1.0, 2.0), 1}), -1);
}

TEST(ExactPredicates, InCircle) {
  const Place a{0, 0}, b{1, 0}, c{1, 1}, d{0, 1};
  EXPECT_EQ(exact_in_circle(a, b, c, {0.5, 0.5}), 1);
  EXPECT_EQ(exact_in_circle(a, b, c, {2, 2}), -1);
  EXPECT_EQ(exact_in_circle(a, b, c, d), 0);
  EXPECT_EQ(exact_in_circle(a, b, c, {std::nextafter(0.0, 1.0), 1}), 1);
  EXPECT_EQ(exact_in_circle(a, b, c, {-std::nextafter(0.0, 1.0), 1}), -1);
}

TEST(ExactPredicates, TiesAreThoseOfTheMesh) {
  // Of a square, the mesh has the diagonal that the perturbation chooses.
  const std::array<Place, 4> p{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  const Triangulation mesh = triangulate(PointsView(p));
  ASSERT_EQ(mesh.number_of_triangles(), 2U);
  const auto at = [&](std::size_t t, std::size_t k) { return p[static_cast<std::size_t>(mesh.triangle(t)[k])]; };
  for (std::size_t k = 0; k < 3; ++k) {
    if (mesh.neighbor(0, k) < 0) continue;
    std::size_t m = 0;
    while (mesh.neighbor(1, m) != 0) ++m;
    EXPECT_EQ(exact_in_circle(at(0, 0), at(0, 1), at(0, 2), at(1, m)), 0);
    EXPECT_EQ(exact_in_circle_of_tie(at(0, 0), at(0, 1), at(0, 2), at(1, m)), -1);
  }
  // Of the two diagonals one is legal.
  EXPECT_EQ(exact_in_circle_of_tie(p[0], p[1], p[3], p[2]), -exact_in_circle_of_tie(p[0], p[1], p[2], p[3]));
}

}  // namespace
}  // namespace cadt
