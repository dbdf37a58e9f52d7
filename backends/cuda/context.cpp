// SPDX-License-Identifier: Apache-2.0
#include "backends/cuda/context.hpp"

#include <cadt/errors.hpp>

#include <algorithm>
#include <limits>
#include <thread>
#include <utility>

namespace cadt::cuda {
namespace {

/// Driver functions that have no equivalent in the runtime. They are obtained through the runtime, so that the program
/// starts without a driver.
struct Driver {
  CUresult (*get_current)(CUcontext*) = nullptr;
  CUresult (*push)(CUcontext) = nullptr;
  CUresult (*pop)(CUcontext*) = nullptr;
  CUresult (*set_current)(CUcontext) = nullptr;
  CUresult (*device)(CUdevice*) = nullptr;
  CUresult (*stream_context)(CUstream, CUcontext*) = nullptr;
  CUresult (*fill)(CUdeviceptr, unsigned, std::size_t, CUstream) = nullptr;
  bool complete = false;

  Driver() {
    complete = find("cuCtxGetCurrent", get_current) && find("cuCtxPushCurrent", push) && find("cuCtxPopCurrent", pop) &&
               find("cuCtxSetCurrent", set_current) && find("cuCtxGetDevice", device) &&
               find("cuStreamGetCtx", stream_context) && find("cuMemsetD32Async", fill);
  }

 private:
  template <class Function>
  static bool find(const char* name, Function& function) {
    void* address = nullptr;
    cudaDriverEntryPointQueryResult found{};
#if CUDART_VERSION >= 12050
    constexpr unsigned version = 12000;  // the functions above have not changed since 4.0 or 9.2
    const cudaError_t code = cudaGetDriverEntryPointByVersion(name, &address, version, cudaEnableDefault, &found);
#else
    const cudaError_t code = cudaGetDriverEntryPoint(name, &address, cudaEnableDefault, &found);
#endif
    if (code != cudaSuccess || found != cudaDriverEntryPointSuccess || address == nullptr) {
      cudaGetLastError();
      return false;
    }
    function = reinterpret_cast<Function>(address);
    return true;
  }
};

const Driver& driver() {
  static const Driver found;
  return found;
}

void check_driver(CUresult code, const char* call, const std::string& device) {
  if (code != CUDA_SUCCESS) throw DeviceError(call, static_cast<int>(code), device, "error of the CUDA driver");
}

/// The device's primary context, created by the runtime if there is none yet. On a thread of its own, since
/// cudaSetDevice changes the current device of the calling thread, which cannot be undone where no context was current.
cudaError_t primary_context(int device, CUcontext& context) {
  cudaError_t code = cudaSuccess;
  std::thread([&] {
    code = cudaSetDevice(device);
    if (code == cudaSuccess && driver().get_current(&context) != CUDA_SUCCESS) code = cudaErrorDeviceUninitialized;
  }).join();
  return code;
}

}  // namespace

void check(cudaError_t code, const char* call, const std::string& device) {
  if (code == cudaSuccess) return;
  cudaGetLastError();  // clears the error: the next call starts clean
  throw DeviceError(call, static_cast<int>(code), device,
                    std::string(cudaGetErrorName(code)) + ", " + cudaGetErrorString(code));
}

void ignore(cudaError_t code) noexcept {
  if (code != cudaSuccess) cudaGetLastError();
}

ContextScope::ContextScope(CUcontext context) noexcept : pushed_(driver().push(context) == CUDA_SUCCESS) {}
ContextScope::~ContextScope() {
  CUcontext popped = nullptr;
  if (pushed_) driver().pop(&popped);
}

CUcontext context_of(cudaStream_t stream) {
  CUcontext context = nullptr;
  std::optional<ContextScope> scope;
  if (driver().get_current(&context) != CUDA_SUCCESS || context == nullptr) {
    // If the runtime has not been used on this thread yet, its first use would make the primary context current.
    int device = 0;
    if (const cudaError_t code = cudaGetDevice(&device); code != cudaSuccess) {
      ignore(code);
      return nullptr;
    }
    if (primary_context(device, context) != cudaSuccess) return nullptr;
    scope.emplace(context);
  }
  return driver().stream_context(stream, &context) == CUDA_SUCCESS ? context : nullptr;
}

int device_of(cudaStream_t stream) {
  if (!driver().complete) return -1;
  CUcontext const context = context_of(stream);
  if (context == nullptr) return -1;
  const ContextScope scope(context);
  CUdevice device = -1;
  return driver().device(&device) == CUDA_SUCCESS ? static_cast<int>(device) : -1;
}

Stream::Stream(int device, std::string name, std::optional<void*> queue, std::shared_ptr<DeviceAllocator> allocator)
    : name_(std::move(name)), allocator_(std::move(allocator)) {
  if (!driver().complete) throw BackendUnavailable("cuda", "the driver lacks functions of CUDA 12");
  if (queue) {
    stream_ = static_cast<cudaStream_t>(*queue);
    context_ = context_of(stream_);
    if (context_ == nullptr) throw BackendUnavailable("cuda", "Options::queue is not a stream");
  } else {
    check(primary_context(device, context_), "cudaSetDevice", name_);
    const ContextScope scope(context_);
    // Synchronises with the default stream in neither direction.
    check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "cudaStreamCreateWithFlags", name_);
    own_ = true;
  }
  if (allocator_ != nullptr) return;
  const ContextScope scope(context_);
  cudaMemPoolProps properties{};
  properties.allocType = cudaMemAllocationTypePinned;
  properties.location.type = cudaMemLocationTypeDevice;
  properties.location.id = device;
  if (const cudaError_t code = cudaMemPoolCreate(&pool_, &properties); code != cudaSuccess) {
    if (own_) ignore(cudaStreamDestroy(stream_));
    check(code, "cudaMemPoolCreate", name_);
  }
  // Freed memory stays in the pool: phases and calls reuse it.
  std::uint64_t keep = std::numeric_limits<std::uint64_t>::max();
  ignore(cudaMemPoolSetAttribute(pool_, cudaMemPoolAttrReleaseThreshold, &keep));
}

