/* SPDX-License-Identifier: Apache-2.0
 *
 * Orientation and incircle: a filter with a proven bound first, exact integers where it cannot tell, and for incircle
 * the symbolic perturbation of ties. The signs are always right.
 *
 * Filters: forward error bounds as in J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
 * geometric predicates" (1997), stage A. The bounds hold when nothing under- or overflows. In the narrow build the
 * driver has scaled all coordinates to multiples of 2^-240 below 1, so the smallest product of four differences is
 * 2^-960; in the wide build each call scales its differences.
 * So it does in the build for floats, where what may be lost is more: devices without gradual underflow take subnormal
 * coordinates for 0, and make subnormal differences and products 0 (docs/decisions/0015-float-path.md).
 */
#ifndef CADT_PREDICATES_FILTERED_PREDICATES_H
#define CADT_PREDICATES_FILTERED_PREDICATES_H

#include "common/portable/counters.dev.h"
#include "common/predicates/exact_predicates.dev.h"

/* (3 + 16 u) u and (10 + 96 u) u for u = 2^-53, for u = 2^-24 */
#if !CADT_FLOAT
#define CADT_ORIENTATION_BOUND 3.3306690738754716e-16
#define CADT_INCIRCLE_BOUND 1.1102230246251577e-15
#else
#define CADT_ORIENTATION_BOUND 1.78813991e-7f
#define CADT_INCIRCLE_BOUND 5.96046789e-7f
#endif

#if CADT_WIDE
/* The wide build scales the differences of a call by a power of two to at most 1, which does not change the sign. Then
 * nothing overflows, and what is lost by underflow, here and in the products, is below CADT_UNDERFLOW altogether.
 *
 * Floats: to less than 4, with a factor of 2^-126 to 2^41. A difference has lost 3 * 2^-126 at most (two coordinates
 * and itself), and 2^-126 once more after scaling, so it is off by e < 2^-83. A product of two is off by 8.1 e, a lift
 * and a minor by 16.5 e, and since both are below 32, their product by 1060 e; three of them by less than 2^-71. The
 * allowance is 2^-60, so that what its own addition rounds off does not matter. */
#if CADT_FLOAT
#define CADT_UNDERFLOW 8.67361738e-19f
#define CADT_SCALED_EXPONENT 128
#define CADT_SCALES(e) ((e) < 5000 && (e) >= -41) /* the largest difference is 2^-40 at least */
#else
#define CADT_UNDERFLOW 1e-300
#define CADT_SCALED_EXPONENT 1022
#define CADT_SCALES(e) ((e) < 5000)
#endif

/* Exponent of the largest magnitude, 5000 if a difference has overflowed. */
CADT_FN cadt_i32 cadt_exponent_of_largest(cadt_real a, cadt_real b, cadt_real c, cadt_real d) {
  const cadt_u64 mask = CADT_EXPONENT_MASK;
  cadt_u64 top = cadt_bits_of_real(a) & mask;
  if ((cadt_bits_of_real(b) & mask) > top) top = cadt_bits_of_real(b) & mask;
  if ((cadt_bits_of_real(c) & mask) > top) top = cadt_bits_of_real(c) & mask;
  if ((cadt_bits_of_real(d) & mask) > top) top = cadt_bits_of_real(d) & mask;
  return top == mask ? 5000 : CADT_CAST(cadt_i32, top >> CADT_MANTISSA_BITS) - CADT_SCALED_EXPONENT;
}
#else
#define CADT_UNDERFLOW 0.0
#endif

#define CADT_UNSURE 2
/* Orientation of a, b, c, or CADT_UNSURE if the filter cannot tell. */
CADT_FN cadt_i32 cadt_orientation_filter(cadt_point a, cadt_point b, cadt_point c) {
  cadt_real ux = a.x - c.x, uy = a.y - c.y, vx = b.x - c.x, vy = b.y - c.y;
#if CADT_WIDE
  /* x and y apart: the determinant is linear in either */
  const cadt_i32 ex = cadt_exponent_of_largest(ux, vx, 0.0, 0.0), ey = cadt_exponent_of_largest(uy, vy, 0.0, 0.0);
  if (!CADT_SCALES(ex) || !CADT_SCALES(ey)) return CADT_UNSURE;
  ux = cadt_ldexp(ux, -ex);
  vx = cadt_ldexp(vx, -ex);
  uy = cadt_ldexp(uy, -ey);
  vy = cadt_ldexp(vy, -ey);
#endif
  const cadt_real left = ux * vy, right = uy * vx, det = left - right;
  const cadt_real bound = CADT_ORIENTATION_BOUND * (cadt_fabs(left) + cadt_fabs(right)) + CADT_UNDERFLOW;
  if (det > bound) return 1;
  if (-det > bound) return -1;
  /* 0: both products are 0, and nothing underflows: points along an axis, as lattices have */
  return bound == 0.0 ? 0 : CADT_UNSURE;
}

