// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/exact/exact_number.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cadt::exact {
namespace {

__extension__ typedef unsigned __int128 Wide;

/// The number without zero limbs at its ends.
Number trimmed(const std::uint64_t* limb, std::int32_t size, std::int32_t low, bool negative) {
  while (size > 0 && limb[size - 1] == 0) --size;
  while (size > 0 && limb[0] == 0) ++limb, ++low, --size;
  if (size == 0) return {};
  return {limb, size, low, negative};
}

std::uint64_t limb_at(const Number& a, std::int32_t place) {
  const std::int32_t i = place - a.low;
  return i >= 0 && i < a.size ? a.limb[i] : 0;
}

int compare_magnitudes(const Number& a, const Number& b) {
  if (a.size == 0 || b.size == 0) return (a.size != 0) - (b.size != 0);
  if (a.low + a.size != b.low + b.size) return a.low + a.size < b.low + b.size ? -1 : 1;
  for (std::int32_t place = a.low + a.size - 1, end = std::min(a.low, b.low); place >= end; --place) {
    const std::uint64_t x = limb_at(a, place), y = limb_at(b, place);
    if (x != y) return x < y ? -1 : 1;
  }
  return 0;
}

/// The place of the highest bit, plus 1: the number is below 2^that in modulus.
std::int64_t bit_length(const Number& a) {
  return 64 * (std::int64_t{a.low} + a.size) - std::countl_zero(a.limb[a.size - 1]);
}

/// Bits [64 place, 64 place + 64) of a 2^shift.
std::uint64_t shifted_limb(const Number& a, std::int64_t shift, std::int64_t place) {
  const std::int64_t bit = 64 * place - shift;
  const std::int64_t from = bit >= 0 ? bit / 64 : -((63 - bit) / 64);
  const auto by = static_cast<unsigned>(bit - 64 * from);
  const std::uint64_t low = limb_at(a, static_cast<std::int32_t>(from));
  if (by == 0) return low;
  return low >> by | limb_at(a, static_cast<std::int32_t>(from + 1)) << (64 - by);
}

/// |dividend / divisor| = (digits + what is below 1) / 2^shift, 2^62 <= digits < 2^64.
struct Quotient {
  std::uint64_t digits;
  std::int64_t shift;
  bool rest;  ///< whether something is left
};

// One step of long division: D. E. Knuth, "The Art of Computer Programming", vol. 2, 4.3.1, algorithm D. The divisor is
// shifted so that its highest bit is the highest of a limb, so the digit from the two highest limbs is at most 2 too
// large.
Quotient divide(const Number& dividend, const Number& divisor, Arena& arena) {
  const std::int64_t shift = 63 - (bit_length(dividend) - bit_length(divisor));
  const std::int64_t up = std::countl_zero(divisor.limb[divisor.size - 1]);
  const std::int64_t top = std::int64_t{divisor.low} + divisor.size;  // the shifted divisor is below 2^(64 top)
  const std::int64_t first = 64 * std::int64_t{dividend.low} + shift + up;
  const std::int64_t low = std::min<std::int64_t>(divisor.low, first >= 0 ? first / 64 : -((63 - first) / 64));
  const auto n = static_cast<std::size_t>(top - low);
  std::uint64_t* const u = arena.take(2 * n + 1);
  std::uint64_t* const v = u + n + 1;
  for (std::size_t i = 0; i <= n; ++i) u[i] = shifted_limb(dividend, shift + up, low + static_cast<std::int64_t>(i));
  for (std::size_t i = 0; i < n; ++i) v[i] = shifted_limb(divisor, up, low + static_cast<std::int64_t>(i));

  std::uint64_t digits = ~std::uint64_t{0};
  if (u[n] < v[n - 1]) digits = static_cast<std::uint64_t>((Wide{u[n]} << 64 | u[n - 1]) / v[n - 1]);
  Wide carry = 0;
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i <= n; ++i) {
    if (i < n) carry += Wide{digits} * v[i];
    const Wide d = Wide{u[i]} - static_cast<std::uint64_t>(carry) - borrow;
    u[i] = static_cast<std::uint64_t>(d);
    borrow = static_cast<std::uint64_t>(d >> 64) & 1;
    carry >>= 64;
  }
  while (borrow != 0) {  // the digit was too large: add the divisor until the carry takes the borrow back
    --digits;
    Wide sum = 0;
    for (std::size_t i = 0; i <= n; ++i) {
      sum += Wide{u[i]} + (i < n ? v[i] : 0);
      u[i] = static_cast<std::uint64_t>(sum);
      sum >>= 64;
    }
    if (sum != 0) borrow = 0;
  }
  const bool rest = std::any_of(u, u + n + 1, [](std::uint64_t limb) { return limb != 0; });
  return {digits, shift, rest};
}

}  // namespace

