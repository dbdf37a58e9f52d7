/* SPDX-License-Identifier: Apache-2.0
 *
 * Orientation and incircle: a filter with a proven bound first, exact integers where it cannot tell, and for incircle
 * the symbolic perturbation of ties. The signs are always right.
 *
 * Filters: forward error bounds as in J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
 * geometric predicates" (1997), stage A. The bounds hold when nothing under- or overflows. In the narrow build the
 * driver has scaled all coordinates to multiples of 2^-240 below 1, so the smallest product of four differences is
 * 2^-960; in the wide build each call checks its differences.
 */
#ifndef CADT_DEVICE_PREDICATES_H
#define CADT_DEVICE_PREDICATES_H

#include "common/device/exact.h"
#include "common/device/tally.h"

/* (3 + 16 u) u and (10 + 96 u) u for u = 2^-53 */
#define CADT_ORIENTATION_BOUND 3.3306690738754716e-16
#define CADT_INCIRCLE_BOUND 1.1102230246251577e-15

#if CADT_WIDE
/* A difference whose products of four neither underflow nor overflow. */
CADT_FN cadt_u32 cadt_tame(double difference) {
  double d = cadt_fabs(difference);
  return d == 0.0 || (d > 1e-70 && d < 1e70) ? 1u : 0u;
}
#endif

CADT_FN cadt_i32 cadt_orientation(cadt_point a, cadt_point b, cadt_point c, cadt_tally* tally) {
  double ux = a.x - c.x, uy = a.y - c.y, vx = b.x - c.x, vy = b.y - c.y;
  double left = ux * vy, right = uy * vx, det = left - right;
  double bound = CADT_ORIENTATION_BOUND * (cadt_fabs(left) + cadt_fabs(right));
#if CADT_WIDE
  if (cadt_tame(ux) && cadt_tame(uy) && cadt_tame(vx) && cadt_tame(vy))
#endif
  {
    if (det > bound) return 1;
    if (-det > bound) return -1;
  }
  tally->count[CADT_COUNT_EXACT_ORIENTATIONS]++;
  return cadt_orientation_exact(a, b, c);
}

/* Lexicographic order of distinct points. */
CADT_FN cadt_u32 cadt_before(cadt_point a, cadt_point b) { return a.x < b.x || (a.x == b.x && a.y < b.y) ? 1u : 0u; }

/* The side of a point p that lies on the circle of the counterclockwise triangle a, b, c: O. Devillers, M. Teillaud,
 * "Perturbations and vertex removal in a 3D Delaunay triangulation" (SODA 2003). The lifted height of each point is
 * raised by a power of an infinitesimal that falls with its lexicographic rank, so the largest point decides: if it is
 * p, p is outside; if it is a vertex, p is inside when the triangle with p in that vertex' place is counterclockwise;
 * if these three are on a line, the next largest decides. 1 inside, -1 outside. */
CADT_FN_SLOW cadt_i32 cadt_tie(cadt_point a, cadt_point b, cadt_point c, cadt_point p, cadt_tally* tally) {
  cadt_u32 spent = 0u; /* bit i: point i (a, b, c) has been the largest already */
  for (cadt_i32 round = 0; round < 3; ++round) {
    cadt_u32 largest = 3u;
    cadt_point top = p;
    if (!(spent & 1u) && cadt_before(top, a)) top = a, largest = 0u;
    if (!(spent & 2u) && cadt_before(top, b)) top = b, largest = 1u;
    if (!(spent & 4u) && cadt_before(top, c)) top = c, largest = 2u;
    if (largest == 3u) return -1;
    spent |= 1u << largest;
    cadt_i32 side = largest == 0u
                        ? cadt_orientation(p, b, c, tally)
                        : (largest == 1u ? cadt_orientation(a, p, c, tally) : cadt_orientation(a, b, p, tally));
    if (side != 0) return side;
  }
  return -1;
}

/* Incircle of the counterclockwise triangle a, b, c and p, never 0. */
CADT_FN cadt_i32 cadt_incircle(cadt_point a, cadt_point b, cadt_point c, cadt_point p, cadt_tally* tally) {
  double ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y, cx = c.x - p.x, cy = c.y - p.y;
  double bxcy = bx * cy, bycx = by * cx, cxay = cx * ay, cyax = cy * ax, axby = ax * by, aybx = ay * bx;
  double alift = ax * ax + ay * ay, blift = bx * bx + by * by, clift = cx * cx + cy * cy;
  double det = alift * (bxcy - bycx) + blift * (cxay - cyax) + clift * (axby - aybx);
  double permanent = alift * (cadt_fabs(bxcy) + cadt_fabs(bycx)) + blift * (cadt_fabs(cxay) + cadt_fabs(cyax)) +
                     clift * (cadt_fabs(axby) + cadt_fabs(aybx));
  double bound = CADT_INCIRCLE_BOUND * permanent;
#if CADT_WIDE
  if (cadt_tame(ax) && cadt_tame(ay) && cadt_tame(bx) && cadt_tame(by) && cadt_tame(cx) && cadt_tame(cy))
#endif
  {
    if (det > bound) return 1;
    if (-det > bound) return -1;
  }
  tally->count[CADT_COUNT_EXACT_INCIRCLES]++;
  cadt_i32 sign = cadt_incircle_exact(a, b, c, p);
  if (sign != 0) return sign;
  tally->count[CADT_COUNT_TIES]++;
  return cadt_tie(a, b, c, p, tally);
}

#endif
