/* SPDX-License-Identifier: Apache-2.0
 *
 * Which vertices of a tile's mesh are open. A triangle is certain if its closed circumscribed disc lies in the open box
 * by a one-sided bound: no point outside of the box can change it. A vertex is open if a triangle at it is not certain,
 * or if it is on the hull (docs/scale.md has the proof).
 *
 *      max_y +--------------------+
 *            |   .---.            |
 *            |  / /\  \    .---.  |      the disc of p q r lies in the box: certain
 *            | | /  \  |  / .s. \ |
 *            |  p----q/  | /   \ ||      that of s t u does not: s, t and u are open
 *            |   '-r-'   t------u |.
 *            |            '.____.'|
 *      min_y +--------------------+
 *          min_x                max_x
 *
 * All is computed by additions, subtractions and multiplications of doubles in a fixed order, none of them fused, so
 * every device comes to the same answer. What is unsure, overflows or is no number is not certain: a vertex that stays
 * open too long costs time, and nothing else.
 */
#ifndef CADT_FINALIZATION_CERTAIN_H
#define CADT_FINALIZATION_CERTAIN_H

#include "common/mesh/mesh_view.dev.h"
#include "common/portable/atomics.dev.h"

/* The box, and the scale that makes the extent of the points about 1: two powers of two. */
typedef struct {
  cadt_real min_x, min_y, max_x, max_y, scale, scale_again;
} cadt_tile_box;
#define CADT_TILE_BOX_PARAMETERS \
  cadt_real min_x, cadt_real min_y, cadt_real max_x, cadt_real max_y, cadt_real scale, cadt_real scale_again
#define CADT_TILE_BOX(box) const cadt_tile_box box = {min_x, min_y, max_x, max_y, scale, scale_again}

/* a - b, scaled; each is rounded once, and the scale rounds nothing but subnormal numbers. */
CADT_FN cadt_real cadt_scaled_difference(const cadt_tile_box* box, cadt_real a, cadt_real b) {
  return a * box->scale * box->scale_again - b * box->scale * box->scale_again;
}

/* Whether |n| < side by more than all rounding errors, for n of squared length `square`. */
CADT_FN cadt_u32 cadt_is_within(cadt_real square, cadt_real side) {
  return side > 0.0 && square < side * side * (1.0 - 0x1p-20) ? 1u : 0u;
}

/* Whether the closed disc of the triangle a b c lies in the open box. With B = b - a, C = c - a, u = 2^-53:
 *
 *   centre = a + n / d,   n = (Cy |B|^2 - By |C|^2, Bx |C|^2 - Cx |B|^2),   d = 2 (Bx Cy - By Cx),   radius = |n| / d
 *
 * The disc stays right of min_x if |n| < (a.x - min_x) d + n.x, and so on. Differences are off by u of themselves, so n
 * is off by less than 8u M with M = |B|^2 (|Cx| + |Cy|) + |C|^2 (|Bx| + |By|), and d by less than 8u P with P = |Bx Cy|
 * + |By Cx|. d >= 2^-24 P makes the relative error of d less than 2^-26; three errors of n are taken off, 32u M each;
 * 2^-20 of each product is far more than what else is rounded. d > 2^-500 and an extent of 1 keep what underflows below
 * 2^-550 of M. */
CADT_FN cadt_u32 cadt_is_certain(const cadt_tile_box* box, cadt_point a, cadt_point b, cadt_point c) {
  const cadt_real bx = cadt_scaled_difference(box, b.x, a.x), by = cadt_scaled_difference(box, b.y, a.y);
  const cadt_real cx = cadt_scaled_difference(box, c.x, a.x), cy = cadt_scaled_difference(box, c.y, a.y);
  const cadt_real b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const cadt_real left = bx * cy, right = by * cx, d = 2.0 * (left - right);
  if (!(d > 0x1p-500 && d >= 0x1p-24 * (cadt_fabs(left) + cadt_fabs(right)))) return 0u;
  const cadt_real nx = cy * b2 - by * c2, ny = bx * c2 - cx * b2, square = nx * nx + ny * ny;
  const cadt_real error = 3.0 * 0x1p-48 * (b2 * (cadt_fabs(cx) + cadt_fabs(cy)) + c2 * (cadt_fabs(bx) + cadt_fabs(by)));
  const cadt_real reach = d * (1.0 - 0x1p-20);
  return cadt_is_within(square, cadt_scaled_difference(box, a.x, box->min_x) * reach + nx - error) &&
                 cadt_is_within(square, cadt_scaled_difference(box, box->max_x, a.x) * reach - nx - error) &&
                 cadt_is_within(square, cadt_scaled_difference(box, a.y, box->min_y) * reach + ny - error) &&
                 cadt_is_within(square, cadt_scaled_difference(box, box->max_y, a.y) * reach - ny - error)
             ? 1u
             : 0u;
}

/* open[v] = 1 for open vertices; it begins as 0. `kept`: 1 for triangles that no child covers, null for a leaf, where
 * all are. The ends of hull edges are open also where the triangle inside is covered. */
CADT_KERNEL(cadt_mark_open, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* kept, CADT_TILE_BOX_PARAMETERS,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* open) {
  CADT_MESH_VIEW(mesh);
  CADT_TILE_BOX(box);
  CADT_FOR(t, mesh.triangles, grain) {
    cadt_u32 v[3];
    for (cadt_u32 k = 0u; k < 3u; ++k) v[k] = cadt_vertex_of(&mesh, t, k);
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      if (cadt_neighbor_of(&mesh, t, k) != CADT_NONE) continue;
      cadt_store_relaxed(open + CADT_PICK(k, v[1], v[2], v[0]), 1u);
      cadt_store_relaxed(open + CADT_PICK(k, v[2], v[0], v[1]), 1u);
    }
    if (kept && !kept[t]) continue;
    if (cadt_is_certain(&box, cadt_load_point(mesh.points + v[0]), cadt_load_point(mesh.points + v[1]),
                        cadt_load_point(mesh.points + v[2])))
      continue;
    for (cadt_u32 k = 0u; k < 3u; ++k) cadt_store_relaxed(open + v[k], 1u);
  }
}

#endif
