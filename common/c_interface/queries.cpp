// SPDX-License-Identifier: Apache-2.0
// Queries, and meshes in arrays of the caller's. Who asks for a count alone hears which sizes, options and grids the
// call would refuse; points are not looked at.
#include "common/c_interface/convert.hpp"
#include "common/queries/call.hpp"
#include "common/queries/interpolate.hpp"

using namespace cadt::c_interface;

struct cadt_voronoi {
  cadt::VoronoiDiagram diagram;
};
struct cadt_polygons {
  cadt::VoronoiPolygons polygons;
};
struct cadt_outline {
  cadt::Outline outline;
};

namespace {

cadt::Interpolation method_of(std::int32_t number) {
  switch (number) {
    case CADT_LINEAR:
      return cadt::Interpolation::linear;
    case CADT_NEAREST:
      return cadt::Interpolation::nearest;
    case CADT_NATURAL:
      return cadt::Interpolation::natural;
  }
  throw InvalidArgument("method", std::to_string(number) + " is none of CADT_LINEAR, CADT_NEAREST, CADT_NATURAL");
}

cadt::Outside outside_of(std::int32_t number) {
  if (number == CADT_OUTSIDE_NAN) return cadt::Outside::nan;
  if (number == CADT_OUTSIDE_NEAREST) return cadt::Outside::nearest;
  throw InvalidArgument("outside", std::to_string(number) + " is neither CADT_OUTSIDE_NAN nor CADT_OUTSIDE_NEAREST");
}

cadt::Grid grid_of(const cadt_grid* grid) {
  const cadt_grid& g = required(grid, "grid");
  return {g.x0, g.y0, g.dx, g.dy, g.columns, g.rows};
}

cadt::DeviceArray array_of(const cadt_device_array* array, const char* name) {
  const cadt_device_array& a = required(array, name);
  return {a.memory, a.size};
}

std::span<const double> values_of(const double* values, std::size_t count) {
  if (count != 0) require(values, "values");
  return {values, count};
}

}  // namespace

