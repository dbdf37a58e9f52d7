// SPDX-License-Identifier: Apache-2.0
#include "backends/host/thread_pool.hpp"

#include <system_error>

namespace cadt::host {

ThreadPool::ThreadPool(unsigned threads, bool interleaved) : shares_(threads), interleaved_(interleaved) {
  try {
    for (std::size_t i = 1; i < threads; ++i) workers_.emplace_back([this, i] { serve(i); });
  } catch (const std::system_error&) {  // the system has no more threads: those that run share the work
  } catch (...) {
    stop();
    throw;
  }
}

ThreadPool::~ThreadPool() { stop(); }

void ThreadPool::stop() noexcept {
  {
    std::lock_guard lock(mutex_);
    ended_ = true;
  }
  start_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::work(std::size_t self) noexcept {
  const std::size_t shares = threads();
  for (std::size_t turn = 0; turn < shares; ++turn) {
    Share& share = shares_[(self + turn) % shares];
    for (;;) {
      const std::uint64_t item = share.next.fetch_add(1, std::memory_order_relaxed);
      if (item >= share.end) break;
      kernel_(static_cast<std::uint32_t>(item), items_, args_);
    }
  }
}

void ThreadPool::serve(std::size_t self) noexcept {
  std::uint64_t seen = 0;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      start_.wait(lock, [&] { return ended_ || (open_ && launch_ != seen); });
      if (ended_) return;
      seen = launch_;
      ++active_;
    }
    work(self);
    std::lock_guard lock(mutex_);
    if (--active_ == 0) done_.notify_one();
  }
}

void ThreadPool::run(KernelFunction kernel, std::uint32_t items, const Arg* args) {
  if (workers_.empty() || items < 2) {  // waking the workers would take longer
    for (std::uint32_t item = 0; item < items; ++item) kernel(item, items, args);
    return;
  }
  kernel_ = kernel;
  args_ = args;
  items_ = items;
  const std::size_t shares = interleaved_ ? 1 : threads();
  for (std::size_t i = 0; i < shares; ++i) {
    shares_[i].next.store(std::uint64_t{items} * i / shares, std::memory_order_relaxed);
    shares_[i].end = std::uint64_t{items} * (i + 1) / shares;
  }
  {
    std::lock_guard lock(mutex_);
    ++launch_;
    open_ = true;
  }
  // Each woken thread has an item at least.
  if (const std::size_t wanted = items - std::size_t{1}; wanted < workers_.size())
    for (std::size_t i = 0; i < wanted; ++i) start_.notify_one();
  else
    start_.notify_all();
  work(0);
  // No item is left. Workers that have not joined by now are not waited for: on a busy machine that can cost a time
  // slice a launch.
  std::unique_lock lock(mutex_);
  open_ = false;
  done_.wait(lock, [&] { return active_ == 0; });
}

}  // namespace cadt::host
