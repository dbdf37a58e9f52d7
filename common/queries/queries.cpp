// SPDX-License-Identifier: Apache-2.0
// MeshQueries is opened, and asked from the host.
#include <cadt/queries.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "common/driver/registry.hpp"
#include "common/driver/triangulation_data.hpp"
#include "common/queries/call.hpp"
#include "common/queries/interpolate.hpp"
#include "common/queries/results.hpp"
#include "common/queries/voronoi.hpp"
#include "common/verify/host/exact_sign.hpp"

namespace cadt {

using device_text::word;
using namespace query;

namespace {

/// Options of a call: queries have no phases to time.
Options for_queries(Options options) {
  options.statistics = StatisticsDetail::none;
  return options;
}

std::unique_ptr<MeshQueries::State> open(const Options& options) {
  auto state = std::make_unique<MeshQueries::State>();
  state->device = std::make_shared<Triangulator::State>(options, open_device(options), true);
  state->options = for_queries(options);
  require_doubles(*state->device->device);
  return state;
}

void index(MeshQueries::State& state, PointsView points, std::span<const std::int32_t> triangles,
           std::span<const std::int32_t> neighbors, bool trusted, std::span<const std::uint32_t> edge_flags = {}) {
  require_size(points.size());
  Call call(state);
  MeshIndex& mesh = state.mesh;
  mesh.point_count = points.size();
  mesh.triangles = triangles.size() / 3;
  if (points.size() != 0) mesh.points = import_points(call.ctx, points);
  if (mesh.triangles != 0) {
    mesh.vertices = call.ctx.memory.import(triangles.data(), triangles.size_bytes());
    mesh.across = call.ctx.memory.import(neighbors.data(), neighbors.size_bytes());
    if (!edge_flags.empty()) mesh.edge_flags = call.ctx.memory.import(edge_flags.data(), edge_flags.size_bytes());
  }
  if (!trusted) check_mesh(call.ctx, mesh);
  index_mesh(call.ctx, mesh);
  call.ctx.device.finish();
}

/// \throws InvalidMesh
void require_counterclockwise(PointsView points, std::span<const std::int32_t> triangles) {
  verifier::require_ieee_arithmetic();
  for (std::size_t t = 0; 3 * t < triangles.size(); ++t) {
    const auto corner = [&](std::size_t k) {
      const auto v = static_cast<std::size_t>(triangles[3 * t + k]);
      return std::array{points.x(v), points.y(v)};
    };
    if (exact_orientation(corner(0), corner(1), corner(2)) <= 0)
      throw InvalidMesh("orientation", static_cast<std::int64_t>(t),
                        "triangle " + std::to_string(t) +
                            " is turned over by the rounding of crossings: make them on a grid, not exact");
  }
}

/// Of a constrained mesh without its segments it is not known which edges are constrained.
void index_of(MeshQueries::State& state, PointsView points, const Triangulation& mesh) {
  state.mesh.any_edge = mesh.data().constrained;
  if (mesh.data().constrained) require_counterclockwise(points, mesh.triangles());
  index(state, points, mesh.triangles(), mesh.neighbors(), true);
}

}  // namespace

std::string_view to_string(Interpolation method) noexcept {
  constexpr std::array<std::string_view, 3> names = {"linear", "nearest", "natural"};
  return names[static_cast<std::size_t>(method)];
}

MeshQueries::MeshQueries(PointsView points, const Triangulation& mesh, const Options& options) : state_(open(options)) {
  require_mesh_of(points.size(), mesh.number_of_points());
  state_->of = mesh;
  index_of(*state_, points, mesh);
}

MeshQueries::MeshQueries(const Triangulation& mesh, const Options& options) : state_(open(options)) {
  if (mesh.points().size() != mesh.number_of_points())
    throw InputError("the mesh has not kept its points: set Options::keep_points, or give them", 0);
  state_->of = mesh;
  index_of(*state_, state_->of->points(), mesh);
}

MeshQueries::MeshQueries(PointsView points, const ConstrainedTriangulation& mesh, const Options& options)
    : state_(open(options)) {
  const std::size_t added = mesh.added_points().size() / 2, all = mesh.mesh().number_of_points();
  if (points.size() + added != all) require_mesh_of(points.size(), all - added);
  state_->constrained = mesh;
  const Triangulation& of = state_->constrained->mesh();
  if (const auto moved = mesh.moved_points(); added != 0 || !moved.empty()) {
    std::vector<double>& vertices = state_->vertices;
    vertices.assign(moved.begin(), moved.end());
    for (std::size_t i = moved.size() / 2; i < points.size(); ++i)
      vertices.insert(vertices.end(), {points.x(i), points.y(i)});
    vertices.insert(vertices.end(), mesh.added_points().begin(), mesh.added_points().end());
    points = vertices;
  }
  if (!mesh.rounded_valid()) require_counterclockwise(points, of.triangles());
  state_->mesh.any_edge = added != 0;
  index(*state_, points, of.triangles(), of.neighbors(), true, mesh.edge_flags());
}

MeshQueries::MeshQueries(PointsView points, const MeshView& mesh, const Options& options) : state_(open(options)) {
  if (mesh.triangles.size() % 3 != 0 || mesh.neighbors.size() != mesh.triangles.size())
    throw InputError("a mesh has three vertices and three neighbours a triangle, not " +
                         std::to_string(mesh.triangles.size()) + " and " + std::to_string(mesh.neighbors.size()) +
                         " in all (adopt() derives neighbours)",
                     std::min(mesh.triangles.size(), mesh.neighbors.size()) / 3);
  if (!mesh.edge_flags.empty() && 3 * mesh.edge_flags.size() != mesh.triangles.size())
    throw InputError("a mesh has no or one word of edge flags a triangle, not " +
                         std::to_string(mesh.edge_flags.size()) + " for " + std::to_string(mesh.triangles.size() / 3),
                     std::min(mesh.edge_flags.size(), mesh.triangles.size() / 3));
  index(*state_, points, mesh.triangles, mesh.neighbors, false, mesh.edge_flags);
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
  index.any_edge = data.added != 0;
  if (data.points != 0) index.points = import_points(call.ctx, points);
  if (!data.rounded_valid) {
    Device& device = call.ctx.device;
    const auto xy = device.read_values<double>(*index.points, 2 * data.points);
    require_counterclockwise(xy, device.read_values<std::int32_t>(*data.triangles, 3 * data.triangle_count));
  }
  if (data.triangle_count != 0) {
    const std::size_t bytes = 3 * data.triangle_count * word;
    index.vertices = call.ctx.memory.wrap(mesh.triangles(), bytes);
    index.across = call.ctx.memory.wrap(mesh.neighbors(), bytes);
    if (mesh.edge_flags() != nullptr)
      index.edge_flags = call.ctx.memory.wrap(mesh.edge_flags(), data.triangle_count * word);
  }
  index_mesh(call.ctx, index);
}

MeshQueries::~MeshQueries() = default;
MeshQueries::MeshQueries(MeshQueries&&) noexcept = default;
MeshQueries& MeshQueries::operator=(MeshQueries&&) noexcept = default;

std::size_t MeshQueries::number_of_points() const noexcept { return state_->mesh.point_count; }
std::size_t MeshQueries::number_of_triangles() const noexcept { return state_->mesh.triangles; }
const DeviceInfo& MeshQueries::device() const noexcept { return state_->device->device->info(); }
Options& MeshQueries::options() noexcept { return state_->options; }

std::vector<std::int32_t> MeshQueries::locate(PointsView queries) {
  require_size(queries.size());
  if (queries.size() == 0) return {};
  Call call(*state_);
  const QueryBatch batch = import_queries(call, queries);
  return to_vector<std::int32_t>(call.ctx, batch.count,
                                 [&](const Allocation& to) { locate_into(call, batch, to, {}); });
}

Located MeshQueries::locate_barycentric(PointsView queries) {
  require_size(queries.size());
  Located result;
  if (queries.size() == 0) return result;
  Call call(*state_);
  const QueryBatch batch = import_queries(call, queries);
  result.triangles = to_vector<std::int32_t>(call.ctx, batch.count, [&](const Allocation& triangles) {
    result.barycentric = to_vector<double>(call.ctx, 3 * batch.count, [&](const Allocation& barycentric) {
      locate_into(call, batch, triangles, barycentric);
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
  require_delaunay(call);
  const QueryBatch batch = import_queries(call, queries);
  return to_vector<std::int32_t>(call.ctx, k * batch.count,
                                 [&](const Allocation& to) { nearest_into(call, batch, k, to); });
}

std::vector<double> MeshQueries::interpolate(std::span<const double> values, PointsView queries, Interpolation method,
                                             Outside outside) {
  require_size(queries.size());
  const std::size_t each = values_a_point(values.size(), state_->mesh.point_count);
  require_results(queries.size(), each);
  if (queries.size() == 0) return {};
  Call call(*state_);
  require_delaunay(call, method, outside);
  const Allocation from = values.empty() ? Allocation() : call.ctx.memory.import(values.data(), values.size_bytes());
  const QueryBatch batch = import_queries(call, queries);
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
  require_delaunay(call, method, Outside::nan);
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
  require_delaunay(call);
  return make_voronoi(call.ctx, state_->mesh);
}

VoronoiPolygons MeshQueries::voronoi_polygons(const Box& box) {
  Call call(*state_);
  require_delaunay(call);
  return clip_voronoi(call.ctx, state_->mesh, box);
}

std::vector<Circle> MeshQueries::largest_empty_circles(std::size_t k) {
  Call call(*state_);
  require_delaunay(call);
  return find_largest_circles(call.ctx, state_->mesh, k);
}

Outline MeshQueries::outline(double max_radius, double max_edge) {
  Call call(*state_);
  return make_outline(call.ctx, state_->mesh, max_radius, max_edge);
}

}  // namespace cadt
