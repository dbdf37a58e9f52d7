// SPDX-License-Identifier: Apache-2.0
// Signed integers of variable length in a fixed array: the last stage of the verifier's predicates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cadt::verifier {

__extension__ typedef unsigned __int128 u128;
__extension__ typedef __int128 i128;

/// Sign and magnitude; only the `size` lowest limbs are in use, so short numbers cost little whatever the capacity. The
/// capacity is not checked: the caller shows that each sum fits (see exact_sign.cpp).
template <std::size_t Capacity>
struct Integer {
  std::array<std::uint64_t, Capacity> limb;  // not initialised above `size`
  std::size_t size = 0;                      // no leading zero limb; 0 for the number zero
  bool negative = false;

  Integer() {}  // NOLINT: leaves the limbs alone on purpose

  /// magnitude * 2^shift
  Integer(bool minus, std::uint64_t magnitude, unsigned shift) : negative(minus) {  // NOLINT
    if (magnitude == 0) return;
    const std::size_t skip = shift / 64;
    const unsigned bits = shift % 64;
    for (std::size_t i = 0; i < skip; ++i) limb[i] = 0;
    limb[skip] = magnitude << bits;
    size = skip + 1;
    const std::uint64_t high = bits == 0 ? 0 : magnitude >> (64 - bits);
    if (high != 0) limb[size++] = high;
  }

  [[nodiscard]] int sign() const { return size == 0 ? 0 : (negative ? -1 : 1); }
};

template <std::size_t N>
int compare_magnitude(const Integer<N>& a, const Integer<N>& b) {
  if (a.size != b.size) return a.size < b.size ? -1 : 1;
  for (std::size_t i = a.size; i-- > 0;)
    if (a.limb[i] != b.limb[i]) return a.limb[i] < b.limb[i] ? -1 : 1;
  return 0;
}

/// a + b, or a - b if `subtract`.
template <std::size_t N>
Integer<N> sum(const Integer<N>& a, const Integer<N>& b, bool subtract = false) {
  Integer<N> r;
  const bool b_negative = b.negative != subtract;
  if (a.negative == b_negative) {
    const Integer<N>& more = a.size >= b.size ? a : b;
    const Integer<N>& less = a.size >= b.size ? b : a;
    u128 carry = 0;
    for (std::size_t i = 0; i < more.size; ++i) {
      carry += more.limb[i];
      if (i < less.size) carry += less.limb[i];
      r.limb[i] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    r.size = more.size;
    if (carry != 0) r.limb[r.size++] = static_cast<std::uint64_t>(carry);
    r.negative = a.negative;
    return r;
  }
  const int order = compare_magnitude(a, b);
  if (order == 0) return r;
  const Integer<N>& more = order > 0 ? a : b;
  const Integer<N>& less = order > 0 ? b : a;
  std::uint64_t transient = 0;
  for (std::size_t i = 0; i < more.size; ++i) {
    const u128 d = u128{more.limb[i]} - (i < less.size ? less.limb[i] : 0) - transient;
    r.limb[i] = static_cast<std::uint64_t>(d);
    transient = static_cast<std::uint64_t>(d >> 64) & 1;
  }
  r.size = more.size;
  while (r.size > 0 && r.limb[r.size - 1] == 0) --r.size;
  r.negative = order > 0 ? a.negative : b_negative;
  return r;
}

template <std::size_t N>
Integer<N> difference(const Integer<N>& a, const Integer<N>& b) {
  return sum(a, b, true);
}

/// The product always fits: its capacity is the sum of those of the factors.
template <std::size_t N, std::size_t M>
Integer<N + M> product(const Integer<N>& a, const Integer<M>& b) {
  Integer<N + M> r;
  if (a.size == 0 || b.size == 0) return r;
  r.size = a.size + b.size;
  for (std::size_t i = 0; i < r.size; ++i) r.limb[i] = 0;
  for (std::size_t i = 0; i < a.size; ++i) {
    u128 carry = 0;
    for (std::size_t j = 0; j < b.size; ++j) {
      carry += u128{a.limb[i]} * b.limb[j] + r.limb[i + j];
      r.limb[i + j] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    r.limb[i + b.size] = static_cast<std::uint64_t>(carry);
  }
  if (r.limb[r.size - 1] == 0) --r.size;
  r.negative = a.negative != b.negative;
  return r;
}

}  // namespace cadt::verifier
