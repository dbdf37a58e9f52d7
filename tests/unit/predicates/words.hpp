// SPDX-License-Identifier: Apache-2.0
// The kernel cadt_predicate_probe on a device.
#pragma once

#include <cstdint>
#include <vector>

#include "common/driver/device.hpp"
#include "tests/unit/predicates/cases.hpp"

namespace cadt::test {
[[nodiscard]] std::vector<std::uint32_t> words_of(Device& device, const std::vector<SignCase>& cases,
                                                  KernelVariant build);
}  // namespace cadt::test