CADT_FN cadt_i32 cadt_orientation(cadt_point a, cadt_point b, cadt_point c, cadt_counters* counters) {
  counters->count[CADT_COUNT_ORIENTATION_TESTS]++;
  const cadt_i32 sign = cadt_orientation_filter(a, b, c);
  if (sign != CADT_UNSURE) return sign;
  counters->count[CADT_COUNT_EXACT_ORIENTATIONS]++;
  return cadt_orientation_exact(a, b, c);
}

/* Lexicographic order of distinct points. */
CADT_FN cadt_u32 cadt_before(cadt_point a, cadt_point b) {
  return cadt_less(a.x, b.x) || (cadt_same(a.x, b.x) && cadt_less(a.y, b.y)) ? 1u : 0u;
}

/* The side of a point p that lies on the circle of the counterclockwise triangle a, b, c: O. Devillers, M. Teillaud,
 * "Perturbations and vertex removal in a 3D Delaunay triangulation" (SODA 2003). The lifted height of each point is
 * raised by a power of an infinitesimal that falls with its lexicographic rank, so the largest point decides: if it is
 * p, p is outside; if it is a vertex, p is inside when the triangle with p in that vertex' place is counterclockwise;
 * if these three are on a line, the next largest decides. 1 inside, -1 outside. */
CADT_FN_SLOW cadt_i32 cadt_tie(cadt_point a, cadt_point b, cadt_point c, cadt_point p) {
  cadt_u32 spent = 0u; /* bit i: point i (a, b, c) has been the largest already */
  for (cadt_i32 round = 0; round < 3; ++round) {
    cadt_u32 largest = 3u;
    cadt_point top = p;
    if (!(spent & 1u) && cadt_before(top, a)) top = a, largest = 0u;
    if (!(spent & 2u) && cadt_before(top, b)) top = b, largest = 1u;
    if (!(spent & 4u) && cadt_before(top, c)) top = c, largest = 2u;
    if (largest == 3u) return -1;
    spent |= 1u << largest;
    const cadt_point x = largest == 0u ? p : a, y = largest == 1u ? p : b, z = largest == 2u ? p : c;
    cadt_i32 side = cadt_orientation_filter(x, y, z);
    if (side == CADT_UNSURE) side = cadt_orientation_exact(x, y, z);
    if (side != 0) return side;
  }
  return -1;
}

/* Whether two sums are equal: both as they are rounded, and what was lost (D. E. Knuth, "The Art of Computer
 * Programming", vol. 2, 4.2.2). */
CADT_FN cadt_real cadt_lost_by_sum(cadt_real a, cadt_real b, cadt_real sum) {
  const cadt_real part = sum - a;
  return (a - (sum - part)) + (b - part);
}
CADT_FN cadt_u32 cadt_equal_sums(cadt_real a, cadt_real b, cadt_real c, cadt_real d) {
  const cadt_real left = a + b, right = c + d;
  return left == right && cadt_lost_by_sum(a, b, left) == cadt_lost_by_sum(c, d, right) ? 1u : 0u;
}

/* Whether a line along an axis mirrors a to b and c to d. Then they are on a circle. */
CADT_FN cadt_u32 cadt_mirrored_pairs(cadt_point a, cadt_point b, cadt_point c, cadt_point d) {
  if (a.y == b.y && c.y == d.y) return cadt_equal_sums(a.x, b.x, c.x, d.x);
  return a.x == b.x && c.x == d.x ? cadt_equal_sums(a.y, b.y, c.y, d.y) : 0u;
}

/* Most ties of lattices and of symmetric figures: known without long integers, where underflow is gradual. */
CADT_FN cadt_u32 cadt_mirrored(cadt_point a, cadt_point b, cadt_point c, cadt_point d) {
  return cadt_mirrored_pairs(a, b, c, d) || cadt_mirrored_pairs(a, c, b, d) || cadt_mirrored_pairs(a, d, b, c) ? 1u
                                                                                                               : 0u;
}

/* A point seen from another one. */
typedef struct {
  cadt_real x, y, lift;
} cadt_lifted_vector;

CADT_FN cadt_lifted_vector cadt_lifted_vector_of(cadt_point from, cadt_point to) {
  cadt_lifted_vector arm;
  arm.x = to.x - from.x;
  arm.y = to.y - from.y;
  arm.lift = arm.x * arm.x + arm.y * arm.y;
  return arm;
}

