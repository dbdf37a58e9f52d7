// SPDX-License-Identifier: Apache-2.0
// How long work on the host ends early.
#pragma once

#include <cadt/errors.hpp>
#include <cadt/options.hpp>

#include <chrono>
#include <functional>
#include <thread>

namespace cadt::constraints {

/// \throws Cancelled if a stop was requested
inline void check(const stop_token& stop) {
  if (stop.stop_requested()) throw Cancelled();
}

/// Whether long work on the host is to end early. On the thread of the call the caller hears from time to time that it
/// goes on, and can request a stop then.
class StopCheck {
 public:
  StopCheck() = default;
  /// `fraction`: of the call, that has been reported; how much of this work is left nobody knows.
  StopCheck(const Options& options, double fraction)
      : stop_(options.stop), progress_(options.progress), fraction_(fraction) {}

  /// Thread-safe. \throws Cancelled if a stop was requested, and what Options::progress throws
  void operator()() const {
    if (progress_ && std::this_thread::get_id() == caller_) tell();
    check(stop_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  void tell() const {
    const Clock::time_point now = Clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(50);
    progress_({"cross", fraction_});
  }

  stop_token stop_;
  std::function<void(const Progress&)> progress_;
  double fraction_ = 0;
  std::thread::id caller_ = std::this_thread::get_id();
  mutable Clock::time_point next_;  // of the caller alone
};

}  // namespace cadt::constraints
