// SPDX-License-Identifier: Apache-2.0
// What all phases of one triangulation share.
#pragma once

#include <cadt/triangulation.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/driver/device.hpp"
#include "common/driver/launcher.hpp"
#include "common/driver/memory.hpp"
#include "common/driver/memory_plan.hpp"

namespace cadt {

struct Context {
  Context(Device& d, Memory& m, const Options& o, Statistics& s, const MemoryPlan& p = {})
      : device(d), options(o), statistics(s), memory(m), plan(p), launcher(d, m, o.grain) {
    if (options.statistics != StatisticsDetail::none) device.start_times();
  }

  Device& device;
  const Options& options;
  Statistics& statistics;
  Memory& memory;
  const MemoryPlan plan;
  Launcher launcher;

  /// What is checked from here on is this part of the whole.
  void begin_share(double begin, double share) noexcept {
    share_begin_ = begin;
    share_ = share;
  }

  /// Tells the progress and looks for a request to stop. \throws Cancelled
  void check(std::string_view phase, double fraction) {
    if (options.stop.stop_requested()) throw Cancelled();
    fraction = share_begin_ + share_ * fraction;
    if (options.progress && fraction > told_) {
      told_ = fraction;
      options.progress({phase, fraction});
      if (options.stop.stop_requested()) throw Cancelled();
    }
  }

  /// Ends a phase: what is launched from here on belongs to the next one. Nothing for StatisticsDetail::none.
  void end_phase(std::string_view name) {
    if (options.statistics == StatisticsDetail::none) return;
    device.mark_time();
    phases_.emplace_back(name);
  }

  /// Waits for the device and notes how long the phases took.
  void finish() {
    device.finish();
    if (phases_.empty()) return;
    const std::vector<double> times = device.times();
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
  double told_ = -1;  ///< passes that are repeated tell nothing new
  std::vector<std::string> phases_;
};

}  // namespace cadt
