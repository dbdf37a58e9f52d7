/* SPDX-License-Identifier: Apache-2.0
 *
 * Exact signs, for where the filter does not decide (filtered_predicates.dev.h). Functions of their own, not inlined:
 * they are rare and take many registers.
 */
#ifndef CADT_PREDICATES_EXACT_PREDICATES_H
#define CADT_PREDICATES_EXACT_PREDICATES_H

#include "common/predicates/bigint.dev.h"

/* Marks which integers are taken. Tests count them (tests/unit/predicates/device_predicates.ipp). */
#ifndef CADT_STAGE
#define CADT_STAGE(name) ((void)0)
#endif

/* Sign of the determinant with rows (d0, d1), (d2, d3), of n limbs each; destroys d. */
CADT_FN cadt_i32 cadt_sign_of_minor(cadt_u32 (*d)[CADT_LIMBS], cadt_i32 n) {
  cadt_u32 negative[4], product[2 * CADT_LIMBS], det[2 * CADT_LIMBS + 1];
  for (cadt_i32 i = 0; i < 4; ++i) negative[i] = cadt_limbs_abs(d[i], n);
  for (cadt_i32 i = 0; i < 2 * CADT_LIMBS + 1; ++i) det[i] = 0u;
  cadt_limbs_mul(product, d[0], n, d[3], n);
  cadt_limbs_accumulate(det, 2 * n + 1, product, 2 * n, negative[0] ^ negative[3]);
  cadt_limbs_mul(product, d[1], n, d[2], n);
  cadt_limbs_accumulate(det, 2 * n + 1, product, 2 * n, negative[1] ^ negative[2] ^ 1u);
  return cadt_limbs_sign(det, 2 * n + 1);
}

/* Orientation, by integers of any length. */
CADT_FN_SLOW cadt_i32 cadt_orientation_limbs(cadt_point a, cadt_point b, cadt_point c) {
  cadt_u32 d[4][CADT_LIMBS], origin[CADT_LIMBS];
  CADT_STAGE(orientation_long);
  const cadt_span s = cadt_span_of(a, b, c);
  const cadt_i32 low = s.low, n = (cadt_span_bits(&s) + 2 + 31) >> 5;
  cadt_limbs_load(d[0], n, a.x, low);
  cadt_limbs_load(d[1], n, a.y, low);
  cadt_limbs_load(d[2], n, b.x, low);
  cadt_limbs_load(d[3], n, b.y, low);
  for (cadt_i32 i = 0; i < 4; ++i) {
    cadt_limbs_load(origin, n, (i & 1) ? c.y : c.x, low);
    cadt_limbs_accumulate(d[i], n, origin, n, 1u);
  }
  return cadt_sign_of_minor(d, n);
}

/* Orientation of a, b, c: 1 counterclockwise, 0 on a line, -1 clockwise. */
CADT_FN_SLOW cadt_i32 cadt_orientation_exact(cadt_point a, cadt_point b, cadt_point c) {
  cadt_scale s = cadt_scale_of(cadt_larger_exponent(cadt_larger_exponent(cadt_larger_exponent(0ul, a), b), c));
  if (s.fits) { /* differences < 2^62 */
    const cadt_i64 cx = cadt_scaled(&s, c.x), cy = cadt_scaled(&s, c.y);
    const cadt_i64 ux = cadt_scaled(&s, a.x) - cx, uy = cadt_scaled(&s, a.y) - cy;
    const cadt_i64 vx = cadt_scaled(&s, b.x) - cx, vy = cadt_scaled(&s, b.y) - cy;
    if (s.fits) {
      CADT_STAGE(orientation_128);
      return cadt_compare_i128(cadt_mul_i64(ux, vy), cadt_mul_i64(uy, vx));
    }
  }
  return cadt_orientation_limbs(a, b, c);
}

