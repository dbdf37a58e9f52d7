/* SPDX-License-Identifier: Apache-2.0
 *
 * Stabilised flips (paper, section 4.4.4): edges that were flipped too often are no longer flipped at once. Off, this
 * is one comparison.
 */
#ifndef CADT_OVERLAY_STABILIZED_FLIPS_H
#define CADT_OVERLAY_STABILIZED_FLIPS_H

#include "common/mesh/locked_mesh.dev.h"

/* Smallest angle of the triangle with vertices 0, u and v: the one between the two longer sides. It has the largest dot
 * product, and all three have the same cross product. */
CADT_FN cadt_real cadt_smallest_angle(cadt_real ux, cadt_real uy, cadt_real vx, cadt_real vy) {
  const cadt_real at_0 = ux * vx + uy * vy, at_u = ux * (ux - vx) + uy * (uy - vy),
                  at_v = vx * (vx - ux) + vy * (vy - uy);
  cadt_real largest = at_0 > at_u ? at_0 : at_u;
  if (at_v > largest) largest = at_v;
  return cadt_atan2(cadt_fabs(ux * vy - uy * vx), largest);
}

/* The quality check of the paper's Algorithm 4: whether it pays to flip the illegal edge a, b to p, q. It does if the
 * determinant, with lengths in units of the largest coordinate difference, is not near zero, or if the smallest angle
 * grows, in degrees. (The paper names no units. With radians, or with the determinant alone, the mesh of perturbed
 * circles would differ by 2.8 to 4.3 %, and not by less than the paper's 0.3 %: docs/evaluation.md.) */
CADT_FN_SLOW cadt_u32 cadt_flip_gains(cadt_point p, cadt_point a, cadt_point b, cadt_point q, cadt_real epsilon) {
  cadt_real d[6], unit = 0.0;
  d[0] = p.x - q.x, d[1] = p.y - q.y, d[2] = a.x - q.x, d[3] = a.y - q.y, d[4] = b.x - q.x, d[5] = b.y - q.y;
  for (cadt_u32 i = 0u; i < 6u; ++i)
    if (cadt_fabs(d[i]) > unit) unit = cadt_fabs(d[i]);
  for (cadt_u32 i = 0u; i < 6u; ++i) d[i] /= unit;
  const cadt_real px = d[0], py = d[1], ax = d[2], ay = d[3], bx = d[4], by = d[5];
  const cadt_real p2 = px * px + py * py, a2 = ax * ax + ay * ay, b2 = bx * bx + by * by;
  const cadt_real det = p2 * (ax * by - bx * ay) + a2 * (bx * py - px * by) + b2 * (px * ay - ax * py);
  if (det >= epsilon) return 1u;
  /* from q: triangles q, b, a and p, a, b before; p, a, q and q, b, p after */
  const cadt_real before_1 = cadt_smallest_angle(bx, by, ax, ay);
  const cadt_real before_2 = cadt_smallest_angle(ax - px, ay - py, bx - px, by - py);
  const cadt_real after_1 = cadt_smallest_angle(px, py, ax, ay), after_2 = cadt_smallest_angle(bx, by, px, py);
  const cadt_real before = before_1 < before_2 ? before_1 : before_2, after = after_1 < after_2 ? after_1 : after_2;
  return (after - before) * 57.295779513082323 > epsilon ? 1u : 0u; /* NaN (a difference overflowed): no gain */
}

/* Whether the illegal edge a, b, edge k of triangle t, stays because it was flipped too often. Hull edges do not: the
 * hull must be convex. */
CADT_FN cadt_u32 cadt_is_stabilized(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 k, cadt_u32 p, cadt_u32 a,
                                    cadt_u32 b, cadt_u32 q) {
  if (m->stabilize == CADT_CAST(cadt_u32, CADT_STABILIZE_OFF)) return 0u;
  if (cadt_flips_get(cadt_load_field(m->locked[t].word + CADT_WORD_FLIPS), k) <= m->threshold) return 0u;
  if (a == CADT_GHOST || b == CADT_GHOST) return 0u;
  if (m->stabilize == CADT_CAST(cadt_u32, CADT_STABILIZE_DEFER)) return 1u;
  return cadt_flip_gains(cadt_point_of(m, p), cadt_point_of(m, a), cadt_point_of(m, b), cadt_point_of(m, q), m->epsilon)
             ? 0u
             : 1u;
}

#endif
