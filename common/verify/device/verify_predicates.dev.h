/* SPDX-License-Identifier: Apache-2.0
 *
 * Predicates of the verifier on the device. They share nothing with those of the builder (filtered_predicates.dev.h,
 * exact_predicates.dev.h, bigint.dev.h), neither code nor formula nor arithmetic: they take coordinates unscaled,
 * compare the two angles opposite an edge instead of a lifted determinant, and where a filter does not decide they use
 * sums of doubles instead of integers. What these cannot represent is left to the verifier of the host
 * (common/verify/host).
 *
 * Edge b-c with a on its left and d on its right, both triangles counterclockwise: d is outside the circle of a, b, c
 * exactly if the angles at a and d add up to less than 180 degrees, that is if
 *
 *   sin(A + D) ~ cross_a dot_d + dot_a cross_d > 0,
 *   cross_a = (b-a) x (c-a), dot_a = (b-a) . (c-a), cross_d = (c-d) x (b-d), dot_d = (c-d) . (b-d)
 *
 * (A. K. Cline, R. J. Renka, 1984). As a polynomial it is the incircle determinant with the opposite sign.
 */
#ifndef CADT_VERIFY_DEVICE_VERIFY_PREDICATES_H
#define CADT_VERIFY_DEVICE_VERIFY_PREDICATES_H

#include "common/portable/dialect.dev.h"

/* A sign that a stage could not decide. */
#define CADT_UNKNOWN 2

/* ---- filters ----------------------------------------------------------------------------------------------------- */

CADT_FN double cadt_larger(double a, double b) {
  const double p = cadt_fabs(a), q = cadt_fabs(b);
  return p > q ? p : q;
}

/* Sign of the area of a, b, c. u = 2^-53; X, Y are the largest computed |dx|, |dy|. Each of the two monomials meets 2
 * roundings of differences, 1 of the product, 1 of the subtraction; 2 more turn true differences into computed ones;
 * the bound is off by 2. So the error is below 2 * 8 u (1 + 16 u) X Y < 32 u X Y = 2^-48 X Y. A product that underflows
 * adds 2^-1075, nothing beside the slack while X, Y > 2^-480. Below 2^500 nothing overflows; NaN and infinity fail the
 * comparisons. Zero is left to the next stage. */
CADT_FN cadt_i32 cadt_verify_turn_filter(cadt_point a, cadt_point b, cadt_point c) {
  const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
  const double X = cadt_larger(bx, cx), Y = cadt_larger(by, cy);
  if (!(X > 0x1p-480 && Y > 0x1p-480 && X < 0x1p500 && Y < 0x1p500)) return CADT_UNKNOWN;
  const double area = bx * cy - by * cx, bound = 0x1p-48 * (X * Y);
  return area > bound ? 1 : (area < -bound ? -1 : CADT_UNKNOWN);
}

/* 1 if the edge b-c between a and d is legal, -1 if not. Each of the 16 monomials meets 4 roundings of differences, 2
 * in the cross, 2 in the dot product, 2 in the sum of products; 4 more turn true differences into computed ones, and
 * the bound is off by 4. The moduli of the monomials add up to at most S = 2 XY (V^2 + W^2) + 2 VW (X^2 + Y^2),   X, Y
 * the largest |dx|, |dy| from a, V, W from d, so the error is below 18 u (1 + 40 u) S < 64 u S / 2 = 2^-47 (S / 2). A
 * product that underflows adds at most 2^-1075 times a factor of S, or 2^-1075: with X, Y, V, W in [2^-220, 2^240] that
 * is below 2^-140 of the slack, and nothing overflows. */
