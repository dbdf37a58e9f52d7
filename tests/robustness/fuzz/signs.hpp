// SPDX-License-Identifier: Apache-2.0
// The kernel cadt_predicate_probe on the host.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/unit/predicates/cases.hpp"

namespace cadt::fuzz {
[[nodiscard]] std::vector<std::uint32_t> narrow_words(const std::vector<test::SignCase>& cases);
[[nodiscard]] std::vector<std::uint32_t> wide_words(const std::vector<test::SignCase>& cases);
}  // namespace cadt::fuzz
