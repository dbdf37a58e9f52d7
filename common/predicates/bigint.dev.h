/* SPDX-License-Identifier: Apache-2.0
 *
 * Exact arithmetic on coordinates as integers. Every finite double (or float) is an integer times a power of two, so
 * the few coordinates of one predicate become integers over their smallest exponent: no rounding, no overflow, no
 * underflow, nothing that contraction, denormal flushing or a fast-math option could break. The coordinates at hand say
 * how long the integers are: 62 bits in most cases, in a wide variant up to the whole range of a double
 * (docs/decisions/0004-exact-integers-and-floats.md).
 */
#ifndef CADT_PREDICATES_BIGINT_H
#define CADT_PREDICATES_BIGINT_H

#include "common/portable/dialect.dev.h"

/* Limbs of a sum of six coordinates: 240 + 4 bits, or 2098 + 4 bits (2^-1074 to 2^1024); of floats 277 + 4 bits
 * (2^-149 to 2^128). */
#if CADT_FLOAT
#define CADT_LIMBS 9
#elif CADT_WIDE
#define CADT_LIMBS 66
#else
#define CADT_LIMBS 8
#endif

/* Exponent of the lowest and one above the highest set bit of finite values. */
typedef struct {
  cadt_i32 low, high;
} cadt_span;

CADT_FN cadt_u64 cadt_mantissa(cadt_u64 bits) {
  cadt_u64 m = bits & (CADT_HIDDEN_BIT - 1ul);
  return (bits >> CADT_MANTISSA_BITS) & CADT_EXPONENTS ? m | CADT_HIDDEN_BIT : m;
}
CADT_FN cadt_i32 cadt_exponent(cadt_u64 bits) {
  cadt_i32 e = CADT_CAST(cadt_i32, (bits >> CADT_MANTISSA_BITS) & CADT_EXPONENTS);
  return (e ? e : 1) - (CADT_EXPONENT_BIAS + CADT_MANTISSA_BITS);
}
/* m != 0 */
CADT_FN cadt_i32 cadt_trailing_zeros(cadt_u64 m) { return 63 - CADT_CAST(cadt_i32, cadt_clz64(m & (0ul - m))); }

