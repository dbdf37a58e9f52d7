// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 0
#include "tests/robustness/fuzz/signs.ipp"

namespace cadt::fuzz {
std::vector<std::uint32_t> narrow_words(const std::vector<test::SignCase>& cases) { return words(cases); }
}  // namespace cadt::fuzz
