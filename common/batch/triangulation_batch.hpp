// SPDX-License-Identifier: Apache-2.0
// Data of the results of a batch.
#pragma once

#include <cadt/batch.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/driver/device_triangulation.hpp"

namespace cadt {

/// What both results keep on the host. Lists of offsets have one entry more than there are sets.
struct BatchShape {
  std::vector<std::size_t> points = {0}, triangles = {0}, duplicates = {0};  ///< first element of each set
  std::vector<std::int8_t> dimensions;
  std::vector<Duplicate> duplicate_list;
  Statistics statistics;
};

struct TriangulationBatch::Data {
  BatchShape shape;
  Words triangles, neighbors;
};

struct DeviceTriangulationBatch::Data {
  std::shared_ptr<Triangulator::State> state;  // declared first, so destroyed last: after the memory
  BatchShape shape;
  Allocation triangles, neighbors, offsets;
};

}  // namespace cadt
