// SPDX-License-Identifier: Apache-2.0
// The registry's view of a back end. Each folder of backends/ defines one function that returns it; for a back end that
// is not compiled in, backends/absent.cpp does.
#pragma once

#include <memory>
#include <vector>

#include "common/driver/device.hpp"

namespace cadt {

class BackendEntry {
 public:
  virtual ~BackendEntry() = default;
  [[nodiscard]] virtual Backend id() const noexcept = 0;
  /// All devices, usable or not; one entry with index -1 and the reason if there is none. Never throws.
  [[nodiscard]] virtual std::vector<DeviceInfo> devices() = 0;
  /// Opens the device with this index (as in `devices()`) and runs its self-test. \throws BackendUnavailable (with
  /// the failed probe), KernelBuildError, DeviceError
  [[nodiscard]] virtual std::unique_ptr<Device> open(int index, const Options& options) = 0;
  /// Index of the device that the caller's stream or queue belongs to, -1 if there is none.
  [[nodiscard]] virtual int device_of(void* /*queue*/) { return -1; }
  /// Index of the caller's current device where the language has one, else -1.
  [[nodiscard]] virtual int preferred_device() { return -1; }
};

BackendEntry& host_backend();
BackendEntry& opencl_backend();
BackendEntry& cuda_backend();

}  // namespace cadt
