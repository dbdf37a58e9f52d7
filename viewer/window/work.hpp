// SPDX-License-Identifier: Apache-2.0
// One long task on a thread of its own, with its progress, that can be cancelled.
#pragma once

#include <cadt/options.hpp>

#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace cadt::viewer {

class Work {
 public:
  /// What a task is given.
  class Desk {
   public:
    [[nodiscard]] cadt::stop_token stop() const { return stop_.get_token(); }
    /// Throws Cancelled if that was asked for.
    void check() const;
    /// From the task's thread. A fraction below 0: not known.
    void report(std::string_view phase, double fraction) noexcept;

   private:
    friend class Work;
    explicit Desk(std::function<void()> wake) : wake_(std::move(wake)) {}
    std::function<void()> wake_;
    cadt::stop_source stop_;
    mutable std::mutex mutex_;
    std::string phase_;
    double fraction_ = -1;
    bool done_ = false;
    std::exception_ptr error_;
    std::chrono::steady_clock::time_point woken_;
  };
  struct State {
    std::string phase;
    double fraction, seconds;
    bool stopping;
  };

  /// `wake` is called from the task's thread, some ten times a second and at its end.
  explicit Work(std::function<void()> wake) : wake_(std::move(wake)) {}
  ~Work();
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  /// \pre !running()
  void start(std::function<void(Desk&)> task);
  [[nodiscard]] bool running() const noexcept { return thread_.joinable(); }
  [[nodiscard]] State state() const;
  /// Asks the task to end; it goes on until it looks.
  void cancel() noexcept;
  /// True once, after the task has ended; `error` is what it threw.
  [[nodiscard]] bool finished(std::exception_ptr& error);
  /// Asks for the end, and waits for it.
  void abandon();

 private:
  std::function<void()> wake_;
  std::shared_ptr<Desk> desk_;
  std::thread thread_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace cadt::viewer