/* Orientation of m, a, b where m = (c0 + c1 + c2) / 3 is in general no coordinate: tripled, m is an integer. */
CADT_FN_SLOW cadt_i32 cadt_orientation_centroid_exact(cadt_point c0, cadt_point c1, cadt_point c2, cadt_point a,
                                                      cadt_point b) {
  cadt_u32 d[4][CADT_LIMBS], term[CADT_LIMBS];
  cadt_span s = cadt_span_of(c0, c1, c2);
  cadt_span_add_point(&s, a);
  cadt_span_add_point(&s, b);
  cadt_i32 n = (cadt_span_bits(&s) + 4 + 31) >> 5; /* |3 a - c0 - c1 - c2| < 6 * 2^bits */
  for (cadt_i32 i = 0; i < 4; ++i) {
    cadt_real value = i == 0 ? a.x : (i == 1 ? a.y : (i == 2 ? b.x : b.y));
    cadt_limbs_load(term, n, value, s.low);
    for (cadt_i32 j = 0; j < n; ++j) d[i][j] = term[j];
    cadt_limbs_accumulate(d[i], n, term, n, 0u);
    cadt_limbs_accumulate(d[i], n, term, n, 0u);
    cadt_limbs_load(term, n, (i & 1) ? c0.y : c0.x, s.low);
    cadt_limbs_accumulate(d[i], n, term, n, 1u);
    cadt_limbs_load(term, n, (i & 1) ? c1.y : c1.x, s.low);
    cadt_limbs_accumulate(d[i], n, term, n, 1u);
    cadt_limbs_load(term, n, (i & 1) ? c2.y : c2.x, s.low);
    cadt_limbs_accumulate(d[i], n, term, n, 1u);
  }
  return cadt_sign_of_minor(d, n);
}

/* What rounding lost of a + b (D. E. Knuth, "The Art of Computer Programming", vol. 2, 4.2.2). */
CADT_FN cadt_real cadt_lost_by_sum(cadt_real a, cadt_real b, cadt_real sum) {
  const cadt_real part = sum - a;
  return (a - (sum - part)) + (b - part);
}

#if CADT_GRADUAL_UNDERFLOW
/* A sum of two doubles, the second at most half a unit in the last place of the first (T. J. Dekker, "A floating-point
 * technique for extending the available precision", 1971). The self-test checks what this needs of a device: sums and
 * products are rounded to nearest, one by one. */
typedef struct {
  double high, low;
} cadt_pair;

CADT_FN cadt_pair cadt_pair_of(double high, double low) {
  const double sum = high + low;
  const cadt_pair r = {sum, low - (sum - high)};
  return r;
}
/* Exact. */
CADT_FN cadt_pair cadt_pair_difference(double a, double b) {
  const double difference = a - b;
  const cadt_pair r = {difference, cadt_lost_by_sum(a, -b, difference)};
  return r;
}
/* The error is less than 2^-103 of |a| + |b|. */
CADT_FN cadt_pair cadt_pair_sum(cadt_pair a, cadt_pair b) {
  const double sum = a.high + b.high;
  return cadt_pair_of(sum, cadt_lost_by_sum(a.high, b.high, sum) + (a.low + b.low));
}
/* The first 26 bits of the mantissa. */
CADT_FN double cadt_upper_half(double a) {
  const double stretched = 134217729.0 * a; /* 2^27 + 1 */
  return stretched - (stretched - a);
}
/* The error is less than 2^-102 of |a b|. */
CADT_FN cadt_pair cadt_pair_product(cadt_pair a, cadt_pair b) {
  const double product = a.high * b.high;
  const double au = cadt_upper_half(a.high), al = a.high - au, bu = cadt_upper_half(b.high), bl = b.high - bu;
  const double lost = ((au * bu - product) + au * bl + al * bu) + al * bl;
  return cadt_pair_of(product, lost + (a.high * b.low + a.low * b.high));
}
#endif

#if CADT_GRADUAL_UNDERFLOW && !CADT_WIDE
/* The sign of the incircle determinant by sums of two doubles, 0 if they do not decide. The filter's bound is `max_det`
 * / 2, about 2^-50 of the sum of all products' magnitudes; here the errors are less than 2^-97 of that: five roundings
 * of a product, each below 2^-102. */
CADT_FN_SLOW cadt_i32 cadt_incircle_pairs(const cadt_point* q, double max_det) {
  cadt_pair d[6], det; /* an array, and loops that are not unrolled: the caller needs registers */
  CADT_ROLLED
  for (cadt_i32 i = 0; i < 3; ++i) {
    d[2 * i] = cadt_pair_difference(q[i].x, q[3].x);
    d[2 * i + 1] = cadt_pair_difference(q[i].y, q[3].y);
  }
  det.high = det.low = 0.0;
  CADT_ROLLED
  for (cadt_i32 x = 0; x < 6; x += 2) {
    const cadt_i32 u = (x + 2) % 6, v = (x + 4) % 6;
    cadt_pair factor[4], part[2]; /* |d|^2 and the minor of the two others, each a sum of two products */
    CADT_ROLLED
    for (cadt_i32 k = 0; k < 4; ++k) {
      const cadt_i32 i = k < 2 ? x + k : (k == 2 ? u : u + 1), j = k < 2 ? x + k : (k == 2 ? v + 1 : v);
      factor[k] = cadt_pair_product(d[i], d[j]);
    }
    factor[3].high = -factor[3].high;
    factor[3].low = -factor[3].low;
    CADT_ROLLED
    for (cadt_i32 k = 0; k < 2; ++k) part[k] = cadt_pair_sum(factor[2 * k], factor[2 * k + 1]);
    det = cadt_pair_sum(det, cadt_pair_product(part[0], part[1]));
  }
  const double bound = max_det * 0x1p-45;
  return det.high > bound ? 1 : (-det.high > bound ? -1 : 0);
}
#endif

