// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 1
#include "tests/unit/predicates/counted.ipp"

namespace cadt::test {
Lengths count_wide(const std::vector<SignCase>& cases) { return count(cases); }
}  // namespace cadt::test
