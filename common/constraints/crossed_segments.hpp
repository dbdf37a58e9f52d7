// SPDX-License-Identifier: Apache-2.0
// What becomes of segments that cross: an error with all pairs, the exact mesh with crossings as vertices, or a mesh on
// a grid.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/constraints/constrained_data.hpp"
#include "common/constraints/constraints.hpp"
#include "common/constraints/mesh_copies.hpp"
#include "common/driver/device_triangulation.hpp"

namespace cadt {

/// `found`: what the device has found, or nothing. \throws CrossingError
[[noreturn]] void refuse_crossings(const std::shared_ptr<Triangulator::State>& state, PointsView points,
                                   std::span<const Segment> segments, const std::optional<FoundCrossings>& found);

/// Fills in mesh, chains and crossings. \throws as Triangulator::triangulate_constrained
void constrain_exactly(const std::shared_ptr<Triangulator::State>& state, PointsView points,
                       std::span<const Segment> segments, std::optional<FoundCrossings> found,
                       ConstrainedTriangulation::Data& data);

/// As constrain_exactly, with points and segments where they are.
[[nodiscard]] DeviceMesh constrain_exactly(const std::shared_ptr<Triangulator::State>& state,
                                           const DevicePoints& points, SegmentJob job);

/// Fills in mesh, chains, added and moved points (Crossing::grid). \throws as Triangulator::triangulate_constrained
void constrain_on_grid(const std::shared_ptr<Triangulator::State>& state, PointsView points,
                       std::span<const Segment> segments, double grid, ConstrainedTriangulation::Data& data);

}  // namespace cadt
