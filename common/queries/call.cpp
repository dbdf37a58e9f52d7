// SPDX-License-Identifier: Apache-2.0
#include "common/queries/call.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "common/points/device_points.hpp"
#include "common/verify/host/exact_sign.hpp"

namespace cadt::query {

using device_text::word;

void require_doubles(const Device& device) {
  if (!takes_floats_only(device)) return;
  const DeviceInfo& info = device.info();
  throw BackendUnavailable(
      std::string(to_string(info.backend)),
      "'" + info.name + "' has no double precision, which this needs: name another device, or the host");
}

void require_mesh_of(std::size_t points, std::size_t of) {
  if (points != of)
    throw InputError("the mesh is one of " + std::to_string(of) + " points, not of " + std::to_string(points),
                     std::min(points, of));
}

void require_room(const DeviceArray& array, std::size_t needed, const char* what) {
  if (array.size < needed)
    throw InputError(std::string("the array for ") + what + " has " + std::to_string(array.size) + " elements, " +
                         std::to_string(needed) + " are needed",
                     array.size);
  if (needed != 0 && array.memory == nullptr)
    throw InputError(std::string("the array for ") + what + " has no memory: DeviceArray::memory is null", 0);
}

namespace {

/// 3 * triangle + k of the first edge whose circles are not empty, or -1: of the constrained ones, if the others are
/// known to have empty ones. It examines each edge from one side.
std::int64_t first_not_delaunay(Context& ctx, const MeshIndex& mesh) {
  verifier::require_ieee_arithmetic();
  Device& device = ctx.device;
  std::vector<std::uint32_t> flags;
  if (!mesh.any_edge) flags = device.read_values(*mesh.edge_flags, mesh.triangles);
  const std::vector<std::uint32_t> vertices = device.read_values(*mesh.vertices, 3 * mesh.triangles),
                                   across = device.read_values(*mesh.across, 3 * mesh.triangles);
  const auto xy = device.read_values<double>(*mesh.points, 2 * mesh.point_count);
  const auto corner = [&](std::size_t half_edge) {
    const std::size_t v = vertices[half_edge];
    return std::array{xy[2 * v], xy[2 * v + 1]};
  };
  for (std::size_t t = 0; t < mesh.triangles; ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t n = across[3 * t + k];
      if ((!mesh.any_edge && (flags[t] >> k & 1U) == 0) || n == CADT_NONE || n < t) continue;
      const std::size_t beyond = std::size_t{3} * n + (across[3 * n] == t ? 0U : across[3 * n + 1] == t ? 1U : 2U);
      if (exact_in_circle(corner(3 * t), corner(3 * t + 1), corner(3 * t + 2), corner(beyond)) > 0)
        return static_cast<std::int64_t>(3 * t + k);
    }
  }
  return -1;
}

}  // namespace

void require_delaunay(Call& call) {
  MeshQueries::State& state = call.state;
  if (!state.mesh.edge_flags && !state.mesh.any_edge) return;
  if (!state.not_delaunay) state.not_delaunay = first_not_delaunay(call.ctx, state.mesh);
  if (*state.not_delaunay < 0) return;
  throw NotDelaunay("edge " + std::to_string(*state.not_delaunay % 3) + " of triangle " +
                        std::to_string(*state.not_delaunay / 3) +
                        " is not Delaunay, but nearest vertices, natural neighbours, Voronoi diagrams "
                        "and empty circles take a Delaunay mesh: triangulate the same vertices without segments for "
                        "them",
                    *state.not_delaunay);
}

Allocation array_of(Context& ctx, const DeviceArray& array, std::size_t element) {
  if (array.size == 0 || array.memory == nullptr) return {};
  return ctx.memory.wrap(array.memory, array.size * element);
}

std::size_t values_a_point(std::size_t values, std::size_t points) {
  if (points == 0 ? values != 0 : values == 0 || values % points != 0)
    throw InputError(std::to_string(values) + " values for " + std::to_string(points) +
                         " points: give the same number for each point",
                     points == 0 ? 0 : values / points);
  return points == 0 ? 1 : values / points;
}

void require_results(std::size_t queries, std::size_t each) {
  if (queries != 0 && each > max_results() / queries)
    throw LimitError("one call has fewer than 2^31 results: ask in several calls", each, max_results() / queries);
}

void locate_into(Call& call, const QueryBatch& queries, const Allocation& triangles, const Allocation& barycentric) {
  const MeshIndex& mesh = call.state.mesh;
  const Allocation none;
  locate_queries(call.ctx, mesh, queries, triangles, none);
  if (!barycentric) return;
  call.ctx.launcher.run<KernelId::cadt_barycentric_of>(QueryMesh{mesh.view(), queries.by}, queries.points,
                                                       queries.curve.order, triangles, barycentric,
                                                       call.ctx.launcher.grid(queries.count));
}

void nearest_into(Call& call, const QueryBatch& queries, std::size_t k, const Allocation& to) {
  const MeshIndex& mesh = call.state.mesh;
  const Allocation reached = call.ctx.memory.allocate(queries.count * word), none;
  locate_queries(call.ctx, mesh, queries, none, reached);
  find_nearest(call.ctx, mesh, queries, reached, k, to);
}

void require_neighbors(std::size_t queries, std::size_t k) {
  if (k == 0) throw OptionError("k", "must be at least 1", "");
  require_results(queries, k);
}

void require_bound(double max_edge) {
  if (!(max_edge >= 0)) throw OptionError("max_edge", "must be a number and not negative", "");
}

}  // namespace cadt::query
