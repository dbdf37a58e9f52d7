// SPDX-License-Identifier: Apache-2.0
// The devices of this machine.
#pragma once

#include <cadt/export.hpp>
#include <cadt/triangulation.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace cadt {

struct DeviceInfo {
  Backend backend = Backend::host;
  int index = 0;         ///< number within its back end, as `Options::device` takes it; -1: the back end itself
  std::string platform;  ///< e.g. "Portable Computing Language"
  std::string name;
  std::string driver;  ///< driver version
  bool usable = false;
  std::string reason;  ///< why it is not usable; empty if it is
  std::uint64_t memory_bytes = 0;
  std::uint64_t largest_buffer_bytes = 0;
  unsigned compute_units = 0;
  bool fp64 = false;  ///< false for a usable device: it takes float coordinates only, and only if it is named
  bool gpu = false;
  bool watchdog =
      false;  ///< its driver ends kernels that run for seconds, since it drives a display; launches are kept shorter
  std::string atomics;  ///< e.g. "C++20 acquire/release", "CL3.0 acquire/release, device scope"
};

/// All devices of all back ends, usable or not. A back end that is not compiled in or finds no device has one entry,
/// with index -1 and the reason. A missing driver is no error.
[[nodiscard]] CADT_API std::vector<DeviceInfo> list_devices();

}  // namespace cadt
