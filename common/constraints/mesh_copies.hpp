// SPDX-License-Identifier: Apache-2.0
// Points, segments and their meshes, copied from a device to the host and back.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/constraints/constrained_data.hpp"
#include "common/constraints/constraints.hpp"
#include "common/driver/device_triangulation.hpp"

namespace cadt {

/// Coordinates and segments of the device: floats where it takes no doubles.
struct CopiedSegments {
  std::vector<double> xy;
  std::vector<float> floats;
  std::vector<Segment> segments;

  [[nodiscard]] PointsView points() const { return floats.empty() ? PointsView(xy) : PointsView(floats); }
  [[nodiscard]] std::vector<double> doubles() const {
    return floats.empty() ? xy : std::vector<double>(floats.begin(), floats.end());
  }
};
[[nodiscard]] CopiedSegments copy_segments(const std::shared_ptr<Triangulator::State>& state,
                                           const DevicePoints& points, const SegmentJob& job);

/// A mesh that was made on the host, without its domains. `xy`: of the points that were given.
[[nodiscard]] DeviceMesh upload_mesh(const std::shared_ptr<Triangulator::State>& state, std::span<const double> xy,
                                     const ConstrainedTriangulation::Data& from);

}  // namespace cadt