Stream::~Stream() {
  const ContextScope scope(context_);
  ignore(cudaStreamSynchronize(stream_));
  if (pool_ != nullptr) ignore(cudaMemPoolDestroy(pool_));
  if (own_) ignore(cudaStreamDestroy(stream_));
}

void* Stream::allocate(std::size_t bytes) {
  void* memory = nullptr;
  if (allocator_ != nullptr) {
    memory = allocator_->allocate(bytes, stream_);
    if (memory != nullptr) return memory;
  } else {
    const cudaError_t code = cudaMallocFromPoolAsync(&memory, bytes, pool_, stream_);
    if (code == cudaSuccess) return memory;
    if (code != cudaErrorMemoryAllocation) check(code, "cudaMallocFromPoolAsync", name_);
    cudaGetLastError();
  }
  const std::size_t available = free_bytes();
  throw OutOfMemory("'" + name_ + "' cannot hold another " + std::to_string(bytes) + " bytes; " +
                        std::to_string(available) + " bytes are free" +
                        (allocator_ != nullptr ? ", but the caller's allocator gave none" : "") + ": use fewer points",
                    bytes, available);
}

void Stream::deallocate(void* memory, std::size_t bytes) noexcept {
  if (allocator_ != nullptr) {
    allocator_->deallocate(memory, bytes, stream_);
  } else {
    ignore(cudaFreeAsync(memory, stream_));  // stream-ordered, after the launches that use it
  }
}

void Stream::fill(void* memory, std::uint32_t word, std::size_t words) {
  check_driver(driver().fill(reinterpret_cast<CUdeviceptr>(memory), word, words, stream_), "cuMemsetD32Async", name_);
}

std::size_t Stream::free_bytes() const noexcept {
  std::size_t available = 0, total = 0;
  ignore(cudaMemGetInfo(&available, &total));
  std::uint64_t reserved = 0, used = 0;
  if (pool_ != nullptr && cudaMemPoolGetAttribute(pool_, cudaMemPoolAttrReservedMemCurrent, &reserved) == cudaSuccess &&
      cudaMemPoolGetAttribute(pool_, cudaMemPoolAttrUsedMemCurrent, &used) == cudaSuccess)
    available += static_cast<std::size_t>(reserved - std::min(used, reserved));
  return available;
}

void Stream::trim() noexcept {
  ignore(cudaStreamSynchronize(stream_));
  if (pool_ != nullptr) ignore(cudaMemPoolTrimTo(pool_, 0));
}

}  // namespace cadt::cuda
