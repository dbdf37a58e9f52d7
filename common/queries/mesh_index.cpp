// SPDX-License-Identifier: Apache-2.0
#include "common/queries/mesh_index.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "common/driver/device_text.hpp"
#include "common/points/key_refinement.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {
namespace {

using namespace device_text;

constexpr int most_levels = 31, most_fine_levels = 15;  // of an axis; of the low word

/// Sorts n points along the curve of the grid.
CurveOrder sort_along_curve(Context& ctx, const Allocation& points, std::size_t n, const KeyGrid& grid) {
  Launcher& launch = ctx.launcher;
  const LaunchGrid all = launch.grid(n);
  const std::size_t bytes = n * word;
  const unsigned low_bits = 2 * grid.fine_levels;
  CurveOrder result;
  result.order = ctx.memory.allocate(bytes);
  result.high = ctx.memory.allocate(bytes);
  Allocation spare = ctx.memory.allocate(bytes), spare_order = ctx.memory.allocate(bytes);
  if (low_bits == 0) {
    make_keys(ctx, points, result.high, {}, n, grid);
    launch.sort(result.high, result.order, spare, spare_order, n, grid.bits(), true);
    return result;
  }
  // Two stable sorts, first by the low words. A sort permutes its keys, so it gets copies.
  const Allocation high = ctx.memory.allocate(bytes), low = ctx.memory.allocate(bytes);
  make_keys(ctx, points, high, low, n, grid);
  launch.run<KernelId::cadt_copy_words>(low, result.high, 0U, all);
  launch.sort(result.high, result.order, spare, spare_order, n, low_bits, true);
  launch.run<KernelId::cadt_gather_words>(high, result.order, result.high, all);
  launch.sort(result.high, result.order, spare, spare_order, n, grid.bits() - low_bits, false);
  result.low = std::move(spare);
  launch.run<KernelId::cadt_gather_words>(low, result.order, result.low, all);
  return result;
}

Bounds bounds_of(Context& ctx, const Allocation& points, std::size_t n) {
  return find_bounds(ctx, points, n, ctx.memory.allocate(CADT_ORDER_WORDS * word));
}

}  // namespace

void check_mesh(Context& ctx, const MeshIndex& mesh) {
  if (mesh.triangles == 0) return;
  const Allocation first = ctx.memory.allocate(word);
  ctx.device.fill(*first, 0, word, CADT_NONE);
  const LaunchGrid all = ctx.launcher.grid(mesh.triangles);
  ctx.launcher.run<KernelId::cadt_check_mesh>(all.items, mesh.view(), mesh.point_count, first, all.grain);
  const std::uint32_t wrong = ctx.launcher.read_word(first, 0);
  if (wrong == CADT_NONE) return;
  throw InputError(
      "triangle " + std::to_string(wrong) +
          " has an index out of range, a vertex twice, or a neighbour that does not have the same edge: give "
          "a mesh of these points with its neighbours, 0-based (verify() says more)",
      wrong);
}

void index_mesh(Context& ctx, MeshIndex& mesh) {
  const std::size_t n = mesh.point_count;
  Launcher& launch = ctx.launcher;
  if (n == 0) return;
  mesh.bounds = bounds_of(ctx, mesh.points, n);
  mesh.lowest = ctx.memory.allocate(n * word);
  ctx.device.fill(*mesh.lowest, 0, n * word, CADT_NONE);
  if (mesh.triangles == 0) return;
  launch.run<KernelId::cadt_lowest_triangles>(mesh.vertices, mesh.lowest, launch.grid(mesh.triangles));
  ctx.check("index", 1);
}

namespace {

/// The vertices along the curve.
void index_curve(Context& ctx, MeshIndex& mesh) {
  const std::size_t n = mesh.point_count;
  Launcher& launch = ctx.launcher;
  mesh.grid = choose_grid(mesh.bounds, std::clamp(static_cast<int>(std::bit_width(n)) + 4, 4, most_key_bits));
  CurveOrder curve = sort_along_curve(ctx, mesh.points, n, mesh.grid);
  Allocation flags = ctx.memory.allocate((n + 1) * word);
  // With many points in over-full cells, walks would be long.
  const int finer =
      std::min(most_fine_levels, most_levels - static_cast<int>(std::max(mesh.grid.bits_x, mesh.grid.bits_y)));
  if (finer > 0 && flag_overfull(ctx, curve.high, flags, n) > n / 8) {
    mesh.grid = mesh.grid.finer(finer);
    curve = {};
    curve = sort_along_curve(ctx, mesh.points, n, mesh.grid);
  }
  ctx.check("sort", 0.1);
  const LaunchGrid all = launch.grid(n);
  launch.run<KernelId::cadt_curve_flags>(curve.order, mesh.lowest, flags, all);
  launch.scan(flags, n + 1);
  const std::size_t size = launch.read_word(flags, n);
  mesh.start = ctx.memory.allocate(size * word);
  mesh.curve_high = ctx.memory.allocate(size * word);
  mesh.curve_low = curve.low ? ctx.memory.allocate(size * word) : Allocation();
  launch.run<KernelId::cadt_curve_pack>(curve.order, mesh.lowest, flags, curve.high, curve.low, mesh.start,
                                        mesh.curve_high, mesh.curve_low, all);
  mesh.curve_size = size;  // last: a call that is stopped before leaves it to the next one
}

}  // namespace

