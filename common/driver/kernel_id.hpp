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

/// Where a kernel belongs. A back end that compiles at run time has a program for each stage.
#define CADT_ENUMERATOR(name, kernels) name,
enum class Stage { CADT_STAGE_LIST(CADT_ENUMERATOR) count };
#undef CADT_ENUMERATOR
inline constexpr std::size_t stage_count = static_cast<std::size_t>(Stage::count);

[[nodiscard]] constexpr Stage stage_of(KernelId kernel) noexcept {
#define CADT_ONE(name) +1
#define CADT_NUMBER(name, kernels) 0 kernels(CADT_ONE),
  constexpr std::array<int, stage_count> kernels_of = {CADT_STAGE_LIST(CADT_NUMBER)};
#undef CADT_NUMBER
#undef CADT_ONE
  std::size_t stage = 0;
  for (int before = static_cast<int>(kernel); before >= kernels_of[stage]; ++stage) before -= kernels_of[stage];
  return static_cast<Stage>(stage);
}
static_assert(stage_of(KernelId::cadt_selftest) == Stage::self_test &&
              stage_of(KernelId::cadt_insert) == Stage::insertion &&
              stage_of(KernelId::cadt_verify_gather) == Stage::verify);

}  // namespace cadt
