// SPDX-License-Identifier: Apache-2.0
#include "common/output/renumber.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "common/driver/counters.hpp"

namespace cadt {
namespace {

using namespace device_text;

/// The compact plan makes the canonical order in so many parts, one after the other: the lists of each have this share
/// of the triangles.
constexpr std::uint32_t parts_of_compact_plan = 2;

struct PartBegin {
  std::uint32_t bucket = 0, triangle = 0;  ///< the first ones of a part
};

/// Where the parts begin, and where the last one ends.
std::vector<PartBegin> split_buckets(Context& ctx, const Allocation& buckets, std::size_t points,
                                     std::uint32_t triangles, std::uint32_t parts) {
  std::vector<PartBegin> begins(parts + std::size_t{1});
  if (parts == 1) {
    begins[1] = {static_cast<std::uint32_t>(points), triangles};
    return begins;
  }
  const Allocation found = ctx.memory.allocate(begins.size() * sizeof begins[0]);
  const LaunchGrid c = ctx.launcher.grid(points);
  ctx.launcher.run<KernelId::cadt_split_buckets>(c.items, buckets, points, triangles, parts, c.grain, found);
  return ctx.device.read_values<PartBegin>(*found, begins.size());
}

/// A part of the triangles in their buckets.
struct BucketPart {
  const Allocation& buckets;
  const Allocation& members;
  const Allocation& input_ids;
  const Allocation& result_begins;  ///< where buckets begin in the result; null: as their members do
  const Allocation& numbers;        ///< of all triangles
  std::uint32_t from, size;         ///< buckets
  std::uint32_t base, count;        ///< triangles
};

/// Longer buckets are sorted as one list by all work-items: one work-item takes 2 microseconds a triangle.
constexpr std::uint32_t longest_serial_bucket = 256;

/// Numbers what cadt_number_buckets has skipped, `listed` triangles.
void number_long_buckets(Context& ctx, const BucketPart& part, std::uint32_t listed) {
  Launcher& launch = ctx.launcher;
  Allocation ranks = ctx.memory.allocate((part.count + std::size_t{1}) * word);
  const LaunchGrid all = launch.grid(part.count), some = launch.grid(listed);
  launch.run<KernelId::cadt_long_flags>(part.buckets, part.from, part.size, part.base, longest_serial_bucket, all,
                                        ranks);
  launch.scan(ranks, part.count + std::size_t{1});
  const std::size_t bytes = listed * word;
  const Allocation seconds = ctx.memory.allocate(bytes), half_edges = ctx.memory.allocate(bytes);
  const Allocation owners = ctx.memory.allocate(bytes), places = ctx.memory.allocate(bytes);
  launch.run<KernelId::cadt_long_pack>(part.buckets, part.members, part.input_ids, part.result_begins, part.from,
                                       part.size, part.base, ranks, all, seconds, half_edges, owners, places);
  ranks.release();
  Allocation sorted = ctx.memory.allocate(bytes), order = ctx.memory.allocate(bytes);
  Allocation spare = ctx.memory.allocate(bytes), spare_order = ctx.memory.allocate(bytes);
  // Stable: first by the second vertex, then by bucket. The sort permutes its keys, so it gets copies.
  launch.run<KernelId::cadt_copy_words>(seconds, sorted, 0U, some);
  launch.sort(sorted, order, spare, spare_order, listed, 32, true);
  launch.run<KernelId::cadt_gather_words>(owners, order, sorted, some);
  launch.sort(sorted, order, spare, spare_order, listed, static_cast<unsigned>(std::bit_width(part.size)), false);
  launch.run<KernelId::cadt_long_numbers>(order, half_edges, places, part.numbers, some);
}

/// Numbers the triangles of each bucket by the second vertex.
void number_buckets(Context& ctx, const BucketPart& part) {
  Launcher& launch = ctx.launcher;
  const Allocation found = launch.zeros(1);
  const LaunchGrid c = launch.grid(part.size);
  const auto number = [&](std::uint32_t longest) {
    launch.run<KernelId::cadt_number_buckets>(c.items, part.buckets, part.members, part.input_ids, part.result_begins,
                                              part.numbers, part.from, part.size, part.base, longest, c.grain, found);
  };
  number(longest_serial_bucket);
  const std::uint32_t skipped = part.count > longest_serial_bucket ? launch.read_word(found, 0) : 0;
  if (skipped == 0) return;
  if (ctx.memory.allows((part.count + 8 * std::size_t{skipped} + 1) * word))
    number_long_buckets(ctx, part, skipped);
  else
    number(CADT_NONE);
}

/// Numbers all triangles from scanned buckets. \pre `numbers` are places in buckets where the device knows them
/// (canonical_order.dev.h)
void number_by_buckets(Context& ctx, const Mesh& mesh, const Allocation& buckets, const Allocation& result_begins,
                       const Allocation& numbers, std::size_t points) {
  Launcher& launch = ctx.launcher;
  const auto triangles = static_cast<std::uint32_t>(mesh.triangles);
  const std::uint32_t parts = ctx.plan.compact ? parts_of_compact_plan : 1;
  const std::vector<PartBegin> begins = split_buckets(ctx, buckets, points, triangles, parts);
  for (std::uint32_t part = 0; part < parts; ++part) {
    const auto [from, base] = begins[part];
    const std::uint32_t size = begins[part + 1].bucket - from, count = begins[part + 1].triangle - base;
    const Allocation members = ctx.memory.transient(std::size_t{count} * sizeof(cadt_member));
    launch.run<KernelId::cadt_bucket_triangles>(mesh.vertices, mesh.input_ids, buckets, numbers, members, from, size,
                                                base, launch.grid(triangles));
    number_buckets(ctx, {buckets, members, mesh.input_ids, result_begins, numbers, from, size, base, count});
  }
}

}  // namespace

std::vector<std::int32_t> chain_loop(std::vector<std::array<std::uint32_t, 2>> edges, std::size_t points) {
  // Few edges are searched: a table by point would be as long as the whole set, and writing it takes longer.
  const bool few = edges.size() < points / 64;
  std::vector<std::int32_t> table(few ? 0 : points, -1);
  if (few) std::sort(edges.begin(), edges.end());
  std::int32_t smallest = static_cast<std::int32_t>(edges.front()[0]);
  for (const auto& [from, to] : edges) {
    if (!few) table[from] = static_cast<std::int32_t>(to);
    smallest = std::min(smallest, static_cast<std::int32_t>(from));
  }
  const auto next = [&](std::int32_t at) {
    const auto from = static_cast<std::uint32_t>(at);
    if (!few) return table[from];
    const auto found = std::lower_bound(edges.begin(), edges.end(), std::array<std::uint32_t, 2>{from, 0});
    return found != edges.end() && (*found)[0] == from ? static_cast<std::int32_t>((*found)[1]) : -1;
  };
  std::vector<std::int32_t> loop;
  loop.reserve(edges.size());
  for (std::int32_t at = smallest; loop.size() < edges.size() && at >= 0; at = next(at)) {
    if (!loop.empty() && at == smallest) break;
    loop.push_back(at);
  }
  if (loop.size() != edges.size() || next(loop.back()) != smallest) give_up("the hull is not one loop");
  return loop;
}

Allocation number_triangles(Context& ctx, const Mesh& mesh, std::size_t points) {
  if (ctx.options.order == Order::fast) return {};
  Launcher& launch = ctx.launcher;
  const Allocation buckets = launch.zeros(points + 1);               // by vertex, of which there are as many or fewer
  Allocation result_begins;                                          // of buckets, by input id
  Allocation numbers = ctx.memory.transient(mesh.triangles * word);  // until they are known: places in the buckets
  launch.run<KernelId::cadt_count_triangles>(mesh.vertices, mesh.input_ids, buckets, numbers,
                                             launch.grid_strided(mesh.triangles));
  if (mesh.input_ids) {
    result_begins = ctx.memory.transient_zeros((points + 1) * word);
    launch.run<KernelId::cadt_sizes_by_input>(buckets, mesh.input_ids, result_begins, launch.grid(points));
    launch.scan(result_begins, points + 1);
  }
  launch.scan(buckets, points + 1);
  number_by_buckets(ctx, mesh, buckets, result_begins, numbers, points);
  return numbers;
}

void write_triangles(Context& ctx, const Mesh& mesh, const Allocation& numbers, const ResultPlace& to) {
  const Allocation none;
  if (numbers && !ctx.device.shape().contiguous) {
    const std::size_t groups = (mesh.triangles - 1) / CADT_OUTPUT_LANES + 1;
    ctx.launcher.run<KernelId::cadt_write_numbered>(view_of(mesh, none), mesh.input_ids, numbers, to.triangles,
                                                    to.neighbors, to.edge_flags, to.first,
                                                    ctx.launcher.grid_of_teams(groups, CADT_OUTPUT_LANES));
    return;
  }
  const LaunchGrid all = ctx.launcher.grid(mesh.triangles);
  ctx.launcher.run<KernelId::cadt_write_triangles>(all.items, view_of(mesh, none), mesh.input_ids, numbers,
                                                   to.triangles, to.neighbors, to.edge_flags, to.first, all.grain);
}

namespace {

/// Below, a few launches take longer than memory is worth.
constexpr std::size_t few_words = std::size_t{1} << 18;

/// Whether the arrays of the mesh become those of the result: in the fast order, with the compact plan, or where cached
/// buffers leave no memory for a second array.
bool in_place(const Context& ctx, const Mesh& mesh) noexcept {
  if (ctx.options.order == Order::fast || ctx.plan.compact) return true;
  return !mesh.vertices.host && ctx.memory.caches() && mesh.all * word >= few_words;
}

/// Slower than write_triangles with arrays of its own if the order is canonical.
void renumber_in_place(Context& ctx, Mesh& mesh, std::size_t points) {
  if (!mesh.finished) {
    const Allocation as_they_are;
    write_triangles(ctx, mesh, as_they_are, {mesh.vertices.device, mesh.across.device, mesh.edge_flags});
    mesh.input_ids.release();
  }
  const Allocation numbers = number_triangles(ctx, mesh, points);
  if (!numbers) return;
  const Allocation moved = ctx.memory.transient(mesh.triangles * word);
  const LaunchGrid all = ctx.launcher.grid(mesh.triangles);
  const auto move = [&](const Allocation& array, std::uint32_t row, std::uint32_t neighbors) {
    for (std::uint32_t k = 0; array && k < row; ++k) {
      ctx.launcher.run<KernelId::cadt_move_words>(array, numbers, row, k, neighbors, moved, all);
      ctx.launcher.run<KernelId::cadt_put_words>(moved, array, row, k, all);
    }
  };
  move(mesh.vertices.device, 3, 0);
  move(mesh.across.device, 3, 1);
  move(mesh.edge_flags, 1, 0);
}

}  // namespace

void write_result(Context& ctx, Mesh& mesh, std::size_t points) {
  if (in_place(ctx, mesh)) return renumber_in_place(ctx, mesh, points);
  Allocation numbers = number_triangles(ctx, mesh, points), flags;
  const Allocation none;
  ctx.check("output", 0.95);
  MeshArray neighbors = make_mesh_array(ctx, mesh.triangles, MeshUse::whole), vertices;
  const auto make_vertices = [&] {
    vertices = make_mesh_array(ctx, mesh.triangles, MeshUse::whole);
    if (mesh.edge_flags) flags = ctx.memory.allocate(mesh.triangles * word);
  };
  if (mesh.vertices.host && !mesh.edge_flags) {  // both at once: each triangle is read and rotated once
    make_vertices();
    write_triangles(ctx, mesh, numbers, {vertices.device, neighbors.device, none});
  } else {  // one after the other, so that the second reuses the memory of one of the mesh's
    write_triangles(ctx, mesh, numbers, {none, neighbors.device, none});
    mesh.across.release();
    make_vertices();
    write_triangles(ctx, mesh, numbers, {vertices.device, none, flags});
  }
  numbers.release();
  mesh.vertices.release();
  mesh.vertices = std::move(vertices);
  mesh.across = std::move(neighbors);
  mesh.edge_flags = std::move(flags);
  mesh.input_ids.release();
}

void renumber_within_sets(Context& ctx, const Allocation& set_starts, const SetStarts& sets, const ResultPlace& of,
                          std::size_t count) {
  const LaunchGrid c = ctx.launcher.grid(count);
  const auto shift = [&](const Allocation& values, const Allocation& by) {
    ctx.launcher.run<KernelId::cadt_batch_shift>(c.items, values, of.first, count, 3U, set_starts, sets.count, by,
                                                 c.grain);
  };
  shift(of.triangles, sets.points);
  shift(of.neighbors, set_starts);
}

std::vector<std::int32_t> find_hull(Context& ctx, const Allocation& triangles, const Allocation& neighbors,
                                    std::size_t count, std::size_t size, std::size_t points) {
  using Edge = std::array<std::uint32_t, 2>;
  Allocation pairs = ctx.memory.allocate(size * sizeof(Edge));
  Allocation written = ctx.launcher.zeros(1);
  ctx.launcher.run<KernelId::cadt_boundary_edges>(triangles, neighbors, ctx.launcher.grid(count), pairs, written, size);
  if (ctx.launcher.read_word(written, 0) != size) give_up("the boundary does not have the size of Euler's formula");
  return chain_loop(ctx.device.read_values<Edge>(*pairs, size), points);
}

}  // namespace cadt
