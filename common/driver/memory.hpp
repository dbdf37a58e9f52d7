// SPDX-License-Identifier: Apache-2.0
// Device memory of one triangulator as it is taken: counted, bounded, and cached for the next call. What a call will
// take is planned before (memory_plan.hpp).
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/driver/device.hpp"

namespace cadt {

class Memory;

/// A buffer that returns its bytes to the budget when it is destroyed. Null after a move.
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

/// The budget and the cache of freed buffers. Outlives its allocations.
class Memory {
 public:
  /// `cache`: freed buffers are cached for the next call, unless the device does that itself.
  Memory(Device& device, bool cache) noexcept : device_(device), caches_(cache && !device.keeps_memory()) {}
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  /// \throws OutOfMemory if the limit or the device does not allow it
  [[nodiscard]] Allocation allocate(std::size_t bytes);
  /// The same, filled with zeros.
  [[nodiscard]] Allocation allocate_zeros(std::size_t bytes);
  /// Transient memory of a few steps: a part of a cached buffer that a later step takes as a whole, so that both
  /// together need no more than the larger. If no cached buffer has room, a buffer of its own, which is not cached.
  /// Not for what may become part of a result, nor for what is still held when the next step allocates its large
  /// buffers. `ends_first`: released before all other transient memory of now, so it is a part of the largest cached
  /// buffer; else of the smallest with room. \throws OutOfMemory as allocate
  [[nodiscard]] Allocation transient(std::size_t bytes, bool ends_first = false);
  /// A buffer that is not cached where buffers are pooled, for what would be in the way as a part of one.
  /// \throws OutOfMemory as allocate
  [[nodiscard]] Allocation allocate_unpooled(std::size_t bytes);
  /// As transient, filled with zeros.
  [[nodiscard]] Allocation transient_zeros(std::size_t bytes);
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
  [[nodiscard]] bool pools(std::size_t bytes) const noexcept;
  /// The caller's data: aliased if the device can, else copied.
  [[nodiscard]] Allocation import(const void* data, std::size_t bytes);
  /// The caller's device memory.
  [[nodiscard]] Allocation wrap(void* handle, std::size_t bytes);
  /// The caller's memory, for kernels to write to, if the device can; else null.
  [[nodiscard]] Allocation export_to(void* data, std::size_t bytes);
  /// Whether `bytes` more are within the limit or, without a limit, within what the device has free.
  [[nodiscard]] bool allows(std::size_t bytes);
  /// \throws OutOfMemory if `bytes` more would pass the limit or what the device has free
  void require(std::size_t bytes);
  /// Frees all cached buffers but those of which parts are in use.
  void drop_cached() noexcept {
    cached_.clear();
    cached_bytes_ = pooled_bytes_;
    dropped_ = true;
  }
  /// Whether cached buffers were dropped since the last call of this function.
  [[nodiscard]] bool dropped() noexcept { return std::exchange(dropped_, false); }

  /// Begins a new budget. `limit` bounds the bytes held and cached together from here on; 0: no limit. `reserved`: the
  /// cached buffers were reserved for a call like this one, so any that is large enough may be taken.
  void begin(std::size_t limit, bool reserved) noexcept {
    limit_ = limit;
    reserved_ = reserved;
    if (limit_ != 0 && held_ + cached_bytes_ > limit_) drop_cached();
    peak_ = held_ + cached_bytes_;
  }
  /// Most bytes held and cached together.
  [[nodiscard]] std::size_t peak() const noexcept { return peak_; }
  /// Allocations that the device was asked for since this was made.
  [[nodiscard]] std::uint64_t allocations() const noexcept { return allocations_; }
  /// Whether freed buffers are cached here, not by the device.
  [[nodiscard]] bool caches() const noexcept { return caches_; }

 private:
  friend class Allocation;
  /// A cached buffer of which parts are in use.
  struct Pool {
    struct Part {
      const Buffer* buffer;
      std::size_t begin, end;
    };
    std::unique_ptr<Buffer> whole;
    std::vector<Part> parts;  ///< ascending
    /// Offset of the first gap of so many bytes; the size of the buffer if there is none.
    [[nodiscard]] std::size_t room(std::size_t bytes) const noexcept;
  };
  [[nodiscard]] Allocation count_in(std::unique_ptr<Buffer> buffer);
  /// Bytes of the buffer that serves a request.
  [[nodiscard]] std::size_t requested(std::size_t bytes) const noexcept;
  /// Whether a cached buffer of `available` bytes may serve a request.
  [[nodiscard]] bool suits(std::size_t available, std::size_t bytes) const noexcept;
  [[nodiscard]] std::unique_ptr<Buffer> take_cached(std::size_t bytes) noexcept;
  /// Null if no cached buffer has room.
  [[nodiscard]] std::unique_ptr<Buffer> take_part(std::size_t bytes, bool ends_first);
  /// False if it is not a part of a pool.
  bool reclaim_part(std::unique_ptr<Buffer>& buffer) noexcept;
  void cache_if_idle(Pool& pool) noexcept;
  void cache(std::unique_ptr<Buffer> buffer) noexcept;
  void reclaim(std::unique_ptr<Buffer> buffer, std::size_t counted) noexcept;
  void check_limit(std::size_t bytes);
  template <class Allocate>
  [[nodiscard]] std::unique_ptr<Buffer> ask(const Allocate& allocate);

  Device& device_;
  bool caches_, reserved_ = false, dropped_ = false, transient_all_ = false;
  std::size_t limit_ = 0, held_ = 0, peak_ = 0;
  std::size_t cached_bytes_ = 0, pooled_bytes_ = 0;  // of whole buffers; those of pools are among both
  std::uint64_t allocations_ = 0;
  std::vector<std::unique_ptr<Buffer>> cached_;
  std::vector<Pool> pools_;
  std::vector<const Buffer*> unpooled_;  // transient, with memory of their own
};

}  // namespace cadt
