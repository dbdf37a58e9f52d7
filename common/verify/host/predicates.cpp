// SPDX-License-Identifier: Apache-2.0
// The predicates for callers, and what they need of the thread.
#include "exact_sign.hpp"

#include <cadt/errors.hpp>
#include <cadt/verify.hpp>

#include <cfenv>
#include <limits>

namespace cadt {

void verifier::require_ieee_arithmetic() {
  volatile double smallest_normal = std::numeric_limits<double>::min(), half = 0.5;
  volatile const double subnormal = smallest_normal * half;
  if (std::fegetround() != FE_TONEAREST || subnormal == 0 || subnormal + subnormal != smallest_normal)
    throw Error(
        "exact answers need IEEE arithmetic on the calling thread: rounding to nearest, and subnormal numbers that are "
        "not flushed to zero");
}

int exact_orientation(const std::array<double, 2>& a, const std::array<double, 2>& b,
                      const std::array<double, 2>& c) noexcept {
  return verifier::orientation({a[0], a[1]}, {b[0], b[1]}, {c[0], c[1]});
}

int exact_in_circle(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c,
                    const std::array<double, 2>& d) noexcept {
  return verifier::incircle({a[0], a[1]}, {b[0], b[1]}, {c[0], c[1]}, {d[0], d[1]});
}

int exact_in_circle_of_tie(const std::array<double, 2>& a, const std::array<double, 2>& b,
                           const std::array<double, 2>& c, const std::array<double, 2>& d) noexcept {
  return verifier::incircle_perturbed({a[0], a[1]}, {b[0], b[1]}, {c[0], c[1]}, {d[0], d[1]});
}

}  // namespace cadt
