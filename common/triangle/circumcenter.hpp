// SPDX-License-Identifier: Apache-2.0
// The circumcentre of a triangle, rounded, and what linear functions are there.
#pragma once

#include <array>

namespace cadt {

using Corner = std::array<double, 2>;

struct Circumcenter {
  double x, y;

  /// The value at the centre of the linear function with these values at a, b and c, which are finite. It is off by
  /// some units in the last place of the values and of the function's slope times the radius, and infinite where it is
  /// beyond the largest double, but never NaN. It can be any number where the angle is as small as below, or one side
  /// 2^900 times as long as another.
  [[nodiscard]] double value(std::array<double, 3> corners) const noexcept;

  /// A number as a double and what is left of it.
  struct Sum {
    double high, low;
  };
  /// b - a for points, divided by a power of two that brings the larger component to 1/2 ... 1.
  struct Side {
    Sum x, y;
    int exponent = 0;
  };
  int from;      ///< a corner, 0 to 2, that the shortest side ends at
  Side p, q;     ///< from there to the next corner, and to the one after that
  double area;   ///< twice that of the triangle, with p and q times their powers of two
  Corner twice;  ///< the centre, as seen from there: twice the area times that, with q times its power of two
};

/// The centre of the circle through a, b and c, which are not on a line. It is found relative to an end of the shortest
/// side, with the area of the triangle correctly signed and nearly correctly rounded, so that the distance from the
/// true centre is some units in the last place of radius and coordinates, for slivers too. Where the angle at that end
/// is below about 2^-900, or the centre is beyond the largest double, coordinates are infinite; none is NaN.
[[nodiscard]] Circumcenter circumcenter(const Corner& a, const Corner& b, const Corner& c) noexcept;

}  // namespace cadt
