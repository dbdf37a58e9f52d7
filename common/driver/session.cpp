// SPDX-License-Identifier: Apache-2.0
#include "common/driver/session.hpp"

#include <algorithm>
#include <string>

#include "common/driver/choose_strategy.hpp"
#include "common/points/device_points.hpp"

namespace cadt {
namespace {

void require_valid(const Options& options, const Device& device) {
  constexpr unsigned most_flips = 1000;  // counters have ten bits
  if (options.tuning.flip_threshold > most_flips)
    throw OptionError("tuning.flip_threshold", std::to_string(options.tuning.flip_threshold) + " is more than " +
                                                   std::to_string(most_flips) + ", the most flips that are told apart");
  if (options.tuning.strategy == Strategy::stars &&
      (options.tuning.stabilize != Stabilize::off || options.tuning.watch))
    throw OptionError("tuning.strategy", "stars goes with neither stabilize nor watch: they are about insertion");
  if (options.tuning.strategy == Strategy::stars && takes_floats_only(device))
    throw OptionError("tuning.strategy", "stars needs double precision, which '" + device.info().name +
                                             "' has not: take locks (or automatic, which does)");
  if (!(options.tuning.quality_epsilon >= 0))
    throw OptionError("tuning.quality_epsilon", "must be a number and not negative");
}

}  // namespace

void require_size(std::size_t points) {
  if (points <= max_points()) return;
  throw LimitError("at most " + std::to_string(max_points()) + " points can be triangulated in one call, not " +
                       std::to_string(points) + ": split the input",
                   points, max_points());
}

void begin_budget(Triangulator::State& state, std::size_t n) {
  if (state.memory.dropped()) state.known = {};
  const std::size_t reserved = state.known.reserved;
  state.memory.begin(state.options.max_memory, n <= reserved ? reserved * sizeof(std::uint32_t) : 0);
}

void begin_call(Triangulator::State& state, std::size_t n, Statistics& statistics) {
  require_valid(state.options, *state.device);
  state.device->begin_call();
  state.copied_before = state.device->copied();
  const DeviceInfo& info = state.device->info();
  statistics.points = n;
  statistics.certified = true;  // no edge is illegal until one is found
  statistics.backend = to_string(info.backend);
  statistics.device = info.name;
  statistics.threads = state.device->threads();
  begin_budget(state, n);
}

MemoryPlan plan_call(Triangulator::State& state, const CallShape& call) {
  const bool stars =
      may_use_stars(traits_of(*state.device), state.options) && call.points >= fewest_for_stars(state.options);
  return choose_memory_plan(state.memory, state.options, state.device->info(), call, stars, state.known);
}

void remember_size(Triangulator::State& state, const Statistics& statistics, const MemoryPlan& plan) {
  const auto n = static_cast<std::size_t>(statistics.points);
  state.known.insertion = std::max(state.known.insertion, n);
  if (statistics.proven_stars == 0) return;
  std::size_t& known = plan.compact ? state.known.compact_stars : state.known.fast_stars;
  known = std::max(known, n);
}

void end_call(Triangulator::State& state, Context& ctx, bool ordered) {
  Statistics& statistics = ctx.statistics;
  const bool measured = ctx.options.statistics != StatisticsDetail::none || ctx.options.tuning.kernel_times;
  if (measured || !ordered || !ctx.options.queue) ctx.finish();
  statistics.launches = ctx.launcher.launches();
  statistics.kernels = ctx.launcher.kernel_times();
  statistics.bytes_device_peak = state.memory.peak();
  const Device::Copied copied = state.device->copied();
  statistics.bytes_to_device = copied.to_device - state.copied_before.to_device;
  statistics.bytes_from_device = copied.from_device - state.copied_before.from_device;
  ctx.check("output", 1);
}

}  // namespace cadt
