// SPDX-License-Identifier: Apache-2.0
// What all phases of one triangulation share.
#pragma once

#include <cadt/triangulation.hpp>

#include <chrono>
#include <string_view>

#include "common/host/device.hpp"
#include "common/host/launcher.hpp"
#include "common/host/memory.hpp"

namespace cadt {

struct Run {
  Run(Device& d, Memory& m, const Options& o, Statistics& s)
      : device(d), options(o), statistics(s), memory(m), launcher(d, m, o.grain) {}

  Device& device;
  const Options& options;
  Statistics& statistics;
  Memory& memory;
  Launcher launcher;

  /// Tells the progress and looks for a request to stop. \throws Cancelled
  void check(std::string_view phase, double fraction) {
    if (options.stop.stop_requested()) throw Cancelled();
    if (options.progress && fraction >= told_) {
      told_ = fraction;
      options.progress({phase, fraction});
      if (options.stop.stop_requested()) throw Cancelled();
    }
  }

  /// Ends a phase: waits for the device and notes the time since the last end. StatisticsDetail::none: does neither.
  void end_phase(std::string_view name) {
    if (options.statistics == StatisticsDetail::none) return;
    device.finish();
    const auto now = std::chrono::steady_clock::now();
    statistics.milliseconds.emplace_back(name, std::chrono::duration<double, std::milli>(now - last_).count());
    last_ = now;
  }

 private:
  double told_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace cadt
