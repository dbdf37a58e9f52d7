// SPDX-License-Identifier: Apache-2.0
// Known answers of the arithmetic and the atomics, from the actual device. Every back end runs this when it opens a
// device.
#pragma once

#include "common/driver/device.hpp"

namespace cadt {

/// \throws BackendUnavailable with the name of the first probe that failed, the expected bits and those found
void run_selftest(Device& device);

}  // namespace cadt
