// SPDX-License-Identifier: Apache-2.0
// Snapshots of the growing mesh for Options::watch.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstdint>
#include <functional>
#include <vector>

#include "common/driver/device.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

class GrowthSnapshots {
 public:
  GrowthSnapshots(Device& device, const SortedPoints& order);
  /// Reads all triangles and calls `watch`. \pre no launch is running that changes the mesh
  void show(const Buffer& locked, const std::function<void(const Snapshot&)>& watch);

 private:
  Device& device_;
  std::vector<std::uint32_t> input_ids_;  ///< position -> index of the input
};

}  // namespace cadt
