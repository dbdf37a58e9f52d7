// SPDX-License-Identifier: Apache-2.0
// Distinct points along a space-filling curve.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>

#include "common/host/run.hpp"

namespace cadt {

struct SpatialOrder {
  Allocation points;  ///< distinct points in order, scaled by a power of two unless `wide`
  Allocation labels;  ///< their lowest input indices
  std::size_t distinct = 0;
  Allocation duplicates, representatives;  ///< points that equal an earlier one, ascending, and that one; null if none
  bool wide = false;                       ///< exponents span too much for the narrow kernels
};

/// Sorts n points (`input`: interleaved doubles), refines crowded cells, finds duplicates.
/// \throws InputError for the first NaN or infinity
[[nodiscard]] SpatialOrder sort_points(Run& run, Allocation input, std::size_t n);

}  // namespace cadt
