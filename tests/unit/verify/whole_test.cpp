// SPDX-License-Identifier: Apache-2.0
// The whole numbers that stand in for GMP: against identities, and against GMP where it is installed.
#include "tests/unit/verify/whole.hpp"

#include "truth.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <utility>

namespace {

using truth::Whole;

class Numbers {
 public:
  /// A whole double times a power of two up to 2^2000, as two factors.
  double mantissa() { return std::ldexp(static_cast<double>(engine_() >> 11), -static_cast<int>(engine_() % 53)); }
  Whole whole() { return Whole(std::floor(mantissa())) * Whole(engine_() % 2 ? 1 : -1) << engine_() % 2000; }
  std::mt19937_64& engine() { return engine_; }

 private:
  std::mt19937_64 engine_{7};
};

TEST(WholeNumbers, ObeyTheLawsOfARing) {
  Numbers numbers;
  for (int i = 0; i < 20000; ++i) {
    const Whole a = numbers.whole(), b = numbers.whole(), c = numbers.whole();
    ASSERT_EQ(sgn((a + b) * (a - b) - (a * a - b * b)), 0);
    ASSERT_EQ(sgn(a * (b + c) - a * b - a * c), 0);
    ASSERT_EQ(sgn((a - b) + (b - c) + (c - a)), 0);
    ASSERT_EQ(sgn(a - b), -sgn(b - a));
    ASSERT_EQ(sgn(a * b), sgn(a) * sgn(b));
    const unsigned long bits = numbers.engine()() % 2000;
    ASSERT_EQ(sgn(((a << bits) >> bits) - a), 0);
    ASSERT_EQ(sgn(a * a + Whole(1)), 1);
    ASSERT_EQ(sgn(Whole(-1) - a * a), -1);
  }
  EXPECT_EQ(sgn(Whole(18446744073709549568.0) - (Whole(1) << 64) + Whole(2048)), 0);
}

#if CADT_TEST_GMP
TEST(WholeNumbers, HaveTheSignsOfGmp) {
  std::mt19937_64 engine(11);
  int zeros = 0;
  for (int i = 0; i < 50000; ++i) {
    // Small numbers often cancel, wide ones seldom.
    std::array<double, 6> v{};
    std::array<unsigned long, 6> shift{};
    for (std::size_t k = 0; k < v.size(); ++k) {
      v[k] = static_cast<double>(engine() >> (i % 2 ? 11 : 62)) * (engine() % 2 ? 1 : -1);
      shift[k] = i % 4 < 2 ? 0 : engine() % 1500;
    }
    const auto value = [&]<class Number>(Number) {
      std::array<Number, 6> n;
      for (std::size_t k = 0; k < n.size(); ++k) n[k] = Number(v[k]) << shift[k];
      Number result = n[0] * n[1] - n[2] * n[3];
      result += n[4];
      result -= n[5];
      // All but the difference of the last two cancels.
      Number rest = n[0] * (n[1] + n[2]) - n[0] * n[1];
      rest -= n[0] * n[2];
      rest += n[4] - n[5];
      return std::pair{sgn(result), sgn(rest)};
    };
    const std::pair<int, int> expected = value(mpz_class());
    ASSERT_EQ(value(Whole()), expected) << i;
    zeros += expected.first == 0 || expected.second == 0;
  }
  EXPECT_GT(zeros, 1000);
}
#endif

}  // namespace
