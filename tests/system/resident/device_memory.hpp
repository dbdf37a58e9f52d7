// SPDX-License-Identifier: Apache-2.0
// Points in device memory as a user would hold them: a CUDA allocation and stream, an OpenCL buffer and queue, or an
// array on the host. Nothing here goes through the library.
#pragma once

#include <cadt/triangulator.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cadt::test {

class DeviceMemory {
 public:
  virtual ~DeviceMemory() = default;
  /// The stream or queue for Options::queue; null on the host, which has none.
  [[nodiscard]] virtual void* queue() const = 0;
  /// Memory that is not initialised, for an allocator; null if there is none left.
  [[nodiscard]] virtual void* allocate(std::size_t bytes) noexcept = 0;
  virtual void free(void* memory) noexcept = 0;
  /// Blocking copies, in the order of the queue.
  virtual void read(const void* memory, std::size_t offset, std::span<std::byte> to) = 0;
  virtual void write(void* memory, std::size_t offset, std::span<const std::byte> from) = 0;
  /// Waits for everything in the queue.
  virtual void wait() = 0;

  /// A copy of the data on the device that lives as long as this object.
  [[nodiscard]] void* upload(std::span<const std::byte> data);
  template <class T>
  [[nodiscard]] void* upload(std::span<const T> values) {
    return upload(std::as_bytes(values));
  }
  /// The first `count` elements of an array on the device; none of a null handle.
  template <class T>
  [[nodiscard]] std::vector<T> download(const void* memory, std::size_t count) {
    std::vector<T> values(memory != nullptr ? count : 0);
    if (!values.empty()) read(memory, 0, std::as_writable_bytes(std::span(values)));
    return values;
  }

 protected:
  /// For destructors of derived classes, while they can still free.
  void free_uploads() noexcept;

 private:
  std::vector<void*> uploads_;
};

/// nullptr if the back end is not compiled in. `device`: index within the back end, as in DeviceInfo.
[[nodiscard]] std::unique_ptr<DeviceMemory> host_memory();
[[nodiscard]] std::unique_ptr<DeviceMemory> cuda_memory(int device);
[[nodiscard]] std::unique_ptr<DeviceMemory> opencl_memory(int device);
[[nodiscard]] std::unique_ptr<DeviceMemory> device_memory(Backend backend, int device);

}  // namespace cadt::test
