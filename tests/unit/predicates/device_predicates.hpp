// SPDX-License-Identifier: Apache-2.0
// The device's predicates as the host compiles them, in both builds.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace cadt::test {

struct Signs {
  int orientation, incircle;
  bool exact_orientation, exact_incircle, tie;
};
struct PlanePoint {
  double x, y;
};

/// Signs of orientation(a, b, c) and incircle(a, b, c, d), and which stages decided. Narrow: \pre multiples of 2^-240
/// below 1, or exponents within 240 binades scaled likewise by the caller.
[[nodiscard]] Signs narrow_signs(PlanePoint a, PlanePoint b, PlanePoint c, PlanePoint d);
[[nodiscard]] Signs wide_signs(PlanePoint a, PlanePoint b, PlanePoint c, PlanePoint d);
/// Orientation of the centroid of a, b, c and p, q.
[[nodiscard]] int narrow_around_centroid(PlanePoint a, PlanePoint b, PlanePoint c, PlanePoint p, PlanePoint q);
[[nodiscard]] int wide_around_centroid(PlanePoint a, PlanePoint b, PlanePoint c, PlanePoint p, PlanePoint q);

}  // namespace cadt::test
