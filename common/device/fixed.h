/* SPDX-License-Identifier: Apache-2.0
 *
 * Exact arithmetic on coordinates as integers. Every finite double is an integer times a power of two, so the few
 * coordinates of one predicate become integers over their smallest exponent: no rounding, no overflow, no underflow,
 * nothing that contraction, denormal flushing or a fast-math option could break. How long the integers are follows from
 * the coordinates at hand: 62 bits in most cases, any length up to the whole range of a double in a wide build
 * (docs/decisions/0005-exact-integers.md).
 */
#ifndef CADT_DEVICE_FIXED_H
#define CADT_DEVICE_FIXED_H

#include "common/device/lang.h"

/* Limbs of a sum of six coordinates: 240 + 4 bits, or 2098 + 4 bits (2^-1074 to 2^1024). */
#if CADT_WIDE
#define CADT_LIMBS 66
#else
#define CADT_LIMBS 8
#endif

/* Exponent of the lowest and one above the highest set bit of finite values. */
typedef struct {
  cadt_i32 low, high;
} cadt_span;

CADT_FN cadt_u64 cadt_mantissa(cadt_u64 bits) {
  cadt_u64 m = bits & 0xFFFFFFFFFFFFFul;
  return (bits >> 52) & 0x7FFul ? m | 0x10000000000000ul : m;
}
CADT_FN cadt_i32 cadt_exponent(cadt_u64 bits) {
  cadt_i32 e = CADT_CAST(cadt_i32, (bits >> 52) & 0x7FFul);
  return (e ? e : 1) - 1075;
}
/* m != 0 */
CADT_FN cadt_i32 cadt_trailing_zeros(cadt_u64 m) { return 63 - CADT_CAST(cadt_i32, cadt_clz64(m & (0ul - m))); }

CADT_FN void cadt_span_clear(cadt_span* s) {
  s->low = 4096;
  s->high = -4096;
}
CADT_FN void cadt_span_add(cadt_span* s, double value) {
  cadt_u64 bits = cadt_bits_of_double(value), m = cadt_mantissa(bits);
  if (m != 0ul) {
    cadt_i32 e = cadt_exponent(bits);
    cadt_i32 low = e + cadt_trailing_zeros(m), high = e + 64 - CADT_CAST(cadt_i32, cadt_clz64(m));
    if (low < s->low) s->low = low;
    if (high > s->high) s->high = high;
  }
}
CADT_FN void cadt_span_add_point(cadt_span* s, cadt_point p) {
  cadt_span_add(s, p.x);
  cadt_span_add(s, p.y);
}
/* Bits of the largest magnitude; 0 if all values are zero. */
CADT_FN cadt_i32 cadt_span_bits(const cadt_span* s) { return s->high > s->low ? s->high - s->low : 0; }

/* value / 2^low as an integer; \pre the span that gave `low` is at most 62 bits */
CADT_FN cadt_i64 cadt_fixed64(double value, cadt_i32 low) {
  cadt_u64 bits = cadt_bits_of_double(value), m = cadt_mantissa(bits);
  if (m == 0ul) return 0;
  cadt_i32 shift = cadt_exponent(bits) - low;
  m = shift >= 0 ? m << shift : m >> (-shift);
  return bits >> 63 ? -CADT_CAST(cadt_i64, m) : CADT_CAST(cadt_i64, m);
}

/* ---- 128-bit integers -------------------------------------------------------------------------------------------- */
typedef struct {
  cadt_i64 high;
  cadt_u64 low;
} cadt_i128;

CADT_FN cadt_i128 cadt_mul_i64(cadt_i64 a, cadt_i64 b) {
  cadt_u64 ua = CADT_CAST(cadt_u64, a), ub = CADT_CAST(cadt_u64, b);
  cadt_u64 high = cadt_mulhi_u64(ua, ub);
  cadt_i128 r;
  /* the unsigned product exceeds the signed one by b * 2^64 if a < 0 and by a * 2^64 if b < 0 */
  if (a < 0) high -= ub;
  if (b < 0) high -= ua;
  r.high = CADT_CAST(cadt_i64, high);
  r.low = ua * ub;
  return r;
}
CADT_FN cadt_i128 cadt_add_i128(cadt_i128 a, cadt_i128 b) {
  cadt_i128 r;
  r.low = a.low + b.low;
  r.high = CADT_CAST(cadt_i64, CADT_CAST(cadt_u64, a.high) + CADT_CAST(cadt_u64, b.high) + (r.low < a.low ? 1ul : 0ul));
  return r;
}
CADT_FN cadt_i32 cadt_sign_i128(cadt_i128 a) {
  return a.high < 0 ? -1 : ((a.high | CADT_CAST(cadt_i64, a.low)) != 0 ? 1 : 0);
}
CADT_FN cadt_i32 cadt_compare_i128(cadt_i128 a, cadt_i128 b) {
  if (a.high != b.high) return a.high < b.high ? -1 : 1;
  return a.low == b.low ? 0 : (a.low < b.low ? -1 : 1);
}

