// SPDX-License-Identifier: Apache-2.0
#include "common/driver/memory.hpp"

#include <algorithm>
#include <bit>
#include <new>
#include <string>

namespace cadt {
namespace {

/// Buffers below this are cached in sizes of powers of two, so that those of one call serve the next, whatever its
/// size. Allocating and freeing one costs as much as two launches with OpenCL.
constexpr std::size_t small = 4096, smallest = 64;

/// Smaller buffers are not pooled: all of them take little memory, and caching them saves time.
constexpr std::size_t least_pooled = std::size_t{1} << 18;
/// Parts begin at multiples of this, or of what the device asks for.
constexpr std::size_t part_step = 4096;
/// Pooled buffers are larger by what this alignment costs a few parts.
constexpr std::size_t pool_slack = 4 * part_step;

std::size_t cached_size(std::size_t bytes) noexcept {
  return bytes >= small ? bytes : std::bit_ceil(std::max(bytes, smallest));
}

}  // namespace

void Allocation::release() noexcept {
  if (buffer_ != nullptr) memory_->reclaim(std::move(buffer_), counted_);
  buffer_.reset();
  counted_ = 0;
}

void Memory::check_limit(std::size_t bytes) {
  if (limit_ == 0) return;
  const std::size_t needed = held_ + bytes;
  if (needed + cached_bytes_ > limit_) drop_cached();
  if (needed > limit_) {
    throw OutOfMemory("this needs " + std::to_string(needed) + " bytes on the device and the limit is " +
                          std::to_string(limit_) + ": raise the limit or use fewer points",
                      needed, limit_);
  }
}

bool Memory::allows(std::size_t bytes) {
  if (limit_ != 0) return held_ + bytes <= limit_;
  return bytes <= device_.free_bytes() + cached_bytes_;
}

void Memory::require(std::size_t bytes) {
  check_limit(bytes);
  const std::size_t available = device_.free_bytes() + cached_bytes_;
  if (bytes > available) {
    throw OutOfMemory("this needs " + std::to_string(bytes) + " bytes and '" + device_.info().name + "' has " +
                          std::to_string(available) + " bytes free: use fewer points or a device with more memory",
                      bytes, available);
  }
}

std::size_t Memory::requested(std::size_t bytes) const noexcept {
  if (pools(bytes)) {
    const std::uint64_t largest = device_.info().largest_buffer_bytes;  // 0: not known
    const std::size_t more = bytes + pool_slack;
    return largest == 0 || more <= largest ? more : std::max(bytes, static_cast<std::size_t>(largest));
  }
  return caches_ ? cached_size(bytes) : std::max<std::size_t>(bytes, 4);  // OpenCL has no empty buffers
}

bool Memory::suits(std::size_t available, std::size_t bytes) const noexcept {
  if (available < bytes) return false;
  if (bytes < small) return available == bytes;  // larger buffers are for larger requests
  if (limit_ != 0) return available == bytes;    // the excess would count, and may be what is missing later
  return reserved_ || available / 2 <= bytes;    // not so large that it would be missed
}

std::unique_ptr<Buffer> Memory::take_cached(std::size_t bytes) noexcept {
  // the smallest that is large enough
  auto best = cached_.end();
  for (auto it = cached_.begin(); it != cached_.end(); ++it)
    if (suits((*it)->bytes(), bytes) && (best == cached_.end() || (*it)->bytes() < (*best)->bytes())) best = it;
  if (best == cached_.end()) return nullptr;
  auto buffer = std::move(*best);
  cached_.erase(best);
  cached_bytes_ -= buffer->bytes();
  return buffer;
}

void Memory::cache(std::unique_ptr<Buffer> buffer) noexcept {
  const std::size_t bytes = buffer->bytes();
  try {
    cached_.push_back(std::move(buffer));
    cached_bytes_ += bytes;
  } catch (const std::bad_alloc&) {  // then it is freed
  }
}

void Memory::reclaim(std::unique_ptr<Buffer> buffer, std::size_t counted) noexcept {
  if (reclaim_part(buffer)) return;
  held_ -= counted;
  if (!caches_ || counted == 0) return;  // 0: the caller's
  if (std::erase(unpooled_, buffer.get()) != 0) return;
  cache(std::move(buffer));
}

std::size_t Memory::Pool::room(std::size_t bytes) const noexcept {
  std::size_t at = 0;
  for (const Part& part : parts) {
    if (part.begin - at >= bytes) return at;
    at = part.end;
  }
  return whole->bytes() - at >= bytes ? at : whole->bytes();
}

std::unique_ptr<Buffer> Memory::take_part(std::size_t bytes, bool ends_first) {
  const auto better = [&](const Buffer& one, const Buffer* best) {
    return best == nullptr || (ends_first ? one.bytes() > best->bytes() : one.bytes() < best->bytes());
  };
  const Buffer* best = nullptr;
  std::size_t best_pool = pools_.size(), idle = cached_.size();
  for (std::size_t i = 0; i < pools_.size(); ++i) {
    const Buffer& whole = *pools_[i].whole;
    if (pools_[i].room(bytes) < whole.bytes() && better(whole, best)) best = &whole, best_pool = i;
  }
  for (std::size_t i = 0; i < cached_.size(); ++i)  // a buffer that just fits will be asked for as a whole
    if (cached_[i]->bytes() / 5 * 4 >= bytes && better(*cached_[i], best)) best = cached_[i].get(), idle = i;
  if (best == nullptr) return nullptr;
  if (idle < cached_.size()) {
    best_pool = pools_.size();
    pools_.emplace_back().whole = std::move(cached_[idle]);
    cached_.erase(cached_.begin() + static_cast<std::ptrdiff_t>(idle));
    pooled_bytes_ += best->bytes();
  }
  Pool* const pool = &pools_[best_pool];
  const std::size_t step = std::max(part_step, device_.part_alignment()), whole = pool->whole->bytes();
  const std::size_t begin = pool->room(bytes), end = std::min((begin + bytes + step - 1) / step * step, whole);
  std::unique_ptr<Buffer> part;
  try {
    pool->parts.reserve(pool->parts.size() + 1);
    part = device_.part(*pool->whole, begin, bytes);
  } catch (...) {
    cache_if_idle(*pool);
    throw;
  }
  const auto after = std::ranges::find_if(pool->parts, [&](const Pool::Part& p) { return p.begin >= end; });
  pool->parts.insert(after, {part.get(), begin, end});
  return part;
}

void Memory::cache_if_idle(Pool& pool) noexcept {
  if (!pool.parts.empty()) return;
  pooled_bytes_ -= pool.whole->bytes();
  cached_bytes_ -= pool.whole->bytes();
  cache(std::move(pool.whole));
  pools_.erase(pools_.begin() + (&pool - pools_.data()));
}

bool Memory::reclaim_part(std::unique_ptr<Buffer>& buffer) noexcept {
  for (Pool& pool : pools_) {
    const auto part = std::ranges::find(pool.parts, buffer.get(), &Pool::Part::buffer);
    if (part == pool.parts.end()) continue;
    buffer.reset();
    pool.parts.erase(part);
    cache_if_idle(pool);
    return true;
  }
  return false;
}

/// Asks the device; if it has too little, once more after the cached buffers are freed.
template <class Allocate>
std::unique_ptr<Buffer> Memory::ask(const Allocate& allocate) {
  ++allocations_;
  if (cached_.empty()) return allocate();
  try {
    return allocate();
  } catch (const OutOfMemory&) {
    drop_cached();
  }
  return allocate();
}

Allocation Memory::count_in(std::unique_ptr<Buffer> buffer) {
  const std::size_t bytes = buffer->bytes();
  held_ += bytes;
  peak_ = std::max(peak_, held_ + cached_bytes_);
  return {*this, std::move(buffer), bytes};
}

Allocation Memory::allocate(std::size_t bytes) {
  if (transient_all_ && pools(bytes)) return transient(bytes);
  bytes = requested(bytes);
  if (auto buffer = take_cached(bytes)) return count_in(std::move(buffer));
  check_limit(bytes);
  return count_in(ask([&] { return device_.allocate(bytes); }));
}

Allocation Memory::allocate_zeros(std::size_t bytes) {
  if (transient_all_ && pools(bytes)) return transient_zeros(bytes);
  bytes = requested(bytes);
  if (auto buffer = take_cached(bytes)) {
    device_.fill(*buffer, 0, (bytes + 3) / 4 * 4, 0);
    return count_in(std::move(buffer));
  }
  check_limit(bytes);
  return count_in(ask([&] { return device_.allocate_zeros(bytes); }));
}

bool Memory::pools(std::size_t bytes) const noexcept {
  return caches_ && limit_ == 0 && bytes >= least_pooled && device_.part_alignment() != 0;
}

Allocation Memory::transient(std::size_t bytes, bool ends_first) {
  if (!pools(bytes)) return allocate(bytes);
  if (auto part = take_part(bytes, ends_first)) return {*this, std::move(part), 0};
  return allocate_unpooled(bytes);
}

Allocation Memory::allocate_unpooled(std::size_t bytes) {
  if (!pools(bytes)) return allocate(bytes);
  unpooled_.reserve(unpooled_.size() + 1);
  auto buffer = ask([&] { return device_.allocate(bytes); });
  unpooled_.push_back(buffer.get());
  return count_in(std::move(buffer));
}

Allocation Memory::transient_zeros(std::size_t bytes) {
  if (!pools(bytes)) return allocate_zeros(bytes);
  Allocation zeros = transient(bytes);
  device_.fill(*zeros, 0, bytes / 4 * 4, 0);
  return zeros;
}

Allocation Memory::import(const void* data, std::size_t bytes) {
  if (auto aliased = device_.alias(data, bytes)) return {*this, std::move(aliased), 0};
  Allocation copy = transient(bytes, true);
  device_.write(*copy, 0, data, bytes);
  return copy;
}

Allocation Memory::wrap(void* handle, std::size_t bytes) { return {*this, device_.wrap(handle, bytes), 0}; }

Allocation Memory::export_to(void* data, std::size_t bytes) {
  if (auto aliased = device_.alias_output(data, bytes)) return {*this, std::move(aliased), 0};
  return {};
}

}  // namespace cadt
