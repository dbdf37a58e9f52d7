// SPDX-License-Identifier: Apache-2.0
// Points and segments in device memory, where the constrained mesh stays.
#include <string>
#include <utility>

#include "common/constraints/chains.hpp"
#include "common/constraints/constraints.hpp"
#include "common/constraints/crossed_segments.hpp"
#include "common/constraints/domains/domains.hpp"
#include "common/constraints/mesh_copies.hpp"

namespace cadt {
namespace {

using State = std::shared_ptr<Triangulator::State>;

/// Seeds are few, and located on the host. `job`: the segments that were given.
DomainSeeds locate_on_host(const State& state, const DevicePoints& points, const SegmentJob& job,
                           const ConstraintOptions& constraints, const DeviceTriangulation::Data& data) {
  if (constraints.domain != Domain::seeds || data.triangle_count == 0) return locate_seeds({}, {}, {}, constraints);
  Device& device = *state->device;
  const auto triangles = device.read_values<std::int32_t>(*data.triangles, 3 * data.triangle_count);
  if (!data.places)
    return locate_seeds(triangles, copy_segments(state, points, {}).doubles(), {}, constraints, state->options.stop);
  const auto xy = device.read_values<double>(*data.places, 2 * data.points);
  const std::size_t given = 2 * (data.points - data.added);
  const std::span<const double> all(xy);
  AddedPlaces added{all.subspan(given), {}, {}};
  std::vector<Segment> segments, pairs;
  if (data.added != 0 && !data.moved) {
    segments = device.read_values<Segment>(*job.segments, job.count);
    pairs = device.read_values<Segment>(*data.added_parents, data.added);
    added.segments = segments, added.pairs = pairs;
  }
  return locate_seeds(triangles, PointsView(all.first(given)), added, constraints, state->options.stop);
}

void add_domains(const State& state, const DevicePoints& points, const SegmentJob& job,
                 const ConstraintOptions& constraints, DeviceTriangulation::Data& data) {
  const DomainSeeds seeds = locate_on_host(state, points, job, constraints, data);
  if (data.triangle_count == 0) return;
  Statistics statistics;
  Context ctx(*state->device, state->memory, state->options, statistics);
  const DomainMesh mesh = {data.triangles, data.neighbors, data.edge_flags, data.triangle_count};
  const DeviceChains chains = {data.chain_offsets, data.chains, data.segments, data.chain_length};
  Domains domains = find_domains(ctx, mesh, data.points, chains, seeds, constraints);
  InsideMesh inside = pack_inside(ctx, mesh, domains);
  data.region_count = domains.value.size();
  data.regions = std::move(domains.region);
  data.region_values = state->memory.upload(std::span(std::as_const(domains.value)));
  data.region_attributes = state->memory.upload(std::span(std::as_const(domains.attribute)));
  data.inside = std::move(inside.inside);
  data.number_inside = inside.triangles;
  data.triangles_inside = std::move(inside.vertices);
  data.neighbors_inside = std::move(inside.neighbors);
}

/// As constrain_on_grid, on the host.
DeviceMesh snap(const State& state, const DevicePoints& points, const SegmentJob& job, double grid) {
  const CopiedSegments copied = copy_segments(state, points, job);
  ConstrainedTriangulation::Data mesh;
  constrain_on_grid(state, copied.points(), copied.segments, grid, mesh);
  return upload_mesh(state, mesh.moved, mesh);
}

DeviceMesh constrain(const State& state, const DevicePoints& points, SegmentJob job, bool exact) {
  job.wants_crossings = exact ? FindCrossings::places : FindCrossings::pairs;
  DeviceMesh mesh = triangulate_on_device(state, points, &job);
  if (job.crossed) mesh.reset();
  if (job.crossed && exact) return constrain_exactly(state, points, std::move(job));
  if (job.crossed && job.crossings) refuse_crossings(state, PointsView(), {}, job.crossings);
  if (job.count == 0) return mesh;
  if (!job.crossed && mesh->triangle_count != 0) {
    mesh->segments = job.count;
    mesh->chain_offsets = std::move(job.chain_offsets);
    mesh->chains = std::move(job.chains);
    mesh->chain_length = job.chain_length;
  } else {
    const CopiedSegments copied = copy_segments(state, points, job);
    if (job.crossed) refuse_crossings(state, copied.points(), copied.segments, std::nullopt);
    ConstrainedTriangulation::Data on_line;
    on_line.mesh = DeviceTriangulation(std::move(mesh)).download();
    chain_on_line(copied.points(), copied.segments, on_line);
    mesh = upload_mesh(state, {}, on_line);
  }
  return mesh;
}

}  // namespace

DeviceTriangulation Triangulator::triangulate_constrained(const DevicePoints& points, const DeviceArray& segments,
                                                          const ConstraintOptions& constraints) {
  require_segments(segments.size / 2);
  require_valid(constraints);
  require_legal_edges(state_->options);
  if (segments.size % 2 != 0)
    throw InputError("an array of segments has two words each, this one has " + std::to_string(segments.size),
                     segments.size / 2);
  if (segments.size != 0 && segments.memory == nullptr)
    throw InputError("the array of segments has no memory: DeviceArray::memory is null", 0);
  const auto job_of_segments = [&] {
    SegmentJob job;
    job.count = segments.size / 2;
    if (job.count != 0) job.segments = state_->memory.wrap(segments.memory, segments.size * sizeof(std::int32_t));
    job.wants_chains = true;
    return job;
  };
  const SegmentJob job = job_of_segments();
  DeviceMesh mesh = constraints.crossing == Crossing::grid
                        ? snap(state_, points, job, constraints.grid)
                        : constrain(state_, points, job_of_segments(), constraints.crossing == Crossing::exact);
  if (constraints.domain != Domain::hull) add_domains(state_, points, job, constraints, *mesh);
  return DeviceTriangulation(std::move(mesh));
}

}  // namespace cadt
