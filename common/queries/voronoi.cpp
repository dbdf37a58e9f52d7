// SPDX-License-Identifier: Apache-2.0
#include "common/queries/voronoi.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "common/driver/device_text.hpp"
#include "common/queries/results.hpp"

namespace cadt {
namespace {

using namespace device_text;

/// The first place from `end` on whose key is not the one before it, or `count`. \pre end > 0
std::size_t end_of_equal_keys(Context& ctx, const Allocation& keys, std::size_t count, std::size_t end) {
  constexpr std::size_t at_a_time = 4096;
  while (end < count) {
    const auto key = ctx.device.read_values(*keys, std::min(at_a_time, count - end) + 1, end - 1);
    const auto other = std::ranges::adjacent_find(key, std::not_equal_to<>());
    end += static_cast<std::size_t>((other == key.end() ? key.end() - 1 : other) - key.begin());
    if (other != key.end()) break;
  }
  return end;
}

QueryMesh in_own_scale(Context& ctx, const MeshIndex& mesh) { return {mesh.view(), scale_for(ctx, mesh, mesh.bounds)}; }

/// Exponents, as those of points.
Bounds bounds_of_sides(const Box& box) {
  Bounds bounds;
  for (const double side : {box.min_x, box.min_y, box.max_x, box.max_y}) {
    if (side == 0) continue;
    bounds.high = std::max(bounds.high, std::ilogb(side) + 1);
    bounds.low = std::min(bounds.low, std::ilogb(side) - std::numeric_limits<double>::digits);
  }
  return bounds;
}

}  // namespace

void write_circumcenters(Context& ctx, const MeshIndex& mesh, const Allocation& xy) {
  if (mesh.triangles == 0) return;
  const LaunchGrid all = ctx.launcher.grid(mesh.triangles);
  ctx.launcher.run<KernelId::cadt_circumcenters>(all.items, in_own_scale(ctx, mesh), xy, all.grain);
}

void write_cells(Context& ctx, const MeshIndex& mesh, const Allocation& begin, const Allocation& cells) {
  Launcher& launch = ctx.launcher;
  const std::size_t n = mesh.point_count;
  ctx.device.fill(*begin, 0, (n + 1) * word, 0);
  if (mesh.triangles == 0) return;
  const LaunchGrid all = launch.grid(mesh.triangles);
  launch.run<KernelId::cadt_cell_sizes>(all.items, mesh.view(), begin, all.grain);
  launch.scan(begin, n + 1);
  if (!cells) return;
  launch.run<KernelId::cadt_cell_triangles>(in_own_scale(ctx, mesh), mesh.lowest, begin, cells, launch.grid(n));
}

Allocation count_edges(Context& ctx, const MeshIndex& mesh) {
  Launcher& launch = ctx.launcher;
  Allocation begin = ctx.memory.allocate((mesh.triangles + 1) * word);
  const LaunchGrid all = launch.grid(mesh.triangles);
  launch.run<KernelId::cadt_edge_counts>(all.items, mesh.view(), begin, all.grain);
  launch.scan(begin, mesh.triangles + 1);
  return begin;
}

void write_edges(Context& ctx, const MeshIndex& mesh, const Allocation& begin, const Allocation& points,
                 const Allocation& vertices) {
  const LaunchGrid all = ctx.launcher.grid(mesh.triangles);
  ctx.launcher.run<KernelId::cadt_list_edges>(all.items, mesh.view(), begin, points, vertices, all.grain);
}

VoronoiDiagram make_voronoi(Context& ctx, const MeshIndex& mesh) {
  VoronoiDiagram result;
  const std::size_t n = mesh.point_count, triangles = mesh.triangles;
  if (triangles == 0) {
    result.cell_begin.assign(n + 1, 0);
    return result;
  }
  result.vertices =
      to_vector<double>(ctx, 2 * triangles, [&](const Allocation& to) { write_circumcenters(ctx, mesh, to); });
  ctx.check("voronoi", 0.3);
  result.cell_begin = to_vector<std::uint32_t>(ctx, n + 1, [&](const Allocation& begin) {
    result.cells = to_vector<std::int32_t>(ctx, 3 * triangles,
                                           [&](const Allocation& cells) { write_cells(ctx, mesh, begin, cells); });
  });
  ctx.check("voronoi", 0.6);
  const Allocation begin = count_edges(ctx, mesh);
  const std::size_t edges = ctx.launcher.read_word(begin, triangles);
  result.edge_points = to_vector<std::int32_t>(ctx, 2 * edges, [&](const Allocation& points) {
    result.edge_vertices = to_vector<std::int32_t>(
        ctx, 2 * edges, [&](const Allocation& vertices) { write_edges(ctx, mesh, begin, points, vertices); });
  });
  ctx.check("voronoi", 1);
  return result;
}

VoronoiPolygons clip_voronoi(Context& ctx, const MeshIndex& mesh, const Box& box) {
  for (const double value : {box.min_x, box.min_y, box.max_x, box.max_y})
    if (!std::isfinite(value)) throw InputError("the box has a side that is not finite", 0);
  if (!(box.min_x < box.max_x && box.min_y < box.max_y))
    throw InputError("the box has no area: min must be below max", 0);
  Launcher& launch = ctx.launcher;
  VoronoiPolygons result;
  const std::size_t n = mesh.point_count;
  if (mesh.triangles == 0) {
    result.begin.assign(n + 1, 0);
    return result;
  }
  const Allocation begin = ctx.memory.allocate((n + 1) * word), none;
  write_cells(ctx, mesh, begin, none);
  const Allocation rows = ctx.memory.allocate((3 * mesh.triangles + 5 * n) * sizeof(cadt_point));
  const Allocation sizes = ctx.memory.allocate((n + 1) * word);
  const Bounds sides = bounds_of_sides(box);
  QueryMesh in{mesh.view(), scale_for(ctx, mesh, sides)};
  if (in.by.wide) {  // far from subnormal numbers, but such that no difference or sum overflows
    const int exponent = 1021 - std::max(mesh.bounds.high, sides.high);
    in.by.scale = std::ldexp(1.0, exponent / 2);
    in.by.scale_again = std::ldexp(1.0, exponent - exponent / 2);
  }
  const auto scaled = [&](double side) { return side * in.by.scale * in.by.scale_again; };
  launch.run<KernelId::cadt_clip_cells>(in, mesh.lowest, begin, scaled(box.min_x), scaled(box.min_y), scaled(box.max_x),
                                        scaled(box.max_y), rows, sizes, launch.grid(n));
  launch.scan(sizes, n + 1);
  result.begin = ctx.device.read_values(*sizes, n + 1);
  ctx.check("voronoi", 0.7);
  result.xy = to_vector<double>(ctx, 2 * std::size_t{result.begin.back()}, [&](const Allocation& to) {
    launch.run<KernelId::cadt_pack_cells>(rows, begin, sizes, to, launch.grid(n));
  });
  ctx.check("voronoi", 1);
  return result;
}

std::vector<Circle> find_largest_circles(Context& ctx, MeshIndex& mesh, std::size_t wanted) {
  Launcher& launch = ctx.launcher;
  const std::size_t count = mesh.triangles, bytes = count * word;
  std::vector<Circle> found;
  if (count == 0 || wanted == 0) return found;
  wanted = std::min(wanted, count);
  Allocation keys = ctx.memory.allocate(bytes), order = ctx.memory.allocate(bytes);
  {
    Allocation spare = ctx.memory.allocate(bytes), spare_order = ctx.memory.allocate(bytes);
    const LaunchGrid all = launch.grid(count);
    launch.run<KernelId::cadt_radius_keys>(all.items, in_own_scale(ctx, mesh), keys, all.grain);
    launch.sort(keys, order, spare, spare_order, count, 32, true);
  }
  ctx.check("circles", 0.5);
  // From large to small until enough have their centres in the hull. The keys are rounded radii, so a part of the list
  // ends with a key that is not the same as the next one.
  for (std::size_t from = 0; from < count && found.size() < wanted;) {
    const std::size_t end = end_of_equal_keys(ctx, keys, count, std::min(count, from + 2 * wanted + 256));
    const std::size_t size = end - from;
    const auto triangles = ctx.device.read_values(*order, size, from);
    const Allocation list = ctx.memory.allocate(size * word), circles = ctx.memory.allocate(size * sizeof(cadt_circle));
    ctx.device.write(*list, 0, triangles.data(), size * word);
    launch.run<KernelId::cadt_circles_of>(in_own_scale(ctx, mesh), list, circles, launch.grid(size));
    const auto circle = ctx.device.read_values<cadt_circle>(*circles, size);
    std::vector<Circle> kept, elsewhere;
    std::vector<double> centers;
    for (std::size_t i = 0; i < size; ++i) {
      const auto& [x, y, radius, inside] = circle[i];
      if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(radius)) continue;
      // A centre in its triangle is in the hull, even if it is on the hull and rounding has put it outside.
      (inside != 0 ? kept : elsewhere).push_back({x, y, radius, static_cast<std::int32_t>(triangles[i])});
      if (inside == 0) centers.insert(centers.end(), {x, y});
    }
    if (!elsewhere.empty()) {
      Allocation points = ctx.memory.allocate(centers.size() * sizeof(double));
      ctx.device.write(*points, 0, centers.data(), centers.size() * sizeof(double));
      const QueryBatch queries = prepare_queries(ctx, mesh, std::move(points), elsewhere.size());
      const Allocation located = ctx.memory.allocate(elsewhere.size() * word), none;
      locate_queries(ctx, mesh, queries, located, none);
      const auto found_in = ctx.device.read_values(*located, elsewhere.size());
      for (std::size_t i = 0; i < elsewhere.size(); ++i)
        if (found_in[i] != CADT_NONE) kept.push_back(elsewhere[i]);
    }
    std::ranges::sort(kept, [](const Circle& a, const Circle& b) {
      return std::tuple(-a.radius, a.triangle) < std::tuple(-b.radius, b.triangle);
    });
    found.insert(found.end(), kept.begin(), kept.end());
    from = end;
  }
  if (found.size() > wanted) found.resize(wanted);
  return found;
}

