// SPDX-License-Identifier: Apache-2.0
// What tests need of the system, and of C++20 where a standard library is behind.
#pragma once

#include <thread>
#include <utility>

#if defined(_WIN32)
#include <process.h>
#else
#include <unistd.h>
#endif

namespace cadt::test {

/// std::jthread, which libc++ has since version 20.
class JoinedThread {
 public:
  template <class Work>
  explicit JoinedThread(Work work) : thread_(std::move(work)) {}
  ~JoinedThread() {
    if (thread_.joinable()) thread_.join();
  }
  JoinedThread(JoinedThread&&) noexcept = default;
  JoinedThread& operator=(JoinedThread&&) = delete;

 private:
  std::thread thread_;
};

inline long process_number() noexcept {
#if defined(_WIN32)
  return ::_getpid();
#else
  return ::getpid();
#endif
}

}  // namespace cadt::test
