// SPDX-License-Identifier: Apache-2.0
// A few independent tasks of different size on threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace cadt::constraints {

/// The number of threads that 0 stands for is that of the cores.
[[nodiscard]] inline unsigned threads_or_all(unsigned threads) {
  return threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
}

/// Calls body(i) for each i in [0, count), each once, on up to `threads` threads. If a thread cannot be started the
/// others do its work. Rethrows an exception of a body once all threads have ended.
template <class Body>
void for_each_task(std::size_t count, unsigned threads, const Body& body) {
  std::atomic<std::size_t> next{0};
  std::mutex lock;
  std::exception_ptr error;
  const auto work = [&] {
    try {
      for (std::size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) body(i);
    } catch (...) {
      next.store(count, std::memory_order_relaxed);
      const std::scoped_lock guard(lock);
      error = std::current_exception();
    }
  };
  {
    struct Helpers {  // no jthread: libc++ has it only since version 20
      std::vector<std::thread> all;
      ~Helpers() {
        for (std::thread& helper : all) helper.join();
      }
    } helpers;
    const std::size_t wanted = std::min<std::size_t>(threads, count);
    if (wanted > 1) helpers.all.reserve(wanted - 1);
    try {
      while (helpers.all.size() + 1 < wanted) helpers.all.emplace_back(work);
    } catch (const std::system_error&) {  // NOLINT: continue with the threads that did start
    }
    work();
  }
  if (error) std::rethrow_exception(error);
}

/// The same for equal blocks of [0, count): body(first, last).
template <class Body>
void for_each_block(std::size_t count, unsigned threads, const Body& body) {
  constexpr std::size_t block = std::size_t{1} << 12;
  for_each_task((count + block - 1) / block, threads,
                [&](std::size_t i) { body(i * block, std::min(count, (i + 1) * block)); });
}

}  // namespace cadt::constraints
