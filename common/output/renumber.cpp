// SPDX-License-Identifier: Apache-2.0
#include "common/output/renumber.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <utility>

#include "common/driver/counters.hpp"

namespace cadt {
namespace {

constexpr std::size_t word = sizeof(std::uint32_t);
constexpr std::uint32_t none = 0xFFFFFFFFU;

/// The values of `from` where the sets begin.
Allocation values_of_sets(Context& ctx, const Allocation& from, const Allocation& places, const SetStarts& sets) {
  Allocation values = ctx.memory.allocate((sets.count + 1) * word);
  const LaunchGrid c = ctx.launcher.grid(sets.count + 1);
  ctx.launcher.run<KernelId::cadt_gather_words>(c.items, from, places, values,
                                                static_cast<std::uint32_t>(sets.count + 1), c.grain);
  return values;
}

/// Where the triangles of the sets begin: two a vertex.
Allocation first_records(Context& ctx, const SetStarts& sets) {
  std::vector<std::uint32_t> places(sets.count + 1);
  ctx.device.read(*(sets.positions ? sets.positions : sets.points), 0, places.data(), places.size() * word);
  for (std::uint32_t& place : places) place *= 2;
  Allocation result = ctx.memory.allocate(places.size() * word);
  ctx.device.write(*result, 0, places.data(), places.size() * word);
  return result;
}

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
  ctx.launcher.run<KernelId::cadt_split_buckets>(c.items, buckets, static_cast<std::uint32_t>(points), triangles, parts,
                                                 c.grain, found);
  ctx.device.read(*found, 0, begins.data(), begins.size() * sizeof begins[0]);
  return begins;
}

/// A part of the triangles in their buckets.
struct BucketPart {
  const Allocation& buckets;
  const Allocation& members;
  std::uint32_t from, size;   ///< buckets
  std::uint32_t base, count;  ///< triangles
};

/// Longer buckets are sorted as one list by all work-items: one work-item takes 2 microseconds a triangle.
constexpr std::uint32_t longest_serial_bucket = 256;

/// Sorts what cadt_sort_buckets has skipped, `listed` triangles.
void sort_long_buckets(Context& ctx, const BucketPart& part, std::uint32_t listed) {
  Launcher& launch = ctx.launcher;
  Allocation ranks = ctx.memory.allocate((part.count + std::size_t{1}) * word);
  const LaunchGrid all = launch.grid(part.count), some = launch.grid(listed);
  launch.run<KernelId::cadt_long_flags>(all.items, part.buckets, part.from, part.size, part.base, longest_serial_bucket,
                                        part.count, all.grain, ranks);
  launch.scan(ranks, part.count + std::size_t{1});
  const std::size_t bytes = listed * word;
  const Allocation seconds = ctx.memory.allocate(bytes), numbers = ctx.memory.allocate(bytes);
  const Allocation owners = ctx.memory.allocate(bytes), places = ctx.memory.allocate(bytes);
  launch.run<KernelId::cadt_long_pack>(all.items, part.buckets, part.members, part.from, part.size, part.base, ranks,
                                       part.count, all.grain, seconds, numbers, owners, places);
  ranks.release();
  Allocation sorted = ctx.memory.allocate(bytes), order = ctx.memory.allocate(bytes);
  Allocation spare = ctx.memory.allocate(bytes), spare_order = ctx.memory.allocate(bytes);
  // Stable: first by the second vertex, then by bucket. The sort permutes its keys, so it gets copies.
  launch.run<KernelId::cadt_copy_words>(some.items, seconds, sorted, std::uint32_t{0}, listed, some.grain);
  launch.sort(sorted, order, spare, spare_order, listed, 32, true);
  launch.run<KernelId::cadt_gather_words>(some.items, owners, order, sorted, listed, some.grain);
  launch.sort(sorted, order, spare, spare_order, listed, static_cast<unsigned>(std::bit_width(part.size)), false);
  launch.run<KernelId::cadt_long_store>(some.items, order, seconds, numbers, places, part.members, listed, some.grain);
}

/// Sorts each bucket by the second vertex.
void sort_buckets(Context& ctx, const BucketPart& part) {
  Launcher& launch = ctx.launcher;
  const Allocation found = launch.zeros(1);
  const LaunchGrid c = launch.grid(part.size);
  const auto sort = [&](std::uint32_t longest) {
    launch.run<KernelId::cadt_sort_buckets>(c.items, part.buckets, part.members, part.from, part.size, part.base,
                                            longest, c.grain, found);
  };
  sort(longest_serial_bucket);
  const std::uint32_t skipped = part.count > longest_serial_bucket ? launch.read_word(found, 0) : 0;
  if (skipped == 0) return;
  if (ctx.memory.allows((part.count + 8 * std::size_t{skipped} + 1) * word))
    sort_long_buckets(ctx, part, skipped);
  else
    sort(none);
}

/// Numbers all triangles from scanned buckets. \pre `numbers` are places in buckets where the device knows them
/// (canonical_order.dev.h)
void number_by_buckets(Context& ctx, const Mesh& mesh, Allocation buckets, const Numbering& result,
                       std::size_t points) {
  Launcher& launch = ctx.launcher;
  const std::size_t places = mesh.in_arrays() ? mesh.triangles : mesh.slots;
  const std::uint32_t parts = ctx.plan.compact && mesh.in_arrays() ? parts_of_compact_plan : 1;
  const std::vector<PartBegin> begins =
      split_buckets(ctx, buckets, points, static_cast<std::uint32_t>(result.triangles), parts);
  const LaunchGrid all = launch.grid(places);
  for (std::uint32_t part = 0; part < parts; ++part) {
    const auto [from, base] = begins[part];
    const std::uint32_t size = begins[part + 1].bucket - from, count = begins[part + 1].triangle - base;
    const Allocation members = ctx.memory.transient(std::size_t{count} * 2 * word);
    launch.run<KernelId::cadt_bucket_triangles>(all.items, mesh.locked, mesh.vertices, mesh.input_ids, buckets,
                                                result.numbers, members, from, size, base,
                                                static_cast<std::uint32_t>(places), all.grain);
    sort_buckets(ctx, {buckets, members, from, size, base, count});
    if (part + 1 == parts) buckets.release();
    if (!mesh.in_arrays()) ctx.device.fill(*result.numbers, 0, places * word, none);  // arrays: all get a number
    const LaunchGrid real = launch.grid(count);
    launch.run<KernelId::cadt_number_triangles>(real.items, members, result.numbers, base, count, real.grain);
  }
}

}  // namespace

