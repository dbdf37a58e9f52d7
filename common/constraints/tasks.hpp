// SPDX-License-Identifier: Apache-2.0
// A few independent tasks of different size on threads, and how they end early.
#pragma once

#include <cadt/errors.hpp>
#include <cadt/options.hpp>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <thread>

#include "common/verify/host/parallel.hpp"

namespace cadt::constraints {

/// The number of threads that 0 stands for is that of the cores.
[[nodiscard]] inline unsigned threads_or_all(unsigned threads) {
  return threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
}

/// \throws Cancelled if a stop was requested
inline void check(const stop_token& stop) {
  if (stop.stop_requested()) throw Cancelled();
}

/// Whether long work on the host is to end early. On the thread of the call the caller hears from time to time that it
/// goes on, and can request a stop then.
class Watch {
 public:
  Watch() = default;
  /// `fraction`: of the call, that has been reported; how much of this work is left nobody knows.
  Watch(const Options& options, double fraction)
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

/// Calls body(i) for each i in [0, count), each once, on up to `threads` threads. As reduce_each, without a result.
template <class Body>
void for_each_task(std::size_t count, unsigned threads, const Body& body) {
  struct Nothing {
    void merge(const Nothing&) {}
  };
  verifier::reduce_each<Nothing>(
      count, threads, [&](std::size_t i, Nothing&) { body(i); }, 1);
}

/// The same for equal blocks of [0, count): body(first, last).
template <class Body>
void for_each_block(std::size_t count, unsigned threads, const Body& body) {
  constexpr std::size_t block = std::size_t{1} << 12;
  for_each_task((count + block - 1) / block, threads,
                [&](std::size_t i) { body(i * block, std::min(count, (i + 1) * block)); });
}

}  // namespace cadt::constraints
