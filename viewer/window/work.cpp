// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/work.hpp"

#include <cadt/errors.hpp>

namespace cadt::viewer {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

void Work::Desk::check() const {
  if (stop_.stop_requested()) throw Cancelled();
}

void Work::Desk::report(std::string_view phase, double fraction) noexcept {
  {
    const std::lock_guard lock(mutex_);
    phase_.assign(phase);
    fraction_ = fraction;
    if (Clock::now() - woken_ < std::chrono::milliseconds(100)) return;
    woken_ = Clock::now();
  }
  wake_();
}

Work::~Work() { abandon(); }

void Work::start(std::function<void(Desk&)> task) {
  desk_ = std::shared_ptr<Desk>(new Desk(wake_));
  begin_ = Clock::now();
  thread_ = std::thread([desk = desk_, task = std::move(task)] {
    std::exception_ptr error;
    try {
      task(*desk);
    } catch (...) {
      error = std::current_exception();
    }
    {
      const std::lock_guard lock(desk->mutex_);
      desk->done_ = true;
      desk->error_ = error;
    }
    desk->wake_();
  });
}

Work::State Work::state() const {
  const std::lock_guard lock(desk_->mutex_);
  return {desk_->phase_, desk_->fraction_, std::chrono::duration<double>(Clock::now() - begin_).count(),
          desk_->stop_.stop_requested()};
}

void Work::cancel() noexcept {
  if (desk_ != nullptr) desk_->stop_.request_stop();
}

bool Work::finished(std::exception_ptr& error) {
  if (!running()) return false;
  {
    const std::lock_guard lock(desk_->mutex_);
    if (!desk_->done_) return false;
    error = desk_->error_;
  }
  thread_.join();
  return true;
}

void Work::abandon() {
  cancel();
  if (thread_.joinable()) thread_.join();
}

}  // namespace cadt::viewer
