/* SPDX-License-Identifier: Apache-2.0
 *
 * The circumcentre of a triangle. Seen from one of its corners it is, with the other two at u and v,
 *
 *     (v.y |u|^2 - u.y |v|^2, u.x |v|^2 - v.x |u|^2) / 2 cross(u, v)
 *
 * where only the cross product loses digits, if u and v are nearly parallel.
 */
#ifndef CADT_QUERIES_CIRCUMCENTER_H
#define CADT_QUERIES_CIRCUMCENTER_H

#include "common/queries/query_mesh.dev.h"

/* The circumcentre of the origin, u and v, of which `cross` is the cross product. */
CADT_FN cadt_point cadt_center_with_origin(cadt_point u, cadt_point v, cadt_real cross) {
  const cadt_real d = 2.0 * cross, uu = u.x * u.x + u.y * u.y, vv = v.x * v.x + v.y * v.y;
  const cadt_point c = {(v.y * uu - u.y * vv) / d, (u.x * vv - v.x * uu) / d};
  return c;
}
CADT_FN cadt_point cadt_seen_from(cadt_point a, cadt_point p) {
  const cadt_point d = {a.x - p.x, a.y - p.y};
  return d;
}
CADT_FN cadt_real cadt_dot(cadt_point u, cadt_point v) { return u.x * v.x + u.y * v.y; }

/* What rounding leaves of a - b and of a * b (T. J. Dekker, "A floating-point technique for extending the available
 * precision", 1971). */
CADT_FN cadt_real cadt_left_by_difference(cadt_real a, cadt_real b, cadt_real difference) {
  const cadt_real part = a - difference;
  return (a - (difference + part)) + (part - b);
}
CADT_FN cadt_real cadt_left_by_product(cadt_real a, cadt_real b, cadt_real product) {
  const cadt_real wide_a = 134217729.0 * a, wide_b = 134217729.0 * b; /* 2^27 + 1: halves of the digits */
  const cadt_real a1 = wide_a - (wide_a - a), b1 = wide_b - (wide_b - b), a0 = a - a1, b0 = b - b1;
  return a0 * b0 - (((product - a1 * b1) - a0 * b1) - a1 * b0);
}
CADT_FN cadt_point cadt_left_by_seeing(cadt_point a, cadt_point p) {
  const cadt_point left = {cadt_left_by_difference(a.x, p.x, a.x - p.x), cadt_left_by_difference(a.y, p.y, a.y - p.y)};
  return left;
}
#if CADT_WIDE
/* Of the differences that are multiplied by 2^-e, before or, with 1024, after it. */
CADT_FN cadt_point cadt_left_by_scaled(cadt_point a, cadt_point p, cadt_i32 e) {
  if (e == 1024) {
    a.x = cadt_ldexp(a.x, -e), a.y = cadt_ldexp(a.y, -e);
    p.x = cadt_ldexp(p.x, -e), p.y = cadt_ldexp(p.y, -e);
    return cadt_left_by_seeing(a, p);
  }
  const cadt_point left = cadt_left_by_seeing(a, p), scaled = {cadt_ldexp(left.x, -e), cadt_ldexp(left.y, -e)};
  return scaled;
}
#endif
/* A triangle is thin if the cross product of two edges is this little of its terms: it has lost 8 bits of its 53. Then
 * what rounding has left of the edges and the terms is added. Below 2^-90 nothing is known, and the centre is infinite.
 */
#define CADT_LOSSY_CROSS 0.00390625
#define CADT_LOST_CROSS 8.0779356694631609e-28

/* The cross product of u + du and v + dv. */
CADT_FN_SLOW cadt_real cadt_cross_of_thin(cadt_point u, cadt_point v, cadt_point du, cadt_point dv) {
  const cadt_real a = u.x * v.y, b = u.y * v.x, d = a - b;
  const cadt_real left = cadt_left_by_difference(a, b, d) +
                         (cadt_left_by_product(u.x, v.y, a) - cadt_left_by_product(u.y, v.x, b)),
                  of_edges = (u.x * dv.y + du.x * v.y) - (u.y * dv.x + du.y * v.x), least = du.x * dv.y - du.y * dv.x;
  return d + (left + of_edges + least);
}

