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

void check(const cadt::stop_token& stop) {
  if (stop.stop_requested()) throw Cancelled();
}

}  // namespace

unsigned threads_for(std::uint64_t blocks, unsigned threads) noexcept {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  return static_cast<unsigned>(std::clamp<std::uint64_t>(blocks, 1, threads));
}

void each_block(const PointSource& source, std::uint64_t begin, std::uint64_t end, unsigned threads,
                const cadt::stop_token& stop,
                const std::function<void(unsigned, std::uint64_t, std::span<const double>)>& look) {
  const std::uint64_t blocks = (end - begin + block_points - 1) / block_points;
  std::atomic<std::uint64_t> next{0};  // blocks are begun in order, so all before one that fails are looked at
  FirstError error;
  const auto work = [&](unsigned thread) {
    try {
      std::vector<double> xy;
      for (std::uint64_t b; (b = next.fetch_add(1)) < blocks;) {
        check(stop);
        const std::uint64_t first = begin + b * block_points;
        const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(block_points, end - first));
        xy.resize(2 * count);
        source.read(first, count, xy.data());
        look(thread, first, xy);
      }
    } catch (...) {
      next.store(blocks);
      error.keep(std::current_exception());
    }
  };
  std::vector<std::thread> helpers;
  const unsigned wanted = threads_for(blocks, threads);
  try {
    for (unsigned i = 1; i < wanted; ++i) helpers.emplace_back(work, i);
  } catch (const std::system_error&) {  // NOLINT: those that did start do the work
  }
  work(0);
  for (std::thread& helper : helpers) helper.join();
  error.rethrow();
}

void for_each_block(const PointSource& source, std::uint64_t begin, std::uint64_t end, const cadt::stop_token& stop,
                    const std::function<void(std::uint64_t, std::span<const double>)>& look) {
  struct Slot {
    std::vector<double> xy;
    std::uint64_t first = 0;
    bool full = false;
  };
  constexpr std::size_t ahead = 4;
  std::vector<Slot> slots(ahead);
  std::mutex lock;
  std::condition_variable changed;
  bool over = false;  // nobody looks any more
  std::exception_ptr error;
  const std::uint64_t blocks = (end - begin + block_points - 1) / block_points;

  std::thread reader([&] {
    try {
      for (std::uint64_t b = 0; b < blocks; ++b) {
        Slot& slot = slots[b % ahead];
        {
          std::unique_lock guard(lock);
          changed.wait(guard, [&] { return !slot.full || over; });
          if (over) return;
        }
        slot.first = begin + b * block_points;
        const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(block_points, end - slot.first));
        slot.xy.resize(2 * count);
        source.read(slot.first, count, slot.xy.data());
        const std::scoped_lock guard(lock);
        slot.full = true;
        changed.notify_all();
      }
    } catch (...) {
      const std::scoped_lock guard(lock);
      error = std::current_exception();
      changed.notify_all();
    }
  });
  struct Join {
    std::thread& thread;
    std::mutex& lock;
    std::condition_variable& changed;
    bool& over;
    ~Join() {
      {
        const std::scoped_lock guard(lock);
        over = true;
        changed.notify_all();
      }
      thread.join();
    }
  } const join{reader, lock, changed, over};
  for (std::uint64_t b = 0; b < blocks; ++b) {
    check(stop);
    Slot& slot = slots[b % ahead];
    {
      std::unique_lock guard(lock);
      changed.wait(guard, [&] { return slot.full || error; });
      if (!slot.full) std::rethrow_exception(error);
    }
    look(slot.first, slot.xy);
    const std::scoped_lock guard(lock);
    slot.full = false;
    changed.notify_all();
  }
}

}  // namespace cadt::tiles
