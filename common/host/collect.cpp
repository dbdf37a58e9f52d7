// SPDX-License-Identifier: Apache-2.0
#include "common/host/collect.hpp"

#include <algorithm>
#include <array>
#include <string>

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

/// Output of the emitting kernel: the caller's arrays themselves if the device can write them, else a copy.
struct Output {
  Output(Run& run, std::int32_t* to, std::size_t values) : run_(run), to_(to), bytes_(values * sizeof *to) {
    buffer = run.memory.export_to(to, bytes_);
    direct_ = static_cast<bool>(buffer);
    if (!direct_) buffer = run.memory.allocate(bytes_);
  }
  void deliver() {
    if (!direct_) run_.device.read(*buffer, 0, to_, bytes_);
    buffer.release();
  }
  Allocation buffer;

 private:
  Run& run_;
  std::int32_t* to_;
  std::size_t bytes_;
  bool direct_;
};

}  // namespace

void collect_mesh(Run& run, const DeviceMesh& mesh, const Allocation& labels, Triangulation::Data& data) {
  Launcher& launch = run.launcher;
  const auto slots = static_cast<std::uint32_t>(mesh.slots);
  const Cut all = launch.cut(mesh.slots);

  Allocation buckets = launch.zeros(data.points + 1);
  Allocation totals = launch.zeros(3);  // real triangles, ghosts, hull edges written
  launch.run(KernelId::cadt_count_triangles, all.items, mesh.records, labels, buckets, slots, all.grain, totals);
  const std::uint32_t triangles = launch.read_word(totals, 0), ghosts = launch.read_word(totals, 1);
  data.triangle_count = triangles;

  std::vector<std::array<std::uint32_t, 2>> edges(ghosts);
  {
    Allocation pairs = run.memory.allocate(ghosts * sizeof edges[0]);
    Allocation written = launch.zeros(1);
    launch.run(KernelId::cadt_emit_hull, all.items, mesh.records, labels, slots, all.grain, pairs, written, ghosts);
    run.device.read(*pairs, 0, edges.data(), ghosts * sizeof edges[0]);
  }
  data.hull = link_loop(edges, data.points);

  launch.scan(buckets, data.points + 1);
  Allocation members = run.memory.allocate(triangles * 2 * word);
  launch.run(KernelId::cadt_bucket_triangles, all.items, mesh.records, labels, buckets, members, slots, all.grain);
  if (run.options.order == Order::canonical) {
    const Cut vertices = launch.cut(data.points);
    launch.run(KernelId::cadt_sort_buckets, vertices.items, buckets, members, static_cast<std::uint32_t>(data.points),
               vertices.grain);
  }
  buckets.release();
  run.check("collect", 0.95);

  Allocation numbers = run.memory.allocate(mesh.slots * word);
  run.device.fill(*numbers, 0, mesh.slots * word, none);
  const Cut real = launch.cut(triangles);
  launch.run(KernelId::cadt_number_triangles, real.items, members, numbers, triangles, real.grain);
  members.release();
  data.triangles = std::make_unique_for_overwrite<std::int32_t[]>(std::size_t{3} * triangles);
  data.neighbors = std::make_unique_for_overwrite<std::int32_t[]>(std::size_t{3} * triangles);
  Output vertices_out(run, data.triangles.get(), std::size_t{3} * triangles);
  Output neighbors_out(run, data.neighbors.get(), std::size_t{3} * triangles);
  launch.run(KernelId::cadt_emit_triangles, all.items, mesh.records, labels, numbers, vertices_out.buffer,
             neighbors_out.buffer, slots, all.grain);
  run.device.finish();
  vertices_out.deliver();
  neighbors_out.deliver();
}

}  // namespace cadt
