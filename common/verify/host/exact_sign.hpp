// SPDX-License-Identifier: Apache-2.0
// The verifier's own predicates, exact for all finite doubles. They share no code with what triangulates points, and
// segments that do not cross, and, after the first filter, no method, so that no single error can both produce a wrong
// mesh and accept it. docs/constrained.md says who else uses them.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace cadt::verifier {

struct Point {
  double x, y;
};

[[nodiscard]] inline bool lexicographic_less(const Point& a, const Point& b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}
[[nodiscard]] inline bool equal(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }

/// The stages of a predicate, cheapest first. Each returns the right sign or none; tests call them one by one.
namespace stage {

using Sign = std::optional<int>;

// Semi-static filters in the manner of O. Devillers and S. Pion, "Efficient exact geometric predicates for Delaunay
// triangulations" (ALENEX 2003), with bounds of our own. u = 2^-53. X and Y are the greatest computed |dx| and |dy|; a
// computed difference is the true one times (1 + e), |e| <= u, also when it is subnormal (then it is exact).
//
// Orientation dx1*dy2 - dy1*dx2: each of the two monomials meets 2 (differences) + 1 (product) + 1 (subtraction)
// roundings, 2 more turn true differences into computed ones, and forming X*Y is off by one: the error is below
// 2 * 7u(1 + 16u) X Y < 16u X Y = 2^-49 X Y. A product that underflows adds 2^-1075, far below the slack of 2u X Y as
// long as X, Y > 2^-480. Below 2^510 nothing overflows. A difference that is infinite fails the comparison.
[[nodiscard]] inline Sign orientation_filter(const Point& a, const Point& b, const Point& c) {
  const double ax = a.x - c.x, ay = a.y - c.y, bx = b.x - c.x, by = b.y - c.y;
  const double X = std::max(std::abs(ax), std::abs(bx));
  const double Y = std::max(std::abs(ay), std::abs(by));
  if (X == 0 || Y == 0)
    return 0;  // a difference is zero only for equal numbers: the points share an axis-parallel line
  if (!(X > 0x1p-480 && Y > 0x1p-480 && X < 0x1p510 && Y < 0x1p510)) return std::nullopt;
  const double det = ax * by - ay * bx;
  const double bound = 0x1p-49 * (X * Y);
  if (det > bound) return 1;
  if (det < -bound) return -1;
  return std::nullopt;
}

// In-circle, the sum of three lift * cross, lift = dx^2 + dy^2, cross = dx1*dy2 - dx2*dy1: each monomial meets 4 (lift)
// + 4 (cross) + 1 (product) + 2 (sum) = 11 roundings, 4 more turn true differences into computed ones, and the bound
// itself is off by 4. The moduli of the monomials add up to at most 3 * (X^2 + Y^2) * 2XY. So the error is below
// 19 * 6u(1 + 40u) XY(X^2 + Y^2) < 128u XY(X^2 + Y^2) = 2^-46 XY(X^2 + Y^2). A lift, cross or product that underflows
// adds 2^-1075 times at most 6XY, 6(X^2 + Y^2) or 1: with X, Y > 2^-220 that is less than 2^-500 of the slack. Below
// 2^250 nothing overflows.
[[nodiscard]] inline Sign incircle_filter(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
  const double X = std::max({std::abs(ax), std::abs(bx), std::abs(cx)});
  const double Y = std::max({std::abs(ay), std::abs(by), std::abs(cy)});
  if (!(X > 0x1p-220 && Y > 0x1p-220 && X < 0x1p250 && Y < 0x1p250)) return std::nullopt;
  const double det = (ax * ax + ay * ay) * (bx * cy - cx * by) + (bx * bx + by * by) * (cx * ay - ax * cy) +
                     (cx * cx + cy * cy) * (ax * by - bx * ay);
  const double bound = 0x1p-46 * (X * Y * (X * X + Y * Y));
  if (det > bound) return 1;
  if (det < -bound) return -1;
  return std::nullopt;
}

/// When the coordinates are small integers times one power of two: 128-bit integers.
[[nodiscard]] Sign orientation_integer(const Point& a, const Point& b, const Point& c);
[[nodiscard]] Sign incircle_integer(const Point& a, const Point& b, const Point& c, const Point& d);
/// When the differences of the coordinates are doubles of moderate exponent: expansions.
[[nodiscard]] Sign orientation_expansion(const Point& a, const Point& b, const Point& c);
[[nodiscard]] Sign incircle_expansion(const Point& a, const Point& b, const Point& c, const Point& d);
/// Always: integers of up to 8448 bits.
[[nodiscard]] int orientation_long(const Point& a, const Point& b, const Point& c);
[[nodiscard]] int incircle_long(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace stage

/// The predicates rely on IEEE 754 arithmetic. A process may have changed it, e.g. by loading code built for fast
/// arithmetic; then no answer is better than a wrong one. Threads inherit the mode of the thread that starts them.
/// \throws Error
void require_ieee_arithmetic();

/// Sign of the area of abc: positive if counterclockwise.
[[nodiscard]] int orientation(const Point& a, const Point& b, const Point& c);

/// Positive if d lies inside the circle of the counterclockwise triangle abc, 0 if on it.
[[nodiscard]] int incircle(const Point& a, const Point& b, const Point& c, const Point& d);

/// The side of d when incircle(a, b, c, d) is 0, after the symbolic perturbation of O. Devillers and M. Teillaud,
/// "Perturbations and vertex removal in a 3D Delaunay triangulation" (SODA 2003): never 0 for distinct points.
[[nodiscard]] int incircle_perturbed(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace cadt::verifier
