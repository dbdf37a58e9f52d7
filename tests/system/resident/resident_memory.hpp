// SPDX-License-Identifier: Apache-2.0
// What tests of device memory ask.
#pragma once

#include "common/driver/device_triangulation.hpp"
#include "tests/system/resident/resident.hpp"

#include <cstdint>

namespace cadt::test {

class ResidentMemory : public ResidentTest {
 protected:
  /// Requests for memory of the device since the triangulator was opened, found through one of its results.
  static std::uint64_t requests(const DeviceTriangulation& mesh) { return mesh.data().state->memory.allocations(); }

  /// That reserve() asks for: more where the star stage is chosen.
  static std::uint64_t kept_buffers(const Triangulator& triangulator) { return triangulator.device().gpu ? 19 : 12; }
};

inline Points set_of_all_kinds() {
  Points xy = cluster_points(1500);
  const Points lattice = grid_points(20, 20), spread = uniform_points(500, 3);
  xy.insert(xy.end(), lattice.begin(), lattice.end());
  xy.insert(xy.end(), spread.begin(), spread.end());
  xy.insert(xy.end(), spread.begin(), spread.end());
  return xy;
}

}  // namespace cadt::test