/* Sign of the incircle determinant, by integers of any length. */
CADT_FN_SLOW cadt_i32 cadt_incircle_limbs(cadt_point a, cadt_point b, cadt_point c, cadt_point p) {
  cadt_u32 d[6][CADT_LIMBS], negative[6];
  cadt_u32 product[2 * CADT_LIMBS], lift[2 * CADT_LIMBS + 1], minor[2 * CADT_LIMBS + 1];
  cadt_u32 term[4 * CADT_LIMBS + 2], det[4 * CADT_LIMBS + 3];
  CADT_STAGE(incircle_long);
  cadt_span s = cadt_span_of(a, b, c);
  cadt_span_add_point(&s, p);
  const cadt_i32 low = s.low, n = (cadt_span_bits(&s) + 2 + 31) >> 5;
  for (cadt_i32 i = 0; i < 6; ++i) {
    cadt_point q = i < 2 ? a : (i < 4 ? b : c);
    cadt_limbs_load(d[i], n, (i & 1) ? q.y : q.x, low);
    cadt_limbs_load(product, n, (i & 1) ? p.y : p.x, low);
    cadt_limbs_accumulate(d[i], n, product, n, 1u);
    negative[i] = cadt_limbs_abs(d[i], n);
  }
  for (cadt_i32 i = 0; i < 4 * n + 3; ++i) det[i] = 0u;
  for (cadt_i32 i = 0; i < 3; ++i) {
    cadt_i32 x = 2 * i, y = x + 1;          /* this point */
    cadt_i32 ux = (x + 2) % 6, uy = ux + 1; /* the next one */
    cadt_i32 vx = (x + 4) % 6, vy = vx + 1; /* and the one after */
    cadt_limbs_mul(lift, d[x], n, d[x], n);
    lift[2 * n] = 0u;
    cadt_limbs_mul(product, d[y], n, d[y], n);
    cadt_limbs_accumulate(lift, 2 * n + 1, product, 2 * n, 0u);
    for (cadt_i32 j = 0; j <= 2 * n; ++j) minor[j] = 0u;
    cadt_limbs_mul(product, d[ux], n, d[vy], n);
    cadt_limbs_accumulate(minor, 2 * n + 1, product, 2 * n, negative[ux] ^ negative[vy]);
    cadt_limbs_mul(product, d[uy], n, d[vx], n);
    cadt_limbs_accumulate(minor, 2 * n + 1, product, 2 * n, negative[uy] ^ negative[vx] ^ 1u);
    cadt_u32 sign = cadt_limbs_abs(minor, 2 * n + 1);
    cadt_limbs_mul(term, lift, 2 * n + 1, minor, 2 * n + 1);
    cadt_limbs_accumulate(det, 4 * n + 3, term, 4 * n + 2, sign);
  }
  return cadt_limbs_sign(det, 4 * n + 3);
}

/* A difference of coordinates, and whether it is exact: what rounding lost (D. E. Knuth, "The Art of Computer
 * Programming", vol. 2, 4.2.2). Where subnormal numbers may be 0 that proves nothing. */
CADT_FN cadt_real cadt_difference(cadt_real a, cadt_real b, cadt_u32* exact) {
  const cadt_real difference = a - b, part = difference - a;
  if (!CADT_GRADUAL_UNDERFLOW || (a - (difference - part)) - (b + part) != 0.0) *exact = 0u;
  return difference;
}

#if CADT_GRADUAL_UNDERFLOW && !CADT_WIDE
CADT_FN_SLOW cadt_i32 cadt_incircle_long(const cadt_point* q, cadt_real max_det) {
  const cadt_i32 sign = cadt_incircle_pairs(q, max_det);
  if (sign != 0) {
    CADT_STAGE(incircle_pairs);
    return sign;
  }
  return cadt_incircle_limbs(q[0], q[1], q[2], q[3]);
}
#endif

