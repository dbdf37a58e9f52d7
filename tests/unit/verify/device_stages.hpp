// SPDX-License-Identifier: Apache-2.0
// The predicates of the verifier on the device, compiled as host C++.
#pragma once

#include "common/verify/host/exact_sign.hpp"

namespace device_stage {

using cadt::verifier::Point;
using cadt::verifier::stage::Sign;

[[nodiscard]] Sign turn_filter(const Point& a, const Point& b, const Point& c);
[[nodiscard]] Sign turn_exact(const Point& a, const Point& b, const Point& c);
/// As signs of the incircle determinant: positive if d is inside.
[[nodiscard]] Sign incircle_filter(const Point& a, const Point& b, const Point& c, const Point& d);
[[nodiscard]] Sign incircle_exact(const Point& a, const Point& b, const Point& c, const Point& d);
/// \pre the points are cocircular, a, b, c and d, c, b counterclockwise
[[nodiscard]] bool tie_is_usual(const Point& a, const Point& b, const Point& c, const Point& d);

}  // namespace device_stage
