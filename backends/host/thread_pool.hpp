// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "backends/host/kernel_table.hpp"

namespace cadt::host {

/// A fixed number of threads, among them the caller's, that share the work-items of one launch after another. Each
/// thread has a contiguous share, so threads work far apart in the mesh and rarely conflict; a thread that has finished
/// its share helps the others. One launch at a time.
class ThreadPool {
 public:
  /// Where the system refuses to start so many, there are fewer. `interleaved`: no shares; each thread takes the next
  /// item, so that threads work side by side and conflict often (for tests).
  ThreadPool(unsigned threads, bool interleaved);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] unsigned threads() const noexcept { return static_cast<unsigned>(workers_.size()) + 1; }

  /// Runs items 0 to items - 1, each on one thread, in no order (ascending with one thread). Returns when all are done.
  void run(KernelFunction kernel, std::uint32_t items, const Arg* args);

 private:
  void work(std::size_t self) noexcept;
  void serve(std::size_t self) noexcept;
  void stop() noexcept;

  // The current launch. run() writes it while no worker is active.
  KernelFunction kernel_ = nullptr;
  const Arg* args_ = nullptr;
  std::uint32_t items_ = 0;
  struct alignas(64) Share {
    std::atomic<std::uint64_t> next{0};  // wider than an item number: each thread overshoots by one
    std::uint64_t end = 0;
  };
  std::vector<Share> shares_;  ///< one a thread; more if not all could be started
  bool interleaved_;

  std::mutex mutex_;
  std::condition_variable start_, done_;
  std::uint64_t launch_ = 0;
  bool open_ = false;    ///< whether workers may still join the launch
  bool ended_ = false;   ///< whether workers shall end
  unsigned active_ = 0;  ///< workers that have joined it and are not done
  std::vector<std::thread> workers_;
};

}  // namespace cadt::host
