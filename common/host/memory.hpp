// SPDX-License-Identifier: Apache-2.0
// Device memory of one run, counted, bounded and freed in time.
#pragma once

#include <memory>
#include <utility>

#include "common/host/device.hpp"

namespace cadt {

class Memory;

/// A buffer that gives its bytes back to the account when it goes. Null after a move.
class Allocation {
 public:
  Allocation() = default;
  Allocation(Memory& memory, std::unique_ptr<Buffer> buffer, std::size_t counted) noexcept
      : memory_(&memory), buffer_(std::move(buffer)), counted_(counted) {}
  ~Allocation() { release(); }
  Allocation(Allocation&& other) noexcept { swap(other); }
  Allocation& operator=(Allocation&& other) noexcept {
    if (this != &other) {
      release();
      swap(other);
    }
    return *this;
  }

  void release() noexcept;
  [[nodiscard]] Buffer& operator*() const noexcept { return *buffer_; }
  [[nodiscard]] explicit operator bool() const noexcept { return buffer_ != nullptr; }
  operator Arg() const noexcept { return {buffer_}; }  // NOLINT: an allocation is passed to kernels as it is

 private:
  void swap(Allocation& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(buffer_, other.buffer_);
    std::swap(counted_, other.counted_);
  }
  Memory* memory_ = nullptr;
  std::unique_ptr<Buffer> buffer_;
  std::size_t counted_ = 0;
};

/// The account. Outlives its allocations.
class Memory {
 public:
  /// `limit` in bytes, 0 for none.
  Memory(Device& device, std::size_t limit) noexcept : device_(device), limit_(limit) {}
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  /// \throws OutOfMemory if the limit or the device does not allow it
  [[nodiscard]] Allocation allocate(std::size_t bytes);
  /// The same, filled with zeros.
  [[nodiscard]] Allocation allocate_zeros(std::size_t bytes);
  /// The caller's data: aliased if the device can, else copied.
  [[nodiscard]] Allocation import(const void* data, std::size_t bytes);
  /// Memory of the caller to be written by kernels, if the device can; else null.
  [[nodiscard]] Allocation export_to(void* data, std::size_t bytes);
  /// \throws OutOfMemory if `bytes` more would pass the limit or the device's memory
  void require(std::size_t bytes) const;

  [[nodiscard]] std::size_t peak() const noexcept { return peak_; }

 private:
  friend class Allocation;
  [[nodiscard]] Allocation account(std::unique_ptr<Buffer> buffer);
  Device& device_;
  std::size_t limit_, held_ = 0, peak_ = 0;
};

}  // namespace cadt
