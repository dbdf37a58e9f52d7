// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 0
#include "tests/unit/predicates/counted.ipp"

namespace cadt::test {
Lengths count_narrow(const std::vector<SignCase>& cases) { return count(cases); }
}  // namespace cadt::test
