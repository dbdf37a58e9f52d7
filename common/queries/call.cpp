// SPDX-License-Identifier: Apache-2.0
#include "common/queries/call.hpp"

#include <algorithm>
#include <string>

#include "common/points/device_points.hpp"

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
  constexpr std::size_t most = std::size_t{1} << 31;
  if (queries != 0 && each > (most - 1) / queries)
    throw LimitError("one call has fewer than 2^31 results: ask in several calls", each, (most - 1) / queries);
}

void locate_into(Call& call, const MeshIndex& mesh, const QueryBatch& queries, const Allocation& triangles,
                 const Allocation& barycentric) {
  const Allocation none;
  locate_queries(call.ctx, mesh, queries, triangles, none);
  if (!barycentric) return;
  call.ctx.launcher.run<KernelId::cadt_barycentric_of>(QueryMesh{mesh.view(), queries.by}, queries.points,
                                                       queries.curve.order, triangles, barycentric,
                                                       call.ctx.launcher.grid(queries.count));
}

void nearest_into(Call& call, const MeshIndex& mesh, const QueryBatch& queries, std::size_t k, const Allocation& to) {
  const Allocation reached = call.ctx.memory.allocate(queries.count * word), none;
  locate_queries(call.ctx, mesh, queries, none, reached);
  find_nearest(call.ctx, mesh, queries, reached, k, to);
}

void require_neighbors(std::size_t queries, std::size_t k) {
  if (k == 0) throw OptionError("k", "must be at least 1");
  require_results(queries, k);
}

void require_bound(double max_edge) {
  if (!(max_edge >= 0)) throw OptionError("max_edge", "must be a number and not negative");
}

}  // namespace cadt::query
