// SPDX-License-Identifier: Apache-2.0
#include "common/driver/thread_state.hpp"

#include <utility>

#include "common/driver/choose_strategy.hpp"
#include "common/driver/registry.hpp"

namespace cadt {
namespace {

/// Whether the state of this thread is destroyed already: a destructor that runs later may call the library. Without a
/// destructor itself, so that it can be read until the thread is gone.
thread_local bool ended = false;

struct OfThread {
  std::shared_ptr<Triangulator::State> state;
  ~OfThread() { ended = true; }
};

std::shared_ptr<Triangulator::State>& of_thread() {
  thread_local OfThread own;
  return own.state;
}

std::shared_ptr<Triangulator::State> open_for_thread() {
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  auto device = open_device(options);
  return std::make_shared<Triangulator::State>(options, std::move(device), true);
}

}  // namespace

bool suits_calling_thread(const Options& options, std::size_t points) noexcept {
  const bool plain = options.device.empty() && !options.queue && options.allocator == nullptr &&
                     options.max_memory == 0 && !options.tuning.kernel_times;
  return plain && points <= most_points_of_calling_thread && options.tuning.strategy == Strategy::automatic &&
         options.tuning.grain == 0 && (options.backend == Backend::host || takes_host(options, points));
}

CallState::CallState(const Options& options, std::size_t points)
    : returns_(!ended && suits_calling_thread(options, points)) {
  if (!returns_) {
    state_ = std::make_shared<Triangulator::State>(options, open_device(options, points), false);
    return;
  }
  state_ = std::exchange(of_thread(), nullptr);
  if (state_ == nullptr) state_ = open_for_thread();
  state_->options = options;
}

CallState::~CallState() {
  if (!returns_) return;
  state_->options = {};  // what belongs to the caller
  if (state_->memory.peak() > most_kept_by_thread) state_->memory.drop_cached();
  of_thread() = std::move(state_);
}

}  // namespace cadt
