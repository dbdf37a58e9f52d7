// SPDX-License-Identifier: Apache-2.0
// The budget of device memory of one triangulator: what is taken from the device, held or cached, is counted and
// bounded. What a call will take is planned before (memory_plan.hpp); what is cached is the device's own business
// (buffer_cache.hpp).
#pragma once

#include <memory>
#include <span>
#include <utility>

#include "common/driver/buffer_cache.hpp"
#include "common/driver/device.hpp"

namespace cadt {

class Memory;

/// A buffer that returns its bytes to the budget when it is destroyed. Null after a move.
class Allocation {
 public:
  Allocation() = default;
  Allocation(Memory& memory, std::unique_ptr<Buffer> buffer, Lifetime lifetime) noexcept
      : buffer_(buffer.release(), {&memory, lifetime}) {}
  /// Memory of the caller's, which is in no budget.
  explicit Allocation(std::unique_ptr<Buffer> callers) noexcept : buffer_(callers.release()) {}

  void release() noexcept { buffer_.reset(); }
  [[nodiscard]] Buffer& operator*() const noexcept { return *buffer_; }
  [[nodiscard]] explicit operator bool() const noexcept { return buffer_ != nullptr; }
  operator Arg() const noexcept { return {buffer_}; }  // NOLINT: an allocation is passed to kernels as it is

 private:
  struct Reclaim {
    Memory* memory;  ///< null for a buffer of the caller, which is in no budget
    Lifetime lifetime;
    void operator()(Buffer* buffer) const noexcept;
  };
  std::unique_ptr<Buffer, Reclaim> buffer_;
};

/// Outlives its allocations.
class Memory {
 public:
  /// `cache`: freed buffers are cached for the next call, unless the device keeps memory itself.
  Memory(Device& device, bool cache) : device_(device), cache_(cache ? device.make_cache() : nullptr) {}
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  /// \throws OutOfMemory if the limit or the device does not allow it
  [[nodiscard]] Allocation allocate(std::size_t bytes) { return serve(bytes, Lifetime::kept, false); }
  /// Filled with zeros. \throws OutOfMemory as allocate
  [[nodiscard]] Allocation allocate_zeros(std::size_t bytes) { return serve(bytes, Lifetime::kept, true); }
  /// Memory of a few steps. Not for what may become part of a result, nor for what is still held when the next step
  /// allocates its large buffers. `ends_first`: released before all other transient memory of now. \throws OutOfMemory
  /// as allocate
  [[nodiscard]] Allocation transient(std::size_t bytes, bool ends_first = false) {
    return serve(bytes, ends_first ? Lifetime::ends_first : Lifetime::transient, false);
  }
  /// As transient, filled with zeros.
  [[nodiscard]] Allocation transient_zeros(std::size_t bytes) { return serve(bytes, Lifetime::transient, true); }
  /// Memory of a few steps that would be in the way in a pool. \throws OutOfMemory as allocate
  [[nodiscard]] Allocation allocate_unpooled(std::size_t bytes) { return serve(bytes, Lifetime::unpooled, false); }
  /// While this lives, all that is allocated is transient, if `enabled`.
  class TransientScope {
   public:
    TransientScope(Memory& memory, bool enabled) noexcept
        : memory_(memory), before_(std::exchange(memory.transient_all_, enabled)) {}
    ~TransientScope() { memory_.transient_all_ = before_; }
    TransientScope(const TransientScope&) = delete;
    TransientScope& operator=(const TransientScope&) = delete;

   private:
    Memory& memory_;
    bool before_;
  };
  /// Whether so many transient bytes come from a pool; else transient() is allocate().
  [[nodiscard]] bool pools(std::size_t bytes) const noexcept { return caches() && cache_->pools(bytes); }
  /// The caller's data: aliased if the device can, else copied.
  [[nodiscard]] Allocation import(const void* data, std::size_t bytes);
  /// A copy of the host's values; null if there are none.
  template <class T>
  [[nodiscard]] Allocation upload(std::span<const T> values) {
    return values.empty() ? Allocation() : upload(values.data(), values.size_bytes());
  }
  /// The caller's device memory.
  [[nodiscard]] Allocation wrap(void* handle, std::size_t bytes) { return Allocation(device_.wrap(handle, bytes)); }
  /// The caller's memory, for kernels to write to, if the device can; else null.
  [[nodiscard]] Allocation export_to(void* data, std::size_t bytes) {
    return Allocation(device_.alias_output(data, bytes));
  }

  /// Whether `bytes` more are within the limit or, without a limit, within what the device has free.
  [[nodiscard]] bool allows(std::size_t bytes);
  /// \throws OutOfMemory if `bytes` more would pass the limit or what the device has free
  void require(std::size_t bytes);
  /// Frees what is cached and not in use.
  void drop_cached() noexcept {
    drop();
    dropped_ = true;
  }
  /// Whether cached buffers were dropped since the last call of this function.
  [[nodiscard]] bool dropped() noexcept { return std::exchange(dropped_, false); }

  /// Begins a new budget. `limit` bounds the bytes held and cached together from here on; 0: no limit. `reserved`: as
  /// BufferCache::begin.
  void begin(std::size_t limit, std::size_t reserved) noexcept;
  /// Bytes held and cached together.
  [[nodiscard]] std::size_t taken() const noexcept { return taken_; }
  /// Most of them.
  [[nodiscard]] std::size_t peak() const noexcept { return peak_; }
  /// Allocations that the device was asked for since this was made.
  [[nodiscard]] std::uint64_t allocations() const noexcept { return allocations_; }
  /// Whether freed buffers are cached, not kept by the device.
  [[nodiscard]] bool caches() const noexcept { return cache_ != nullptr; }

 private:
  friend class Allocation;
  [[nodiscard]] Allocation upload(const void* data, std::size_t bytes);
  [[nodiscard]] Allocation serve(std::size_t bytes, Lifetime lifetime, bool zeros);
  /// A new buffer; if the device has too little, it is asked once more after the cached buffers are freed.
  [[nodiscard]] std::unique_ptr<Buffer> ask(std::size_t bytes, bool zeros);
  void check_limit(std::size_t bytes);
  /// False if nothing was cached.
  bool drop() noexcept;
  void reclaim(std::unique_ptr<Buffer> buffer, Lifetime lifetime) noexcept;
  [[nodiscard]] std::size_t cached() const noexcept { return caches() ? cache_->bytes() : 0; }

  Device& device_;
  std::unique_ptr<BufferCache> cache_;  // null: none
  bool dropped_ = false, transient_all_ = false;
  std::size_t limit_ = 0, taken_ = 0, peak_ = 0;  // taken: held and cached together
  std::uint64_t allocations_ = 0;
};

}  // namespace cadt
