// SPDX-License-Identifier: Apache-2.0
// The device text as host C++: the driver uses its layouts and constants, and the parameters of its kernels check every
// launch (kernel_signature.hpp). Of its functions only those that hash and
// generate are called outside of kernels.
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

constexpr std::size_t word = sizeof(cadt_u32);  // bytes
}  // namespace cadt::device_text
#pragma GCC diagnostic pop
