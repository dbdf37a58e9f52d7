// SPDX-License-Identifier: Apache-2.0
#include "common/host/set_order.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "common/host/device_constants.hpp"

namespace cadt {
namespace {

using namespace device_constants;

constexpr std::size_t word = sizeof(std::uint32_t);
constexpr unsigned key_bits = 32;

/// Levels of the square of a set: about sixteen cells a point of the largest one, if there are the bits.
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

SetOrder sort_sets(Run& run, Allocation input, std::span<const std::uint32_t> starts, std::size_t together,
                   std::size_t first, std::size_t first_set) {
  Launcher& launch = run.launcher;
  launch.set_build(narrow_build(run.options.statistics));
  const std::uint32_t count = starts.back();
  const std::size_t n = count, sets = starts.size() - 1;
  const auto set_count = static_cast<std::uint32_t>(sets);
  const Cut c = launch.cut(n), teams = launch.cut_teams(sets, CADT_SET_LANES);
  SetOrder result;
  result.starts.count = sets;
  result.starts.points = run.memory.allocate((sets + 1) * word);
  run.device.write(*result.starts.points, 0, starts.data(), (sets + 1) * word);
  result.sets = run.memory.allocate(sets * sizeof(cadt_set));
  result.states = run.memory.allocate(sets * word);
  const std::uint32_t levels = choose_levels(starts);
  const Allocation bad = run.memory.allocate(word);
  run.device.fill(*bad, 0, word, CADT_NONE);
  launch.run_in_groups(KernelId::cadt_set_bounds, teams.items, CADT_SET_LANES, input, result.starts.points, set_count,
                       levels, static_cast<std::uint32_t>(narrow_span), teams.grain, result.sets, result.states, bad);
  if (const std::uint32_t at = launch.read_word(bad, 0); at != CADT_NONE) refuse_point(starts, at, first, first_set);
  run.end_phase("bounds");
  run.check("sort", 0.01);

  Allocation keys = run.memory.allocate(n * word), spare = run.memory.allocate(n * word);
  Allocation order = run.memory.allocate(n * word);
  result.order.grid.bits_x = result.order.grid.bits_y = levels;
  launch.run(KernelId::cadt_set_keys, c.items, input, result.starts.points, set_count, result.sets, levels, 0U, keys,
             count, c.grain);
  {
    Allocation spare_order = run.memory.allocate(n * word);
    const auto bits = static_cast<unsigned>(std::bit_width(sets - 1)) + 2 * levels;
    launch.sort(keys, order, spare, spare_order, n, bits, true);
  }
  run.end_phase("sort");
  const std::uint32_t crowd = flag_crowded(run, keys, spare, n);
  const bool refined = refine_crowd(run, input, keys, order, spare, n, crowd);
  run.end_phase("refine");

  Allocation sorted = run.memory.allocate(n * sizeof(cadt_point));
  launch.run(KernelId::cadt_set_gather, c.items, input, order, result.starts.points, set_count, result.sets, sorted,
             count, c.grain);
  input.release();
  const Allocation totals = launch.zeros(CADT_ORDER_WORDS);
  flag_distinct(run, keys, sorted, order, spare, n, false, totals);
  const std::uint32_t equal = launch.read_word(totals, CADT_EQUAL);
  if (!refined && equal == 0) result.order.keys = std::move(keys);
  keys.release();
  close_order(run, result.order, std::move(sorted), std::move(order), spare, n, equal, &result.starts);
  launch.run_in_groups(KernelId::cadt_set_kinds, teams.items, CADT_SET_LANES, result.order.points, result.positions(),
                       set_count, static_cast<std::uint32_t>(together), teams.grain, result.states);
  run.end_phase("gather");
  return result;
}

}  // namespace cadt
