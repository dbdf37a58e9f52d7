// SPDX-License-Identifier: Apache-2.0
#include "common/batch/sort_batch.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "common/driver/device_text.hpp"
#include "common/points/duplicates.hpp"
#include "common/points/key_refinement.hpp"

namespace cadt {
namespace {

using namespace device_text;

constexpr unsigned key_bits = 32;

/// Levels of the square of a set: about sixteen cells a point of the largest set, if there are enough bits.
unsigned choose_levels(std::span<const std::uint32_t> starts) {
  std::size_t largest = 1;
  for (std::size_t s = 0; s + 1 < starts.size(); ++s)
    largest = std::max<std::size_t>(largest, starts[s + 1] - starts[s]);
  const auto wanted = (static_cast<unsigned>(std::bit_width(largest)) + 5) / 2;
  const auto set_bits = static_cast<unsigned>(std::bit_width(starts.size() - 2));
  return std::clamp((key_bits - set_bits) / 2, 1U, wanted);
}

[[noreturn]] void refuse_point(std::span<const std::uint32_t> starts, std::uint32_t bad, std::size_t first,
                               std::size_t first_set) {
  const auto set = static_cast<std::size_t>(std::ranges::upper_bound(starts, bad) - starts.begin()) - 1;
  throw InputError("in set " + std::to_string(first_set + set) + ": point " + std::to_string(bad - starts[set]) +
                       " (counted from 0) has a coordinate that is NaN or infinite: remove or repair it",
                   first + bad);
}

}  // namespace

SortedBatch sort_batch(Context& ctx, Allocation input, std::span<const std::uint32_t> starts, std::size_t most_batched,
                       std::size_t first, std::size_t first_set) {
  Launcher& launch = ctx.launcher;
  launch.set_variant(narrow_variant(ctx.options.statistics));
  const std::size_t n = starts.back(), sets = starts.size() - 1;
  const LaunchGrid all = launch.grid(n), teams = launch.grid_of_teams(sets, CADT_SET_LANES);
  SortedBatch result;
  result.starts.count = sets;
  result.starts.points = ctx.memory.allocate((sets + 1) * word);
  ctx.device.write(*result.starts.points, 0, starts.data(), (sets + 1) * word);
  result.sets = ctx.memory.allocate(sets * sizeof(cadt_set));
  result.states = ctx.memory.allocate(sets * word);
  const std::uint32_t levels = choose_levels(starts);
  const Allocation bad = ctx.memory.allocate(word);
  ctx.device.fill(*bad, 0, word, CADT_NONE);
  launch.run_in_groups<KernelId::cadt_batch_bounds>(teams.items, CADT_SET_LANES, input, result.starts.points, sets,
                                                    levels, static_cast<std::uint32_t>(narrow_span), teams.grain,
                                                    result.sets, result.states, bad);
  if (const std::uint32_t at = launch.read_word(bad, 0); at != CADT_NONE) refuse_point(starts, at, first, first_set);
  ctx.end_phase("bounds");
  ctx.check("sort", 0.01);

  Allocation keys = ctx.memory.allocate(n * word), spare = ctx.memory.allocate(n * word);
  Allocation order = ctx.memory.allocate(n * word);
  result.order.grid.bits_x = result.order.grid.bits_y = levels;
  launch.run<KernelId::cadt_batch_keys>(input, result.starts.points, sets, result.sets, levels, false, keys, all);
  {
    Allocation spare_order = ctx.memory.allocate(n * word);
    const auto bits = static_cast<unsigned>(std::bit_width(sets - 1)) + 2 * levels;
    launch.sort(keys, order, spare, spare_order, n, bits, true);
  }
  ctx.end_phase("sort");
  const std::uint32_t overfull_points = flag_overfull(ctx, keys, spare, n);
  const bool refined = refine_overfull(ctx, input, keys, order, spare, n, overfull_points);
  ctx.end_phase("refine");

  Allocation sorted = ctx.memory.allocate(n * sizeof(cadt_point));
  launch.run<KernelId::cadt_batch_gather>(input, order, result.starts.points, sets, result.sets, sorted, all);
  input.release();
  const Allocation totals = launch.zeros(CADT_ORDER_WORDS);
  flag_distinct(ctx, keys, sorted, order, spare, n, false, totals);
  const std::uint32_t equal = launch.read_word(totals, CADT_EQUAL);
  if (!refined && equal == 0) result.order.keys = std::move(keys);
  keys.release();
  compact_distinct(ctx, result.order, std::move(sorted), std::move(order), spare, n, equal, &result.starts);
  launch.run_in_groups<KernelId::cadt_batch_classify>(teams.items, CADT_SET_LANES, result.order.points,
                                                      result.positions(), sets, most_batched, teams.grain,
                                                      result.states);
  ctx.end_phase("gather");
  return result;
}

}  // namespace cadt
