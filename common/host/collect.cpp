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

/// Links hull edges (from, to) to one loop that starts at the smallest index.
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

}  // namespace

Numbering number_triangles(Run& run, const DeviceMesh& mesh, const Allocation& labels, std::size_t points) {
  Launcher& launch = run.launcher;
  const auto slots = static_cast<std::uint32_t>(mesh.slots);
  const Cut all = launch.cut(mesh.slots);
  const FlipCounts flips(run);
  const Cut records = launch.cut_strided(mesh.slots);
  Numbering result;
  if (run.options.order == Order::fast) {
    result.ranked = true;
    result.numbers = run.memory.allocate((mesh.slots + 1) * word);
    launch.run(KernelId::cadt_flag_triangles, records.items, mesh.records, result.numbers, slots, records.grain, flips);
    launch.scan(result.numbers, mesh.slots + 1);
    result.triangles = launch.read_word(result.numbers, mesh.slots);
    flips.collect(run.statistics);
    return result;
  }
  Allocation buckets = launch.zeros(points + 1);
  result.numbers = run.memory.allocate(mesh.slots * word);  // until they are known: places in the buckets
  launch.run(KernelId::cadt_count_triangles, records.items, mesh.records, labels, buckets, result.numbers, slots,
             records.grain, flips);
  launch.scan(buckets, points + 1);
  const std::uint32_t triangles = launch.read_word(buckets, points);
  result.triangles = triangles;
  flips.collect(run.statistics);
  Allocation members = run.memory.allocate(std::size_t{triangles} * 2 * word);
  launch.run(KernelId::cadt_bucket_triangles, all.items, mesh.records, labels, buckets, result.numbers, members, slots,
             all.grain);
  const Cut vertices = launch.cut(points);
  launch.run(KernelId::cadt_sort_buckets, vertices.items, buckets, members, static_cast<std::uint32_t>(points),
             vertices.grain);
  buckets.release();
  run.device.fill(*result.numbers, 0, mesh.slots * word, none);
  const Cut real = launch.cut(triangles);
  launch.run(KernelId::cadt_number_triangles, real.items, members, result.numbers, triangles, real.grain);
  return result;
}

void emit_triangles(Run& run, const DeviceMesh& mesh, const Allocation& labels, const Numbering& numbering,
                    const Allocation& triangles, const Allocation& neighbors) {
  const Cut all = run.launcher.cut(mesh.slots);
  run.launcher.run(numbering.ranked ? KernelId::cadt_emit_ranked : KernelId::cadt_emit_triangles, all.items,
                   mesh.records, labels, numbering.numbers, triangles, neighbors,
                   static_cast<std::uint32_t>(mesh.slots), all.grain);
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
