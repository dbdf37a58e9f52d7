// SPDX-License-Identifier: Apache-2.0
// Loops over index ranges on threads, with results that do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace cadt::platform {

/// The number of threads that 0 stands for is that of the cores.
[[nodiscard]] inline unsigned threads_or_all(unsigned threads) noexcept {
  return threads != 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
}

/// Calls body(i, result) for each i in [0, count) and merges the results of all threads, which take `block` of them at
/// a time. If a thread cannot be started, the others do its work. Rethrows an exception of a body once all threads have
/// ended.
template <class Result, class Body>
Result reduce_each(std::size_t count, unsigned threads, const Body& body, std::size_t block = std::size_t{1} << 13) {
  const std::size_t blocks = (count + block - 1) / block;
  std::atomic<std::size_t> next{0};
  std::mutex lock;
  Result total;
  std::exception_ptr error;
  const auto work = [&] {
    try {
      Result mine;
      for (std::size_t b; (b = next.fetch_add(1, std::memory_order_relaxed)) < blocks;)
        for (std::size_t i = b * block, end = std::min(count, i + block); i < end; ++i) body(i, mine);
      const std::scoped_lock guard(lock);
      total.merge(mine);
    } catch (...) {
      next.store(blocks, std::memory_order_relaxed);
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
    };
    Helpers started;
    std::vector<std::thread>& helpers = started.all;
    const std::size_t wanted = std::min<std::size_t>(threads, blocks);
    if (wanted > 1) helpers.reserve(wanted - 1);
    try {
      while (helpers.size() + 1 < wanted) helpers.emplace_back(work);
    } catch (const std::system_error&) {  // NOLINT: continue with the threads that did start
    }
    work();
  }
  if (error) std::rethrow_exception(error);
  return total;
}

/// The same without a result: body(i).
template <class Body>
void for_each_task(std::size_t count, unsigned threads, const Body& body, std::size_t block = 1) {
  struct Nothing {
    void merge(const Nothing&) {}
  };
  reduce_each<Nothing>(
      count, threads, [&](std::size_t i, Nothing&) { body(i); }, block);
}

/// The same for equal blocks of [0, count): body(first, last).
template <class Body>
void for_each_block(std::size_t count, unsigned threads, const Body& body) {
  constexpr std::size_t block = std::size_t{1} << 12;
  for_each_task((count + block - 1) / block, threads,
                [&](std::size_t i) { body(i * block, std::min(count, (i + 1) * block)); });
}

}  // namespace cadt::platform
