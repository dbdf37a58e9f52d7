// SPDX-License-Identifier: Apache-2.0
#include "backends/cuda/workers.hpp"

#include <system_error>

namespace cadt::cuda {

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  begun_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Workers::start(std::size_t count) {
  threads_.reserve(count);
  try {
    while (threads_.size() < count) threads_.emplace_back([this, self = threads_.size() + 1] { serve(self); });
  } catch (const std::system_error&) {  // those that run share the work
  }
}

void Workers::run(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (count > 1) start(count - 1);
  {
    const std::lock_guard lock(mutex_);
    work_ = &work;
    count_ = count;
    ++call_;
  }
  begun_.notify_all();
  work(0);
  std::unique_lock lock(mutex_);
  work_ = nullptr;
  done_.wait(lock, [this] { return active_ == 0; });
}

void Workers::serve(std::size_t self) noexcept {
  std::uint64_t seen = 0;
  std::unique_lock lock(mutex_);
  while (true) {
    begun_.wait(lock, [&] { return stop_ || (call_ != seen && work_ != nullptr && self < count_); });
    if (stop_) return;
    seen = call_;
    const auto* const work = work_;
    ++active_;
    lock.unlock();
    (*work)(self);
    lock.lock();
    if (--active_ == 0) done_.notify_one();
  }
}

}  // namespace cadt::cuda
