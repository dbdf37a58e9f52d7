// SPDX-License-Identifier: Apache-2.0
#include "tiles/parallel.hpp"

#include <cadt/errors.hpp>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace cadt::tiles {
namespace {

/// Keeps the error that is to be thrown: of several points that are wrong, the first.
class FirstError {
 public:
  void keep(std::exception_ptr error) noexcept {
    const std::scoped_lock guard(lock_);
    if (!error_ || index_of(error) < index_of(error_)) error_ = std::move(error);
  }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  static std::size_t index_of(const std::exception_ptr& error) noexcept {
    try {
      std::rethrow_exception(error);
    } catch (const InputError& e) {
      return e.index();
    } catch (...) {
      return ~std::size_t{0};
    }
  }
  std::mutex lock_;
  std::exception_ptr error_;
};

/// Lets blocks pass one after the other.
class Turns {
 public:
  /// False if the turn will not come: a block before it has failed.
  [[nodiscard]] bool wait_for(std::uint64_t block) {
    std::unique_lock guard(lock_);
    changed_.wait(guard, [&] { return turn_ == block || ended_; });
    return !ended_;
  }
  void pass_on() {
    const std::scoped_lock guard(lock_);
    ++turn_;
    changed_.notify_all();
  }
  void end() {
    const std::scoped_lock guard(lock_);
    ended_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex lock_;
  std::condition_variable changed_;
  std::uint64_t turn_ = 0;
  bool ended_ = false;
};

/// Calls work(thread) on so many threads, of which this is number 0. If some cannot be started, the others do the work.
void on_threads(unsigned threads, const std::function<void(unsigned)>& work) {
  std::vector<std::thread> helpers;
  try {
    helpers.reserve(threads);
    for (unsigned i = 1; i < threads; ++i) helpers.emplace_back(work, i);
  } catch (const std::exception&) {  // NOLINT: those that did start do the work
  }
  work(0);
  for (std::thread& helper : helpers) helper.join();
}

void check(const cadt::stop_token& stop) {
  if (stop.stop_requested()) throw Cancelled();
}

}  // namespace

unsigned threads_for(std::uint64_t blocks, unsigned threads) noexcept {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  return static_cast<unsigned>(std::clamp<std::uint64_t>(blocks, 1, threads));
}

void each_block(const PointSource& source, std::uint64_t begin, std::uint64_t end, unsigned threads,
                const cadt::stop_token& stop, const BlockWork& work) {
  const std::uint64_t blocks = (end - begin + block_points - 1) / block_points;
  std::atomic<std::uint64_t> next{0};  // blocks are begun in order, so all before one that fails are looked at
  FirstError error;
  Turns turns;
  on_threads(threads_for(blocks, threads), [&](unsigned thread) {
    try {
      std::vector<double> xy;
      for (std::uint64_t b; (b = next.fetch_add(1)) < blocks;) {
        check(stop);
        const std::uint64_t first = begin + b * block_points;
        const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(block_points, end - first));
        xy.resize(2 * count);
        source.read(first, count, xy.data());
        work.look(thread, first, xy);
        if (work.in_turn) {
          if (!turns.wait_for(b)) return;
          work.in_turn(thread);
          turns.pass_on();
        }
        if (work.then) work.then(thread);
      }
    } catch (...) {
      next.store(blocks);
      error.keep(std::current_exception());
      turns.end();
    }
  });
  error.rethrow();
}

void run_tasks(std::span<const std::function<void()>> tasks, unsigned threads) {
  std::vector<std::exception_ptr> errors(tasks.size());
  std::atomic<std::size_t> next{0};
  on_threads(std::clamp(threads, 1U, static_cast<unsigned>(std::max<std::size_t>(tasks.size(), 1))), [&](unsigned) {
    for (std::size_t i; (i = next.fetch_add(1)) < tasks.size();) {
      try {
        tasks[i]();
      } catch (...) {
        errors[i] = std::current_exception();
      }
    }
  });
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

}  // namespace cadt::tiles