/* ---- integers of any length: little-endian 32-bit limbs ---------------------------------------------------------- */

/* x = value / 2^low, two's complement, n limbs */
CADT_FN void cadt_limbs_load(cadt_u32* x, cadt_i32 n, double value, cadt_i32 low) {
  cadt_u64 bits = cadt_bits_of_double(value), m = cadt_mantissa(bits);
  for (cadt_i32 i = 0; i < n; ++i) x[i] = 0u;
  if (m == 0ul) return;
  cadt_i32 shift = cadt_exponent(bits) - low;
  if (shift < 0) {
    m >>= -shift;
    shift = 0;
  }
  cadt_i32 at = shift >> 5, rest = shift & 31;
  cadt_u64 lower = m << rest, upper = rest ? m >> (64 - rest) : 0ul;
  x[at] = CADT_CAST(cadt_u32, lower);
  if (at + 1 < n) x[at + 1] = CADT_CAST(cadt_u32, lower >> 32);
  if (at + 2 < n) x[at + 2] = CADT_CAST(cadt_u32, upper);
  if (bits >> 63) {
    cadt_u32 carry = 1u;
    for (cadt_i32 i = 0; i < n; ++i) {
      x[i] = ~x[i] + carry;
      carry = carry && x[i] == 0u ? 1u : 0u;
    }
  }
}

/* x += y or x -= y; y has m <= n limbs and is unsigned or of the same length */
CADT_FN void cadt_limbs_accumulate(cadt_u32* x, cadt_i32 n, const cadt_u32* y, cadt_i32 m, cadt_u32 subtract) {
  cadt_u64 carry = subtract ? 1ul : 0ul;
  for (cadt_i32 i = 0; i < n; ++i) {
    cadt_u32 term = i < m ? y[i] : 0u;
    carry += CADT_CAST(cadt_u64, x[i]) + (subtract ? ~term : term);
    x[i] = CADT_CAST(cadt_u32, carry);
    carry >>= 32;
  }
}

/* Two's complement to magnitude in place; returns 1 if it was negative. */
CADT_FN cadt_u32 cadt_limbs_abs(cadt_u32* x, cadt_i32 n) {
  if (!(x[n - 1] >> 31)) return 0u;
  cadt_u32 carry = 1u;
  for (cadt_i32 i = 0; i < n; ++i) {
    x[i] = ~x[i] + carry;
    carry = carry && x[i] == 0u ? 1u : 0u;
  }
  return 1u;
}

CADT_FN cadt_i32 cadt_limbs_sign(const cadt_u32* x, cadt_i32 n) {
  if (x[n - 1] >> 31) return -1;
  for (cadt_i32 i = 0; i < n; ++i)
    if (x[i]) return 1;
  return 0;
}

/* out = a * b, magnitudes; out has n + m limbs */
CADT_FN void cadt_limbs_mul(cadt_u32* out, const cadt_u32* a, cadt_i32 n, const cadt_u32* b, cadt_i32 m) {
  for (cadt_i32 i = 0; i < n + m; ++i) out[i] = 0u;
  for (cadt_i32 i = 0; i < n; ++i) {
    cadt_u64 carry = 0ul, factor = a[i];
    if (factor == 0ul) continue;
    for (cadt_i32 j = 0; j < m; ++j) {
      carry += factor * b[j] + out[i + j];
      out[i + j] = CADT_CAST(cadt_u32, carry);
      carry >>= 32;
    }
    out[i + m] = CADT_CAST(cadt_u32, carry);
  }
}

#endif
