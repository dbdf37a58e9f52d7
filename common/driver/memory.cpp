// SPDX-License-Identifier: Apache-2.0
#include "common/driver/memory.hpp"

#include <algorithm>
#include <bit>
#include <new>
#include <string>

namespace cadt {
namespace {

/// Buffers below this are kept in sizes of powers of two, so that those of one call serve the next, whatever it has to
/// count. To make and to free one costs as much as two launches with OpenCL.
constexpr std::size_t small = 4096, smallest = 64;

/// Smaller buffers are not borrowed: what they take together is little, and to have kept them saves time.
constexpr std::size_t least_pooled = std::size_t{1} << 18;
/// Parts begin at multiples of this, or of what the device asks for.
constexpr std::size_t part_step = 4096;
/// What is lent is larger by as much as a few parts lose by that.
constexpr std::size_t pool_slack = 4 * part_step;

std::size_t kept_size(std::size_t bytes) noexcept {
  return bytes >= small ? bytes : std::bit_ceil(std::max(bytes, smallest));
}

}  // namespace

void Allocation::release() noexcept {
  if (buffer_ != nullptr) memory_->give_back(std::move(buffer_), counted_);
  buffer_.reset();
  counted_ = 0;
}

void Memory::check_limit(std::size_t bytes) {
  if (limit_ == 0) return;
  const std::size_t needed = held_ + bytes;
  if (needed + kept_bytes_ > limit_) drop_kept();
  if (needed > limit_) {
    throw OutOfMemory("this needs " + std::to_string(needed) + " bytes on the device and the limit is " +
                          std::to_string(limit_) + ": raise the limit or use fewer points",
                      needed, limit_);
  }
}

bool Memory::allows(std::size_t bytes) {
  if (limit_ != 0) return held_ + bytes <= limit_;
  return bytes <= device_.free_bytes() + kept_bytes_;
}

void Memory::require(std::size_t bytes) {
  check_limit(bytes);
  const std::size_t available = device_.free_bytes() + kept_bytes_;
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
  return keep_ ? kept_size(bytes) : std::max<std::size_t>(bytes, 4);  // OpenCL has no empty buffers
}

bool Memory::suits(std::size_t kept, std::size_t bytes) const noexcept {
  if (kept < bytes) return false;
  if (bytes < small) return kept == bytes;  // larger ones are waited for
  if (limit_ != 0) return kept == bytes;    // what is too large would count, and might be what is missing later
  return reserved_ || kept / 2 <= bytes;    // not so large that it would be missed
}

std::unique_ptr<Buffer> Memory::take_kept(std::size_t bytes) noexcept {
  // the smallest that is large enough
  auto best = kept_.end();
  for (auto it = kept_.begin(); it != kept_.end(); ++it)
    if (suits((*it)->bytes(), bytes) && (best == kept_.end() || (*it)->bytes() < (*best)->bytes())) best = it;
  if (best == kept_.end()) return nullptr;
  auto buffer = std::move(*best);
  kept_.erase(best);
  kept_bytes_ -= buffer->bytes();
  return buffer;
}

void Memory::keep(std::unique_ptr<Buffer> buffer) noexcept {
  const std::size_t bytes = buffer->bytes();
  try {
    kept_.push_back(std::move(buffer));
    kept_bytes_ += bytes;
  } catch (const std::bad_alloc&) {  // then it is freed
  }
}

void Memory::give_back(std::unique_ptr<Buffer> buffer, std::size_t counted) noexcept {
  if (give_back_part(buffer)) return;
  held_ -= counted;
  if (!keep_ || counted == 0) return;  // 0: the caller's
  if (std::erase(unpooled_, buffer.get()) != 0) return;
  keep(std::move(buffer));
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
  std::size_t pools = pools_.size(), idle = kept_.size();
  for (std::size_t i = 0; i < pools_.size(); ++i) {
    const Buffer& whole = *pools_[i].whole;
    if (pools_[i].room(bytes) < whole.bytes() && better(whole, best)) best = &whole, pools = i;
  }
  for (std::size_t i = 0; i < kept_.size(); ++i)  // what just fits will be asked for as a whole
    if (kept_[i]->bytes() / 5 * 4 >= bytes && better(*kept_[i], best)) best = kept_[i].get(), idle = i;
  if (best == nullptr) return nullptr;
  if (idle < kept_.size()) {
    pools = pools_.size();
    pools_.emplace_back().whole = std::move(kept_[idle]);
    kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(idle));
    pooled_bytes_ += best->bytes();
  }
  Pool* const pool = &pools_[pools];
  const std::size_t step = std::max(part_step, device_.part_alignment()), whole = pool->whole->bytes();
  const std::size_t begin = pool->room(bytes), end = std::min((begin + bytes + step - 1) / step * step, whole);
  std::unique_ptr<Buffer> part;
  try {
    pool->parts.reserve(pool->parts.size() + 1);
    part = device_.part(*pool->whole, begin, bytes);
  } catch (...) {
    keep_if_idle(*pool);
    throw;
  }
  const auto after = std::ranges::find_if(pool->parts, [&](const Pool::Part& p) { return p.begin >= end; });
  pool->parts.insert(after, {part.get(), begin, end});
  return part;
}

