// SPDX-License-Identifier: Apache-2.0
// Context, stream and memory pool of an open device.
#pragma once

#include <cuda.h>
#include <cuda_runtime_api.h>

#include <cadt/triangulator.hpp>

#include <memory>
#include <optional>
#include <string>

namespace cadt::cuda {

/// \throws DeviceError unless `code` is cudaSuccess
void check(cudaError_t code, const char* call, const std::string& device);

/// For calls whose failure does not matter: clears their error, but keeps an earlier error of the caller.
void ignore(cudaError_t code) noexcept;

/// Makes a context current, and restores the caller's at the end of the scope.
class ContextScope {
 public:
  explicit ContextScope(CUcontext context) noexcept;
  ~ContextScope();
  ContextScope(const ContextScope&) = delete;
  ContextScope& operator=(const ContextScope&) = delete;

 private:
  bool pushed_;
};

/// Ordinal of the device that a stream belongs to; -1 if there is none. The default streams are those of the current
/// context, or of the current device's primary context. Makes no context current.
[[nodiscard]] int device_of(cudaStream_t stream);
/// The context of a stream; null if it has none.
[[nodiscard]] CUcontext context_of(cudaStream_t stream);

/// A stream, its context, and the source of its memory. Lives as long as the last buffer.
class Stream {
 public:
  /// The caller's stream, or a new one in the device's primary context. \throws DeviceError
  Stream(int device, std::string name, std::optional<void*> queue, std::shared_ptr<DeviceAllocator> allocator);
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  [[nodiscard]] cudaStream_t get() const noexcept { return stream_; }
  [[nodiscard]] CUcontext context() const noexcept { return context_; }
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

  /// \pre the context is current. Holds for all three. \throws OutOfMemory, DeviceError
  [[nodiscard]] void* allocate(std::size_t bytes);
  void deallocate(void* memory, std::size_t bytes) noexcept;
  void wait() { check(cudaStreamSynchronize(stream_), "cudaStreamSynchronize", name_); }
  void fill(void* memory, std::uint32_t word, std::size_t words);

  [[nodiscard]] bool has_allocator() const noexcept { return allocator_ != nullptr; }
  [[nodiscard]] std::size_t free_bytes() const noexcept;
  void trim() noexcept;

 private:
  std::string name_;
  std::shared_ptr<DeviceAllocator> allocator_;
  CUcontext context_ = nullptr;
  cudaStream_t stream_ = nullptr;
  cudaMemPool_t pool_ = nullptr;
  bool own_ = false;
};

}  // namespace cadt::cuda
