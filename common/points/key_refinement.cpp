// SPDX-License-Identifier: Apache-2.0
#include "common/points/key_refinement.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "common/driver/device_text.hpp"

namespace cadt {

using device_text::word;

std::uint32_t flag_overfull(Context& ctx, const Allocation& keys, const Allocation& flags, std::size_t n) {
  const Allocation totals = ctx.launcher.zeros(1);
  ctx.launcher.run<KernelId::cadt_flag_overfull>(keys, flags, ctx.launcher.grid(n), totals);
  return ctx.launcher.read_word(totals, 0);
}

bool refine_overfull(Context& ctx, const Allocation& input, Allocation& keys, const Allocation& order,
                     Allocation& spare, std::size_t n, std::uint32_t overfull_points) {
  Launcher& launch = ctx.launcher;
  const LaunchGrid all = launch.grid(n);
  constexpr std::uint32_t rounds = 4;
  for (std::uint32_t round = 0; round < rounds; ++round) {
    if (round != 0) overfull_points = flag_overfull(ctx, keys, spare, n);
    if (overfull_points == 0) return round != 0;
    ctx.statistics.refined_points = std::max<std::uint64_t>(ctx.statistics.refined_points, overfull_points);
    launch.scan(spare, n);
    const std::size_t bytes = overfull_points * word;
    Allocation places = ctx.memory.transient(bytes), round_keys = ctx.memory.transient(bytes);
    Allocation members = ctx.memory.transient(bytes), runs = ctx.memory.transient(bytes);
    const LaunchGrid few = launch.grid(overfull_points);
    launch.run<KernelId::cadt_pack_overfull>(all.items, spare, places, n, overfull_points, all.grain);
    for (;; ++round) {  // skip rounds in which all members of each run agree
      Allocation fresh = launch.zeros(1);
      launch.run<KernelId::cadt_refined_keys>(few.items, input, order, keys, places, round_keys, members, runs,
                                              overfull_points, round, few.grain, fresh);
      if (launch.read_word(fresh, 0) != 0) break;
      if (round + 1 == rounds) return true;
    }
    launch.scan(runs, overfull_points);
    const std::uint32_t last_run = launch.read_word(runs, overfull_points - 1);
    Allocation from = ctx.memory.transient(bytes), sorted = ctx.memory.transient(bytes);
    Allocation spare_from = ctx.memory.transient(bytes), spare_sorted = ctx.memory.transient(bytes);
    // Two stable sorts: by the key of the round, then by run. The sort permutes its keys, so it gets copies.
    launch.run<KernelId::cadt_copy_words>(round_keys, sorted, 0U, few);
    launch.sort(sorted, from, spare_sorted, spare_from, overfull_points, 32, true);
    if (last_run != 0) {
      launch.run<KernelId::cadt_gather_words>(runs, from, sorted, few);
      launch.sort(sorted, from, spare_sorted, spare_from, overfull_points,
                  static_cast<unsigned>(std::bit_width(last_run)), false);
    }
    launch.run<KernelId::cadt_run_tails>(keys, Allocation(), spare, all);
    launch.run<KernelId::cadt_store_refined>(places, members, from, runs, round_keys, order, spare, few);
    launch.scan(spare, n);
    std::swap(keys, spare);
    ctx.check("sort", 0.05 + 0.01 * round);
  }
  return true;
}

}  // namespace cadt
