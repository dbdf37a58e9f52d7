// SPDX-License-Identifier: Apache-2.0
// The mesh during insertion, and the other arguments of its kernels.
#pragma once

#include <cstdint>
#include <tuple>

#include "common/driver/context.hpp"
#include "common/driver/device_text.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

struct LockedMesh {
  Context& ctx;
  const SortedPoints& order;
  std::uint32_t stabilize;  ///< CADT_STABILIZE_...
  Allocation locked = {}, vertex_to_triangle = {};
  Allocation edge_flags = {};  ///< a word a triangle; null while no edge is constrained
  device_text::cadt_point center = {};
  std::uint32_t first = 0, second = 0, third = 0;

  /// CADT_LOCKED_MESH_PARAMETERS
  [[nodiscard]] auto arguments() const {
    return std::tie(locked, order.points, vertex_to_triangle, edge_flags, center.x, center.y, first, second, third,
                    stabilize, ctx.options.tuning.flip_threshold, ctx.options.tuning.quality_epsilon);
  }
};

}  // namespace cadt
