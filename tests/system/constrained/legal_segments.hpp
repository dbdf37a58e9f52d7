// SPDX-License-Identifier: Apache-2.0
// Segments between given points that do not cross.
#pragma once

#include <cadt/constrained.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/support/families.hpp"

namespace cadt::test {

/// Up to `count` segments between points chosen at random, about half of them between points that are near in the order
/// of the input; those that would cross one before are left out. O(count^2). \pre few: the test for each pair is exact
[[nodiscard]] std::vector<Segment> legal_segments(const Points& xy, std::size_t count, std::uint64_t seed);

/// Whether two segments have one common point, inside both, at which no point of `xy` lies. By exact predicates alone.
[[nodiscard]] bool crosses(const Points& xy, const Segment& s, const Segment& t);

}  // namespace cadt::test
