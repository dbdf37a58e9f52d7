// SPDX-License-Identifier: Apache-2.0
// MeshQueries is asked in device memory.
#include <cadt/queries.hpp>

#include "common/queries/call.hpp"
#include "common/queries/interpolate.hpp"
#include "common/queries/voronoi.hpp"

namespace cadt {

using device_text::word;
using namespace query;

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
  const QueryBatch batch = import_queries(call, queries);
  locate_into(call, batch, array_of(call.ctx, triangles, word), array_of(call.ctx, barycentric, sizeof(double)));
  call.end();
  return batch.count;
}

std::size_t MeshQueries::nearest_vertices(const DevicePoints& queries, std::size_t k, const DeviceArray& vertices) {
  require_size(queries.size);
  require_neighbors(queries.size, k);
  require_room(vertices, k * queries.size, "vertices");
  if (queries.size == 0) return 0;
  Call call(*state_);
  require_delaunay(call);
  const QueryBatch batch = import_queries(call, queries);
  nearest_into(call, batch, k, array_of(call.ctx, vertices, word));
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
  require_delaunay(call, method, outside);
  const QueryBatch batch = import_queries(call, queries);
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
  require_delaunay(call, method, Outside::nan);
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
  require_delaunay(call);
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
