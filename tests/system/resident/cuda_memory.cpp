// SPDX-License-Identifier: Apache-2.0
#include "tests/system/resident/device_memory.hpp"

#ifdef CADT_HAVE_CUDA
#include <cuda_runtime_api.h>

#include <stdexcept>

namespace cadt::test {
namespace {

void check(cudaError_t code) {
  if (code != cudaSuccess) throw std::runtime_error(cudaGetErrorString(code));
}

class CudaMemory final : public DeviceMemory {
 public:
  explicit CudaMemory(int device) : device_(device) {
    check(cudaSetDevice(device_));
    check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking));
  }
  ~CudaMemory() override {
    cudaSetDevice(device_);
    cudaStreamSynchronize(stream_);
    free_uploads();
    cudaStreamDestroy(stream_);
  }
  [[nodiscard]] void* queue() const override { return stream_; }
  [[nodiscard]] void* allocate(std::size_t bytes) noexcept override {
    void* memory = nullptr;
    if (cudaMalloc(&memory, bytes) == cudaSuccess) return memory;
    cudaGetLastError();
    return nullptr;
  }
  void free(void* memory) noexcept override { cudaFree(memory); }
  void read(const void* memory, std::size_t offset, std::span<std::byte> to) override {
    copy(to.data(), static_cast<const std::byte*>(memory) + offset, to.size(), cudaMemcpyDeviceToHost);
  }
  void write(void* memory, std::size_t offset, std::span<const std::byte> from) override {
    copy(static_cast<std::byte*>(memory) + offset, from.data(), from.size(), cudaMemcpyHostToDevice);
  }
  void wait() override { check(cudaStreamSynchronize(stream_)); }

 private:
  void copy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
    check(cudaMemcpyAsync(to, from, bytes, kind, stream_));
    wait();
  }
  int device_;
  cudaStream_t stream_ = nullptr;
};

}  // namespace

std::unique_ptr<DeviceMemory> cuda_memory(int device) { return std::make_unique<CudaMemory>(device); }

}  // namespace cadt::test
#else
namespace cadt::test {
std::unique_ptr<DeviceMemory> cuda_memory(int /*device*/) { return nullptr; }
}  // namespace cadt::test
#endif
