// SPDX-License-Identifier: Apache-2.0
// The text of the kernels as host C++: its layouts and constants are those of the driver, and the parameters of its
// kernels are those of every launch (kernel_signature.hpp). Nothing of it is called here.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#if defined(__clang__)
#pragma GCC diagnostic ignored "-Wunneeded-internal-declaration"
#endif
namespace cadt::device_text {
#include "common/portable/kernels.dev.h"
}  // namespace cadt::device_text
#pragma GCC diagnostic pop
