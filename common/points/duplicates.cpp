// SPDX-License-Identifier: Apache-2.0
#include "common/points/duplicates.hpp"

#include <bit>
#include <utility>

#include "common/driver/device_text.hpp"
#include "common/points/device_points.hpp"

namespace cadt {
namespace {

using device_text::word;

/// Lists the duplicates, ascending, and their representatives.
void find_duplicates(Context& ctx, SortedPoints& result, const Allocation& order, const Allocation& ranks,
                     std::size_t n) {
  const std::size_t count = n - result.distinct;
  result.duplicates = ctx.memory.allocate(count * word);
  result.representatives = ctx.memory.allocate(count * word);
  Allocation spare = ctx.memory.allocate(count * word), spare_values = ctx.memory.allocate(count * word);
  const LaunchGrid c = ctx.launcher.grid(n);
  ctx.launcher.run<KernelId::cadt_duplicate_pairs>(c.items, order, ranks, result.input_ids, result.duplicates,
                                                   result.representatives, n, result.distinct, c.grain);
  ctx.launcher.sort(result.duplicates, result.representatives, spare, spare_values, count,
                    static_cast<unsigned>(std::bit_width(n - 1)), false);
}

}  // namespace

void flag_distinct(Context& ctx, const Allocation& keys, const Allocation& sorted, const Allocation& order,
                   const Allocation& flags, std::size_t n, bool neighbours, const Allocation& totals) {
  const LaunchGrid c = ctx.launcher.grid(n);
  ctx.launcher.run<KernelId::cadt_sort_runs>(keys, sorted, order, c, totals);
  ctx.launcher.run<KernelId::cadt_unique_flags>(sorted, keys, flags, c, neighbours, totals);
}

void compact_distinct(Context& ctx, SortedPoints& result, Allocation sorted, Allocation order, const Allocation& flags,
                      std::size_t n, std::uint32_t equal, SetStarts* sets) {
  Launcher& launch = ctx.launcher;
  const std::size_t distinct = result.distinct = n - equal;
  if (equal == 0) {
    result.points = std::move(sorted);
    result.input_ids = std::move(order);
    return;
  }
  const LaunchGrid c = launch.grid(n);
  launch.scan(flags, n);
  result.points = ctx.memory.allocate(distinct * point_bytes(ctx.device));
  result.input_ids = ctx.memory.allocate(distinct * word);
  launch.run<KernelId::cadt_unique_pack>(c.items, sorted, order, flags, result.points, result.input_ids, n, distinct,
                                         c.grain);
  find_duplicates(ctx, result, order, flags, n);
  if (sets != nullptr) {
    const LaunchGrid s = launch.grid(sets->count + 1);
    sets->positions = ctx.memory.allocate((sets->count + 1) * word);
    launch.run<KernelId::cadt_batch_starts>(s.items, flags, sets->points, sets->count, n, distinct, s.grain,
                                            sets->positions);
  }
}

}  // namespace cadt
