// SPDX-License-Identifier: Apache-2.0
// Device memory of one triangulator, counted, bounded, and kept for the next call.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/driver/device.hpp"

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
  /// For some steps of a call: a part of a kept buffer that a later step will take as a whole, so that the two need no
  /// more together than the larger. Where no kept one has room, a buffer of its own, which is not kept. What may be in
  /// a result, or is still held when the large buffers of the next step are asked for, is not for this.
  /// `ends_first`: it is given back before the others that are borrowed now, so it is a part of the largest kept
  /// buffer, the others are of the smallest with room. \throws OutOfMemory as allocate
  [[nodiscard]] Allocation transient(std::size_t bytes, bool ends_first = false);
  /// A buffer that is not kept where others are lent, for what would be in the way as a part of one.
  /// \throws OutOfMemory as allocate
  [[nodiscard]] Allocation allocate_unpooled(std::size_t bytes);
  /// As borrow, filled with zeros.
  [[nodiscard]] Allocation transient_zeros(std::size_t bytes);
  /// As long as this lives, all is borrowed that is allocated.
  class TransientScope {
   public:
    TransientScope(Memory& memory, bool really) noexcept
        : memory_(memory), before_(std::exchange(memory.transient_all_, really)) {}
    ~TransientScope() { memory_.transient_all_ = before_; }
    TransientScope(const TransientScope&) = delete;
    TransientScope& operator=(const TransientScope&) = delete;

   private:
    Memory& memory_;
    bool before_;
  };
  /// Whether borrow() gives so many bytes otherwise than allocate().
  [[nodiscard]] bool pools(std::size_t bytes) const noexcept;
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
  /// Gives kept buffers back to the device, but for those that are lent.
  void drop_kept() noexcept {
    kept_.clear();
    kept_bytes_ = pooled_bytes_;
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
  /// A kept buffer of which parts are in use.
  struct Pool {
    struct Part {
      const Buffer* buffer;
      std::size_t begin, end;
    };
    std::unique_ptr<Buffer> whole;
    std::vector<Part> parts;  ///< ascending
    /// Where so many bytes are free, the first such place; none: its end.
    [[nodiscard]] std::size_t room(std::size_t bytes) const noexcept;
  };
  [[nodiscard]] Allocation count_in(std::unique_ptr<Buffer> buffer);
  /// Bytes of the buffer for a request.
  [[nodiscard]] std::size_t requested(std::size_t bytes) const noexcept;
  /// Whether a kept buffer may serve a request for less.
  [[nodiscard]] bool suits(std::size_t kept, std::size_t bytes) const noexcept;
  [[nodiscard]] std::unique_ptr<Buffer> take_kept(std::size_t bytes) noexcept;
  /// Null if no kept buffer has room.
  [[nodiscard]] std::unique_ptr<Buffer> take_part(std::size_t bytes, bool ends_first);
  /// False if it is no part.
  bool give_back_part(std::unique_ptr<Buffer>& buffer) noexcept;
  void keep_if_idle(Pool& pool) noexcept;
  void keep(std::unique_ptr<Buffer> buffer) noexcept;
  void give_back(std::unique_ptr<Buffer> buffer, std::size_t counted) noexcept;
  void check_limit(std::size_t bytes);
  template <class Allocate>
  [[nodiscard]] std::unique_ptr<Buffer> ask(const Allocate& allocate);

  Device& device_;
  bool keep_, reserved_ = false, dropped_ = false, transient_all_ = false;
  std::size_t limit_ = 0, held_ = 0, peak_ = 0;
  std::size_t kept_bytes_ = 0, pooled_bytes_ = 0;  // of whole buffers; those that lend are among both
  std::uint64_t allocations_ = 0;
  std::vector<std::unique_ptr<Buffer>> kept_;
  std::vector<Pool> pools_;
  std::vector<const Buffer*> unpooled_;  // borrowed, with memory of their own
};

}  // namespace cadt