Outline make_outline(Context& ctx, const MeshIndex& mesh, double max_radius, double max_edge) {
  for (const auto& [name, value] : {std::pair("max_radius", max_radius), std::pair("max_edge", max_edge)})
    if (!(value >= 0)) throw OptionError(name, "must be a number and not negative", "");
  Launcher& launch = ctx.launcher;
  Outline result;
  const std::size_t count = mesh.triangles;
  if (count == 0) return result;
  const LaunchGrid all = launch.grid(count);
  const Allocation places = ctx.memory.allocate((count + 1) * word);
  const QueryMesh in = in_own_scale(ctx, mesh);
  launch.run<KernelId::cadt_flag_compact>(all.items, in, max_edge * in.by.scale * in.by.scale_again, max_radius, places,
                                          all.grain);
  launch.scan(places, count + 1);
  result.triangles = to_vector<std::int32_t>(ctx, launch.read_word(places, count), [&](const Allocation& to) {
    launch.run<KernelId::cadt_pack_kept>(places, to, all);
  });
  const Allocation begin = ctx.memory.allocate((count + 1) * word);
  launch.run<KernelId::cadt_outline_counts>(all.items, mesh.view(), places, begin, all.grain);
  launch.scan(begin, count + 1);
  result.edges =
      to_vector<std::int32_t>(ctx, 2 * std::size_t{launch.read_word(begin, count)}, [&](const Allocation& to) {
        launch.run<KernelId::cadt_outline_edges>(all.items, mesh.view(), places, begin, to, all.grain);
      });
  return result;
}

}  // namespace cadt
