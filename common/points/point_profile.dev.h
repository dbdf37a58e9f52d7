/* SPDX-License-Identifier: Apache-2.0
 *
 * Shapes of the point set that decide on the strategy: a sample of the sorted points is compared with its neighbours in
 * order, and with points far away.
 */
#ifndef CADT_POINTS_POINT_PROFILE_H
#define CADT_POINTS_POINT_PROFILE_H

#include "common/portable/atomics.dev.h"
#include "common/portable/layout.dev.h"
#include "common/predicates/filtered_predicates.dev.h"

/* Whether CADT_HULL_PROBES points spread over the sorted order lie on one side of the line from point i to the next, as
 * far as rounded arithmetic shows. Few points that are not on the hull pass. */
CADT_FN cadt_u32 cadt_seems_on_hull(CADT_GLOBAL const cadt_point* sorted, cadt_u32 count, cadt_u32 i) {
  if (i + 1u >= count) return 0u;
  const cadt_point a = sorted[i], b = sorted[i + 1u];
  const cadt_real x = b.x - a.x, y = b.y - a.y;
  const cadt_u32 step = count / CADT_HULL_PROBES;
  cadt_u32 left = 0u, right = 0u, at = i + step / 2u;
  for (cadt_u32 k = 0u; k < CADT_CAST(cadt_u32, CADT_HULL_PROBES); ++k, at += step) {
    const cadt_point q = sorted[at % count];
    const cadt_real side = x * (q.y - a.y) - y * (q.x - a.x);
    left |= side > 0.0 ? 1u : 0u;
    right |= side < 0.0 ? 1u : 0u;
  }
  return left ^ right;
}

/* The shape of four points that follow one another, as far as the floating-point filter shows: CADT_SHAPE_LINE,
 * collinear; cocircular: CADT_SHAPE_MIRRORED if a cheap exact test decides, as on an axis-parallel lattice, else
 * CADT_SHAPE_CIRCLE; or CADT_NONE. */
CADT_FN cadt_u32 cadt_shape_of(CADT_GLOBAL const cadt_point* p) {
  cadt_real most;
  for (cadt_u32 k = 0u; k < 3u; ++k)
    if (cadt_same(p[k].x, p[k + 1u].x) && cadt_same(p[k].y, p[k + 1u].y)) return CADT_NONE;
  if (cadt_incircle_filter(p[0], p[1], p[2], p[3], &most) != 0) return CADT_NONE;
  if (cadt_orientation_filter(p[0], p[1], p[2]) == CADT_UNSURE &&
      cadt_orientation_filter(p[1], p[2], p[3]) == CADT_UNSURE)
    return CADT_SHAPE_LINE;
  return cadt_mirrored(p[0], p[1], p[2], p[3]) ? CADT_SHAPE_MIRRORED : CADT_SHAPE_CIRCLE;
}

/* Adds point i of the sample to `totals` (CADT_SHAPE_...): certainly beside the line through two points; cocircular
 * with three far points, as far as the filter shows; on the hull; and with `neighbours`, its shape with the next three
 * points. */
CADT_FN void cadt_count_shapes(CADT_GLOBAL const cadt_point* sorted, cadt_u32 count, cadt_u32 i, cadt_u32 neighbours,
                               CADT_GLOBAL cadt_u32* totals) {
  const cadt_u32 far = count / 4u;
  const cadt_i32 side = cadt_orientation_filter(sorted[0], sorted[count / 2u], sorted[i]);
  cadt_real most;
  if (side == 1 || side == -1) cadt_store_relaxed(totals + CADT_SHAPE_BESIDE, 1u);
  if (cadt_incircle_filter(sorted[(i + far) % count], sorted[(i + 2u * far) % count], sorted[(i + 3u * far) % count],
                           sorted[i], &most) == 0)
    cadt_add_relaxed(totals + CADT_SHAPE_ONE_CIRCLE, 1u);
  if (cadt_seems_on_hull(sorted, count, i)) cadt_add_relaxed(totals + CADT_SHAPE_HULL, 1u);
  if (neighbours && i + 3u < count) {
    const cadt_u32 shape = cadt_shape_of(sorted + i);
    if (shape != CADT_NONE) cadt_add_relaxed(totals + shape, 1u);
  }
}

#endif