extern "C" {

cadt_status cadt_queries_open(const cadt_points* points, const cadt_triangulation* mesh, const cadt_options* options,
                              cadt_queries** queries) {
  return guarded([&] {
    auto& result = required(queries, "queries");
    const cadt::Triangulation& of = required(mesh, "mesh").mesh;
    const CallOptions given(options);
    const cadt::Options with = given.begin_call();
    result = new cadt_queries{
        given, points == nullptr ? cadt::MeshQueries(of, with) : cadt::MeshQueries(points_of(points), of, with)};
  });
}

cadt_status cadt_queries_open_arrays(const cadt_points* points, const cadt_mesh_view* mesh, const cadt_options* options,
                                     cadt_queries** queries) {
  return guarded([&] {
    auto& result = required(queries, "queries");
    const cadt::PointsView view = points_of(points);
    const auto of = take(mesh, "mesh");
    const std::size_t indices = indices_of(of.triangle_count);
    if (indices != 0) require(of.triangles, "mesh->triangles"), require(of.neighbors, "mesh->neighbors");
    cadt::MeshView arrays{{of.triangles, indices}, {of.neighbors, indices}, {}, {}};
    if (of.edge_flags != nullptr) arrays.edge_flags = {of.edge_flags, of.triangle_count};
    const CallOptions given(options);
    result = new cadt_queries{given, cadt::MeshQueries(view, arrays, given.begin_call())};
  });
}

cadt_status cadt_queries_open_device(cadt_triangulator* triangulator, const cadt_device_points* points,
                                     const cadt_device_triangulation* mesh, cadt_queries** queries) {
  return guarded([&] {
    auto& result = required(queries, "queries");
    auto& of = required(triangulator, "triangulator");
    const cadt::DevicePoints at = points_of(points);
    const cadt::DeviceTriangulation& on_device = required(mesh, "mesh").mesh;
    result = new cadt_queries{of.options, cadt::MeshQueries(of.begin_call(), at, on_device)};
  });
}

void cadt_queries_free(cadt_queries* queries) { delete queries; }

cadt_status cadt_queries_locate(cadt_queries* queries, const cadt_points* where, int32_t* triangles, size_t capacity,
                                size_t* count) {
  return guarded([&] {
    auto& asked = required(queries, "queries").begin_call();
    const cadt::PointsView at = points_of(where);
    cadt::require_size(at.size());
    if (has_room(triangles, capacity, at.size(), count)) std::ranges::copy(asked.locate(at), triangles);
  });
}

cadt_status cadt_queries_locate_barycentric(cadt_queries* queries, const cadt_points* where, int32_t* triangles,
                                            double* barycentric, size_t capacity, size_t* count) {
  return guarded([&] {
    auto& asked = required(queries, "queries").begin_call();
    const cadt::PointsView at = points_of(where);
    cadt::require_size(at.size());
    if (!has_room(triangles, capacity, at.size(), count)) return;
    require(barycentric, "barycentric");
    const cadt::Located found = asked.locate_barycentric(at);
    std::ranges::copy(found.triangles, triangles);
    std::ranges::copy(found.barycentric, barycentric);
  });
}

cadt_status cadt_queries_nearest_vertices(cadt_queries* queries, const cadt_points* where, size_t k, int32_t* vertices,
                                          size_t capacity, size_t* count) {
  return guarded([&] {
    auto& asked = required(queries, "queries").begin_call();
    const cadt::PointsView at = points_of(where);
    cadt::require_size(at.size());
    cadt::query::require_neighbors(at.size(), k);
    if (has_room(vertices, capacity, at.size() * k, count)) std::ranges::copy(asked.nearest_vertices(at, k), vertices);
  });
}

cadt_status cadt_queries_interpolate(cadt_queries* queries, const double* values, size_t value_count,
                                     const cadt_points* where, int32_t method, int32_t outside, double* results,
                                     size_t capacity, size_t* count) {
  return guarded([&] {
    auto& asked = required(queries, "queries").begin_call();
    const cadt::PointsView at = points_of(where);
    const auto from = values_of(values, value_count);
    const cadt::Interpolation by = method_of(method);
    const cadt::Outside beyond = outside_of(outside);
    cadt::require_size(at.size());
    const std::size_t each = cadt::query::values_a_point(value_count, asked.number_of_points());
    cadt::query::require_results(at.size(), each);
    if (has_room(results, capacity, at.size() * each, count))
      std::ranges::copy(asked.interpolate(from, at, by, beyond), results);
  });
}

cadt_status cadt_queries_rasterize(cadt_queries* queries, const cadt_grid* grid, const double* values,
                                   size_t value_count, int32_t method, double max_edge, double* cells, size_t capacity,
                                   size_t* count) {
  return guarded([&] {
    auto& asked = required(queries, "queries").begin_call();
    const cadt::Grid to = grid_of(grid);
    const auto from = values_of(values, value_count);
    const cadt::Interpolation by = method_of(method);
    cadt::require_grid(to);
    cadt::query::require_bound(max_edge);
    cadt::query::require_mesh_of(value_count, asked.number_of_points());
    if (has_room(cells, capacity, to.cells(), count)) std::ranges::copy(asked.rasterize(to, from, by, max_edge), cells);
  });
}

cadt_status cadt_queries_circumcenters(cadt_queries* queries, double* xy, size_t capacity, size_t* count) {
  return guarded([&] {
    auto& asked = required(queries, "queries").begin_call();
    if (has_room(xy, capacity, 2 * asked.number_of_triangles(), count)) std::ranges::copy(asked.circumcenters(), xy);
  });
}

cadt_status cadt_queries_largest_empty_circles(cadt_queries* queries, size_t k, cadt_circle* circles, size_t capacity,
                                               size_t* count) {
  return guarded([&] {
    const auto found = required(queries, "queries").begin_call().largest_empty_circles(k);
    if (!has_room(circles, capacity, found.size(), count)) return;
    for (const cadt::Circle& circle : found) *circles++ = {circle.x, circle.y, circle.radius, circle.triangle};
  });
}

cadt_status cadt_queries_voronoi(cadt_queries* queries, cadt_voronoi** diagram) {
  return guarded([&] {
    auto& result = required(diagram, "diagram");
    result = new cadt_voronoi{required(queries, "queries").begin_call().voronoi()};
  });
}

cadt_status cadt_voronoi_vertices(const cadt_voronoi* diagram, const double** xy, size_t* vertices) {
  return guarded([&] {
    const auto& list = required(diagram, "diagram").diagram.vertices;
    auto& array = required(xy, "xy");
    required(vertices, "vertices") = list.size() / 2;
    array = list.data();
  });
}

cadt_status cadt_voronoi_cells(const cadt_voronoi* diagram, const uint32_t** begin, size_t* points,
                               const int32_t** cells) {
  return guarded([&] {
    const auto& of = required(diagram, "diagram").diagram;
    auto& first = required(begin, "begin");
    auto& list = required(cells, "cells");
    required(points, "points") = of.cell_begin.size() - 1;
    first = of.cell_begin.data();
    list = of.cells.data();
  });
}

cadt_status cadt_voronoi_edges(const cadt_voronoi* diagram, const int32_t** points, const int32_t** vertices,
                               size_t* edges) {
  return guarded([&] {
    const auto& of = required(diagram, "diagram").diagram;
    auto& ends = required(points, "points");
    auto& sides = required(vertices, "vertices");
    required(edges, "edges") = of.edge_points.size() / 2;
    ends = of.edge_points.data();
    sides = of.edge_vertices.data();
  });
}

void cadt_voronoi_free(cadt_voronoi* diagram) { delete diagram; }

cadt_status cadt_queries_voronoi_polygons(cadt_queries* queries, const cadt_box* box, cadt_polygons** polygons) {
  return guarded([&] {
    auto& result = required(polygons, "polygons");
    const cadt_box& b = required(box, "box");
    result = new cadt_polygons{
        required(queries, "queries").begin_call().voronoi_polygons({b.min_x, b.min_y, b.max_x, b.max_y})};
  });
}

cadt_status cadt_polygons_get(const cadt_polygons* polygons, const uint32_t** begin, size_t* points,
                              const double** xy) {
  return guarded([&] {
    const auto& of = required(polygons, "polygons").polygons;
    auto& first = required(begin, "begin");
    auto& list = required(xy, "xy");
    required(points, "points") = of.begin.size() - 1;
    first = of.begin.data();
    list = of.xy.data();
  });
}

void cadt_polygons_free(cadt_polygons* polygons) { delete polygons; }

cadt_status cadt_queries_outline(cadt_queries* queries, double max_radius, double max_edge, cadt_outline** outline) {
  return guarded([&] {
    auto& result = required(outline, "outline");
    result = new cadt_outline{required(queries, "queries").begin_call().outline(max_radius, max_edge)};
  });
}

cadt_status cadt_outline_triangles(const cadt_outline* outline, const int32_t** triangles, size_t* count) {
  return guarded([&] {
    const auto& list = required(outline, "outline").outline.triangles;
    auto& array = required(triangles, "triangles");
    required(count, "count") = list.size();
    array = list.data();
  });
}

cadt_status cadt_outline_edges(const cadt_outline* outline, const int32_t** edges, size_t* count) {
  return guarded([&] {
    const auto& list = required(outline, "outline").outline.edges;
    auto& array = required(edges, "edges");
    required(count, "count") = list.size() / 2;
    array = list.data();
  });
}

void cadt_outline_free(cadt_outline* outline) { delete outline; }

cadt_status cadt_queries_locate_device(cadt_queries* queries, const cadt_device_points* where,
                                       const cadt_device_array* triangles) {
  return guarded(
      [&] { required(queries, "queries").begin_call().locate(points_of(where), array_of(triangles, "triangles")); });
}

cadt_status cadt_queries_nearest_vertices_device(cadt_queries* queries, const cadt_device_points* where, size_t k,
                                                 const cadt_device_array* vertices) {
  return guarded([&] {
    required(queries, "queries").begin_call().nearest_vertices(points_of(where), k, array_of(vertices, "vertices"));
  });
}

cadt_status cadt_queries_interpolate_device(cadt_queries* queries, const cadt_device_array* values,
                                            const cadt_device_points* where, int32_t method, int32_t outside,
                                            const cadt_device_array* results) {
  return guarded([&] {
    required(queries, "queries")
        .begin_call()
        .interpolate(array_of(values, "values"), points_of(where), array_of(results, "results"), method_of(method),
                     outside_of(outside));
  });
}

cadt_status cadt_queries_rasterize_device(cadt_queries* queries, const cadt_grid* grid, const cadt_device_array* values,
                                          int32_t method, double max_edge, const cadt_device_array* cells) {
  return guarded([&] {
    required(queries, "queries")
        .begin_call()
        .rasterize(grid_of(grid), array_of(values, "values"), array_of(cells, "cells"), method_of(method), max_edge);
  });
}

cadt_status cadt_triangulator_triangulate_device_into(cadt_triangulator* triangulator, const cadt_device_points* points,
                                                      const cadt_device_array* triangles,
                                                      const cadt_device_array* neighbors, size_t* count) {
  return guarded([&] {
    auto& number = required(count, "count");
    auto& of = required(triangulator, "triangulator");
    const cadt::DevicePoints at = points_of(points);
    const cadt::DeviceArray to = array_of(triangles, "triangles");
    number = of.begin_call().triangulate(at, to,
                                         neighbors == nullptr ? cadt::DeviceArray{} : array_of(neighbors, "neighbors"));
  });
}

cadt_status cadt_triangulator_triangulate_into(cadt_triangulator* triangulator, const cadt_points* points,
                                               int32_t* triangles, size_t triangles_capacity, int32_t* neighbors,
                                               size_t neighbors_capacity, size_t* count) {
  return guarded([&] {
    auto& number = required(count, "count");
    auto& of = required(triangulator, "triangulator");
    const cadt::PointsView at = points_of(points);
    if (triangles_capacity != 0) require(triangles, "triangles");
    if (neighbors_capacity != 0) require(neighbors, "neighbors");
    number = of.begin_call().triangulate(at, std::span(triangles, triangles_capacity),
                                         std::span(neighbors, neighbors_capacity));
  });
}
}