CADT_FN cadt_i32 cadt_verify_edge_filter(cadt_point a, cadt_point b, cadt_point c, cadt_point d) {
  const double abx = b.x - a.x, aby = b.y - a.y, acx = c.x - a.x, acy = c.y - a.y;
  const double dbx = b.x - d.x, dby = b.y - d.y, dcx = c.x - d.x, dcy = c.y - d.y;
  const double X = cadt_larger(abx, acx), Y = cadt_larger(aby, acy);
  const double V = cadt_larger(dbx, dcx), W = cadt_larger(dby, dcy);
  if (!(X > 0x1p-220 && Y > 0x1p-220 && V > 0x1p-220 && W > 0x1p-220)) return CADT_UNKNOWN;
  if (!(X < 0x1p240 && Y < 0x1p240 && V < 0x1p240 && W < 0x1p240)) return CADT_UNKNOWN;
  const double sine =
      (abx * acy - aby * acx) * (dbx * dcx + dby * dcy) + (abx * acx + aby * acy) * (dcx * dby - dcy * dbx);
  const double bound = 0x1p-47 * (X * Y * (V * V + W * W) + V * W * (X * X + Y * Y));
  return sine > bound ? 1 : (sine < -bound ? -1 : CADT_UNKNOWN);
}

/* ---- exact sums of doubles (expansions: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
 * geometric predicates", 1997) ---------------------------------------------------------------------------------------
 * A sum is kept as components that do not overlap, of increasing magnitude, none of them zero. It is exact as long as
 * no operation overflows or loses bits below 2^-1074. Differences are accepted in [2^-216, 2^240] only: as doubles they
 * are multiples of 2^-268, hence all terms of degree 4 multiples of 2^-1072 and below 2^970. */

/* Adds a term; returns the new number of components, at most one more. */
CADT_FN cadt_u32 cadt_sum_add(double* sum, cadt_u32 size, double term) {
  cadt_u32 kept = 0u;
  for (cadt_u32 i = 0u; i < size; ++i) {
    const double e = sum[i], s = term + e, part = s - term;
    const double error = (term - (s - part)) + (e - part);
    term = s;
    if (error != 0.0) sum[kept++] = error;
  }
  if (term != 0.0) sum[kept++] = term;
  return kept;
}

/* Adds a * b: Dekker's product with Veltkamp's split, as not every device has a fused multiply-add. */
CADT_FN cadt_u32 cadt_sum_add_product(double* sum, cadt_u32 size, double a, double b) {
  const double p = a * b, as = 134217729.0 * a, bs = 134217729.0 * b; /* 2^27 + 1 */
  const double ah = as - (as - a), al = a - ah, bh = bs - (bs - b), bl = b - bh;
  const double error = al * bl - (((p - ah * bh) - al * bh) - ah * bl);
  if (error != 0.0) size = cadt_sum_add(sum, size, error);
  return cadt_sum_add(sum, size, p);
}

/* Adds the product of two sums. */
CADT_FN_SLOW cadt_u32 cadt_sum_add_products(double* sum, cadt_u32 size, const double* a, cadt_u32 m, const double* b,
                                            cadt_u32 n) {
  for (cadt_u32 i = 0u; i < m; ++i)
    for (cadt_u32 j = 0u; j < n; ++j) size = cadt_sum_add_product(sum, size, a[i], b[j]);
  return size;
}

/* No two components overlap, so the last outweighs all others. */
CADT_FN cadt_i32 cadt_sum_sign(const double* sum, cadt_u32 size) {
  return size == 0u ? 0 : (sum[size - 1u] > 0.0 ? 1 : -1);
}

/* *d = p - q; returns 1 if that is exact and of a magnitude for which all later steps are exact. */
CADT_FN cadt_u32 cadt_exact_difference(double p, double q, double* d) {
  const double r = p - q, magnitude = cadt_fabs(r);
  *d = r;
  if (r == 0.0) return 1u; /* only for equal numbers */
  if (!(magnitude >= 0x1p-216 && magnitude <= 0x1p240)) return 0u;
  const double q_part = p - r, p_part = r + q_part; /* Knuth's sum of p and -q; its error is zero if both parts fit */
  return (p - p_part) + (q_part - q) == 0.0 ? 1u : 0u;
}

