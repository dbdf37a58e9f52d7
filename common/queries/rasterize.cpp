// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "common/driver/device_text.hpp"
#include "common/points/spatial_sort.hpp"
#include "common/queries/interpolate.hpp"

namespace cadt {
namespace {

using namespace device_text;

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr std::size_t cells_at_a_time = std::size_t{1} << 24;  // where each is a query

/// CADT_RASTER_PARAMETERS
struct RasterArguments {
  Grid grid;
  double first_x = static_cast<double>(grid.first_column), first_y = static_cast<double>(grid.first_row);
  std::uint32_t columns = static_cast<std::uint32_t>(grid.columns), rows = static_cast<std::uint32_t>(grid.rows);
  [[nodiscard]] auto arguments() const {
    return std::tie(grid.x0, grid.y0, grid.dx, grid.dy, first_x, first_y, columns, rows);
  }
};

/// Exponents of all centres, as those of a point in Bounds: of origin + (i + 0.5) step with i below `end`, rounded
/// twice.
void add_exponents(Bounds& bounds, double origin, double step, std::size_t end) {
  constexpr int mantissa = std::numeric_limits<double>::digits;
  const double last = origin + (static_cast<double>(end) - 0.5) * step;
  for (const double value : {origin, 0.5 * step, last})
    if (value != 0) bounds.high = std::max(bounds.high, std::ilogb(value) + 1);
  for (const double value : {origin, 0.5 * step})
    if (value != 0) bounds.low = std::min(bounds.low, std::ilogb(value) - mantissa);
}

Bounds bounds_of_centers(const Grid& grid) {
  Bounds bounds;
  add_exponents(bounds, grid.x0, grid.dx, grid.first_column + grid.columns);
  add_exponents(bounds, grid.y0, grid.dy, grid.first_row + grid.rows);
  // Centres that are rounded to subnormal numbers are not the scaled ones: they need the wide kernels, which do not
  // scale.
  constexpr int lowest = std::numeric_limits<double>::min_exponent - std::numeric_limits<double>::digits;
  if (bounds.low < lowest) bounds.high = std::max(bounds.high, bounds.low + narrow_span + 1);
  return bounds;
}

/// Triangle by triangle.
void draw(Context& ctx, const MeshIndex& mesh, const Grid& grid, const Allocation& values, double max_edge,
          const Allocation& cells) {
  Launcher& launch = ctx.launcher;
  const QueryMesh in{mesh.view(), scale_for(ctx, mesh, bounds_of_centers(grid))};
  Grid scaled = grid;
  for (double* value : {&scaled.x0, &scaled.y0, &scaled.dx, &scaled.dy})
    *value = *value * in.by.scale * in.by.scale_again;
  const RasterArguments raster{scaled};
  const Allocation large = ctx.memory.allocate(mesh.triangles * word), listed = launch.zeros(1);
  const LaunchGrid all = launch.grid(mesh.triangles);
  const double longest = max_edge * in.by.scale * in.by.scale_again;
  launch.run<KernelId::cadt_draw_small>(all.items, in, mesh.lowest, raster, longest, values, cells, large, listed,
                                        all.grain);
  ctx.check("raster", 0.5);
  const std::size_t count = launch.read_word(listed, 0);
  if (count == 0) return;
  const Allocation first_row = ctx.memory.allocate((count + 1) * word);
  // So many triangles at a time that their rows have numbers.
  const std::size_t most = std::max<std::size_t>(1, (std::size_t{1} << 31) / std::max<std::size_t>(1, grid.rows));
  for (std::size_t from = 0; from < count; from += most) {
    const std::size_t size = std::min(most, count - from);
    const Allocation part = from == 0 && size == count ? Allocation() : ctx.memory.allocate(size * word);
    if (part) {
      const auto list = ctx.device.read_values(*large, size, from);
      ctx.device.write(*part, 0, list.data(), size * word);
    }
    const Allocation& list = part ? part : large;
    launch.run<KernelId::cadt_large_rows>(in, raster, list, first_row, launch.grid(size));
    launch.scan(first_row, size + 1);
    const std::size_t rows = launch.read_word(first_row, size);
    launch.run<KernelId::cadt_draw_large>(in, mesh.lowest, raster, list, first_row, size, values, cells,
                                          launch.grid(rows));
  }
  ctx.check("raster", 1);
}

/// Cell by cell.
void query_cells(Context& ctx, MeshIndex& mesh, const Grid& grid, const Allocation& values, Interpolation method,
                 double max_edge, const Allocation& cells) {
  Launcher& launch = ctx.launcher;
  const std::size_t all = grid.cells();
  for (std::size_t from = 0; from < all; from += cells_at_a_time) {
    const std::size_t count = std::min(cells_at_a_time, all - from);
    Allocation centers = ctx.memory.allocate(count * sizeof(cadt_point));
    const Allocation results = ctx.memory.allocate(count * sizeof(double));
    launch.run<KernelId::cadt_cell_centers>(RasterArguments{grid}, from, centers, launch.grid(count));
    const QueryBatch queries = prepare_queries(ctx, mesh, std::move(centers), count);
    const Allocation located = interpolate_queries(ctx, mesh, queries, values, 1, method, Outside::nan, results);
    if (max_edge < unbounded) {
      launch.run<KernelId::cadt_drop_long_edges>(QueryMesh{mesh.view(), queries.by}, located,
                                                 max_edge * queries.by.scale * queries.by.scale_again, results,
                                                 launch.grid(count));
    }
    launch.run<KernelId::cadt_copy_words>(results, cells, static_cast<std::uint32_t>(2 * from), launch.grid(2 * count));
    ctx.check("raster", static_cast<double>(from + count) / static_cast<double>(all));
  }
}

}  // namespace

void require_grid(const Grid& grid) {
  constexpr std::size_t most = max_results();
  constexpr double exact = 2251799813685248.0;  // 2^51
  const auto first_column = static_cast<double>(grid.first_column), first_row = static_cast<double>(grid.first_row);
  if (first_column > exact || first_row > exact)
    throw InputError("a grid has at most 2^51 cells before its first one", 0);
  const double right = grid.x0 + (first_column + static_cast<double>(grid.columns) + 1) * grid.dx;
  const double top = grid.y0 + (first_row + static_cast<double>(grid.rows) + 1) * grid.dy;
  for (const double value : {grid.x0, grid.y0, grid.dx, grid.dy, right, top})
    if (!std::isfinite(value)) throw InputError("the grid has a corner or a cell that is not finite", 0);
  if (grid.dx == 0 || grid.dy == 0) throw InputError("the cells of the grid have no size: dx and dy must not be 0", 0);
  if (grid.columns != 0 && grid.rows > most / grid.columns) {
    constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
    const std::size_t count = grid.rows > all / grid.columns ? all : grid.columns * grid.rows;
    throw LimitError("a raster has fewer than 2^31 cells: take larger ones, or several rasters", count, most);
  }
}

void rasterize_mesh(Context& ctx, MeshIndex& mesh, const Grid& grid, const Allocation& values, Interpolation method,
                    double max_edge, const Allocation& cells) {
  if (method == Interpolation::linear || mesh.triangles == 0)
    ctx.launcher.run<KernelId::cadt_clear_raster>(cells, ctx.launcher.grid(grid.cells()));
  if (mesh.triangles == 0) return;
  if (method == Interpolation::linear)
    draw(ctx, mesh, grid, values, max_edge, cells);
  else
    query_cells(ctx, mesh, grid, values, method, max_edge, cells);
}

}  // namespace cadt
