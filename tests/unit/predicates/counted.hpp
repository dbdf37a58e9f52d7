// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "tests/unit/predicates/cases.hpp"

namespace cadt::test {

/// How often the exact stage of a predicate took integers of which length, and how often mirrored pairs told a tie.
/// Orientation is compared as products of 128 bits; the incircle determinant has 192 bits, 256 bits or as many as it
/// needs, unless sums of two doubles tell its sign.
struct Lengths {
  std::uint64_t orientation_128 = 0, orientation_long = 0;
  std::uint64_t incircle_192 = 0, incircle_256 = 0, incircle_pairs = 0, incircle_long = 0, mirrored = 0;
  Lengths& operator+=(const Lengths& other);
};

/// Of orientation and incircle of each case.
[[nodiscard]] Lengths count_narrow(const std::vector<SignCase>& cases);
[[nodiscard]] Lengths count_wide(const std::vector<SignCase>& cases);
[[nodiscard]] Lengths count_floats(const std::vector<SignCase>& cases);

}  // namespace cadt::test