std::vector<std::int32_t> chain_loop(const std::vector<std::array<std::uint32_t, 2>>& edges, std::size_t points) {
  std::vector<std::int32_t> next(points, -1);
  std::int32_t smallest = static_cast<std::int32_t>(edges.front()[0]);
  for (const auto& edge : edges) {
    next[edge[0]] = static_cast<std::int32_t>(edge[1]);
    smallest = std::min(smallest, static_cast<std::int32_t>(edge[0]));
  }
  std::vector<std::int32_t> loop;
  loop.reserve(edges.size());
  for (std::int32_t at = smallest; loop.size() < edges.size() && at >= 0; at = next[static_cast<std::size_t>(at)]) {
    if (!loop.empty() && at == smallest) break;
    loop.push_back(at);
  }
  if (loop.size() != edges.size() || next[static_cast<std::size_t>(loop.back())] != smallest)
    throw InternalError("the hull is not one loop; please report this with the input");
  return loop;
}

Numbering renumber(Context& ctx, const Mesh& mesh, std::size_t points, const SetStarts* sets) {
  Launcher& launch = ctx.launcher;
  Numbering result;
  if (mesh.in_arrays() && ctx.options.order == Order::fast) {
    result.triangles = mesh.triangles;
    return result;
  }
  const std::size_t places = mesh.in_arrays() ? mesh.triangles : mesh.slots;
  const auto slots = static_cast<std::uint32_t>(places);
  const FlipHistogram flips(ctx, !mesh.in_arrays());  // arrays have no flip counters
  const LaunchGrid all = launch.grid_strided(places);
  if (ctx.options.order == Order::fast) {
    result.ranked = true;
    result.numbers = ctx.memory.allocate((mesh.slots + 1) * word);
    launch.run<KernelId::cadt_flag_triangles>(all.items, mesh.locked, result.numbers, slots, all.grain, flips);
    launch.scan(result.numbers, mesh.slots + 1);
    result.triangles = launch.read_word(result.numbers, mesh.slots);
    if (sets != nullptr) result.set_starts = values_of_sets(ctx, result.numbers, first_records(ctx, *sets), *sets);
    flips.collect(ctx.statistics);
    return result;
  }
  Allocation buckets = launch.zeros(points + 1);
  // until they are known: places in the buckets
  result.numbers = mesh.in_arrays() ? ctx.memory.transient(places * word) : ctx.memory.allocate(places * word);
  launch.run<KernelId::cadt_count_triangles>(all.items, mesh.locked, mesh.vertices, mesh.input_ids, buckets,
                                             result.numbers, slots, all.grain, flips);
  launch.scan(buckets, points + 1);
  result.triangles = mesh.in_arrays() ? mesh.triangles : launch.read_word(buckets, points);
  if (sets != nullptr) result.set_starts = values_of_sets(ctx, buckets, sets->points, *sets);
  flips.collect(ctx.statistics);
  number_by_buckets(ctx, mesh, std::move(buckets), result, points);
  return result;
}

