// SPDX-License-Identifier: Apache-2.0
// What the free function triangulate() computes with: a device opened for the call or, for small sets on the host, the
// calling thread's own, which stays open and keeps its memory until the thread ends.
#pragma once

#include <cstddef>
#include <memory>

#include "common/driver/device_triangulation.hpp"

namespace cadt {

/// Whether the options leave a set of so many points to the calling thread alone: on the host, without what a device is
/// opened for.
[[nodiscard]] bool suits_calling_thread(const Options& options, std::size_t points) noexcept;

/// Bytes that a thread keeps at most from one call to the next.
constexpr std::size_t most_kept_by_thread = std::size_t{8} << 20;

/// The state of one call. While this lives it belongs to the call alone: a call from within another one, out of
/// Options::progress, gets one of its own.
class CallState {
 public:
  /// \throws as open_device
  CallState(const Options& options, std::size_t points);
  ~CallState();
  CallState(const CallState&) = delete;
  CallState& operator=(const CallState&) = delete;

  [[nodiscard]] const std::shared_ptr<Triangulator::State>& operator*() const noexcept { return state_; }

 private:
  std::shared_ptr<Triangulator::State> state_;
  bool returns_;  ///< to the thread
};

}  // namespace cadt
