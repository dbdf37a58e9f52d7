// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/verify.hpp>

namespace cadt::test {

/// Expects that the verifier on a device says what the one of the host does, in every field of every check.
void expect_same_report(const VerifyReport& device, const VerifyReport& host);

}  // namespace cadt::test