/* CPUs share what is known of a point that many triangles are tested with. */
#define CADT_SHARED_LIFTS (CADT_CONTIGUOUS && !CADT_WIDE)
#if CADT_SHARED_LIFTS
/* A filter for points seen from p, 0 if it cannot tell. It is that of cadt_incircle with a bound that takes fewer
 * operations but is larger, much so where the points are in a row along an axis: |bx cy| + |by cx| <= (|b|^2 + |c|^2) /
 * 2 and so on. The factor makes up for its own rounding errors, a few times 2^-53. */
CADT_FN cadt_i32 cadt_incircle_loose_filter(cadt_lifted_vector a, cadt_lifted_vector b, cadt_lifted_vector c) {
  const cadt_real det =
      a.lift * (b.x * c.y - b.y * c.x) + b.lift * (c.x * a.y - c.y * a.x) + c.lift * (a.x * b.y - a.y * b.x);
  const cadt_real bound =
      CADT_INCIRCLE_BOUND * 1.00000000000001 * (a.lift * b.lift + b.lift * c.lift + c.lift * a.lift);
  if (det > bound) return 1;
  return -det > bound ? -1 : 0;
}
#define CADT_FN_STAGED CADT_FN_SLOW /* it is seldom asked */
#else
#define CADT_FN_STAGED CADT_FN
#endif

/* The sign of the incircle determinant by rounded numbers; 0 if they cannot tell: then its magnitude is at most `most`.
 */
CADT_FN cadt_i32 cadt_incircle_filter(cadt_point a, cadt_point b, cadt_point c, cadt_point p, cadt_real* max_det) {
  cadt_real ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y, cx = c.x - p.x, cy = c.y - p.y;
  *max_det = CADT_INFINITY;
#if CADT_WIDE
  const cadt_i32 e0 = cadt_exponent_of_largest(ax, ay, bx, by), e1 = cadt_exponent_of_largest(cx, cy, 0.0, 0.0);
  const cadt_i32 e = e0 > e1 ? e0 : e1;
  if (!CADT_SCALES(e)) return 0;
  ax = cadt_ldexp(ax, -e);
  ay = cadt_ldexp(ay, -e);
  bx = cadt_ldexp(bx, -e);
  by = cadt_ldexp(by, -e);
  cx = cadt_ldexp(cx, -e);
  cy = cadt_ldexp(cy, -e);
#endif
  const cadt_real bxcy = bx * cy, bycx = by * cx, cxay = cx * ay, cyax = cy * ax, axby = ax * by, aybx = ay * bx;
  const cadt_real alift = ax * ax + ay * ay, blift = bx * bx + by * by, clift = cx * cx + cy * cy;
  const cadt_real det = alift * (bxcy - bycx) + blift * (cxay - cyax) + clift * (axby - aybx);
  const cadt_real permanent = alift * (cadt_fabs(bxcy) + cadt_fabs(bycx)) +
                              blift * (cadt_fabs(cxay) + cadt_fabs(cyax)) + clift * (cadt_fabs(axby) + cadt_fabs(aybx));
  const cadt_real bound = CADT_INCIRCLE_BOUND * permanent + CADT_UNDERFLOW;
  if (det > bound) return 1;
  if (-det > bound) return -1;
#if !CADT_WIDE
  *max_det = 2.0 * bound;
#endif
  return 0;
}

/* Incircle of the counterclockwise triangle a, b, c and p, never 0. */
CADT_FN_STAGED cadt_i32 cadt_incircle_staged(cadt_point a, cadt_point b, cadt_point c, cadt_point p,
                                             cadt_counters* counters) {
  cadt_real max_det;
  const cadt_i32 rounded = cadt_incircle_filter(a, b, c, p, &max_det);
  if (rounded != 0) return rounded;
  counters->count[CADT_COUNT_EXACT_INCIRCLES]++;
  if (CADT_GRADUAL_UNDERFLOW && cadt_mirrored(a, b, c, p)) {
    CADT_STAGE(mirrored);
  } else {
    const cadt_i32 sign = cadt_incircle_exact(a, b, c, p, max_det);
    if (sign != 0) return sign;
  }
  counters->count[CADT_COUNT_TIES]++;
  return cadt_tie(a, b, c, p);
}

CADT_FN cadt_i32 cadt_incircle(cadt_point a, cadt_point b, cadt_point c, cadt_point p, cadt_counters* counters) {
#if CADT_SHARED_LIFTS
  const cadt_i32 sign =
      cadt_incircle_loose_filter(cadt_lifted_vector_of(p, a), cadt_lifted_vector_of(p, b), cadt_lifted_vector_of(p, c));
  if (sign != 0) return sign;
#endif
  return cadt_incircle_staged(a, b, c, p, counters);
}

#endif