/* Incircle: 1 if p is inside the circle of the counterclockwise triangle a, b, c, 0 on it, -1 outside. \pre the
 * magnitude of the determinant is at most `max_det` */
CADT_FN_SLOW cadt_i32 cadt_incircle_exact(cadt_point a, cadt_point b, cadt_point c, cadt_point p, cadt_real max_det) {
  cadt_u32 exact = 1u;
  cadt_point d[3];
  d[0].x = cadt_difference(a.x, p.x, &exact);
  d[0].y = cadt_difference(a.y, p.y, &exact);
  d[1].x = cadt_difference(b.x, p.x, &exact);
  d[1].y = cadt_difference(b.y, p.y, &exact);
  d[2].x = cadt_difference(c.x, p.x, &exact);
  d[2].y = cadt_difference(c.y, p.y, &exact);
  /* Of near points the differences are mostly exact, and fit where the coordinates do not. */
  const cadt_u64 none = 0ul;
  cadt_scale s =
      exact ? cadt_scale_of(cadt_larger_exponent(cadt_larger_exponent(cadt_larger_exponent(none, d[0]), d[1]), d[2]))
            : cadt_scale_of(cadt_larger_exponent(
                  cadt_larger_exponent(cadt_larger_exponent(cadt_larger_exponent(none, a), b), c), p));
  if (s.fits) {
    cadt_i64 ax = cadt_scaled(&s, exact ? d[0].x : a.x), ay = cadt_scaled(&s, exact ? d[0].y : a.y);
    cadt_i64 bx = cadt_scaled(&s, exact ? d[1].x : b.x), by = cadt_scaled(&s, exact ? d[1].y : b.y);
    cadt_i64 cx = cadt_scaled(&s, exact ? d[2].x : c.x), cy = cadt_scaled(&s, exact ? d[2].y : c.y);
    if (!exact) {
      const cadt_i64 px = cadt_scaled(&s, p.x), py = cadt_scaled(&s, p.y);
      ax -= px, ay -= py;
      bx -= px, by -= py;
      cx -= px, cy -= py;
    }
    if (s.fits) {
#if CADT_GRADUAL_UNDERFLOW
      /* As integers without a common factor 2. If then the determinant is below 2^191, its value modulo 2^192 gives its
       * sign, whatever its terms lose. */
      const cadt_u64 bits = CADT_CAST(cadt_u64, ax | ay | bx | by | cx | cy);
      const cadt_i32 zeros = bits ? cadt_trailing_zeros(bits) : 0;
      const double unit = s.scale * cadt_double_of_bits(CADT_CAST(cadt_u64, 1023 - zeros) << 52), square = unit * unit;
      /* |differences| < 2^62: lifts and minors < 2^125, sums of products < 3 * 2^250. Loops keep it short. */
      if (max_det * square * square < 1.5e57) { /* 2^190 */
        CADT_STAGE(incircle_192);
        cadt_i192 det;
        for (cadt_i32 i = 0; i < 3; ++i) det.word[i] = 0ul;
        ax >>= zeros, ay >>= zeros, bx >>= zeros, by >>= zeros, cx >>= zeros, cy >>= zeros;
        CADT_ROLLED
        for (cadt_i32 corner = 0; corner < 3; ++corner) {
          cadt_add_product_i192(&det, cadt_minor_i64(ax, ax, -ay, ay), cadt_minor_i64(bx, cy, by, cx));
          const cadt_i64 x = ax, y = ay;
          ax = bx, ay = by;
          bx = cx, by = cy;
          cx = x, cy = y;
        }
        return cadt_sign_i192(&det);
      }
#else
      (void)max_det;
#endif
      CADT_STAGE(incircle_256);
      cadt_i256 det;
      for (cadt_i32 i = 0; i < 4; ++i) det.word[i] = 0ul;
      CADT_ROLLED
      for (cadt_i32 corner = 0; corner < 3; ++corner) {
        cadt_add_product_i256(&det, cadt_minor_i64(ax, ax, -ay, ay), cadt_minor_i64(bx, cy, by, cx));
        const cadt_i64 x = ax, y = ay;
        ax = bx, ay = by;
        bx = cx, by = cy;
        cx = x, cy = y;
      }
      return cadt_sign_i256(&det);
    }
  }
#if CADT_GRADUAL_UNDERFLOW && !CADT_WIDE
  cadt_point q[4];
  q[0] = a;
  q[1] = b;
  q[2] = c;
  q[3] = p;
  return cadt_incircle_long(q, max_det);
#else
  return cadt_incircle_limbs(a, b, c, p);
#endif
}

#endif
