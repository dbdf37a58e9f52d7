// SPDX-License-Identifier: Apache-2.0
// Distinct points along a space-filling curve.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>
#include <vector>

#include "common/host/run.hpp"

namespace cadt {

struct SpatialOrder {
  Allocation points;  ///< distinct points in order, scaled by a power of two unless `wide`
  Allocation labels;  ///< their lowest input indices
  std::size_t distinct = 0;
  std::vector<Duplicate> duplicates;  ///< ascending by point
  bool wide = false;                  ///< exponents span too much for the narrow kernels
};

/// Sorts the points, refines crowded cells, finds duplicates. \throws InputError for the first NaN or infinity
[[nodiscard]] SpatialOrder sort_points(Run& run, PointsView points);

}  // namespace cadt
