// SPDX-License-Identifier: Apache-2.0
// What all stages of one call share: device, options, statistics, memory and its plan, launcher.
#pragma once

#include <cadt/triangulation.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/driver/device.hpp"
#include "common/driver/give_up.hpp"
#include "common/driver/launcher.hpp"
#include "common/driver/memory.hpp"
#include "common/driver/memory_plan.hpp"

namespace cadt {

struct Context {
  Context(Device& d, Memory& m, const Options& o, Statistics& s, const MemoryPlan& p = {})
      : device(d), options(o), statistics(s), memory(m), plan(p), launcher(d, m, o.tuning.grain) {
    if (options.statistics == StatisticsDetail::none) return;
    device.start_times();
    phases_.reserve(16);
  }

  Device& device;
  const Options& options;
  Statistics& statistics;
  Memory& memory;
  const MemoryPlan plan;
  Launcher launcher;
  bool result_on_host = false;  ///< the result goes to memory of the host: kernels write there if the device can

  /// The fractions passed to check() from here on are of this part of the call: `share` of it, from `begin` on.
  void begin_share(double begin, double share) noexcept {
    share_begin_ = begin;
    share_ = share;
  }

  /// Reports the progress and looks for a stop request. \throws Cancelled
  void check(std::string_view phase, double fraction) {
    if (options.stop.stop_requested()) throw Cancelled();
    fraction = share_begin_ + share_ * fraction;
    if (options.progress && fraction > reported_) {
      reported_ = fraction;
      options.progress({phase, fraction});
      if (options.stop.stop_requested()) throw Cancelled();
    }
  }

  /// Ends a phase: what was launched since the last one belongs to it. Does nothing for StatisticsDetail::none. `name`:
  /// a literal.
  void end_phase(std::string_view name) {
    if (options.statistics == StatisticsDetail::none) return;
    device.mark_time();
    phases_.push_back(name);
  }

  /// Waits for the device and adds the times of the phases to the statistics.
  void finish() {
    device.finish();
    if (phases_.empty()) return;
    const std::vector<double> times = device.times();
    statistics.milliseconds.reserve(statistics.milliseconds.size() + phases_.size());
    for (std::size_t i = 0; i < phases_.size(); ++i) {
      const auto same = std::ranges::find(statistics.milliseconds, phases_[i], &std::pair<std::string, double>::first);
      if (same == statistics.milliseconds.end())
        statistics.milliseconds.emplace_back(phases_[i], times[i]);
      else
        same->second += times[i];
    }
    phases_.clear();
  }

 private:
  double share_begin_ = 0, share_ = 1;
  double reported_ = -1;  ///< so that repeated passes report nothing again
  std::vector<std::string_view> phases_;
};

}  // namespace cadt
