// SPDX-License-Identifier: Apache-2.0
// Points in device memory as a user would hold them: a CUDA allocation and stream, or an OpenCL buffer and queue.
#pragma once

#include <cadt/triangulator.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string>

namespace cadt::test {

class DeviceMemory {
 public:
  virtual ~DeviceMemory() = default;
  /// The stream or queue for Options::queue.
  [[nodiscard]] virtual void* queue() const = 0;
  /// A copy of the data on the device that lives as long as this object.
  [[nodiscard]] virtual void* upload(std::span<const std::byte> data) = 0;
  /// Waits for everything in the queue.
  virtual void wait() = 0;

  template <class T>
  [[nodiscard]] void* upload(std::span<const T> values) {
    return upload(std::as_bytes(values));
  }
};

/// nullptr if the back end is not compiled in. `device`: index within the back end, as in DeviceInfo.
[[nodiscard]] std::unique_ptr<DeviceMemory> cuda_memory(int device);
[[nodiscard]] std::unique_ptr<DeviceMemory> opencl_memory(int device);

}  // namespace cadt::test