CADT_FN void cadt_span_clear(cadt_span* s) {
  s->low = 4096;
  s->high = -4096;
}
CADT_FN void cadt_span_add(cadt_span* s, cadt_real value) {
  cadt_u64 bits = cadt_bits_of_real(value), m = cadt_mantissa(bits);
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
CADT_FN cadt_span cadt_span_of(cadt_point a, cadt_point b, cadt_point c) {
  cadt_span s;
  cadt_span_clear(&s);
  cadt_span_add_point(&s, a);
  cadt_span_add_point(&s, b);
  cadt_span_add_point(&s, c);
  return s;
}
/* Bits of the largest magnitude; 0 if all values are zero. */
CADT_FN cadt_i32 cadt_span_bits(const cadt_span* s) { return s->high > s->low ? s->high - s->low : 0; }

/* ---- 64-bit integers over one exponent, that of the largest coordinate ---- */
typedef struct {
#if CADT_GRADUAL_UNDERFLOW
  double scale; /* a power of two that makes the largest coordinate less than 2^61 */
#else
  cadt_i32 power; /* of two */
#endif
  cadt_u32 fits;
} cadt_scale;

CADT_FN cadt_u64 cadt_larger_exponent(cadt_u64 exponent, cadt_point p) {
  const cadt_u64 mask = CADT_EXPONENT_MASK;
  const cadt_u64 x = cadt_bits_of_real(p.x) & mask, y = cadt_bits_of_real(p.y) & mask;
  const cadt_u64 larger = x > y ? x : y;
  return larger > exponent ? larger : exponent;
}

#if CADT_GRADUAL_UNDERFLOW
/* \pre `exponent` is that of the largest coordinate, as in its bits */
CADT_FN cadt_scale cadt_scale_of(cadt_u64 exponent) {
  cadt_scale s;
  const cadt_i32 power = 60 + 1023 - CADT_CAST(cadt_i32, exponent >> 52);
  s.fits = power <= 1023 && power >= -1022 ? 1u : 0u;
  s.scale = cadt_double_of_bits(CADT_CAST(cadt_u64, (s.fits ? power : 0) + 1023) << 52);
  return s;
}

/* The coordinate as an integer; s->fits becomes 0 if it has lower bits. */
CADT_FN cadt_i64 cadt_scaled(cadt_scale* s, double value) {
  const double scaled = value * s->scale;
  const cadt_i64 integer = CADT_CAST(cadt_i64, scaled);
  if (CADT_CAST(double, integer) != scaled || (integer == 0 && value != 0.0)) s->fits = 0u; /* or underflow */
  return integer;
}
#else
/* The same from the bits of the coordinates alone. */
CADT_FN cadt_scale cadt_scale_of(cadt_u64 exponent) {
  cadt_scale s;
  s.power = 60 + CADT_EXPONENT_BIAS - CADT_CAST(cadt_i32, exponent >> CADT_MANTISSA_BITS);
  s.fits = 1u;
  return s;
}

CADT_FN cadt_i64 cadt_scaled(cadt_scale* s, cadt_real value) {
  const cadt_u64 bits = cadt_bits_of_real(value);
  cadt_u64 m = cadt_mantissa(bits);
  const cadt_i32 shift = m ? cadt_exponent(bits) + s->power : 0;
  if (shift < 0 && cadt_trailing_zeros(m) < -shift) {
    s->fits = 0u;
    return 0;
  }
  m = shift < 0 ? m >> -shift : m << shift;
  return bits >> CADT_SIGN_SHIFT ? -CADT_CAST(cadt_i64, m) : CADT_CAST(cadt_i64, m);
}
#endif

/* ---- 128-bit integers ---- */
typedef struct {
  cadt_i64 high;
  cadt_u64 low;
} cadt_i128;

CADT_FN cadt_i128 cadt_mul_i64(cadt_i64 a, cadt_i64 b) {
  cadt_u64 ua = CADT_CAST(cadt_u64, a), ub = CADT_CAST(cadt_u64, b);
  cadt_u64 high = cadt_mulhi_u64(ua, ub);
  /* the unsigned product exceeds the signed one by b * 2^64 if a < 0 and by a * 2^64 if b < 0 */
  if (a < 0) high -= ub;
  if (b < 0) high -= ua;
  const cadt_i128 r = {CADT_CAST(cadt_i64, high), ua * ub};
  return r;
}
CADT_FN cadt_i128 cadt_add_i128(cadt_i128 a, cadt_i128 b) {
  cadt_i128 r;
  r.low = a.low + b.low;
  r.high = CADT_CAST(cadt_i64, CADT_CAST(cadt_u64, a.high) + CADT_CAST(cadt_u64, b.high) + (r.low < a.low ? 1ul : 0ul));
  return r;
}
CADT_FN cadt_i32 cadt_compare_i128(cadt_i128 a, cadt_i128 b) {
  if (a.high != b.high) return a.high < b.high ? -1 : 1;
  return a.low == b.low ? 0 : (a.low < b.low ? -1 : 1);
}

/* ---- 256-bit integers: two's complement, little-endian ---- */
typedef struct {
  cadt_u64 word[4];
} cadt_i256;

/* a b - c d; \pre magnitudes are below 2^63 and the result is below 2^127 */
CADT_FN cadt_i128 cadt_minor_i64(cadt_i64 a, cadt_i64 b, cadt_i64 c, cadt_i64 d) {
  return cadt_add_i128(cadt_mul_i64(a, b), cadt_mul_i64(-c, d));
}

/* Magnitude of a; `negative` becomes all ones or 0. */
CADT_FN cadt_i128 cadt_abs_i128(cadt_i128 a, cadt_u64* negative) {
  const cadt_u64 mask = CADT_CAST(cadt_u64, a.high >> 63), low = (a.low ^ mask) - mask;
  const cadt_u64 high = (CADT_CAST(cadt_u64, a.high) ^ mask) + (mask && low == 0ul ? 1ul : 0ul);
  const cadt_i128 r = {CADT_CAST(cadt_i64, high), low};
  *negative = mask;
  return r;
}

/* sum += a b */
CADT_FN void cadt_add_product_i256(cadt_i256* sum, cadt_i128 a, cadt_i128 b) {
  cadt_u64 sign_a, sign_b, product[4];
  const cadt_i128 x = cadt_abs_i128(a, &sign_a), y = cadt_abs_i128(b, &sign_b);
  const cadt_u64 x1 = CADT_CAST(cadt_u64, x.high), y1 = CADT_CAST(cadt_u64, y.high), sign = sign_a ^ sign_b;
  const cadt_u64 left = x.low * y1, right = x1 * y.low, both = x1 * y1;
  product[0] = x.low * y.low;
  product[1] = cadt_mulhi_u64(x.low, y.low) + left;
  cadt_u64 over = product[1] < left ? 1ul : 0ul;
  product[1] += right;
  over += product[1] < right ? 1ul : 0ul;
  product[2] = cadt_mulhi_u64(x.low, y1) + both;
  product[3] = cadt_mulhi_u64(x1, y1) + (product[2] < both ? 1ul : 0ul);
  const cadt_u64 upper = cadt_mulhi_u64(x1, y.low);
  product[2] += upper;
  product[3] += product[2] < upper ? 1ul : 0ul;
  product[2] += over;
  product[3] += product[2] < over ? 1ul : 0ul;
  cadt_u64 carry = sign & 1ul; /* -v is ~v + 1 */
  for (cadt_i32 i = 0; i < 4; ++i) {
    const cadt_u64 term = product[i] ^ sign, partial = sum->word[i] + term, total = partial + carry;
    carry = (partial < term ? 1ul : 0ul) | (total < partial ? 1ul : 0ul);
    sum->word[i] = total;
  }
}

/* ---- 192-bit integers: two's complement, little-endian ---- */
typedef struct {
  cadt_u64 word[3];
} cadt_i192;

/* sum += a b, modulo 2^192 */
CADT_FN void cadt_add_product_i192(cadt_i192* sum, cadt_i128 a, cadt_i128 b) {
  const cadt_u64 a1 = CADT_CAST(cadt_u64, a.high), b1 = CADT_CAST(cadt_u64, b.high);
  const cadt_u64 left = a.low * b1, right = a1 * b.low, low = a.low * b.low;
  cadt_u64 middle = cadt_mulhi_u64(a.low, b.low) + left;
  cadt_u64 high = cadt_mulhi_u64(a.low, b1) + cadt_mulhi_u64(a1, b.low) + a1 * b1 + (middle < left ? 1ul : 0ul);
  middle += right;
  high += middle < right ? 1ul : 0ul;
  if (a.high < 0) high -= b.low; /* the upper words were taken as unsigned */
  if (b.high < 0) high -= a.low;
  sum->word[0] += low;
  const cadt_u64 carry = sum->word[0] < low ? 1ul : 0ul, partial = sum->word[1] + middle;
  sum->word[1] = partial + carry;
  sum->word[2] += high + (partial < middle ? 1ul : 0ul) + (sum->word[1] < carry ? 1ul : 0ul);
}

CADT_FN cadt_i32 cadt_sign_i192(const cadt_i192* a) {
  if (a->word[2] >> 63) return -1;
  return (a->word[0] | a->word[1] | a->word[2]) != 0ul ? 1 : 0;
}

CADT_FN cadt_i32 cadt_sign_i256(const cadt_i256* a) {
  if (a->word[3] >> 63) return -1;
  return (a->word[0] | a->word[1] | a->word[2] | a->word[3]) != 0ul ? 1 : 0;
}

/* ---- integers of any length: little-endian 32-bit limbs ---- */

/* x = -x, two's complement */
CADT_FN void cadt_limbs_negate(cadt_u32* x, cadt_i32 n) {
  cadt_u32 carry = 1u;
  for (cadt_i32 i = 0; i < n; ++i) {
    x[i] = ~x[i] + carry;
    carry = carry && x[i] == 0u ? 1u : 0u;
  }
}

/* x = value / 2^low, two's complement, n limbs */
CADT_FN void cadt_limbs_load(cadt_u32* x, cadt_i32 n, cadt_real value, cadt_i32 low) {
  cadt_u64 bits = cadt_bits_of_real(value), m = cadt_mantissa(bits);
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
  if (bits >> CADT_SIGN_SHIFT) cadt_limbs_negate(x, n);
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
  cadt_limbs_negate(x, n);
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
