// SPDX-License-Identifier: Apache-2.0
#include "common/host/collect.hpp"

#include <algorithm>
#include <array>
#include <string>

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
  const Cut all = launch.cut(places);
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
  result.numbers = run.memory.allocate(places * word);  // until they are known: places in the buckets
  launch.run(KernelId::cadt_count_triangles, records.items, mesh.records, mesh.vertices, labels, buckets,
             result.numbers, slots, records.grain, flips);
  launch.scan(buckets, points + 1);
  const std::uint32_t triangles = launch.read_word(buckets, points);
  result.triangles = triangles;
  if (sets != nullptr) result.set_starts = values_of_sets(run, buckets, sets->points, *sets);
  flips.collect(run.statistics);
  Allocation members = run.memory.allocate(std::size_t{triangles} * 2 * word);
  launch.run(KernelId::cadt_bucket_triangles, all.items, mesh.records, mesh.vertices, labels, buckets, result.numbers,
             members, slots, all.grain);
  const Cut vertices = launch.cut(points);
  launch.run(KernelId::cadt_sort_buckets, vertices.items, buckets, members, static_cast<std::uint32_t>(points),
             vertices.grain);
  buckets.release();
  run.device.fill(*result.numbers, 0, places * word, none);
  const Cut real = launch.cut(triangles);
  launch.run(KernelId::cadt_number_triangles, real.items, members, result.numbers, triangles, real.grain);
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
