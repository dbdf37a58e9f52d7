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
/// The buffers, `slot_bytes` * 2 a thread, are allocated by the first copy that needs them and kept until release().
/// Where the system refuses to lock so much memory or to start so many threads, there are fewer; without any, suits()
/// is false, and the caller takes the driver's copy, which is slower.
class Transfer {
 public:
  static constexpr std::size_t slot_bytes = std::size_t{2} << 20;    ///< a huge page: no two threads make the same one
  static constexpr std::size_t fewest_bytes = std::size_t{2} << 20;  ///< below, waking threads takes longer
  static constexpr unsigned most_threads = 16;

  /// `threads`: at most; 0: one for each core.
  Transfer(std::shared_ptr<Stream> stream, unsigned threads) noexcept;
  ~Transfer();
  Transfer(const Transfer&) = delete;
  Transfer& operator=(const Transfer&) = delete;

  /// Whether a copy from or to this memory is faster through the buffers: it is large and not page-locked or managed,
  /// and there are buffers. \pre the context is current. Holds for all. \throws DeviceError
  [[nodiscard]] bool suits(const void* host, std::size_t bytes);
  /// Both wait for the stream first, and return when all is copied. \pre suits(host, bytes) \throws DeviceError
  void to_device(void* device, const void* host, std::size_t bytes);
  void to_host(void* host, const void* device, std::size_t bytes);
  /// Frees the buffers.
  void release() noexcept;

 private:
  struct Lane;
  struct Job;
  /// As many lanes as a copy of so many bytes keeps busy, if there is memory for them.
  void make_lanes(std::size_t bytes);
  void run(Job& job);

  std::shared_ptr<Stream> stream_;
  unsigned threads_;
  bool refused_ = false;  ///< the system locks no more memory
  std::vector<std::unique_ptr<Lane>> lanes_;
  Workers workers_;
};

}  // namespace cadt::cuda
