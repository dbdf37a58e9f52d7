// SPDX-License-Identifier: Apache-2.0
// What becomes of segments that cross: an error with all pairs, or the exact mesh with crossings as vertices.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/constraints/constrained_data.hpp"
#include "common/constraints/constraints.hpp"
#include "common/driver/device_triangulation.hpp"

namespace cadt {

/// The chains of a result. Those of segments of no length are empty.
void take_chains(ConstrainedTriangulation::Data& data, std::vector<std::int64_t> offsets,
                 std::vector<std::int32_t> vertices);

/// `found`: what the device has found, or nothing. \throws CrossingError
[[noreturn]] void refuse_crossings(const std::shared_ptr<Triangulator::State>& state, PointsView points,
                                   std::span<const Segment> segments, const std::optional<FoundCrossings>& found);

/// Fills in mesh, chains and crossings. \throws as Triangulator::triangulate_constrained
void constrain_exactly(const std::shared_ptr<Triangulator::State>& state, PointsView points,
                       std::span<const Segment> segments, std::optional<FoundCrossings> found,
                       ConstrainedTriangulation::Data& data);

/// A mesh with crossings on the device, and the chains of its segments there (SegmentJob).
struct CrossedMesh {
  std::unique_ptr<DeviceTriangulation::Data> data;
  Allocation chain_offsets, chains;
  std::size_t chain_length = 0;
};
/// As constrain_exactly, with points and segments where they are.
[[nodiscard]] CrossedMesh constrain_exactly(const std::shared_ptr<Triangulator::State>& state,
                                            const DevicePoints& points, SegmentJob job);

/// Coordinates and segments of the device.
struct CopiedSegments {
  std::vector<double> xy;
  std::vector<Segment> segments;
};
[[nodiscard]] CopiedSegments copy_segments(const std::shared_ptr<Triangulator::State>& state,
                                           const DevicePoints& points, const SegmentJob& job);

}  // namespace cadt
