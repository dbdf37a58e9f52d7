// SPDX-License-Identifier: Apache-2.0
#include "tests/gpu/device_memory.hpp"

#ifdef CADT_HAVE_CUDA
#include <cuda_runtime_api.h>

#include <stdexcept>
#include <vector>

namespace cadt::test {
namespace {

void check(cudaError_t code) {
  if (code != cudaSuccess) throw std::runtime_error(cudaGetErrorString(code));
}

class CudaMemory final : public DeviceMemory {
 public:
  explicit CudaMemory(int device) {
    check(cudaSetDevice(device));
    check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking));
  }
  ~CudaMemory() override {
    for (void* memory : memory_) cudaFree(memory);
    cudaStreamDestroy(stream_);
  }
  [[nodiscard]] void* queue() const override { return stream_; }
  [[nodiscard]] void* upload(std::span<const std::byte> data) override {
    void* memory = nullptr;
    check(cudaMalloc(&memory, data.size()));
    memory_.push_back(memory);
    check(cudaMemcpy(memory, data.data(), data.size(), cudaMemcpyHostToDevice));
    return memory;
  }
  void wait() override { check(cudaStreamSynchronize(stream_)); }

 private:
  cudaStream_t stream_ = nullptr;
  std::vector<void*> memory_;
};

}  // namespace

std::unique_ptr<DeviceMemory> cuda_memory(int device) { return std::make_unique<CudaMemory>(device); }

}  // namespace cadt::test
#else
namespace cadt::test {
std::unique_ptr<DeviceMemory> cuda_memory(int /*device*/) { return nullptr; }
}  // namespace cadt::test
#endif
