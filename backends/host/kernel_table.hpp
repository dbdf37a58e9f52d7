// SPDX-License-Identifier: Apache-2.0
// The kernels of the device text as functions of (work-item, arguments).
#pragma once

#include <array>
#include <cstdint>

#include "common/driver/device.hpp"

namespace cadt::host {

/// Runs one work-item of a kernel; unpacks `args` by the kernel's parameter types.
using KernelFunction = void (*)(std::uint32_t item, std::uint32_t items, const Arg* args);
using KernelTable = std::array<KernelFunction, kernel_count>;

extern const KernelTable narrow_kernels;  ///< coordinates within 240 binades
extern const KernelTable wide_kernels;    ///< any double
extern const KernelTable timed_kernels;   ///< narrow, with timers

/// Address of a buffer of this back end, as a kernel argument.
[[nodiscard]] void* address(Buffer* buffer) noexcept;

}  // namespace cadt::host
