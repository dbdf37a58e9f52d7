/* SPDX-License-Identifier: Apache-2.0
 *
 * Orientation and incircle in stages: a floating-point filter with a proven error bound first, exact integers where it
 * does not decide, and for incircle the symbolic perturbation of ties. The signs are always right.
 *
 * Filters: forward error bounds as in J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
 * geometric predicates" (1997), stage A. The bounds hold if nothing under- or overflows. In the narrow variant the
 * driver has scaled all coordinates to multiples of 2^-240 below 1, so the smallest product of four differences is
 * 2^-960; in the wide variant each call scales its differences. So it does in the variant for floats, where more may be
 * lost: devices without gradual underflow take subnormal coordinates for 0, and make subnormal differences and products
 * 0 (docs/decisions/0004-exact-integers-and-floats.md).
 */
#ifndef CADT_PREDICATES_FILTERED_PREDICATES_H
#define CADT_PREDICATES_FILTERED_PREDICATES_H

#include "common/portable/counters.dev.h"
#include "common/predicates/exact_predicates.dev.h"

/* (3 + 16 u) u and (10 + 96 u) u, for u = 2^-53 and for u = 2^-24 */
#if !CADT_FLOAT
#define CADT_ORIENTATION_BOUND 3.3306690738754716e-16
#define CADT_INCIRCLE_BOUND 1.1102230246251577e-15
#else
#define CADT_ORIENTATION_BOUND 1.78813991e-7f
#define CADT_INCIRCLE_BOUND 5.96046789e-7f
#endif

#if CADT_WIDE
/* The wide variant scales the differences of a call by a power of two to at most 1, which does not change the sign.
 * Then nothing overflows, and all that underflow loses, here and in the products, is below CADT_UNDERFLOW.
 *
 * Floats are scaled to less than 4, with a factor of 2^-126 to 2^41. A difference has lost 3 * 2^-126 at most (two
 * coordinates and itself), and 2^-126 once more after scaling, so its error is e < 2^-83. The error of a product of two
 * is 8.1 e, that of a lift and of a minor 16.5 e, and since both are below 32, that of their product 1060 e; that of
 * three products is less than 2^-71. The allowance is 2^-60, so that the rounding of its own addition does not matter.
 */
#define CADT_OVERFLOWED 5000 /* in place of an exponent: a difference has overflowed */
#if CADT_FLOAT
#define CADT_UNDERFLOW 8.67361738e-19f
#define CADT_SCALED_EXPONENT 128
#define CADT_SCALES(e) ((e) < CADT_OVERFLOWED && (e) >= -41) /* the largest difference is at least 2^-40 */
#else
#define CADT_UNDERFLOW 1e-300
#define CADT_SCALED_EXPONENT 1022
#define CADT_SCALES(e) ((e) < CADT_OVERFLOWED)
#endif

/* Exponent of the largest magnitude, or CADT_OVERFLOWED. */
CADT_FN cadt_i32 cadt_exponent_of_largest(cadt_real a, cadt_real b, cadt_real c, cadt_real d) {
  const cadt_u64 mask = CADT_EXPONENT_MASK;
  cadt_u64 top = cadt_bits_of_real(a) & mask;
  if ((cadt_bits_of_real(b) & mask) > top) top = cadt_bits_of_real(b) & mask;
  if ((cadt_bits_of_real(c) & mask) > top) top = cadt_bits_of_real(c) & mask;
  if ((cadt_bits_of_real(d) & mask) > top) top = cadt_bits_of_real(d) & mask;
  return top == mask ? CADT_OVERFLOWED : CADT_CAST(cadt_i32, top >> CADT_MANTISSA_BITS) - CADT_SCALED_EXPONENT;
}
#else
#define CADT_UNDERFLOW 0.0
#endif

