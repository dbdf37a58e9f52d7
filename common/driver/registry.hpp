// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/driver/device.hpp"

namespace cadt {

/// Opens the device that the options name, never another one in its place. \throws BackendUnavailable
[[nodiscard]] std::unique_ptr<Device> open_device(const Options& options);

}  // namespace cadt