QueryScale scale_for(Context& ctx, const MeshIndex& mesh, const Bounds& queries) {
  const int low = std::min(mesh.bounds.low, queries.low), high = std::max(mesh.bounds.high, queries.high);
  QueryScale by;
  by.wide = high - low > narrow_span;
  ctx.launcher.set_variant(by.wide ? KernelVariant::wide : KernelVariant::narrow);
  const int exponent = by.wide || high < low ? 0 : -high;
  by.scale = std::ldexp(1.0, exponent / 2);  // in two steps: one factor may be out of range
  by.scale_again = std::ldexp(1.0, exponent - exponent / 2);
  return by;
}

QueryBatch prepare_queries(Context& ctx, MeshIndex& mesh, Allocation points, std::size_t count) {
  QueryBatch batch;
  batch.points = std::move(points);
  batch.count = count;
  Bounds bounds;
  try {
    bounds = bounds_of(ctx, batch.points, count);
  } catch (const InputError& error) {
    throw InputError("query " + std::to_string(error.index()) +
                         " has a coordinate that is NaN or infinite: remove it, or give it a finite one",
                     error.index());
  }
  if (mesh.triangles == 0) return batch;
  if (mesh.curve_size == 0) index_curve(ctx, mesh);
  batch.curve = sort_along_curve(ctx, batch.points, count, mesh.grid);
  batch.by = scale_for(ctx, mesh, bounds);
  ctx.check("sort", 0.3);
  return batch;
}

void locate_queries(Context& ctx, const MeshIndex& mesh, const QueryBatch& queries, const Allocation& located,
                    const Allocation& reached) {
  Launcher& launch = ctx.launcher;
  if (mesh.triangles == 0) {
    for (const Allocation* result : {&located, &reached})
      if (*result) ctx.device.fill(**result, 0, queries.count * word, CADT_NONE);
    return;
  }
  const Allocation lost = launch.zeros(1);
  launch.run<KernelId::cadt_locate_queries>(QueryMesh{mesh.view(), queries.by}, mesh.lowest, mesh.curve_high,
                                            mesh.curve_low, mesh.start, mesh.curve_size, 2 * mesh.grid.fine_levels,
                                            queries.points, queries.curve.high, queries.curve.low, queries.curve.order,
                                            located, reached, lost, launch.grid(queries.count));
  if (launch.read_word(lost, 0) != 0)
    throw InputError(
        "the mesh is no triangulation of the convex hull of these points, counterclockwise: a walk through it "
        "did not end (verify() says more)",
        0);
  ctx.check("locate", 0.8);
}

void find_nearest(Context& ctx, const MeshIndex& mesh, const QueryBatch& queries, const Allocation& reached,
                  std::size_t wanted, const Allocation& nearest) {
  if (mesh.triangles == 0) return ctx.device.fill(*nearest, 0, queries.count * wanted * word, CADT_NONE);
  // A launch cannot be stopped: each vertex after the first looks at all before it.
  constexpr std::size_t pairs_per_launch = std::size_t{1} << 26;
  const std::size_t step =
      std::max<std::size_t>({pairs_per_launch / wanted / wanted, ctx.device.shape().parallelism, 1});
  for (std::size_t first = 0; first < queries.count; first += step) {
    const std::size_t count = std::min(step, queries.count - first);
    ctx.launcher.run<KernelId::cadt_nearest_vertices>(QueryMesh{mesh.view(), queries.by}, mesh.lowest, mesh.point_count,
                                                      queries.points, queries.curve.order, reached, wanted, nearest,
                                                      first, ctx.launcher.grid(count));
    ctx.check("nearest", 0.8 + 0.1 * static_cast<double>(first + count) / static_cast<double>(queries.count));
  }
}

}  // namespace cadt
