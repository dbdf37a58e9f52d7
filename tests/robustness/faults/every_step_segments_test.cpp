// SPDX-License-Identifier: Apache-2.0
// Steps that fail while segments become edges.
#include "tests/robustness/faults/every_step.hpp"

#include <cadt/constrained.hpp>

namespace cadt::test {
namespace {

/// Segments across all points, side by side, and one along points on a line: pieces wait, and there are long chains.
struct Walls {
  Points xy = some_points();
  std::vector<Segment> segments;
  Walls() {
    for (int i = 0; i < 6; ++i) {
      const auto v = static_cast<std::int32_t>(xy.size() / 2);
      xy.insert(xy.end(), {-9, 0.1 + 0.13 * i, 9, 0.11 + 0.13 * i});
      segments.push_back({v, v + 1});
    }
    segments.push_back({200, 256});
  }
};

Outcome constrained_outcome(const ConstrainedTriangulation& mesh) {
  return {mesh.hash().to_string(), static_cast<std::size_t>(mesh.statistics().bytes_device_peak)};
}

TEST_P(EveryStep, SegmentsOfTheHost) {
  peak_varies = true;
  const Walls walls;
  ConstraintOptions constraints;
  constraints.domain = Domain::layers;
  const Call call = [&](Triangulator& t) {
    const ConstrainedTriangulation mesh = t.triangulate_constrained(Reals(walls.xy), walls.segments, constraints);
    EXPECT_GE(mesh.statistics().inserted_segments, 6U);
    return constrained_outcome(mesh);
  };
  for (const bool warm : {false, true}) fail_each(options(), call, warm);
}

TEST_P(EveryStep, SegmentsOfTheDevice) {
  peak_varies = true;
  const Walls walls;
  const DevicePoints points = upload(walls.xy);
  const DeviceArray segments{memory->upload(std::span<const Segment>(walls.segments)), 2 * walls.segments.size()};
  fail_each(options(),
            [&](Triangulator& t) { return test::outcome_of(t.triangulate_constrained(points, segments).download()); });
}

/// With a segment across some of the others.
Walls crossed_walls() {
  Walls walls;
  walls.segments.push_back({static_cast<std::int32_t>(walls.xy.size() / 2) - 1, 200});
  return walls;
}
Call crossing_call(Crossing crossing) {
  const Walls walls = crossed_walls();
  ConstraintOptions constraints;
  constraints.crossing = crossing;
  constraints.grid = 0.01;
  return [walls, constraints](Triangulator& t) {
    try {
      return constrained_outcome(t.triangulate_constrained(Reals(walls.xy), walls.segments, constraints));
    } catch (const CrossingError& error) {
      return Outcome{std::to_string(error.pairs().size()) + " pairs", 0};
    }
  };
}

TEST_P(EveryStep, SegmentsThatCross) {
  peak_varies = true;
  if (GetParam().backend == Backend::opencl) each = 4;
  for (const Crossing crossing : {Crossing::error, Crossing::exact, Crossing::grid})
    fail_each(options(), crossing_call(crossing));
}

TEST_P(EveryStep, SegmentsThatCrossOnTheDevice) {
  peak_varies = true;
  if (GetParam().backend == Backend::opencl) each = 4;
  const Walls walls = crossed_walls();
  const DevicePoints points = upload(walls.xy);
  const DeviceArray segments{memory->upload(std::span<const Segment>(walls.segments)), 2 * walls.segments.size()};
  ConstraintOptions exact, grid;
  exact.crossing = Crossing::exact;
  exact.domain = Domain::layers;
  grid.crossing = Crossing::grid;
  grid.grid = 0.01;
  grid.domain = Domain::seeds;
  grid.holes = {{0.5, 0.5}};
  for (const ConstraintOptions& constraints : {exact, grid}) {
    fail_each(options(), [&](Triangulator& t) {
      const DeviceTriangulation mesh = t.triangulate_constrained(points, segments, constraints);
      EXPECT_GT(mesh.number_added(), 0U);
      return constrained_outcome(mesh.download_constrained());
    });
  }
}

TEST_P(EveryStep, SegmentsCancelled) {
  peak_varies = true;
  const Walls walls;
  cancel_each(options(), [&](Triangulator& t) {
    return constrained_outcome(t.triangulate_constrained(Reals(walls.xy), walls.segments));
  });
  for (const Crossing crossing : {Crossing::error, Crossing::exact, Crossing::grid})
    cancel_each(options(), crossing_call(crossing));
}

}  // namespace
}  // namespace cadt::test