void Arena::refill(std::size_t limbs) {
  left_ = std::max<std::size_t>(limbs, std::size_t{1} << 14);
  more_.push_back(std::make_unique_for_overwrite<std::uint64_t[]>(left_));
  at_ = more_.back().get();
}

Number Arithmetic::number(double value) const {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const auto field = static_cast<int>(bits >> 52 & 0x7ff);
  const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52) - 1);
  const std::uint64_t mantissa = field == 0 ? fraction : fraction | std::uint64_t{1} << 52;
  if (mantissa == 0) return {};
  const int exponent = std::max(field, 1) - 1075 + 1088;  // 1088 = 17 * 64: not negative
  const auto by = static_cast<unsigned>(exponent % 64);
  std::uint64_t* const limb = arena_.take(2);
  limb[0] = mantissa << by;
  limb[1] = by == 0 ? 0 : mantissa >> (64 - by);
  return trimmed(limb, 2, exponent / 64 - 17, (bits >> 63) != 0);
}

Number Arithmetic::add(const Number& a, const Number& b) const {
  if (a.size == 0) return b;
  if (b.size == 0) return a;
  const bool subtracts = a.negative != b.negative;
  const bool swap = subtracts && compare_magnitudes(a, b) < 0;
  const Number &x = swap ? b : a, &y = swap ? a : b;
  const std::int32_t low = std::min(a.low, b.low);
  const std::int32_t size = std::max(a.low + a.size, b.low + b.size) - low + (subtracts ? 0 : 1);
  std::uint64_t* const limb = arena_.take(static_cast<std::size_t>(size));
  std::uint64_t carry = 0;
  for (std::int32_t i = 0; i < size; ++i) {
    const std::uint64_t p = limb_at(x, low + i), q = limb_at(y, low + i);
    const Wide sum = subtracts ? Wide{p} - q - carry : Wide{p} + q + carry;
    limb[i] = static_cast<std::uint64_t>(sum);
    carry = static_cast<std::uint64_t>(sum >> 64) & 1;
  }
  return trimmed(limb, size, low, x.negative);
}

Number Arithmetic::multiply(const Number& a, const Number& b) const {
  if (a.size == 0 || b.size == 0) return {};
  const std::int32_t size = a.size + b.size;
  std::uint64_t* const limb = arena_.take(static_cast<std::size_t>(size));
  std::fill(limb, limb + size, 0);
  for (std::int32_t i = 0; i < a.size; ++i) {
    Wide carry = 0;
    for (std::int32_t j = 0; j < b.size; ++j) {
      carry += Wide{a.limb[i]} * b.limb[j] + limb[i + j];
      limb[i + j] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    limb[i + b.size] = static_cast<std::uint64_t>(carry);
  }
  return trimmed(limb, size, a.low + b.low, a.negative != b.negative);
}

int compare(const Number& a, const Number& b) {
  if (a.sign() != b.sign()) return a.sign() < b.sign() ? -1 : 1;
  return a.negative ? compare_magnitudes(b, a) : compare_magnitudes(a, b);
}

Rounded round_quotient(const Number& dividend, const Number& divisor, Arena& arena) {
  if (dividend.size == 0) return {};
  const Quotient q = divide(dividend, divisor, arena);
  // 53 bits, or down to 2^-1074, stay; what they count is 2^(drop - shift)
  const std::int64_t drop =
      std::max<std::int64_t>(static_cast<std::int64_t>(std::bit_width(q.digits)) - 53, q.shift - 1074);
  std::uint64_t kept = drop < 64 ? q.digits >> drop : 0;
  const std::uint64_t below = drop < 64 ? q.digits & ((std::uint64_t{1} << drop) - 1) : q.digits;
  int rest = below != 0 || q.rest ? 1 : 0;
  if (drop <= 64) {
    const std::uint64_t half = std::uint64_t{1} << (drop - 1);
    if (below > half || (below == half && (q.rest || (kept & 1) != 0))) ++kept, rest = -1;
  }
  const bool negative = dividend.negative != divisor.negative;
  const double value = std::ldexp(static_cast<double>(kept), static_cast<int>(drop - q.shift));
  return {negative ? -value : value, negative ? -rest : rest};
}

std::int64_t floor_quotient(const Number& dividend, const Number& divisor, Arena& arena) {
  if (dividend.size == 0) return 0;
  const Quotient q = divide(dividend, divisor, arena);  // shift >= 0, as the quotient is below 2^62
  const bool small = q.shift < 64;
  const std::uint64_t whole = small ? q.digits >> q.shift : 0;
  const bool rest = q.rest || (small ? whole << q.shift != q.digits : true);
  const auto value = static_cast<std::int64_t>(whole);
  if (dividend.negative == divisor.negative) return value;
  return rest ? -value - 1 : -value;
}

}  // namespace cadt::exact
