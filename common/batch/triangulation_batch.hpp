// SPDX-License-Identifier: Apache-2.0
// What the results of a call with several sets hold.
#pragma once

#include <cadt/batch.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/driver/device_triangulation.hpp"

namespace cadt {

/// What both have on the host. Offsets have one number more than there are sets.
struct BatchShape {
  std::vector<std::size_t> points = {0}, triangles = {0}, duplicates = {0};  ///< where those of each set begin
  std::vector<std::int8_t> dimensions;
  std::vector<Duplicate> duplicate_list;
  Statistics statistics;
};

struct TriangulationBatch::Data {
  BatchShape shape;
  Words triangles, neighbors;
};

struct DeviceTriangulationBatch::Data {
  std::shared_ptr<Triangulator::State> state;  // first: goes last, after the memory
  BatchShape shape;
  Allocation triangles, neighbors, offsets;
};

}  // namespace cadt
