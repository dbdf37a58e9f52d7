// SPDX-License-Identifier: Apache-2.0
// The public calls: arguments are checked, queries go to the device, results come back.
#include <cadt/queries.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "common/driver/context.hpp"
#include "common/driver/device_triangulation.hpp"
#include "common/driver/registry.hpp"
#include "common/driver/session.hpp"
#include "common/points/device_points.hpp"
#include "common/points/import.hpp"
#include "common/queries/interpolate.hpp"
#include "common/queries/results.hpp"
#include "common/queries/voronoi.hpp"

namespace cadt {

using device_text::word;

struct MeshQueries::State {
  std::shared_ptr<Triangulator::State> device;  // first member: destroyed last, after the memory
  std::optional<Triangulation> of;              ///< what `mesh` may alias
  Options options;
  MeshIndex mesh;
};

namespace {

/// One call: its options, statistics and context.
struct Call {
  explicit Call(MeshQueries::State& state)
      : ctx(*state.device->device, state.device->memory, state.options, statistics) {
    begin_budget(*state.device, state.mesh.point_count);
    ctx.check("queries", 0);
  }
  /// Results in device memory are there when the call returns, or in the order of the caller's queue.
  void end() {
    if (!ctx.options.queue) ctx.device.finish();
  }
  Statistics statistics;
  Context ctx;
};

void require_doubles(const Device& device) {
  if (!takes_floats_only(device)) return;
  const DeviceInfo& info = device.info();
  throw BackendUnavailable(
      std::string(to_string(info.backend)),
      "'" + info.name + "' has no double precision, which queries need: name another device, or the host");
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

/// Options of a call: queries have no phases to time.
Options for_queries(Options options) {
  options.statistics = StatisticsDetail::none;
  return options;
}

Allocation array_of(Context& ctx, const DeviceArray& array, std::size_t element) {
  if (array.size == 0 || array.memory == nullptr) return {};
  return ctx.memory.wrap(array.memory, array.size * element);
}

std::unique_ptr<MeshQueries::State> open(const Options& options) {
  auto state = std::make_unique<MeshQueries::State>();
  state->device = std::make_shared<Triangulator::State>(options, open_device(options), true);
  state->options = for_queries(options);
  require_doubles(*state->device->device);
  return state;
}

void index(MeshQueries::State& state, PointsView points, std::span<const std::int32_t> triangles,
           std::span<const std::int32_t> neighbors, bool trusted) {
  require_size(points.size());
  Call call(state);
  MeshIndex& mesh = state.mesh;
  mesh.point_count = points.size();
  mesh.triangles = triangles.size() / 3;
  if (points.size() != 0) mesh.points = import_points(call.ctx, points);
  if (mesh.triangles != 0) {
    mesh.vertices = call.ctx.memory.import(triangles.data(), triangles.size_bytes());
    mesh.across = call.ctx.memory.import(neighbors.data(), neighbors.size_bytes());
  }
  if (!trusted) check_mesh(call.ctx, mesh);
  index_mesh(call.ctx, mesh);
  call.ctx.device.finish();
}

/// The number of values a point. \throws InputError
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

template <class Points>
QueryBatch import_queries(Call& call, const MeshIndex& mesh, const Points& queries, std::size_t count) {
  return prepare_queries(call.ctx, mesh, import_points(call.ctx, queries), count);
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

}  // namespace

std::string_view to_string(Interpolation method) noexcept {
  constexpr std::array<std::string_view, 3> names = {"linear", "nearest", "natural"};
  return names[static_cast<std::size_t>(method)];
}

MeshQueries::MeshQueries(PointsView points, const Triangulation& mesh, const Options& options) : state_(open(options)) {
  require_mesh_of(points.size(), mesh.number_of_points());
  state_->of = mesh;
  index(*state_, points, mesh.triangles(), mesh.neighbors(), true);
}

MeshQueries::MeshQueries(const Triangulation& mesh, const Options& options) : state_(open(options)) {
  if (mesh.points().size() != mesh.number_of_points())
    throw InputError("the mesh has not kept its points: set Options::keep_points, or give them", 0);
  state_->of = mesh;
  index(*state_, state_->of->points(), mesh.triangles(), mesh.neighbors(), true);
}

MeshQueries::MeshQueries(PointsView points, const MeshView& mesh, const Options& options) : state_(open(options)) {
  if (mesh.triangles.size() % 3 != 0 || mesh.neighbors.size() != mesh.triangles.size())
    throw InputError("a mesh has three vertices and three neighbours a triangle, not " +
                         std::to_string(mesh.triangles.size()) + " and " + std::to_string(mesh.neighbors.size()) +
                         " in all (adopt() derives neighbours)",
                     std::min(mesh.triangles.size(), mesh.neighbors.size()) / 3);
  index(*state_, points, mesh.triangles, mesh.neighbors, false);
}

MeshQueries::MeshQueries(Triangulator& triangulator, const DevicePoints& points, const DeviceTriangulation& mesh)
    : state_(std::make_unique<State>()) {
  const DeviceTriangulation::Data& data = mesh.data();
  state_->device = triangulator.state();
  if (data.state != state_->device) throw InputError("the mesh is one of another triangulator", 0);
  require_mesh_of(points.size, data.points);
  require_doubles(*state_->device->device);
  state_->options = for_queries(triangulator.options());
  Call call(*state_);
  MeshIndex& index = state_->mesh;
  index.point_count = data.points;
  index.triangles = data.triangle_count;
  if (data.points != 0) index.points = import_points(call.ctx, points);
  if (data.triangle_count != 0) {
    const std::size_t bytes = 3 * data.triangle_count * word;
    index.vertices = call.ctx.memory.wrap(mesh.triangles(), bytes);
    index.across = call.ctx.memory.wrap(mesh.neighbors(), bytes);
  }
  index_mesh(call.ctx, index);
}

MeshQueries::~MeshQueries() = default;
MeshQueries::MeshQueries(MeshQueries&&) noexcept = default;
MeshQueries& MeshQueries::operator=(MeshQueries&&) noexcept = default;

std::size_t MeshQueries::number_of_points() const noexcept { return state_->mesh.point_count; }
std::size_t MeshQueries::number_of_triangles() const noexcept { return state_->mesh.triangles; }
const DeviceInfo& MeshQueries::device() const noexcept { return state_->device->device->info(); }

std::vector<std::int32_t> MeshQueries::locate(PointsView queries) {
  require_size(queries.size());
  if (queries.size() == 0) return {};
  Call call(*state_);
  const QueryBatch batch = import_queries(call, state_->mesh, queries, queries.size());
  return to_vector<std::int32_t>(call.ctx, batch.count,
                                 [&](const Allocation& to) { locate_into(call, state_->mesh, batch, to, {}); });
}

Located MeshQueries::locate_barycentric(PointsView queries) {
  require_size(queries.size());
  Located result;
  if (queries.size() == 0) return result;
  Call call(*state_);
  const QueryBatch batch = import_queries(call, state_->mesh, queries, queries.size());
  result.triangles = to_vector<std::int32_t>(call.ctx, batch.count, [&](const Allocation& triangles) {
    result.barycentric = to_vector<double>(call.ctx, 3 * batch.count, [&](const Allocation& barycentric) {
      locate_into(call, state_->mesh, batch, triangles, barycentric);
    });
  });
  return result;
}

std::vector<std::uint8_t> MeshQueries::within_hull(PointsView queries) {
  const std::vector<std::int32_t> triangles = locate(queries);
  std::vector<std::uint8_t> inside(triangles.size());
  std::ranges::transform(triangles, inside.begin(), [](std::int32_t t) { return t >= 0 ? 1 : 0; });
  return inside;
}

std::vector<std::int32_t> MeshQueries::nearest_vertex(PointsView queries) { return nearest_vertices(queries, 1); }

std::vector<std::int32_t> MeshQueries::nearest_vertices(PointsView queries, std::size_t k) {
  require_size(queries.size());
  require_neighbors(queries.size(), k);
  if (queries.size() == 0) return {};
  Call call(*state_);
  const QueryBatch batch = import_queries(call, state_->mesh, queries, queries.size());
  return to_vector<std::int32_t>(call.ctx, k * batch.count,
                                 [&](const Allocation& to) { nearest_into(call, state_->mesh, batch, k, to); });
}

std::vector<double> MeshQueries::interpolate(std::span<const double> values, PointsView queries, Interpolation method,
                                             Outside outside) {
  require_size(queries.size());
  const std::size_t each = values_a_point(values.size(), state_->mesh.point_count);
  require_results(queries.size(), each);
  if (queries.size() == 0) return {};
  Call call(*state_);
  const Allocation from = values.empty() ? Allocation() : call.ctx.memory.import(values.data(), values.size_bytes());
  const QueryBatch batch = import_queries(call, state_->mesh, queries, queries.size());
  return to_vector<double>(call.ctx, each * batch.count, [&](const Allocation& to) {
    interpolate_queries(call.ctx, state_->mesh, batch, from, each, method, outside, to);
  });
}

std::vector<double> MeshQueries::rasterize(const Grid& grid, std::span<const double> values, Interpolation method,
                                           double max_edge) {
  require_grid(grid);
  require_bound(max_edge);
  require_mesh_of(values.size(), state_->mesh.point_count);
  if (grid.cells() == 0) return {};
  Call call(*state_);
  const Allocation from = values.empty() ? Allocation() : call.ctx.memory.import(values.data(), values.size_bytes());
  return to_vector<double>(call.ctx, grid.cells(), [&](const Allocation& to) {
    rasterize_mesh(call.ctx, state_->mesh, grid, from, method, max_edge, to);
  });
}

std::vector<double> MeshQueries::circumcenters() {
  Call call(*state_);
  return to_vector<double>(call.ctx, 2 * state_->mesh.triangles,
                           [&](const Allocation& to) { write_circumcenters(call.ctx, state_->mesh, to); });
}

VoronoiDiagram MeshQueries::voronoi() {
  Call call(*state_);
  return make_voronoi(call.ctx, state_->mesh);
}

VoronoiPolygons MeshQueries::voronoi_polygons(const Box& box) {
  Call call(*state_);
  return clip_voronoi(call.ctx, state_->mesh, box);
}

std::vector<Circle> MeshQueries::largest_empty_circles(std::size_t k) {
  Call call(*state_);
  return find_largest_circles(call.ctx, state_->mesh, k);
}

Outline MeshQueries::outline(double max_radius, double max_edge) {
  Call call(*state_);
  return make_outline(call.ctx, state_->mesh, max_radius, max_edge);
}

std::size_t MeshQueries::locate(const DevicePoints& queries, const DeviceArray& triangles) {
  return locate_barycentric(queries, triangles, {});
}

std::size_t MeshQueries::locate_barycentric(const DevicePoints& queries, const DeviceArray& triangles,
                                            const DeviceArray& barycentric) {
  require_size(queries.size);
  require_room(triangles, queries.size, "triangles");
  if (barycentric.memory != nullptr) require_room(barycentric, 3 * queries.size, "barycentric coordinates");
  if (queries.size == 0) return 0;
  Call call(*state_);
  const QueryBatch batch = import_queries(call, state_->mesh, queries, queries.size);
  locate_into(call, state_->mesh, batch, array_of(call.ctx, triangles, word),
              array_of(call.ctx, barycentric, sizeof(double)));
  call.end();
  return batch.count;
}

std::size_t MeshQueries::nearest_vertices(const DevicePoints& queries, std::size_t k, const DeviceArray& vertices) {
  require_size(queries.size);
  require_neighbors(queries.size, k);
  require_room(vertices, k * queries.size, "vertices");
  if (queries.size == 0) return 0;
  Call call(*state_);
  const QueryBatch batch = import_queries(call, state_->mesh, queries, queries.size);
  nearest_into(call, state_->mesh, batch, k, array_of(call.ctx, vertices, word));
  call.end();
  return k * batch.count;
}

std::size_t MeshQueries::interpolate(const DeviceArray& values, const DevicePoints& queries, const DeviceArray& results,
                                     Interpolation method, Outside outside) {
  require_size(queries.size);
  const std::size_t each = values_a_point(values.size, state_->mesh.point_count);
  require_results(queries.size, each);
  require_room(values, values.size, "values");
  require_room(results, each * queries.size, "results");
  if (queries.size == 0) return 0;
  Call call(*state_);
  const QueryBatch batch = import_queries(call, state_->mesh, queries, queries.size);
  interpolate_queries(call.ctx, state_->mesh, batch, array_of(call.ctx, values, sizeof(double)), each, method, outside,
                      array_of(call.ctx, results, sizeof(double)));
  call.end();
  return each * batch.count;
}

std::size_t MeshQueries::rasterize(const Grid& grid, const DeviceArray& values, const DeviceArray& cells,
                                   Interpolation method, double max_edge) {
  require_grid(grid);
  require_bound(max_edge);
  require_mesh_of(values.size, state_->mesh.point_count);
  require_room(values, values.size, "values");
  require_room(cells, grid.cells(), "cells");
  if (grid.cells() == 0) return 0;
  Call call(*state_);
  rasterize_mesh(call.ctx, state_->mesh, grid, array_of(call.ctx, values, sizeof(double)), method, max_edge,
                 array_of(call.ctx, cells, sizeof(double)));
  call.end();
  return grid.cells();
}

std::size_t MeshQueries::circumcenters(const DeviceArray& xy) {
  require_room(xy, 2 * state_->mesh.triangles, "circumcentres");
  if (state_->mesh.triangles == 0) return 0;
  Call call(*state_);
  write_circumcenters(call.ctx, state_->mesh, array_of(call.ctx, xy, sizeof(double)));
  call.end();
  return 2 * state_->mesh.triangles;
}

std::size_t MeshQueries::voronoi(const DeviceVoronoi& to) {
  const std::size_t triangles = state_->mesh.triangles, n = state_->mesh.point_count;
  const bool edges = to.edge_points.memory != nullptr || to.edge_vertices.memory != nullptr;
  const auto require = [](const DeviceArray& array, std::size_t needed, const char* what) {
    if (array.memory != nullptr) require_room(array, needed, what);
  };
  require(to.vertices, 2 * triangles, "vertices");
  require(to.cells, 3 * triangles, "cells");
  if (to.cells.memory != nullptr || to.cell_begin.memory != nullptr) require_room(to.cell_begin, n + 1, "cell_begin");
  Call call(*state_);
  Context& ctx = call.ctx;
  Allocation begin;
  std::size_t count = 0;
  if (edges && triangles != 0) {
    begin = count_edges(ctx, state_->mesh);
    count = ctx.launcher.read_word(begin, triangles);
    require(to.edge_points, 2 * count, "edge_points");
    require(to.edge_vertices, 2 * count, "edge_vertices");
  }
  if (to.vertices.memory != nullptr) write_circumcenters(ctx, state_->mesh, array_of(ctx, to.vertices, sizeof(double)));
  if (to.cell_begin.memory != nullptr)
    write_cells(ctx, state_->mesh, array_of(ctx, to.cell_begin, word), array_of(ctx, to.cells, word));
  if (count != 0)
    write_edges(ctx, state_->mesh, begin, array_of(ctx, to.edge_points, word), array_of(ctx, to.edge_vertices, word));
  call.end();
  return count;
}

}  // namespace cadt