#define CADT_UNSURE 2
/* Orientation of a, b, c, or CADT_UNSURE if the filter does not decide. */
CADT_FN cadt_i32 cadt_orientation_filter(cadt_point a, cadt_point b, cadt_point c) {
  cadt_real ux = a.x - c.x, uy = a.y - c.y, vx = b.x - c.x, vy = b.y - c.y;
#if CADT_WIDE
  /* x and y apart: the determinant is linear in each */
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
 * p, p is outside; if it is a vertex, p is inside when the triangle with p in place of that vertex is counterclockwise;
 * if those three are on a line, the next largest decides. 1 inside, -1 outside. */
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

/* Whether two sums are equal: both the rounded sums and what rounding lost. */
CADT_FN cadt_u32 cadt_equal_sums(cadt_real a, cadt_real b, cadt_real c, cadt_real d) {
  const cadt_real left = a + b, right = c + d;
  return left == right && cadt_lost_by_sum(a, b, left) == cadt_lost_by_sum(c, d, right) ? 1u : 0u;
}

/* Whether a reflection in a line along an axis takes a to b and c to d. Then they are on a circle. */
CADT_FN cadt_u32 cadt_mirrored_pairs(cadt_point a, cadt_point b, cadt_point c, cadt_point d) {
  if (a.y == b.y && c.y == d.y) return cadt_equal_sums(a.x, b.x, c.x, d.x);
  return a.x == b.x && c.x == d.x ? cadt_equal_sums(a.y, b.y, c.y, d.y) : 0u;
}

/* Most ties of lattices and of symmetric figures: found without long integers, where underflow is gradual. */
CADT_FN cadt_u32 cadt_mirrored(cadt_point a, cadt_point b, cadt_point c, cadt_point d) {
  return cadt_mirrored_pairs(a, b, c, d) || cadt_mirrored_pairs(a, c, b, d) || cadt_mirrored_pairs(a, d, b, c) ? 1u
                                                                                                               : 0u;
}

/* The vector from one point to another, and its square: its height when lifted to the paraboloid. */
typedef struct {
  cadt_real x, y, lift;
} cadt_lifted_vector;

CADT_FN cadt_lifted_vector cadt_lifted_vector_of(cadt_point from, cadt_point to) {
  const cadt_real x = to.x - from.x, y = to.y - from.y;
  const cadt_lifted_vector arm = {x, y, x * x + y * y};
  return arm;
}

/* On CPUs many triangles are tested with the same point: they share these vectors. */
#define CADT_SHARED_LIFTS (CADT_CONTIGUOUS && !CADT_WIDE)
#if CADT_SHARED_LIFTS
/* A filter for points seen from p, 0 if it does not decide. Its bound takes fewer operations than that of
 * cadt_incircle_filter but is larger, much so where the points are in a row along an axis: |bx cy| + |by cx| <= (|b|^2
 * +
 * c|^2) / 2 and so on. The factor makes up for its own rounding errors, a few times 2^-53.
 */
CADT_FN cadt_i32 cadt_incircle_loose_filter(cadt_lifted_vector a, cadt_lifted_vector b, cadt_lifted_vector c) {
  const cadt_real det =
      a.lift * (b.x * c.y - b.y * c.x) + b.lift * (c.x * a.y - c.y * a.x) + c.lift * (a.x * b.y - a.y * b.x);
  const cadt_real bound =
      CADT_INCIRCLE_BOUND * 1.00000000000001 * (a.lift * b.lift + b.lift * c.lift + c.lift * a.lift);
  if (det > bound) return 1;
  return -det > bound ? -1 : 0;
}
#define CADT_FN_STAGED CADT_FN_SLOW /* it is seldom called */
#else
#define CADT_FN_STAGED CADT_FN
#endif

/* The floating-point filter of incircle: the sign, or 0 if it does not decide; then the determinant's magnitude is at
 * most `max_det`. */
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

/* Incircle of the counterclockwise triangle a, b, c and p, never 0, by the filter, exactly, and by perturbation. */
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
