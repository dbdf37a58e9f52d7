// SPDX-License-Identifier: Apache-2.0
// Freed buffers of a triangulator that wait for a later request. A device makes the cache that suits it
// (Device::make_cache): this one, one that also pools, or none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/driver/device.hpp"

namespace cadt {

/// How long memory is needed. All of it is `kept` where a cache does not pool a request.
enum class Lifetime : std::uint8_t {
  kept,        ///< it may become part of a result, or is held when the next step allocates its large buffers
  transient,   ///< of a few steps: it may be a part of a cached buffer that a later step takes as a whole
  ends_first,  ///< transient, and released before all other transient memory of now
  unpooled     ///< of a few steps, and in the way as a part of a cached buffer
};

/// Never asks for memory: Memory does, and the bytes here are part of its budget.
class BufferCache {
 public:
  BufferCache() = default;
  virtual ~BufferCache() = default;
  BufferCache(const BufferCache&) = delete;
  BufferCache& operator=(const BufferCache&) = delete;

  /// Begins a call. `bounded`: the bytes here count against a limit of the caller's. `reserved`: if not 0, buffers of
  /// so many bytes and more were reserved for a call like this one, so any that is large enough may be taken.
  void begin(bool bounded, std::size_t reserved) noexcept {
    bounded_ = bounded;
    any_serves_ = reserved != 0 && !pools(reserved);  // pooled buffers are few; each serves requests of its own size
  }
  /// Whether requests of so many bytes are pooled.
  [[nodiscard]] virtual bool pools(std::size_t /*bytes*/) const noexcept { return false; }
  /// Bytes of the new buffer for a request that take() does not serve.
  [[nodiscard]] virtual std::size_t new_size(std::size_t bytes, Lifetime lifetime) const noexcept;
  /// A cached buffer or a part of one, null if there is none. A part takes no bytes: they stay here.
  [[nodiscard]] virtual std::unique_ptr<Buffer> take(std::size_t bytes, Lifetime lifetime);
  /// Takes a buffer that was taken here or is new, with the lifetime of its request. Returns the bytes that it frees.
  virtual std::size_t put(std::unique_ptr<Buffer> buffer, Lifetime lifetime) noexcept;
  /// Frees all buffers but those of which parts are in use. Returns their bytes.
  std::size_t drop() noexcept;
  /// Bytes of all buffers here, with those of which parts are in use.
  [[nodiscard]] virtual std::size_t bytes() const noexcept { return bytes_; }

 protected:
  [[nodiscard]] bool bounded() const noexcept { return bounded_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Buffer>>& idle() const noexcept { return idle_; }
  [[nodiscard]] std::unique_ptr<Buffer> take_idle(std::size_t place) noexcept;

 private:
  /// Whether a buffer of `available` bytes may serve a request.
  [[nodiscard]] bool suits(std::size_t available, std::size_t bytes) const noexcept;

  bool bounded_ = false, any_serves_ = false;
  std::size_t bytes_ = 0;  // of idle_
  std::vector<std::unique_ptr<Buffer>> idle_;
};

}  // namespace cadt
