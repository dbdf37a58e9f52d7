// SPDX-License-Identifier: Apache-2.0
// The circumcentre of a triangle, rounded.
#pragma once

#include <array>

namespace cadt {

using Corner = std::array<double, 2>;

struct Circumcenter {
  double x, y;
  std::array<double, 3> weights;  ///< the centre as a sum of a, b and c
};

/// The centre of the circle through a, b and c, which are not on a line. It is found relative to an end of the shortest
/// side, with the area of the triangle correctly signed and nearly correctly rounded, so that the distance from the
/// true centre is some units in the last place of radius and coordinates, for slivers too. Where the angle at that end
/// is below about 2^-900, or the centre is beyond the largest double, coordinates are infinite; none is NaN.
[[nodiscard]] Circumcenter circumcenter(const Corner& a, const Corner& b, const Corner& c) noexcept;

}  // namespace cadt
