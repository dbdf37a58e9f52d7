// SPDX-License-Identifier: Apache-2.0
// Large copies between device memory and pageable memory of the host.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "backends/cuda/context.hpp"
#include "backends/cuda/workers.hpp"

namespace cadt::cuda {

/// Copies through page-locked buffers by several threads: each has two buffers and a stream, and copies between one
/// buffer and the caller's memory while the bus copies the other. So the bus runs at its full rate, and pages that are
/// written for the first time are made by all threads. The driver's own copy of pageable memory does that with one
/// thread.
///
/// Locking memory takes as long as several copies of it. So a thread gets its buffers, `slot_bytes` * 2, only when
/// `bytes_a_lane` more have been copied: a device that is opened for one call of a million points spends nothing, and
/// one that is kept has all buffers after a few calls. They are kept until release(). Where the system refuses to lock
/// so much memory or to start so many threads, there are fewer; without enough of them prepare() is false, and the
/// caller takes the driver's copy, which is slower.
class Transfer {
 public:
  static constexpr std::size_t slot_bytes = std::size_t{1} << 20;     ///< smaller ones keep the bus waiting
  static constexpr std::size_t fewest_bytes = std::size_t{2} << 20;   ///< below, the gain is not clear
  static constexpr std::size_t bytes_a_lane = std::size_t{16} << 20;  ///< about twice what locking its memory takes
  static constexpr std::size_t fewest_lanes = 4;  ///< the driver's copy is as fast as fewer, unless they are all
  static constexpr unsigned most_threads = 16;

  /// `threads`: at most; 0: one for each core.
  Transfer(std::shared_ptr<Stream> stream, unsigned threads) noexcept;
  ~Transfer();
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;

  /// Whether a copy from or to this memory is faster through the buffers: it is large and not page-locked or managed,
  /// and there are buffers, which are made here as far as what was copied earns them. \pre the context is current.
  /// Holds for all. \throws DeviceError
  [[nodiscard]] bool prepare(const void* host, std::size_t bytes);
  /// Both wait for the stream first, and return when all is copied. \pre prepare(host, bytes) \throws DeviceError
  void to_device(void* device, const void* host, std::size_t bytes);
  void to_host(void* host, const void* device, std::size_t bytes);
  /// Frees the buffers.
  void release() noexcept;

 private:
  struct Lane;
  struct Job;
  struct Piece;
  /// Lanes for a copy of so many bytes; 0: the driver's copy is as fast.
  [[nodiscard]] std::size_t lanes_for(std::size_t bytes);
  void run(Job& job);

  std::shared_ptr<Stream> stream_;
  unsigned threads_;
  std::size_t copied_ = 0;  ///< bytes of all large copies
  bool refused_ = false;    ///< the system locks no more memory
  std::vector<std::unique_ptr<Lane>> lanes_;
  Workers workers_;
};

}  // namespace cadt::cuda
