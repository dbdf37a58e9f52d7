// SPDX-License-Identifier: Apache-2.0
// Points and segments on which an algorithm for constrained triangulations takes quadratic time or memory, or many
// launches, if any does. No segments cross.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/system/constrained/constrained_check.hpp"

namespace cadt::test {

struct Adversary {
  std::string name;
  std::function<Drawing(int)> make;  ///< of about n points or segments
};

[[nodiscard]] const std::vector<Adversary>& adversaries();

/// Points one unit in the last place apart around a segment, and on it.
[[nodiscard]] Drawing ulps_around_segment(std::uint64_t seed);
/// Segments between points whose coordinates are subnormal, or the largest ones, or both.
[[nodiscard]] Drawing extreme_points(std::uint64_t seed, bool subnormal, bool largest);

}  // namespace cadt::test
