// SPDX-License-Identifier: Apache-2.0
// What asks a running call to end, and what the call looks at: those of C++20 where the standard library has them, else
// (libc++ before version 20, as on macOS) the part of them that cadt needs.
#pragma once

#include <version>

#if defined(__cpp_lib_jthread)

#include <stop_token>

namespace cadt {
using std::stop_source;
using std::stop_token;
}  // namespace cadt

#else

#include <atomic>
#include <memory>
#include <utility>

namespace cadt {

class stop_token {
 public:
  stop_token() noexcept = default;
  [[nodiscard]] bool stop_requested() const noexcept { return requested_ != nullptr && requested_->load(); }
  [[nodiscard]] bool stop_possible() const noexcept { return requested_ != nullptr; }

 private:
  friend class stop_source;
  explicit stop_token(std::shared_ptr<std::atomic<bool> > requested) noexcept : requested_(std::move(requested)) {}
  std::shared_ptr<std::atomic<bool> > requested_;
};

class stop_source {
 public:
  stop_source() : requested_(std::make_shared<std::atomic<bool> >(false)) {}
  [[nodiscard]] stop_token get_token() const noexcept { return stop_token(requested_); }
  [[nodiscard]] bool stop_requested() const noexcept { return requested_->load(); }
  [[nodiscard]] bool stop_possible() const noexcept { return true; }
  /// True if nobody has asked before. From any thread.
  bool request_stop() noexcept { return !requested_->exchange(true); }

 private:
  std::shared_ptr<std::atomic<bool> > requested_;
};

}  // namespace cadt

#endif
