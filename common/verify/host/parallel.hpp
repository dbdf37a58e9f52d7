// SPDX-License-Identifier: Apache-2.0
// Loops over index ranges on threads, with results that do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace cadt::verifier {

/// Outcome of one check; the lowest failing index is kept, so it is the same for every number of threads.
struct Findings {
  std::uint64_t failures = 0, examined = 0;
  std::int64_t first = -1;

  void fail(std::size_t where) {
    ++failures;
    const auto w = static_cast<std::int64_t>(where);
    if (first < 0 || w < first) first = w;
  }
  void merge(const Findings& other) {
    if (other.first >= 0 && (first < 0 || other.first < first)) first = other.first;
    failures += other.failures;
    examined += other.examined;
  }
};

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

}  // namespace cadt::verifier
