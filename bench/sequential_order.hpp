// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace cadt::bench {

/// The order of insertion: rounds of a random sample each, every round several times as large as all before it, and
/// each along a Hilbert curve (N. Amenta, S. Choi, G. Rote, "Incremental constructions con BRIO", 2003). Over-full
/// cells of the curve are refined, so neighbours stay together in skewed sets too. \pre finite coordinates
[[nodiscard]] std::vector<std::uint32_t> insertion_order(std::span<const double> xy);

}  // namespace cadt::bench