void Memory::keep_if_idle(Pool& pool) noexcept {
  if (!pool.parts.empty()) return;
  pooled_bytes_ -= pool.whole->bytes();
  kept_bytes_ -= pool.whole->bytes();
  keep(std::move(pool.whole));
  pools_.erase(pools_.begin() + (&pool - pools_.data()));
}

bool Memory::give_back_part(std::unique_ptr<Buffer>& buffer) noexcept {
  for (Pool& pool : pools_) {
    const auto part = std::ranges::find(pool.parts, buffer.get(), &Pool::Part::buffer);
    if (part == pool.parts.end()) continue;
    buffer.reset();
    pool.parts.erase(part);
    keep_if_idle(pool);
    return true;
  }
  return false;
}

/// Asks the device, and once more without the kept buffers if it has too little.
template <class Allocate>
std::unique_ptr<Buffer> Memory::ask(const Allocate& allocate) {
  ++allocations_;
  if (kept_.empty()) return allocate();
  try {
    return allocate();
  } catch (const OutOfMemory&) {
    drop_kept();
  }
  return allocate();
}

Allocation Memory::count_in(std::unique_ptr<Buffer> buffer) {
  const std::size_t bytes = buffer->bytes();
  held_ += bytes;
  peak_ = std::max(peak_, held_ + kept_bytes_);
  return {*this, std::move(buffer), bytes};
}

Allocation Memory::allocate(std::size_t bytes) {
  if (transient_all_ && pools(bytes)) return transient(bytes);
  bytes = requested(bytes);
  if (auto buffer = take_kept(bytes)) return count_in(std::move(buffer));
  check_limit(bytes);
  return count_in(ask([&] { return device_.allocate(bytes); }));
}

Allocation Memory::allocate_zeros(std::size_t bytes) {
  if (transient_all_ && pools(bytes)) return transient_zeros(bytes);
  bytes = requested(bytes);
  if (auto buffer = take_kept(bytes)) {
    device_.fill(*buffer, 0, (bytes + 3) / 4 * 4, 0);
    return count_in(std::move(buffer));
  }
  check_limit(bytes);
  return count_in(ask([&] { return device_.allocate_zeros(bytes); }));
}

bool Memory::pools(std::size_t bytes) const noexcept {
  return keep_ && limit_ == 0 && bytes >= least_pooled && device_.part_alignment() != 0;
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
  Allocation borrowed = transient(bytes);
  device_.fill(*borrowed, 0, bytes / 4 * 4, 0);
  return borrowed;
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
