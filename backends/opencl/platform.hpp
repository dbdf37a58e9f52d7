// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/devices.hpp>
#include <string>
#include <vector>

#include "backends/opencl/cl.hpp"
#include "backends/opencl/facts.hpp"

namespace cadt::opencl {

struct FoundDevice {
  cl::Device device;
  Facts facts;
  DeviceInfo info;
  bool gpu_hardware = false;  ///< the real type; tests may override info.gpu
  /// Work-items of a group on GPUs: 128 leave several resident groups a compute unit even for kernels with many
  /// registers.
  std::size_t gpu_group = 128;
  std::string vendor, device_version, platform_version;
};

struct Found {
  std::vector<FoundDevice> devices;  ///< of all platforms, in the loader's order; the position is the device index
  std::string none;                  ///< why there is no device; empty if there is one
};

/// Queries all platforms. Failures of the runtime become reasons, never exceptions.
[[nodiscard]] Found find_devices();

}  // namespace cadt::opencl
