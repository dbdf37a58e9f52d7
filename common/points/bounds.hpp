// SPDX-License-Identifier: Apache-2.0
// Bounding box and range of exponents of the points (common/points/bounds.dev.h).
#pragma once

#include <cstddef>

#include "common/driver/context.hpp"

namespace cadt {

struct Bounds {
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
  int low = 4096, high = -4096;  ///< exponents of the lowest set bit and above the highest; low > high: all are zero
};

/// Bounds of n points (`input`: interleaved, as the device takes them). The CADT_ORDER_WORDS of `totals` become 0.
/// \throws InputError for the first NaN or infinity
[[nodiscard]] Bounds find_bounds(Context& ctx, const Allocation& input, std::size_t n, const Allocation& totals);

}  // namespace cadt
