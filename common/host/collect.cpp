// SPDX-License-Identifier: Apache-2.0
#include "common/host/collect.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <utility>

#include "common/host/counters.hpp"

namespace cadt {
namespace {

constexpr std::size_t word = sizeof(std::uint32_t);
constexpr std::uint32_t none = 0xFFFFFFFFU;

/// The values of `from` where the sets begin.
Allocation values_of_sets(Run& run, const Allocation& from, const Allocation& places, const SetStarts& sets) {
  Allocation values = run.memory.allocate((sets.count + 1) * word);
  const Cut c = run.launcher.cut(sets.count + 1);
  run.launcher.run(KernelId::cadt_gather_words, c.items, from, places, values,
                   static_cast<std::uint32_t>(sets.count + 1), c.grain);
  return values;
}

/// Where the records of the sets begin: two a vertex.
Allocation first_records(Run& run, const SetStarts& sets) {
  std::vector<std::uint32_t> places(sets.count + 1);
  run.device.read(*(sets.positions ? sets.positions : sets.points), 0, places.data(), places.size() * word);
  for (std::uint32_t& place : places) place *= 2;
  Allocation result = run.memory.allocate(places.size() * word);
  run.device.write(*result, 0, places.data(), places.size() * word);
  return result;
}

/// Parts of the canonical order that are made one after the other where memory is to be saved: the lists of each have
/// this share of the triangles.
constexpr std::uint32_t parts_to_save = 2;

struct BucketCut {
  std::uint32_t bucket = 0, triangle = 0;  ///< the first ones of a part
};

/// Where the parts begin, and the end of the last.
std::vector<BucketCut> cut_buckets(Run& run, const Allocation& buckets, std::size_t points, std::uint32_t triangles,
                                   std::uint32_t parts) {
  std::vector<BucketCut> cuts(parts + std::size_t{1});
  if (parts == 1) {
    cuts[1] = {static_cast<std::uint32_t>(points), triangles};
    return cuts;
  }
  const Allocation found = run.memory.allocate(cuts.size() * sizeof cuts[0]);
  const Cut c = run.launcher.cut(points);
  run.launcher.run(KernelId::cadt_cut_buckets, c.items, buckets, static_cast<std::uint32_t>(points), triangles, parts,
                   c.grain, found);
  run.device.read(*found, 0, cuts.data(), cuts.size() * sizeof cuts[0]);
  return cuts;
}

/// A part of the triangles in their buckets.
struct BucketPart {
  const Allocation& buckets;
  const Allocation& members;
  std::uint32_t from, size;   ///< buckets
  std::uint32_t base, count;  ///< triangles
};

/// Buckets with more triangles are sorted as one list by all work-items: one takes 2 microseconds a triangle.
constexpr std::uint32_t longest_bucket = 256;

/// Sorts what cadt_sort_buckets has skipped, `left` triangles.
void sort_long_buckets(Run& run, const BucketPart& part, std::uint32_t left) {
  Launcher& launch = run.launcher;
  Allocation ranks = run.memory.allocate((part.count + std::size_t{1}) * word);
  const Cut all = launch.cut(part.count), some = launch.cut(left);
  launch.run(KernelId::cadt_long_flags, all.items, part.buckets, part.from, part.size, part.base, longest_bucket,
             part.count, all.grain, ranks);
  launch.scan(ranks, part.count + std::size_t{1});
  const std::size_t bytes = left * word;
  const Allocation seconds = run.memory.allocate(bytes), records = run.memory.allocate(bytes);
  const Allocation owners = run.memory.allocate(bytes), places = run.memory.allocate(bytes);
  launch.run(KernelId::cadt_long_pack, all.items, part.buckets, part.members, part.from, part.size, part.base, ranks,
             part.count, all.grain, seconds, records, owners, places);
  ranks.release();
  Allocation sorted = run.memory.allocate(bytes), order = run.memory.allocate(bytes);
  Allocation spare = run.memory.allocate(bytes), spare_order = run.memory.allocate(bytes);
  // Stable: first by the second vertex, then by bucket. The sort permutes its keys, so it gets copies.
  launch.run(KernelId::cadt_copy_words, some.items, seconds, sorted, std::uint32_t{0}, left, some.grain);
  launch.sort(sorted, order, spare, spare_order, left, 32, true);
  launch.run(KernelId::cadt_gather_words, some.items, owners, order, sorted, left, some.grain);
  launch.sort(sorted, order, spare, spare_order, left, static_cast<unsigned>(std::bit_width(part.size)), false);
  launch.run(KernelId::cadt_long_store, some.items, order, seconds, records, places, part.members, left, some.grain);
}

/// Sorts each bucket by the second vertex.
void sort_buckets(Run& run, const BucketPart& part) {
  Launcher& launch = run.launcher;
  const Allocation found = launch.zeros(1);
  const Cut c = launch.cut(part.size);
  const auto sort = [&](std::uint32_t longest) {
    launch.run(KernelId::cadt_sort_buckets, c.items, part.buckets, part.members, part.from, part.size, part.base,
               longest, c.grain, found);
  };
  sort(longest_bucket);
  const std::uint32_t left = part.count > longest_bucket ? launch.read_word(found, 0) : 0;
  if (left == 0) return;
  if (run.memory.allows((part.count + 8 * std::size_t{left} + 1) * word))
    sort_long_buckets(run, part, left);
  else
    sort(none);
}

/// The numbers of all triangles, from scanned buckets. \pre the numbers are places in buckets where the device knows
/// them (emit.h)
void number_by_buckets(Run& run, const DeviceMesh& mesh, const Allocation& labels, Allocation buckets,
                       const Numbering& result, std::size_t points) {
  Launcher& launch = run.launcher;
  const std::size_t places = mesh.in_arrays() ? mesh.triangles : mesh.slots;
  const std::uint32_t parts = run.saves_memory && mesh.in_arrays() ? parts_to_save : 1;
  const std::vector<BucketCut> cuts =
      cut_buckets(run, buckets, points, static_cast<std::uint32_t>(result.triangles), parts);
  const Cut all = launch.cut(places);
  for (std::uint32_t part = 0; part < parts; ++part) {
    const auto [from, base] = cuts[part];
    const std::uint32_t size = cuts[part + 1].bucket - from, count = cuts[part + 1].triangle - base;
    const Allocation members = run.memory.borrow(std::size_t{count} * 2 * word);
    launch.run(KernelId::cadt_bucket_triangles, all.items, mesh.records, mesh.vertices, labels, buckets, result.numbers,
               members, from, size, base, static_cast<std::uint32_t>(places), all.grain);
    sort_buckets(run, {buckets, members, from, size, base, count});
    if (part + 1 == parts) buckets.release();
    if (!mesh.in_arrays()) run.device.fill(*result.numbers, 0, places * word, none);  // arrays: all get a number
    const Cut real = launch.cut(count);
    launch.run(KernelId::cadt_number_triangles, real.items, members, result.numbers, base, count, real.grain);
  }
}

}  // namespace

std::vector<std::int32_t> link_loop(const std::vector<std::array<std::uint32_t, 2>>& edges, std::size_t points) {
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

Numbering number_triangles(Run& run, const DeviceMesh& mesh, const Allocation& labels, std::size_t points,
                           const SetStarts* sets) {
  Launcher& launch = run.launcher;
  Numbering result;
  if (mesh.in_arrays() && run.options.order == Order::fast) {
    result.triangles = mesh.triangles;
    return result;
  }
  const std::size_t places = mesh.in_arrays() ? mesh.triangles : mesh.slots;
  const auto slots = static_cast<std::uint32_t>(places);
  const FlipCounts flips(run, !mesh.in_arrays());  // arrays have none any more
  const Cut records = launch.cut_strided(places);
  if (run.options.order == Order::fast) {
    result.ranked = true;
    result.numbers = run.memory.allocate((mesh.slots + 1) * word);
    launch.run(KernelId::cadt_flag_triangles, records.items, mesh.records, result.numbers, slots, records.grain, flips);
    launch.scan(result.numbers, mesh.slots + 1);
    result.triangles = launch.read_word(result.numbers, mesh.slots);
    if (sets != nullptr) result.set_starts = values_of_sets(run, result.numbers, first_records(run, *sets), *sets);
    flips.collect(run.statistics);
    return result;
  }
  Allocation buckets = launch.zeros(points + 1);
  // until they are known: places in the buckets
  result.numbers = mesh.in_arrays() ? run.memory.borrow(places * word) : run.memory.allocate(places * word);
  launch.run(KernelId::cadt_count_triangles, records.items, mesh.records, mesh.vertices, labels, buckets,
             result.numbers, slots, records.grain, flips);
  launch.scan(buckets, points + 1);
  result.triangles = mesh.in_arrays() ? mesh.triangles : launch.read_word(buckets, points);
  if (sets != nullptr) result.set_starts = values_of_sets(run, buckets, sets->points, *sets);
  flips.collect(run.statistics);
  number_by_buckets(run, mesh, labels, std::move(buckets), result, points);
  return result;
}

void emit_triangles(Run& run, const DeviceMesh& mesh, const Allocation& labels, const Numbering& numbering,
                    const Allocation& triangles, const Allocation& neighbors, std::size_t first) {
  if (mesh.in_arrays()) {
    const Cut real = run.launcher.cut(mesh.triangles);
    run.launcher.run(KernelId::cadt_emit_arrays, real.items, mesh.vertices, mesh.links, labels, numbering.numbers,
                     triangles, neighbors, static_cast<std::uint32_t>(first),
                     static_cast<std::uint32_t>(mesh.triangles), real.grain);
    return;
  }
  const Cut all = run.launcher.cut(mesh.slots);
  run.launcher.run(numbering.ranked ? KernelId::cadt_emit_ranked : KernelId::cadt_emit_triangles, all.items,
                   mesh.records, labels, numbering.numbers, triangles, neighbors, static_cast<std::uint32_t>(first),
                   static_cast<std::uint32_t>(mesh.slots), all.grain);
}

std::size_t emit_in_place(Run& run, DeviceMesh& mesh, Allocation& labels, std::size_t points) {
  Numbering as_they_are;
  as_they_are.triangles = mesh.triangles;
  emit_triangles(run, mesh, labels, as_they_are, mesh.vertices, mesh.links);
  labels.release();
  if (run.options.order == Order::fast) return mesh.triangles;
  const Numbering numbering = number_triangles(run, mesh, labels, points);
  const auto count = static_cast<std::uint32_t>(numbering.triangles);
  const Allocation moved = run.memory.borrow(count * word);
  const Cut c = run.launcher.cut(count);
  for (const Allocation* array : {&mesh.vertices, &mesh.links}) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t links = array == &mesh.links ? 1 : 0;
      run.launcher.run(KernelId::cadt_move_words, c.items, *array, numbering.numbers, k, links, moved, count, c.grain);
      run.launcher.run(KernelId::cadt_put_words, c.items, moved, *array, k, count, c.grain);
    }
  }
  return count;
}

