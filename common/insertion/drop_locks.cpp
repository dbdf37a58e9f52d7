// SPDX-License-Identifier: Apache-2.0
#include "common/insertion/drop_locks.hpp"

#include <utility>

#include "common/driver/counters.hpp"
#include "common/driver/device_text.hpp"

namespace cadt {
namespace {

using namespace device_text;

/// Triangles without a ghost before each slot, and their number behind the last.
Allocation rank_triangles(Context& ctx, const LockedTriangles& locked, MeshUse use) {
  Allocation ranks = ctx.memory.allocate((locked.slots + 1) * word);
  const FlipHistogram flips(ctx, use != MeshUse::part);
  ctx.launcher.run<KernelId::cadt_flag_triangles>(locked.triangles, ranks, ctx.launcher.grid_strided(locked.slots),
                                                  flips);
  ctx.launcher.scan(ranks, locked.slots + 1);
  flips.collect(ctx.statistics);
  return ranks;
}

/// Null `input_ids`: a part, with ghosts.
Mesh write_arrays(Context& ctx, const LockedTriangles& locked, const Allocation& ranks, std::uint32_t first_unused,
                  const Allocation& input_ids, MeshUse use) {
  Mesh mesh;
  mesh.finished = static_cast<bool>(input_ids);
  mesh.triangles = ctx.launcher.read_word(ranks, locked.slots);
  mesh.all = mesh.finished ? mesh.triangles : locked.slots - 2;
  mesh.vertices = make_mesh_array(ctx, mesh.all, use);
  mesh.across = make_mesh_array(ctx, mesh.all, use);
  if (locked.edge_flags) mesh.edge_flags = ctx.memory.allocate(mesh.all * word);
  mesh.certified = true;
  const LaunchGrid c = ctx.launcher.grid(locked.slots);
  ctx.launcher.run<KernelId::cadt_drop_locks>(c.items, locked.triangles, locked.edge_flags, ranks, locked.slots,
                                              mesh.finished ? CADT_NONE : first_unused, input_ids, c.grain,
                                              mesh.vertices, mesh.across, mesh.edge_flags);
  return mesh;
}

}  // namespace

Mesh drop_locks(Context& ctx, LockedTriangles locked, std::uint32_t first_unused, Allocation input_ids, MeshUse use) {
  const Allocation ranks = rank_triangles(ctx, locked, use);
  if (use == MeshUse::whole) return write_arrays(ctx, locked, ranks, first_unused, input_ids, use);
  Mesh mesh = write_arrays(ctx, locked, ranks, first_unused, {}, use);
  mesh.input_ids = std::move(input_ids);
  return mesh;
}

Mesh drop_locks_of_sets(Context& ctx, LockedTriangles locked, std::span<const std::uint32_t> first_slots,
                        const Allocation& input_ids, Allocation& set_starts) {
  const Allocation ranks = rank_triangles(ctx, locked, MeshUse::part);
  const std::size_t sets = first_slots.size();
  const Allocation slots = ctx.memory.allocate(sets * word);
  ctx.device.write(*slots, 0, first_slots.data(), sets * word);
  set_starts = ctx.memory.allocate(sets * word);
  ctx.launcher.run<KernelId::cadt_gather_words>(ranks, slots, set_starts, ctx.launcher.grid(sets));
  return write_arrays(ctx, locked, ranks, CADT_NONE, input_ids, MeshUse::part);
}

}  // namespace cadt
