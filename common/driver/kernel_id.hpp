// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "common/portable/kernel_list.h"

namespace cadt {

#define CADT_ENUMERATOR(name) name,
enum class KernelId { CADT_KERNEL_LIST(CADT_ENUMERATOR) count };
#undef CADT_ENUMERATOR

/// Variants of the kernels (common/portable/dialect.dev.h).
enum class KernelVariant {
  narrow,  ///< exponents of all coordinates within 240 binades
  wide,    ///< any double
  timed    ///< narrow, with clocks (counters.dev.h)
};
inline constexpr std::size_t kernel_variants = 3;

inline constexpr std::size_t kernel_count = static_cast<std::size_t>(KernelId::count);

#define CADT_NAME(name) #name,
inline constexpr std::array<const char*, kernel_count> kernel_names = {CADT_KERNEL_LIST(CADT_NAME)};
#undef CADT_NAME

}  // namespace cadt
