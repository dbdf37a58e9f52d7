// SPDX-License-Identifier: Apache-2.0
// Work of several threads: passes over the blocks of a source, and tasks.
#pragma once

#include "tiles/source.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace cadt::tiles {

/// Threads for `blocks` blocks; 0: one for each core.
[[nodiscard]] unsigned threads_for(std::uint64_t blocks, unsigned threads) noexcept;

/// A T for each thread, which makes its own when it first asks for it. So what two threads write is not in one cache
/// line, as it would be if one thread made all.
template <class T>
class PerThread {
 public:
  template <class Make>
  PerThread(unsigned threads, Make make) : make_(std::move(make)), made_(threads) {}
  [[nodiscard]] T& of(unsigned thread) {
    if (!made_[thread]) made_[thread] = std::make_unique<T>(make_());
    return *made_[thread];
  }
  /// Calls body(T&) for those that were made, in the order of the threads.
  template <class Body>
  void each(const Body& body) {
    for (const auto& made : made_)
      if (made) body(*made);
  }

 private:
  std::function<T()> make_;
  std::vector<std::unique_ptr<T>> made_;
};

/// What is done with a block, on the thread that has read it.
struct BlockWork {
  std::function<void(unsigned thread, std::uint64_t first, std::span<const double> xy)> look;  ///< in any order
  /// After it, in the order of the blocks, one call at a time. May be empty.
  std::function<void(unsigned thread)> in_turn = {};
  std::function<void(unsigned thread)> then = {};  ///< after that, in any order. May be empty
};

/// Does this with each block of [begin, end) on up to `threads` threads (0: all cores), each of which reads its own
/// blocks. If several throw InputError, that with the smallest index is thrown. \throws what the work and reading
/// throw, Cancelled
void each_block(const PointSource& source, std::uint64_t begin, std::uint64_t end, unsigned threads,
                const cadt::stop_token& stop, const BlockWork& work);

/// Runs tasks that do not depend on each other, the first ones first, on up to `threads` threads. All have ended when
/// it returns. \throws what the first task throws that fails
void run_tasks(std::span<const std::function<void()>> tasks, unsigned threads);

}  // namespace cadt::tiles
