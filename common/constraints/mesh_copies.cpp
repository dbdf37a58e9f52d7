// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/mesh_copies.hpp"

#include <utility>

#include "common/constraints/chains.hpp"
#include "common/constraints/domains/domains.hpp"
#include "common/driver/device_text.hpp"
#include "common/points/device_points.hpp"
#include "common/points/import.hpp"

namespace cadt {
namespace {

using device_text::word;
using State = std::shared_ptr<Triangulator::State>;
using Data = ConstrainedTriangulation::Data;

template <class T>
std::vector<T> read(Device& device, const Allocation& from, std::size_t count) {
  return from && count != 0 ? device.read_values<T>(*from, count) : std::vector<T>{};
}

/// With Domain::hull no regions are kept on a device: finds them for the copy.
void find_regions_of_hull(Context& ctx, const DeviceTriangulation::Data& from, Data& to) {
  Allocation none;
  if (!from.edge_flags) none = ctx.memory.allocate_zeros(from.triangle_count * word);
  const DomainMesh mesh = {from.triangles, from.neighbors, from.edge_flags ? from.edge_flags : none,
                           from.triangle_count};
  Domains domains = find_domains(ctx, mesh, from.points, {none, none, 0, 0}, {}, {});
  to.region = ctx.device.read_values<std::int32_t>(*domains.region, from.triangle_count);
  to.inside.assign(from.triangle_count, 1);
  to.number_inside = from.triangle_count;
  to.region_value = std::move(domains.value);
  to.region_attribute = std::move(domains.attribute);
}

void upload_chains(const State& state, const Data& from, DeviceTriangulation::Data& to) {
  to.segments = from.chain_offsets.size() - 1;
  to.chain_length = from.chain_vertices.size();
  if (to.segments == 0) return;
  require_chain_length(to.chain_length);
  const std::vector<std::uint32_t> offsets(from.chain_offsets.begin(), from.chain_offsets.end());
  to.chain_offsets = state->memory.upload(std::span(offsets));
  to.chains = state->memory.upload(std::span(from.chain_vertices));
}

}  // namespace

CopiedSegments copy_segments(const State& state, const DevicePoints& points, const SegmentJob& job) {
  Statistics statistics;
  Context ctx(*state->device, state->memory, state->options, statistics);
  CopiedSegments copied;
  if (points.size != 0) {
    const Allocation imported = import_points(ctx, points);
    if (takes_floats_only(ctx.device))
      copied.floats = read<float>(ctx.device, imported, 2 * points.size);
    else
      copied.xy = read<double>(ctx.device, imported, 2 * points.size);
  }
  copied.segments = read<Segment>(ctx.device, job.segments, job.count);
  ctx.device.finish();
  return copied;
}

DeviceMesh upload_mesh(const State& state, std::span<const double> xy, const Data& from) {
  Memory& memory = state->memory;
  const Triangulation& mesh = from.mesh;
  auto to = std::make_unique<DeviceTriangulation::Data>();
  to->state = state;
  to->points = mesh.number_of_points();
  to->duplicate_count = mesh.duplicates().size();
  to->distinct = to->points - to->duplicate_count;
  to->triangle_count = mesh.number_of_triangles();
  to->dimension = mesh.dimension();
  to->statistics = mesh.statistics();
  to->triangles = memory.upload(mesh.triangles());
  to->neighbors = memory.upload(mesh.neighbors());
  to->edge_flags = memory.upload(std::span(from.edge_flags));
  std::vector<std::int32_t> points, representatives;
  for (const Duplicate& d : mesh.duplicates()) {
    points.push_back(d.point);
    representatives.push_back(d.representative);
  }
  to->duplicate_points = memory.upload(std::span(std::as_const(points)));
  to->representatives = memory.upload(std::span(std::as_const(representatives)));
  std::vector<double> places(xy.begin(), xy.end());
  places.insert(places.end(), from.added.begin(), from.added.end());
  to->added = from.parents.size();
  to->moved = !from.moved.empty();
  to->rounded_valid = from.rounded_valid;
  to->places = memory.upload(std::span(std::as_const(places)));
  to->added_parents = memory.upload(std::span(from.parents));
  upload_chains(state, from, *to);
  return to;
}

ConstrainedTriangulation DeviceTriangulation::download_constrained() const {
  auto copy = std::make_shared<ConstrainedTriangulation::Data>();
  copy->mesh = download();
  const Data& from = *data_;
  if (from.state == nullptr) return ConstrainedTriangulation(std::move(copy));
  Device& device = *from.state->device;
  const std::size_t count = from.triangle_count;
  copy->edge_flags = read<std::uint32_t>(device, from.edge_flags, count);
  copy->edge_flags.resize(count);
  if (from.chain_offsets) {
    const auto offsets = read<std::uint32_t>(device, from.chain_offsets, from.segments + 1);
    take_chains(*copy, {offsets.begin(), offsets.end()}, read<std::int32_t>(device, from.chains, from.chain_length));
  }
  if (from.regions) {
    copy->region = read<std::int32_t>(device, from.regions, count);
    const auto inside = read<std::uint32_t>(device, from.inside, count);
    copy->inside.assign(inside.begin(), inside.end());
    copy->number_inside = from.number_inside;
    copy->region_value = read<std::int32_t>(device, from.region_values, from.region_count);
    copy->region_attribute = read<double>(device, from.region_attributes, from.region_count);
  } else if (count != 0) {
    Statistics statistics;
    Context ctx(device, from.state->memory, from.state->options, statistics);
    find_regions_of_hull(ctx, from, *copy);
  }
  if (from.places) {
    std::vector<double> xy = read<double>(device, from.places, 2 * from.points);
    const auto added = xy.begin() + static_cast<std::ptrdiff_t>(2 * (from.points - from.added));
    copy->added.assign(added, xy.end());
    xy.erase(added, xy.end());
    if (from.moved) copy->moved = std::move(xy);
    copy->parents = read<Segment>(device, from.added_parents, from.added);
    copy->rounded_valid = from.rounded_valid;
  }
  return ConstrainedTriangulation(std::move(copy));
}

}  // namespace cadt