/* The circumcentre of a triangle, seen from the corner opposite its longest edge: of the two edges there, one at least
 * is short, so a corner that is far from the others does not take the digits of their places. */
typedef struct {
  cadt_point corner, arm;
  cadt_u32 inside; /* 1: the centre is in the triangle, or within rounding of it */
} cadt_center;

CADT_FN cadt_center cadt_center_of(cadt_point a, cadt_point b, cadt_point c) {
  cadt_point ab = cadt_seen_from(b, a), bc = cadt_seen_from(c, b), ca = cadt_seen_from(a, c);
#if CADT_WIDE /* the longest becomes about 1 */
  cadt_i32 e = cadt_exponent_of_largest(ab.x, ab.y, bc.x, bc.y);
  const cadt_i32 other = cadt_exponent_of_largest(ca.x, ca.y, 0.0, 0.0);
  e = other > e ? other : e;
  if (e == CADT_OVERFLOWED) { /* halve first */
    e = 1024;
    ab.x = cadt_ldexp(b.x, -e) - cadt_ldexp(a.x, -e), ab.y = cadt_ldexp(b.y, -e) - cadt_ldexp(a.y, -e);
    bc.x = cadt_ldexp(c.x, -e) - cadt_ldexp(b.x, -e), bc.y = cadt_ldexp(c.y, -e) - cadt_ldexp(b.y, -e);
    ca.x = cadt_ldexp(a.x, -e) - cadt_ldexp(c.x, -e), ca.y = cadt_ldexp(a.y, -e) - cadt_ldexp(c.y, -e);
  } else {
    ab.x = cadt_ldexp(ab.x, -e), ab.y = cadt_ldexp(ab.y, -e);
    bc.x = cadt_ldexp(bc.x, -e), bc.y = cadt_ldexp(bc.y, -e);
    ca.x = cadt_ldexp(ca.x, -e), ca.y = cadt_ldexp(ca.y, -e);
  }
#endif
  /* The square of an edge is the sum of the products at its ends, but for the sign: that at the corner opposite the
   * longest edge is the largest. */
  const cadt_real at_a = cadt_dot(ab, ca), at_b = cadt_dot(ab, bc), at_c = cadt_dot(bc, ca);
  cadt_center center = {a, ab, 0u};
  cadt_point u = ab, v = ca, p = b, q = c;
  cadt_real most = at_a;
  if (at_b > most) center.corner = b, u = bc, v = ab, p = c, q = a, most = at_b;
  if (at_c > most) center.corner = c, u = ca, v = bc, p = a, q = b, most = at_c;
  center.inside = most <= 4.0 * CADT_ORIENTATION_BOUND * (cadt_fabs(u.x * v.x) + cadt_fabs(u.y * v.y)) ? 1u : 0u;
  v.x = -v.x, v.y = -v.y;
  cadt_real cross = cadt_cross(u.x, u.y, v.x, v.y);
  const cadt_real terms = cadt_fabs(u.x * v.y) + cadt_fabs(u.y * v.x);
  if (cadt_fabs(cross) < CADT_LOSSY_CROSS * terms) {
#if CADT_WIDE
    const cadt_point du = cadt_left_by_scaled(p, center.corner, e), dv = cadt_left_by_scaled(q, center.corner, e);
#else
    const cadt_point du = cadt_left_by_seeing(p, center.corner), dv = cadt_left_by_seeing(q, center.corner);
#endif
    cross = cadt_cross_of_thin(u, v, du, dv);
    if (cadt_fabs(cross) < CADT_LOST_CROSS * terms) cross = 0.0;
  }
  center.arm = cadt_center_with_origin(u, v, cross);
#if CADT_WIDE
  center.arm.x = cadt_ldexp(center.arm.x, e), center.arm.y = cadt_ldexp(center.arm.y, e);
#endif
  return center;
}
CADT_FN cadt_center cadt_center_of_triangle(const cadt_query_mesh* m, cadt_u32 t) {
  return cadt_center_of(cadt_corner(m, t, 0u), cadt_corner(m, t, 1u), cadt_corner(m, t, 2u));
}
CADT_FN cadt_point cadt_center_seen_from(cadt_center center, cadt_point p) {
  const cadt_point seen = {center.arm.x + (center.corner.x - p.x), center.arm.y + (center.corner.y - p.y)};
  return seen;
}

#endif
