// SPDX-License-Identifier: Apache-2.0
#include "backends/host/thread_pool.hpp"

namespace cadt::host {

ThreadPool::ThreadPool(unsigned threads) {
  for (unsigned i = 1; i < threads; ++i) workers_.emplace_back([this](const std::stop_token& stop) { serve(stop); });
}

ThreadPool::~ThreadPool() {
  for (auto& worker : workers_) worker.request_stop();
}

void ThreadPool::work() noexcept {
  for (;;) {
    const std::uint64_t item = next_.fetch_add(1, std::memory_order_relaxed);
    if (item >= items_) return;
    kernel_(static_cast<std::uint32_t>(item), items_, args_);
  }
}

void ThreadPool::serve(const std::stop_token& stop) noexcept {
  std::uint64_t seen = 0;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (!start_.wait(lock, stop, [&] { return launch_ != seen; })) return;
      seen = launch_;
    }
    work();
    std::lock_guard lock(mutex_);
    if (--active_ == 0) done_.notify_one();
  }
}

void ThreadPool::run(KernelFunction kernel, std::uint32_t items, const Arg* args) {
  kernel_ = kernel;
  args_ = args;
  items_ = items;
  next_.store(0, std::memory_order_relaxed);
  if (workers_.empty() || items < 2) {  // waking the others would take longer
    work();
    return;
  }
  {
    std::lock_guard lock(mutex_);
    ++launch_;
    active_ = static_cast<unsigned>(workers_.size());
  }
  start_.notify_all();
  work();
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return active_ == 0; });
}

}  // namespace cadt::host
