// SPDX-License-Identifier: Apache-2.0
// Points and segments in device memory, where the constrained mesh stays.
#include <string>
#include <utility>

#include "common/constraints/constraints.hpp"
#include "common/constraints/crossed_segments.hpp"
#include "common/constraints/domains.hpp"

namespace cadt {
namespace {

void add_domains(Context& ctx, const ConstraintOptions& constraints, const DeviceChains& chains,
                 DeviceTriangulation::Data& data) {
  const DomainMesh mesh = {data.triangles, data.neighbors, data.edge_flags, data.triangle_count};
  Domains domains = find_domains(ctx, mesh, data.points, chains, {}, constraints);
  InsideMesh inside = pack_inside(ctx, mesh, domains);
  data.regions = std::move(domains.region);
  data.number_inside = inside.triangles;
  data.triangles_inside = std::move(inside.vertices);
  data.neighbors_inside = std::move(inside.neighbors);
}

}  // namespace

DeviceTriangulation Triangulator::triangulate_constrained(const DevicePoints& points, const DeviceArray& segments,
                                                          const ConstraintOptions& constraints) {
  require_segments(segments.size / 2);
  if (segments.size % 2 != 0)
    throw InputError("an array of segments has two words each, this one has " + std::to_string(segments.size),
                     segments.size / 2);
  if (segments.size != 0 && segments.memory == nullptr)
    throw InputError("the array of segments has no memory: DeviceArray::memory is null", 0);
  if (constraints.crossing == Crossing::grid)
    throw OptionError("crossing", "a grid moves points, which are not changed on the device; copy them to the host");
  if (constraints.domain == Domain::seeds)
    throw OptionError("domain", "seeds are located on the host; copy points and segments there");
  const bool exact = constraints.crossing == Crossing::exact, has_domain = constraints.domain != Domain::hull;
  SegmentJob job;
  job.count = segments.size / 2;
  if (job.count != 0) job.segments = state_->memory.wrap(segments.memory, segments.size * sizeof(std::int32_t));
  job.wants_chains = has_domain;
  job.wants_crossings = exact ? FindCrossings::places : FindCrossings::pairs;
  CrossedMesh mesh;
  mesh.data = triangulate_on_device(state_, points, &job);
  const std::size_t count = job.count;
  if (!job.crossed) {
    mesh.chain_offsets = std::move(job.chain_offsets);
    mesh.chains = std::move(job.chains);
    mesh.chain_length = job.chain_length;
  } else if (exact) {
    mesh = constrain_exactly(state_, points, std::move(job));
  } else if (job.crossings) {
    refuse_crossings(state_, PointsView(), {}, job.crossings);
  } else {
    const CopiedSegments copied = copy_segments(state_, points, job);
    refuse_crossings(state_, copied.xy, copied.segments, std::nullopt);
  }
  if (has_domain && mesh.data->triangle_count != 0) {
    Statistics statistics;
    Context ctx(*state_->device, state_->memory, state_->options, statistics);
    add_domains(ctx, constraints, {mesh.chain_offsets, mesh.chains, count, mesh.chain_length}, *mesh.data);
  }
  return DeviceTriangulation(std::move(mesh.data));
}

}  // namespace cadt
