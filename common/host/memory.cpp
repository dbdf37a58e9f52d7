// SPDX-License-Identifier: Apache-2.0
#include "common/host/memory.hpp"

#include <algorithm>
#include <string>

namespace cadt {

void Allocation::release() noexcept {
  if (buffer_ != nullptr) memory_->held_ -= counted_;
  buffer_.reset();
  counted_ = 0;
}

void Memory::require(std::size_t bytes) const {
  const std::size_t needed = held_ + bytes;
  if (limit_ != 0 && needed > limit_) {
    throw OutOfMemory("this needs " + std::to_string(needed) + " bytes on the device and the limit is " +
                          std::to_string(limit_) + ": raise the limit or use fewer points",
                      needed, limit_);
  }
  const std::size_t memory = device_.info().memory_bytes;
  if (memory != 0 && needed > memory) {
    throw OutOfMemory("this needs " + std::to_string(needed) + " bytes and '" + device_.info().name + "' has " +
                          std::to_string(memory) + ": use fewer points or a device with more memory",
                      needed, memory);
  }
}

Allocation Memory::account(std::unique_ptr<Buffer> buffer) {
  const std::size_t bytes = buffer->bytes();
  held_ += bytes;
  peak_ = std::max(peak_, held_);
  return {*this, std::move(buffer), bytes};
}

Allocation Memory::allocate(std::size_t bytes) {
  bytes = std::max<std::size_t>(bytes, 4);  // OpenCL has no empty buffers
  require(bytes);
  return account(device_.allocate(bytes));
}

Allocation Memory::allocate_zeros(std::size_t bytes) {
  bytes = std::max<std::size_t>(bytes, 4);
  require(bytes);
  return account(device_.allocate_zeros(bytes));
}

Allocation Memory::import(const void* data, std::size_t bytes) {
  if (auto aliased = device_.alias(data, bytes)) return {*this, std::move(aliased), 0};
  Allocation copy = allocate(bytes);
  device_.write(*copy, 0, data, bytes);
  return copy;
}

Allocation Memory::export_to(void* data, std::size_t bytes) {
  if (auto aliased = device_.alias_output(data, bytes)) return {*this, std::move(aliased), 0};
  return {};
}

}  // namespace cadt
