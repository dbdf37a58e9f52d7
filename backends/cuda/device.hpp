// SPDX-License-Identifier: Apache-2.0
// A CUDA device: its memory pool, one stream, launches.
#pragma once

#include <cuda_runtime_api.h>

#include <memory>

#include "common/host/device.hpp"

namespace cadt::cuda {

/// \throws DeviceError, or OutOfMemory for cudaErrorMemoryAllocation, unless `code` is cudaSuccess
void check(cudaError_t code, const char* call, const std::string& device);

/// Makes a device current and restores the caller's choice.
class DeviceScope {
 public:
  explicit DeviceScope(int device) noexcept;
  ~DeviceScope();
  DeviceScope(const DeviceScope&) = delete;
  DeviceScope& operator=(const DeviceScope&) = delete;

 private:
  int before_ = -1;
};

/// A stream and the memory pool that its buffers come from. Lives as long as the last buffer.
class Stream {
 public:
  Stream(int device, const std::string& name);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  [[nodiscard]] cudaStream_t get() const noexcept { return stream_; }
  [[nodiscard]] cudaMemPool_t pool() const noexcept { return pool_; }
  [[nodiscard]] int device() const noexcept { return device_; }

 private:
  int device_;
  cudaStream_t stream_ = nullptr;
  cudaMemPool_t pool_ = nullptr;
};

class CudaDevice final : public Device {
 public:
  CudaDevice(DeviceInfo info, unsigned block_size);
  ~CudaDevice() override;

  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] LaunchShape shape() const noexcept override;
  [[nodiscard]] unsigned threads() const noexcept override { return info_.compute_units; }
  [[nodiscard]] std::unique_ptr<Buffer> allocate(std::size_t bytes) override;
  [[nodiscard]] std::unique_ptr<Buffer> alias(const void* data, std::size_t bytes) override;
  void write(Buffer& to, std::size_t offset, const void* from, std::size_t bytes) override;
  void read(const Buffer& from, std::size_t offset, void* to, std::size_t bytes) override;
  void fill(Buffer& to, std::size_t offset, std::size_t bytes, std::uint32_t word) override;
  void launch(KernelId kernel, std::uint32_t items, std::span<const Arg> args, bool wide) override;
  void finish() override;

 private:
  void check_call(cudaError_t code, const char* call) const { check(code, call, info_.name); }

  DeviceInfo info_;
  unsigned block_size_;
  std::shared_ptr<Stream> stream_;
};

}  // namespace cadt::cuda
