// SPDX-License-Identifier: Apache-2.0
// Refinement of over-full cells (common/points/key_refinement.dev.h).
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/driver/context.hpp"

namespace cadt {

/// Sets flags[i] to 1 for members of over-full cells, else 0; returns how many members there are. Waits for the device.
[[nodiscard]] std::uint32_t flag_overfull(Context& ctx, const Allocation& keys, const Allocation& flags, std::size_t n);

/// Sorts the members of over-full cells by more bits, a round at a time. False if there are none; else `keys` are no
/// longer those of the grid. \pre `overfull_points` of them are flagged in `spare`
[[nodiscard]] bool refine_overfull(Context& ctx, const Allocation& input, Allocation& keys, const Allocation& order,
                                   Allocation& spare, std::size_t n, std::uint32_t overfull_points);

}  // namespace cadt
