// SPDX-License-Identifier: Apache-2.0
// The kernel cadt_signs on a device.
#pragma once

#include <cstdint>
#include <vector>

#include "common/host/device.hpp"
#include "tests/unit/predicates/cases.hpp"

namespace cadt::test {
[[nodiscard]] std::vector<std::uint32_t> words_of(Device& device, const std::vector<SignCase>& cases,
                                                  KernelBuild build);
}  // namespace cadt::test
