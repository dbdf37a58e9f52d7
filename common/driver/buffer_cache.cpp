// SPDX-License-Identifier: Apache-2.0
#include "common/driver/buffer_cache.hpp"

#include <algorithm>
#include <bit>
#include <new>
#include <utility>

namespace cadt {
namespace {

/// Buffers below this are cached in sizes of powers of two, so that those of one call serve the next, whatever its
/// size. Allocating and freeing one costs as much as two launches with OpenCL.
constexpr std::size_t small_buffer = 4096, smallest_buffer = 64;

}  // namespace

std::unique_ptr<BufferCache> Device::make_cache() { return std::make_unique<BufferCache>(); }

std::size_t BufferCache::new_size(std::size_t bytes, Lifetime /*lifetime*/) const noexcept {
  return bytes >= small_buffer ? bytes : std::bit_ceil(std::max(bytes, smallest_buffer));
}

bool BufferCache::suits(std::size_t available, std::size_t bytes) const noexcept {
  if (available < bytes) return false;
  if (bytes < small_buffer) return available == bytes;  // larger buffers are for larger requests
  if (bounded_) return available == bytes;              // the excess would count, and may be what is missing later
  return any_serves_ || available / 2 <= bytes;         // not so large that it would be missed
}

std::unique_ptr<Buffer> BufferCache::take(std::size_t bytes, Lifetime lifetime) {
  bytes = new_size(bytes, lifetime);
  std::size_t best = idle_.size();                // the smallest that is large enough
  for (std::size_t i = idle_.size(); i-- > 0;) {  // backwards: what was used last may still be in the processor's cache
    const std::size_t available = idle_[i]->bytes();
    if (available == bytes) return take_idle(i);
    if (suits(available, bytes) && (best == idle_.size() || available < idle_[best]->bytes())) best = i;
  }
  return best < idle_.size() ? take_idle(best) : nullptr;
}

std::unique_ptr<Buffer> BufferCache::take_idle(std::size_t place) noexcept {
  auto buffer = std::exchange(idle_[place], nullptr);
  std::swap(idle_[place], idle_.back());
  idle_.pop_back();
  bytes_ -= buffer->bytes();
  return buffer;
}

std::size_t BufferCache::put(std::unique_ptr<Buffer> buffer, Lifetime /*lifetime*/) noexcept {
  const std::size_t bytes = buffer->bytes();
  try {
    idle_.push_back(std::move(buffer));
  } catch (const std::bad_alloc&) {
    return bytes;
  }
  bytes_ += bytes;
  return 0;
}

std::size_t BufferCache::drop() noexcept {
  std::size_t freed = 0;
  for (const auto& buffer : idle_) freed += buffer->bytes();
  idle_.clear();
  bytes_ -= freed;
  return freed;
}

}  // namespace cadt
