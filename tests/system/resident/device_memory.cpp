// SPDX-License-Identifier: Apache-2.0
#include "tests/system/resident/device_memory.hpp"

#include <cstring>
#include <new>

namespace cadt::test {
namespace {

class HostMemory final : public DeviceMemory {
 public:
  ~HostMemory() override { free_uploads(); }
  [[nodiscard]] void* queue() const override { return nullptr; }
  [[nodiscard]] void* allocate(std::size_t bytes) noexcept override {
    return ::operator new(bytes, alignment, std::nothrow);  // std::aligned_alloc() is not everywhere
  }
  void free(void* memory) noexcept override { ::operator delete(memory, alignment); }
  void read(const void* memory, std::size_t offset, std::span<std::byte> to) override {
    std::memcpy(to.data(), static_cast<const std::byte*>(memory) + offset, to.size());
  }
  void write(void* memory, std::size_t offset, std::span<const std::byte> from) override {
    std::memcpy(static_cast<std::byte*>(memory) + offset, from.data(), from.size());
  }
  void wait() override {}

 private:
  static constexpr std::align_val_t alignment{256};
};

}  // namespace

void* DeviceMemory::upload(std::span<const std::byte> data) {
  uploads_.push_back(nullptr);
  void* memory = allocate(data.size());
  if (memory == nullptr) throw std::bad_alloc();
  uploads_.back() = memory;
  write(memory, 0, data);
  return memory;
}

void DeviceMemory::free_uploads() noexcept {
  for (void* memory : uploads_)
    if (memory != nullptr) free(memory);
  uploads_.clear();
}

std::unique_ptr<DeviceMemory> host_memory() { return std::make_unique<HostMemory>(); }

std::unique_ptr<DeviceMemory> device_memory(Backend backend, int device) {
  switch (backend) {
    case Backend::host:
      return host_memory();
    case Backend::opencl:
      return opencl_memory(device);
    case Backend::cuda:
      return cuda_memory(device);
    case Backend::automatic:
      break;
  }
  return nullptr;
}

}  // namespace cadt::test
