// SPDX-License-Identifier: Apache-2.0
// Opening a device, with options for tests. No OpenCL headers needed.
#pragma once

#include <cadt/triangulator.hpp>

#include <memory>
#include <optional>
#include <string>

#include "common/driver/device.hpp"

namespace cadt::opencl {

struct OpenRequest {
  int index = 0;
  unsigned work_group_size = 0;  ///< 0: the default of the device
  std::optional<void*> queue;    ///< the caller's cl_command_queue: its device and context instead of `index`
  std::shared_ptr<DeviceAllocator> allocator;
  bool kernel_times = false;  ///< as in Options

  // The following are for tests.
  std::string extra_options;   ///< appended to the compiler's options
  std::string source;          ///< the program of all stages, instead of the embedded ones, if not empty
  bool probe_atomics = false;  ///< try the compiler even if the device advertises acquire/release
  bool best_effort_atomics = false;
  bool fresh = false;          ///< a context of its own instead of the process's
  bool* from_cache = nullptr;  ///< set if a program is built: whether it came from disk
};

/// Index of the device of a cl_command_queue among all devices, -1 if it is none of them.
[[nodiscard]] int device_of(void* queue);

/// \throws BackendUnavailable, KernelBuildError, OutOfMemory, DeviceError
[[nodiscard]] std::unique_ptr<Device> open_device(const OpenRequest& request);

/// Marks the process's context for this request as lost by the runtime. For tests.
void lose_context(const OpenRequest& request);

}  // namespace cadt::opencl
