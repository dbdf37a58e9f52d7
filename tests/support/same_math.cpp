// SPDX-License-Identifier: Apache-2.0
#include "tests/support/same_math.hpp"

#include <cmath>

namespace cadt::test {
namespace {

// A sum of two doubles, the second at most half a unit of the first.
struct Pair {
  double high, low;
};

Pair quick_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}
Pair sum(double a, double b) {
  const double s = a + b, part = s - a;
  return {s, (a - (s - part)) + (b - part)};
}
Pair product(double a, double b) {
  const double p = a * b;
#if defined(__MINGW32__)  // whose std::fma() rounds twice
  return {p, static_cast<double>(static_cast<__float128>(a) * b - p)};
#else
  return {p, std::fma(a, b, -p)};  // exact wherever it is computed
#endif
}
Pair operator+(Pair a, Pair b) {
  const Pair high = sum(a.high, b.high), low = sum(a.low, b.low);
  const Pair partial = quick_sum(high.high, high.low + low.high);
  return quick_sum(partial.high, partial.low + low.low);
}
Pair operator-(Pair a) { return {-a.high, -a.low}; }
Pair operator-(Pair a, Pair b) { return a + -b; }
Pair operator*(Pair a, Pair b) {
  const Pair p = product(a.high, b.high);
  return quick_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}
Pair operator/(Pair a, Pair b) {
  const double first = a.high / b.high;
  const Pair rest = a - b * Pair{first, 0};
  const double second = rest.high / b.high;
  const double third = (rest - b * Pair{second, 0}).high / b.high;
  return quick_sum(first, second) + Pair{third, 0};
}
Pair exactly(double a) { return {a, 0}; }

constexpr Pair half_pi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr Pair log_2{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};

// x + c(1) x^3 + ... : the terms of sin(x) from `term` on, each the one before times -x^2 / (k (k + 1)).
Pair alternating(Pair x, Pair term, int k) {
  const Pair square = x * x;
  Pair total = term;
  for (; k < 40; k += 2) {
    term = -(term * square) / exactly(double(k) * (k + 1));
    total = total + term;
  }
  return total;
}

// sin(x + quarters * pi/2)
double sine(double x, int quarters) {
  const double count = std::floor(x / half_pi.high + 0.5);
  const Pair rest = exactly(x) - half_pi * exactly(count);
  const int turn = (static_cast<int>(std::fmod(count, 4.0)) + quarters + 8) % 4;
  const Pair value = turn % 2 == 0 ? alternating(rest, rest, 2) : alternating(rest, exactly(1), 1);
  return turn < 2 ? value.high : -value.high;
}

}  // namespace

double same_sin(double x) { return sine(x, 0); }
double same_cos(double x) { return sine(x, 1); }

double same_exp(double x) {
  const double count = std::floor(x / log_2.high + 0.5);
  const Pair rest = exactly(x) - log_2 * exactly(count);
  Pair term = exactly(1), total = term;
  for (int k = 1; k < 28; ++k) {
    term = term * rest / exactly(k);
    total = total + term;
  }
  return std::ldexp(total.high, static_cast<int>(count));
}

double same_log(double x) {
  int exponent = 0;
  double part = std::frexp(x, &exponent);  // [0.5, 1)
  if (part < 0.70710678) part *= 2, --exponent;
  // log(part) = 2 artanh(s), |s| < 0.172
  const Pair s = (exactly(part) - exactly(1)) / (exactly(part) + exactly(1)), square = s * s;
  Pair power = s, total = s;
  for (int k = 3; k < 45; k += 2) {
    power = power * square;
    total = total + power / exactly(k);
  }
  return (log_2 * exactly(exponent) + total + total).high;
}

double same_power(double x, int exponent) {
  Pair result = exactly(1);
  for (int k = 0; k < exponent; ++k) result = result * exactly(x);
  return result.high;
}

}  // namespace cadt::test
