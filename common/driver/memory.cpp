// SPDX-License-Identifier: Apache-2.0
#include "common/driver/memory.hpp"

#include <algorithm>
#include <limits>
#include <string>

namespace cadt {

void Allocation::Reclaim::operator()(Buffer* buffer) const noexcept {
  std::unique_ptr<Buffer> owned(buffer);
  if (memory != nullptr) memory->reclaim(std::move(owned), lifetime);
}

void Memory::begin(std::size_t limit, std::size_t reserved) noexcept {
  limit_ = limit;
  if (caches()) cache_->begin(limit != 0, reserved);
  if (limit_ != 0 && taken_ > limit_) drop_cached();
  peak_ = taken_;
}

bool Memory::drop() noexcept {
  const std::size_t freed = caches() ? cache_->drop() : 0;
  if (freed == 0) return false;
  taken_ -= freed;
  return dropped_ = true;
}

void Memory::check_limit(std::size_t bytes) {
  if (limit_ == 0) return;
  if (taken_ + bytes > limit_) drop_cached();
  const std::size_t needed = taken_ - cached() + bytes;
  if (needed > limit_) {
    throw OutOfMemory("this needs " + std::to_string(needed) + " bytes on the device and the limit is " +
                          std::to_string(limit_) + ": raise the limit or use fewer points",
                      needed, limit_);
  }
}

bool Memory::allows(std::size_t bytes) {
  if (limit_ != 0) return taken_ - cached() + bytes <= limit_;
  return bytes <= device_.free_bytes() + cached();
}

void Memory::require(std::size_t bytes) {
  check_limit(bytes);
  const std::size_t available = device_.free_bytes() + cached();
  if (bytes > available) {
    throw OutOfMemory("this needs " + std::to_string(bytes) + " bytes and '" + device_.info().name + "' has " +
                          std::to_string(available) + " bytes free: use fewer points or a device with more memory",
                      bytes, available);
  }
}

std::unique_ptr<Buffer> Memory::ask(std::size_t bytes, bool zeros) {
  ++allocations_;
  const auto allocate = [&] { return zeros ? device_.allocate_zeros(bytes) : device_.allocate(bytes); };
  try {
    return allocate();
  } catch (const OutOfMemory&) {
    if (!drop()) throw;
  }
  return allocate();
}

Allocation Memory::serve(std::size_t bytes, Lifetime lifetime, bool zeros) {
  // Sizes are rounded up and added: those that nothing has must not wrap.
  if (bytes > std::numeric_limits<std::size_t>::max() / 2)
    throw OutOfMemory("this needs " + std::to_string(bytes) + " bytes, more than there are addresses", bytes, 0);
  if (transient_all_ && lifetime == Lifetime::kept) lifetime = Lifetime::transient;
  if (!pools(bytes)) lifetime = Lifetime::kept;
  if (auto buffer = caches() ? cache_->take(bytes, lifetime) : nullptr) {
    Allocation used_again(*this, std::move(buffer), lifetime);
    if (zeros) device_.fill(*used_again, 0, (bytes + 3) / 4 * 4, 0);
    return used_again;
  }
  const std::size_t size = caches() ? cache_->new_size(bytes, lifetime) : std::max<std::size_t>(bytes, 4);
  check_limit(size);
  auto buffer = ask(size, zeros);
  taken_ += buffer->bytes();
  peak_ = std::max(peak_, taken_);
  return {*this, std::move(buffer), lifetime};
}

void Memory::reclaim(std::unique_ptr<Buffer> buffer, Lifetime lifetime) noexcept {
  taken_ -= caches() ? cache_->put(std::move(buffer), lifetime) : buffer->bytes();
}

Allocation Memory::import(const void* data, std::size_t bytes) {
  if (auto aliased = device_.alias(data, bytes)) return Allocation(std::move(aliased));
  Allocation copy = transient(bytes, true);
  device_.write(*copy, 0, data, bytes);
  return copy;
}

Allocation Memory::upload(const void* data, std::size_t bytes) {
  Allocation copy = allocate(bytes);
  device_.write(*copy, 0, data, bytes);
  return copy;
}

}  // namespace cadt
