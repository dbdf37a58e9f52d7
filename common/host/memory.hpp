// SPDX-License-Identifier: Apache-2.0
// Device memory of one triangulator, counted, bounded, and kept for the next call.
#pragma once

#include <memory>
#include <utility>
#include <vector>

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
  /// `keep`: freed buffers are kept for the next call, unless the device does that itself.
  Memory(Device& device, bool keep) noexcept : device_(device), keep_(keep && !device.keeps_memory()) {}
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  /// \throws OutOfMemory if the limit or the device does not allow it
  [[nodiscard]] Allocation allocate(std::size_t bytes);
  /// The same, filled with zeros.
  [[nodiscard]] Allocation allocate_zeros(std::size_t bytes);
  /// The caller's data: aliased if the device can, else copied.
  [[nodiscard]] Allocation import(const void* data, std::size_t bytes);
  /// The caller's device memory.
  [[nodiscard]] Allocation wrap(void* handle, std::size_t bytes);
  /// Memory of the caller to be written by kernels, if the device can; else null.
  [[nodiscard]] Allocation export_to(void* data, std::size_t bytes);
  /// Whether `bytes` more are within the limit, or within what the device has free if there is none.
  [[nodiscard]] bool allows(std::size_t bytes);
  /// \throws OutOfMemory if `bytes` more would pass the limit or what the device has free
  void require(std::size_t bytes);
  /// Gives kept buffers back to the device.
  void drop_kept() noexcept {
    kept_.clear();
    kept_bytes_ = 0;
    dropped_ = true;
  }
  /// Whether kept buffers were given back since this was asked last.
  [[nodiscard]] bool dropped() noexcept { return std::exchange(dropped_, false); }

  /// A new account. `limit` in bytes bounds what is held and kept together from here on; 0 for none. `reserved`: the
  /// kept buffers are for a call like this one, so any that is large enough may be taken.
  void begin(std::size_t limit, bool reserved) noexcept {
    limit_ = limit;
    reserved_ = reserved;
    if (limit_ != 0 && held_ + kept_bytes_ > limit_) drop_kept();
    peak_ = held_ + kept_bytes_;
  }
  /// Most bytes held and kept together.
  [[nodiscard]] std::size_t peak() const noexcept { return peak_; }
  /// Buffers that had to be asked of the device since the beginning.
  [[nodiscard]] std::uint64_t allocations() const noexcept { return allocations_; }
  /// Whether buffers are kept here, not by the device.
  [[nodiscard]] bool keeps() const noexcept { return keep_; }

 private:
  friend class Allocation;
  [[nodiscard]] Allocation account(std::unique_ptr<Buffer> buffer);
  /// Bytes of the buffer for a request.
  [[nodiscard]] std::size_t requested(std::size_t bytes) const noexcept;
  /// Whether a kept buffer may serve a request for less.
  [[nodiscard]] bool suits(std::size_t kept, std::size_t bytes) const noexcept;
  [[nodiscard]] std::unique_ptr<Buffer> take_kept(std::size_t bytes) noexcept;
  void give_back(std::unique_ptr<Buffer> buffer, std::size_t counted) noexcept;
  void check_limit(std::size_t bytes);
  template <class Allocate>
  [[nodiscard]] std::unique_ptr<Buffer> ask(const Allocate& allocate);

  Device& device_;
  bool keep_, reserved_ = false, dropped_ = false;
  std::size_t limit_ = 0, held_ = 0, kept_bytes_ = 0, peak_ = 0;
  std::uint64_t allocations_ = 0;
  std::vector<std::unique_ptr<Buffer>> kept_;
};

}  // namespace cadt