/* u x v and u . v as sums of at most four components */
CADT_FN cadt_u32 cadt_sum_cross(double* sum, double ux, double uy, double vx, double vy) {
  return cadt_sum_add_product(sum, cadt_sum_add_product(sum, 0u, ux, vy), -uy, vx);
}
CADT_FN cadt_u32 cadt_sum_dot(double* sum, double ux, double uy, double vx, double vy) {
  return cadt_sum_add_product(sum, cadt_sum_add_product(sum, 0u, ux, vx), uy, vy);
}

/* Sign of the area of a, b, c, or CADT_UNKNOWN. */
CADT_FN_SLOW cadt_i32 cadt_verify_turn_exact(cadt_point a, cadt_point b, cadt_point c) {
  double bx, by, cx, cy, cross[4];
  cadt_u32 exact = cadt_exact_difference(b.x, a.x, &bx) & cadt_exact_difference(b.y, a.y, &by);
  exact &= cadt_exact_difference(c.x, a.x, &cx) & cadt_exact_difference(c.y, a.y, &cy);
  if (!exact) return CADT_UNKNOWN;
  return cadt_sum_sign(cross, cadt_sum_cross(cross, bx, by, cx, cy));
}

/* 1 if the edge b-c between a and d is legal, -1 if not, 0 for cocircular points, or CADT_UNKNOWN. */
CADT_FN_SLOW cadt_i32 cadt_verify_edge_exact(cadt_point a, cadt_point b, cadt_point c, cadt_point d) {
  double abx, aby, acx, acy, dbx, dby, dcx, dcy;
  cadt_u32 exact = cadt_exact_difference(b.x, a.x, &abx) & cadt_exact_difference(b.y, a.y, &aby);
  exact &= cadt_exact_difference(c.x, a.x, &acx) & cadt_exact_difference(c.y, a.y, &acy);
  exact &= cadt_exact_difference(b.x, d.x, &dbx) & cadt_exact_difference(b.y, d.y, &dby);
  exact &= cadt_exact_difference(c.x, d.x, &dcx) & cadt_exact_difference(c.y, d.y, &dcy);
  if (!exact) return CADT_UNKNOWN;
  double cross[4], dot[4], sine[64]; /* twice 4 x 4 products of two terms each */
  cadt_u32 m = cadt_sum_cross(cross, abx, aby, acx, acy), n = cadt_sum_dot(dot, dbx, dby, dcx, dcy);
  cadt_u32 size = cadt_sum_add_products(sine, 0u, cross, m, dot, n);
  m = cadt_sum_cross(cross, dcx, dcy, dbx, dby);
  n = cadt_sum_dot(dot, abx, aby, acx, acy);
  size = cadt_sum_add_products(sine, size, cross, m, dot, n);
  return cadt_sum_sign(sine, size);
}

/* ---- ties -------------------------------------------------------------------------------------------------------- */

CADT_FN cadt_u32 cadt_is_beyond(cadt_point p, cadt_point q) { return p.x > q.x || (p.x == q.x && p.y > q.y) ? 1u : 0u; }

/* Whether a tie is decided as the symbolic perturbation does. Of the two diagonals of four cocircular points the
 * perturbation of O. Devillers and M. Teillaud (SODA 2003) keeps the one that does not end in the lexicographically
 * greatest of them: that point is lifted by more than all others together; raising an end of an edge makes the edge
 * reflex, raising a point across makes it convex. No orientation is needed, since the two triangles are
 * counterclockwise and cocircular, hence form a strictly convex quadrilateral. */
CADT_FN cadt_u32 cadt_verify_tie_is_usual(cadt_point a, cadt_point b, cadt_point c, cadt_point d) {
  const cadt_point across = cadt_is_beyond(a, d) ? a : d, end = cadt_is_beyond(b, c) ? b : c;
  return cadt_is_beyond(across, end);
}

#endif
