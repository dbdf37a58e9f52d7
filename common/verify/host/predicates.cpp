// SPDX-License-Identifier: Apache-2.0
// The predicates for callers.
#include "exact_sign.hpp"

#include <cadt/verify.hpp>

namespace cadt {

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
