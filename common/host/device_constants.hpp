// SPDX-License-Identifier: Apache-2.0
// The layout that the driver shares with the kernels.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace cadt::device_constants {
#include "common/device/layout.h"
#include "common/device/verify_layout.h"
}  // namespace cadt::device_constants
