// SPDX-License-Identifier: Apache-2.0
// What the calls of MeshQueries share (queries.cpp for the host, device_queries.cpp for device memory).
#pragma once

#include <cadt/queries.hpp>

#include <memory>
#include <optional>

#include "common/driver/context.hpp"
#include "common/driver/device_triangulation.hpp"
#include "common/driver/session.hpp"
#include "common/points/import.hpp"
#include "common/queries/mesh_index.hpp"

namespace cadt {

struct MeshQueries::State {
  std::shared_ptr<Triangulator::State> device;  // first member: destroyed last, after the memory
  std::optional<Triangulation> of;              ///< what `mesh` may alias
  std::optional<ConstrainedTriangulation> constrained;
  std::vector<double> vertices;  ///< of a constrained mesh that has added or moved points
  Options options;
  MeshIndex mesh;
  std::optional<std::int64_t> not_delaunay;  ///< NotDelaunay::edge(), or -1; once examined
};

namespace query {

/// One call: its options, statistics and context.
struct Call {
  explicit Call(MeshQueries::State& from)
      : state(from), ctx(*state.device->device, state.device->memory, state.options, statistics) {
    state.device->device->begin_call();
    begin_budget(*state.device, state.mesh.point_count);
    ctx.check("queries", 0);
  }
  /// Results in device memory are there when the call returns, or in the order of the caller's queue.
  void end() {
    if (!ctx.options.queue) ctx.device.finish();
  }
  MeshQueries::State& state;
  Statistics statistics;
  Context ctx;
};

/// \throws BackendUnavailable
void require_doubles(const Device& device);
/// \throws InputError
void require_mesh_of(std::size_t points, std::size_t of);
/// \throws InputError if the array is too small or has no memory
void require_room(const DeviceArray& array, std::size_t needed, const char* what);
/// \throws LimitError
void require_results(std::size_t queries, std::size_t each);
/// \throws OptionError, LimitError
void require_neighbors(std::size_t queries, std::size_t k);
/// \throws OptionError
void require_bound(double max_edge);
/// For what takes a Delaunay mesh. \throws NotDelaunay
void require_delaunay(Call& call);
inline void require_delaunay(Call& call, Interpolation method, Outside outside) {
  if (method != Interpolation::linear || outside == Outside::nearest) require_delaunay(call);
}
/// The number of values a point. \throws InputError
[[nodiscard]] std::size_t values_a_point(std::size_t values, std::size_t points);

/// The caller's memory; null if there is none.
[[nodiscard]] Allocation array_of(Context& ctx, const DeviceArray& array, std::size_t element);

[[nodiscard]] inline QueryBatch import_queries(Call& call, PointsView queries) {
  return prepare_queries(call.ctx, call.state.mesh, import_points(call.ctx, queries), queries.size());
}
[[nodiscard]] inline QueryBatch import_queries(Call& call, const DevicePoints& queries) {
  return prepare_queries(call.ctx, call.state.mesh, import_points(call.ctx, queries), queries.size);
}

/// `barycentric`: null if they are not wanted.
void locate_into(Call& call, const QueryBatch& queries, const Allocation& triangles, const Allocation& barycentric);
void nearest_into(Call& call, const QueryBatch& queries, std::size_t k, const Allocation& to);

}  // namespace query
}  // namespace cadt
