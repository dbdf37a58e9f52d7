// SPDX-License-Identifier: Apache-2.0
#include "common/driver/backend.hpp"

#include <mutex>
#include <set>

#include "backends/cuda/device.hpp"
#include "common/self_test/self_test.hpp"

namespace cadt {
namespace {

constexpr int least_capability = 75;  // oldest compute capability that the kernels are compiled for

std::string version(int number) { return std::to_string(number / 1000) + "." + std::to_string(number % 1000 / 10); }

DeviceInfo describe(int index, int driver) {
  DeviceInfo info;
  info.backend = Backend::cuda;
  info.index = index;
  info.platform = "NVIDIA CUDA";
  info.driver = "CUDA " + version(driver);
  cudaDeviceProp properties{};
  if (const cudaError_t code = cudaGetDeviceProperties(&properties, index); code != cudaSuccess) {
    info.name = "device " + std::to_string(index);
    info.reason = std::string("its properties cannot be read: ") + cudaGetErrorString(code);
    cudaGetLastError();
    return info;
  }
  info.name = properties.name;
  info.memory_bytes = properties.totalGlobalMem;
  info.largest_buffer_bytes = properties.totalGlobalMem;
  info.compute_units = static_cast<unsigned>(properties.multiProcessorCount);
  info.fp64 = true;
  info.gpu = true;
  info.atomics = "CUDA, device scope";
  int watchdog = 0;
  cudaDeviceGetAttribute(&watchdog, cudaDevAttrKernelExecTimeout, index);
  info.watchdog = watchdog != 0;
  int pools = 0;
  cudaDeviceGetAttribute(&pools, cudaDevAttrMemoryPoolsSupported, index);
  if (properties.major * 10 + properties.minor < least_capability) {
    info.reason = "compute capability " + std::to_string(properties.major) + "." + std::to_string(properties.minor) +
                  " is below 7.5";
  } else if (pools == 0) {
    info.reason = "its driver has no memory pools";
  } else {
    info.usable = true;
  }
  return info;
}

class CudaEntry final : public BackendEntry {
 public:
  [[nodiscard]] Backend id() const noexcept override { return Backend::cuda; }

  [[nodiscard]] std::vector<DeviceInfo> devices() override {
    DeviceInfo none;
    none.backend = Backend::cuda;
    none.index = -1;
    int driver = 0, runtime = 0, count = 0;
    cudaDriverGetVersion(&driver);
    cudaRuntimeGetVersion(&runtime);
    if (driver == 0) {
      none.reason = "no CUDA driver is installed";
      cudaGetLastError();
      return {none};
    }
    if (const cudaError_t code = cudaGetDeviceCount(&count); code != cudaSuccess || count == 0) {
      none.reason = code == cudaErrorInsufficientDriver
                        ? "the driver knows CUDA " + version(driver) + " and the program needs " + version(runtime)
                        : (code == cudaSuccess ? std::string("no CUDA device") : std::string(cudaGetErrorString(code)));
      cudaGetLastError();
      return {none};
    }
    std::vector<DeviceInfo> all;
    for (int i = 0; i < count; ++i) all.push_back(describe(i, driver));
    return all;
  }

  [[nodiscard]] std::unique_ptr<Device> open(int index, const Options& options) override {
    int driver = 0;
    cudaDriverGetVersion(&driver);
    const DeviceInfo info = describe(index, driver);
    if (!info.usable) throw BackendUnavailable("cuda", "'" + info.name + "': " + info.reason);
    auto device = std::make_unique<cuda::CudaDevice>(info, options);
    // Once per context: its kernels and the device do not change.
    const std::lock_guard lock(mutex_);
    if (tested_.count(device->context()) == 0) {
      device->load_kernels();
      run_selftest(*device);
      run_lock_test(*device);
      tested_.insert(device->context());
    }
    return device;
  }

  [[nodiscard]] int device_of(void* queue) override { return cuda::device_of(static_cast<cudaStream_t>(queue)); }

  [[nodiscard]] int preferred_device() override {
    int device = -1;
    if (cudaGetDevice(&device) == cudaSuccess) return device;
    cudaGetLastError();
    return -1;
  }

 private:
  std::mutex mutex_;
  std::set<CUcontext> tested_;
};

}  // namespace

/// Never destroyed: destructors of the program may still call the library.
BackendEntry& cuda_backend() {
  static auto* const entry = new CudaEntry;
  return *entry;
}

}  // namespace cadt