void number_within_sets(Run& run, const Numbering& numbering, const SetStarts& sets, const Allocation& triangles,
                        const Allocation& neighbors, std::size_t first) {
  const Cut c = run.launcher.cut(numbering.triangles);
  const auto shift = [&](const Allocation& values, const Allocation& by) {
    run.launcher.run(KernelId::cadt_set_shift, c.items, values, static_cast<std::uint32_t>(first),
                     static_cast<std::uint32_t>(numbering.triangles), 3U, numbering.set_starts,
                     static_cast<std::uint32_t>(sets.count), by, c.grain);
  };
  shift(triangles, sets.points);
  shift(neighbors, numbering.set_starts);
}

std::vector<std::int32_t> find_hull(Run& run, const Allocation& triangles, const Allocation& neighbors,
                                    std::size_t count, std::size_t size, std::size_t points) {
  std::vector<std::array<std::uint32_t, 2>> edges(size);
  const Cut c = run.launcher.cut(count);
  Allocation pairs = run.memory.allocate(size * sizeof edges[0]);
  Allocation written = run.launcher.zeros(1);
  run.launcher.run(KernelId::cadt_boundary_edges, c.items, triangles, neighbors, static_cast<std::uint32_t>(count),
                   c.grain, pairs, written, static_cast<std::uint32_t>(size));
  if (run.launcher.read_word(written, 0) != size)
    throw InternalError("the boundary does not have the size of Euler's formula; please report this with the input");
  run.device.read(*pairs, 0, edges.data(), size * sizeof edges[0]);
  return link_loop(edges, points);
}

}  // namespace cadt
