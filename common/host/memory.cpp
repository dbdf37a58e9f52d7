// SPDX-License-Identifier: Apache-2.0
#include "common/host/memory.hpp"

#include <algorithm>
#include <bit>
#include <new>
#include <string>

namespace cadt {
namespace {

/// Buffers below this are kept in sizes of powers of two, so that those of one call serve the next, whatever it has to
/// count. To make and to free one costs as much as two launches with OpenCL.
constexpr std::size_t small = 4096, smallest = 64;

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

void Memory::give_back(std::unique_ptr<Buffer> buffer, std::size_t counted) noexcept {
  held_ -= counted;
  if (!keep_ || counted == 0) return;  // 0: the caller's
  try {
    kept_.push_back(std::move(buffer));
    kept_bytes_ += counted;
  } catch (const std::bad_alloc&) {  // then it is freed
  }
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

Allocation Memory::account(std::unique_ptr<Buffer> buffer) {
  const std::size_t bytes = buffer->bytes();
  held_ += bytes;
  peak_ = std::max(peak_, held_ + kept_bytes_);
  return {*this, std::move(buffer), bytes};
}

Allocation Memory::allocate(std::size_t bytes) {
  bytes = requested(bytes);
  if (auto buffer = take_kept(bytes)) return account(std::move(buffer));
  check_limit(bytes);
  return account(ask([&] { return device_.allocate(bytes); }));
}

Allocation Memory::allocate_zeros(std::size_t bytes) {
  bytes = requested(bytes);
  if (auto buffer = take_kept(bytes)) {
    device_.fill(*buffer, 0, (bytes + 3) / 4 * 4, 0);
    return account(std::move(buffer));
  }
  check_limit(bytes);
  return account(ask([&] { return device_.allocate_zeros(bytes); }));
}

Allocation Memory::import(const void* data, std::size_t bytes) {
  if (auto aliased = device_.alias(data, bytes)) return {*this, std::move(aliased), 0};
  Allocation copy = allocate(bytes);
  device_.write(*copy, 0, data, bytes);
  return copy;
}

Allocation Memory::wrap(void* handle, std::size_t bytes) { return {*this, device_.wrap(handle, bytes), 0}; }

Allocation Memory::export_to(void* data, std::size_t bytes) {
  if (auto aliased = device_.alias_output(data, bytes)) return {*this, std::move(aliased), 0};
  return {};
}

}  // namespace cadt
