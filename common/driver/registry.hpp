// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/driver/device.hpp"

namespace cadt {

/// Opens the device that the options name. Never falls back to another one. \throws BackendUnavailable
[[nodiscard]] std::unique_ptr<Device> open_device(const Options& options);

}  // namespace cadt
