// SPDX-License-Identifier: Apache-2.0
// The mesh on the device while it is made: records, and what the kernels over it get besides.
#pragma once

#include <cstdint>

#include "common/host/device_constants.hpp"
#include "common/host/run.hpp"
#include "common/host/spatial_order.hpp"

namespace cadt {

struct WorkingMesh {
  Run& run;
  SpatialOrder& order;
  std::uint32_t stabilize;  ///< CADT_STABILIZE_...
  Allocation records = {}, hints = {};
  device_constants::cadt_point center = {};
  std::uint32_t first = 0, second = 0, third = 0;

  /// A kernel over the mesh: its view comes first among the parameters.
  template <class... Args>
  void run_kernel(KernelId kernel, std::uint32_t items, const Args&... args) const {
    run.launcher.run(kernel, items, records, order.points, hints, center.x, center.y, first, second, third, stabilize,
                     run.options.flip_threshold, run.options.quality_epsilon, args...);
  }
};

}  // namespace cadt
