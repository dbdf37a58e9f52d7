// SPDX-License-Identifier: Apache-2.0
// OpenCL has no memory pool, but sub-buffers. Short steps use parts of a cached buffer that a later step takes as a
// whole, so both together need no more than the larger.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/driver/buffer_cache.hpp"

namespace cadt::opencl {

/// Pools large requests, unless the memory is bounded. Transient memory is a part of a cached buffer (Buffer::part). If
/// none has room, it is a buffer of its own, which is not cached.
class BufferPool final : public BufferCache {
 public:
  /// Alignment of the offsets of sub-buffers, and the device's largest buffer (0: not known).
  BufferPool(std::size_t alignment, std::uint64_t largest_buffer) noexcept;

  [[nodiscard]] bool pools(std::size_t bytes) const noexcept override;
  [[nodiscard]] std::size_t new_size(std::size_t bytes, Lifetime lifetime) const noexcept override;
  [[nodiscard]] std::unique_ptr<Buffer> take(std::size_t bytes, Lifetime lifetime) override;
  std::size_t put(std::unique_ptr<Buffer> buffer, Lifetime lifetime) noexcept override;
  [[nodiscard]] std::size_t bytes() const noexcept override { return BufferCache::bytes() + parted_bytes_; }

 private:
  struct Part {
    const Buffer* buffer;
    std::size_t begin, end;
  };
  /// A buffer of which parts are in use.
  struct Parted {
    std::unique_ptr<Buffer> whole;
    std::vector<Part> parts;  ///< ascending
  };
  /// Offset of the first gap of so many bytes; the size of the buffer if there is none.
  [[nodiscard]] static std::size_t room(const Parted& from, std::size_t bytes) noexcept;
  [[nodiscard]] std::unique_ptr<Buffer> take_part(std::size_t bytes, bool ends_first);

  std::size_t step_;
  std::uint64_t largest_buffer_;
  std::size_t parted_bytes_ = 0;
  std::vector<Parted> parted_;
};

}  // namespace cadt::opencl
