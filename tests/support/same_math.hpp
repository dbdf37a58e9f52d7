// SPDX-License-Identifier: Apache-2.0
// sin, cos, exp, log and powers with the same bits on every machine. Those of the C library differ in the last place
// between versions, and between processors with and without fused multiplication; these use only operations that IEEE
// 754 rounds correctly, on pairs of doubles (about 100 bits), and round once at the end.
#pragma once

namespace cadt::test {

/// |x| up to 1e6.
[[nodiscard]] double same_sin(double x);
[[nodiscard]] double same_cos(double x);
/// |x| up to 700.
[[nodiscard]] double same_exp(double x);
/// Positive normal x.
[[nodiscard]] double same_log(double x);
/// x to a whole power from 0 on.
[[nodiscard]] double same_power(double x, int exponent);

}  // namespace cadt::test
