// SPDX-License-Identifier: Apache-2.0
// Distinct points along a space-filling curve.
#pragma once

#include <cadt/triangulation.hpp>

#include <algorithm>
#include <cstddef>

#include "common/host/run.hpp"

namespace cadt {

/// The grid of the sort keys (common/device/order.h), for the points as they are in SpatialOrder.
struct KeyGrid {
  unsigned bits_x = 1, bits_y = 1;
  double half_min_x = 0, half_min_y = 0;
  double scale = 0;               ///< cells a unit of halved coordinates
  double most_x = 0, most_y = 0;  ///< largest coordinates of the points, in cells
  bool clipped = false;           ///< some points are outside, and have the nearest cell at the edge
  [[nodiscard]] unsigned bits() const noexcept { return bits_x + bits_y; }
  [[nodiscard]] unsigned levels() const noexcept { return std::min(bits_x, bits_y); }
};

struct SpatialOrder {
  Allocation points;  ///< distinct points in order, scaled by a power of two unless `wide`
  Allocation labels;  ///< their lowest input indices
  std::size_t distinct = 0;
  Allocation duplicates, representatives;  ///< points that equal an earlier one, ascending, and that one; null if none
  KeyGrid grid;
  Allocation keys;    ///< their sort keys in this grid, or null
  bool wide = false;  ///< exponents span too much for the narrow kernels
};

/// Sort keys of n points of the device.
void make_keys(Run& run, const Allocation& points, const Allocation& keys, std::size_t n, const KeyGrid& grid);

/// Sorts n points (`input`: interleaved doubles), refines crowded cells, finds duplicates. `keep_keys`: the result has
/// the sort keys, unless cells were crowded or points equal.
/// \throws InputError for the first NaN or infinity
[[nodiscard]] SpatialOrder sort_points(Run& run, Allocation input, std::size_t n, bool keep_keys);

}  // namespace cadt