void write_triangles(Context& ctx, const Mesh& mesh, const Numbering& numbering, const Allocation& triangles,
                     const Allocation& neighbors, std::size_t first) {
  if (mesh.in_arrays()) {
    const LaunchGrid real = ctx.launcher.grid(mesh.triangles);
    ctx.launcher.run<KernelId::cadt_write_arrays>(
        real.items, mesh.vertices, mesh.half_edges, mesh.input_ids, numbering.numbers, triangles, neighbors,
        static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(mesh.triangles), real.grain);
    return;
  }
  const LaunchGrid all = ctx.launcher.grid(mesh.slots);
  const auto write = [&]<KernelId kernel>() {
    ctx.launcher.run<kernel>(all.items, mesh.locked, mesh.input_ids, numbering.numbers, triangles, neighbors,
                             static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(mesh.slots), all.grain);
  };
  if (numbering.ranked)
    write.template operator()<KernelId::cadt_write_ranked>();
  else
    write.template operator()<KernelId::cadt_write_triangles>();
}

std::size_t renumber_in_place(Context& ctx, Mesh& mesh, std::size_t points) {
  Numbering as_they_are;
  as_they_are.triangles = mesh.triangles;
  write_triangles(ctx, mesh, as_they_are, mesh.vertices, mesh.half_edges);
  mesh.input_ids.release();
  if (ctx.options.order == Order::fast) return mesh.triangles;
  const Numbering numbering = renumber(ctx, mesh, points);
  const auto count = static_cast<std::uint32_t>(numbering.triangles);
  const Allocation moved = ctx.memory.transient(count * word);
  const LaunchGrid c = ctx.launcher.grid(count);
  for (const Allocation* array : {&mesh.vertices, &mesh.half_edges}) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t half_edges = array == &mesh.half_edges ? 1 : 0;
      ctx.launcher.run<KernelId::cadt_move_words>(c.items, *array, numbering.numbers, k, half_edges, moved, count,
                                                  c.grain);
      ctx.launcher.run<KernelId::cadt_put_words>(c.items, moved, *array, k, count, c.grain);
    }
  }
  return count;
}

void renumber_within_sets(Context& ctx, const Numbering& numbering, const SetStarts& sets, const Allocation& triangles,
                          const Allocation& neighbors, std::size_t first) {
  const LaunchGrid c = ctx.launcher.grid(numbering.triangles);
  const auto shift = [&](const Allocation& values, const Allocation& by) {
    ctx.launcher.run<KernelId::cadt_batch_shift>(
        c.items, values, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(numbering.triangles), 3U,
        numbering.set_starts, static_cast<std::uint32_t>(sets.count), by, c.grain);
  };
  shift(triangles, sets.points);
  shift(neighbors, numbering.set_starts);
}

std::vector<std::int32_t> find_hull(Context& ctx, const Allocation& triangles, const Allocation& neighbors,
                                    std::size_t count, std::size_t size, std::size_t points) {
  std::vector<std::array<std::uint32_t, 2>> edges(size);
  const LaunchGrid c = ctx.launcher.grid(count);
  Allocation pairs = ctx.memory.allocate(size * sizeof edges[0]);
  Allocation written = ctx.launcher.zeros(1);
  ctx.launcher.run<KernelId::cadt_boundary_edges>(c.items, triangles, neighbors, static_cast<std::uint32_t>(count),
                                                  c.grain, pairs, written, static_cast<std::uint32_t>(size));
  if (ctx.launcher.read_word(written, 0) != size)
    throw InternalError("the boundary does not have the size of Euler's formula; please report this with the input");
  ctx.device.read(*pairs, 0, edges.data(), size * sizeof edges[0]);
  return chain_loop(edges, points);
}

}  // namespace cadt
