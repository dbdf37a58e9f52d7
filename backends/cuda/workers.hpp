// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace cadt::cuda {

/// Threads that sleep until there is something to do together. One call at a time.
class Workers {
 public:
  Workers() = default;
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Calls work(0) on this thread and work(1) to work(count - 1) on others, each at most once: a call whose thread
  /// comes when work(0) has returned is left out, so work(0) must end only when nothing is left to begin. Returns when
  /// all have. Threads are started when they are first needed; where the system refuses, there are fewer. \pre `work`
  /// does not throw
  void run(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  void start(std::size_t count);
  void serve(std::size_t self) noexcept;

  std::mutex mutex_;
  std::condition_variable begun_, done_;
  const std::function<void(std::size_t)>* work_ = nullptr;  ///< null: nobody may join
  std::size_t count_ = 0;
  std::uint64_t call_ = 0;
  std::size_t active_ = 0;  ///< threads that have joined and are not done
  bool stop_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace cadt::cuda
