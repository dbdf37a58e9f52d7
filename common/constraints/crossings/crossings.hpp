// SPDX-License-Identifier: Apache-2.0
// The pairs of segments that cross: cadt::find_crossings.
#pragma once

#include "common/constraints/crossings/arrangement.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace cadt::constraints {

/// All pairs of input segments that cross, ascending. \throws Cancelled
[[nodiscard]] std::vector<std::array<std::int32_t, 2>> crossing_pairs(const Arrangement& arrangement,
                                                                      const StopCheck& check_stop = {});

}  // namespace cadt::constraints
