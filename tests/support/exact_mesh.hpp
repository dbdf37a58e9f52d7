// SPDX-License-Identifier: Apache-2.0
// Meshes with crossings as the host makes them alone.
#pragma once

#include "common/constraints/exact_mesh/exact_crossings.hpp"

#include <span>
#include <utility>

namespace cadt::test {

struct ExactMesh : constraints::ExactMesh, constraints::DividedSegments {};

inline ExactMesh triangulate_with_crossings(PointsView points, std::span<const Segment> segments,
                                            const Triangulation& delaunay, unsigned threads,
                                            const constraints::StopCheck& check_stop = {}) {
  const constraints::Arrangement in = constraints::arrange(points, segments, threads, check_stop);
  constraints::DividedSegments divided = constraints::divide_segments(in, segments);
  return {constraints::triangulate_with_crossings(in, divided.number, delaunay, threads, check_stop),
          std::move(divided)};
}

}  // namespace cadt::test
