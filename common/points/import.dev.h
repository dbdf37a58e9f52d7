/* SPDX-License-Identifier: Apache-2.0
 *
 * Import: the caller's coordinates become points of the device; and points gathered by index. Both scale by powers of
 * two.
 */
#ifndef CADT_POINTS_IMPORT_H
#define CADT_POINTS_IMPORT_H

#include "common/portable/layout.dev.h"

/* A coordinate times two powers of two (one factor may not reach all of a double's exponents); -0.0 becomes 0.0. Floats
 * stay as they are: a product could lose bits, and all comparisons of floats treat -0.0 and 0.0 as equal. */
CADT_FN cadt_real cadt_multiplied(cadt_real x, cadt_real scale, cadt_real scale_again) {
#if CADT_GRADUAL_UNDERFLOW
  return x * scale * scale_again + 0.0;
#else
  (void)scale, (void)scale_again;
  return x;
#endif
}

CADT_FN cadt_point cadt_multiplied_point(cadt_point p, cadt_real scale, cadt_real scale_again) {
  p.x = cadt_multiplied(p.x, scale, scale_again);
  p.y = cadt_multiplied(p.y, scale, scale_again);
  return p;
}

/* Points from the caller's memory: coordinate i of an axis is at first + i * stride. With `order`: the points that it
 * lists, times both factors; null: all points, unscaled. */
#define CADT_IMPORT_KERNEL(name, type)                                                                        \
  CADT_KERNEL(name, CADT_GLOBAL const type* x, CADT_GLOBAL const type* y, cadt_u32 first_x, cadt_u32 first_y, \
              cadt_u32 stride, CADT_GLOBAL const cadt_u32* order, cadt_real scale, cadt_real scale_again,     \
              CADT_GLOBAL cadt_point* points, cadt_u32 count, cadt_u32 grain) {                               \
    CADT_FOR(i, count, grain) {                                                                               \
      const cadt_u32 at = order ? order[i] : i;                                                               \
      const cadt_point p = {CADT_CAST(cadt_real, x[first_x + at * stride]),                                   \
                            CADT_CAST(cadt_real, y[first_y + at * stride])};                                  \
      points[i] = order ? cadt_multiplied_point(p, scale, scale_again) : p;                                   \
    }                                                                                                         \
  }
#if CADT_BUILDS(POINTS)
#if !CADT_FLOAT
CADT_IMPORT_KERNEL(cadt_import_doubles, double)
#endif
CADT_IMPORT_KERNEL(cadt_import_floats, float)

/* Points in the order of `order`, scaled. */
CADT_KERNEL(cadt_gather_points, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* order,
            CADT_GLOBAL cadt_point* sorted, cadt_u32 count, cadt_u32 grain, cadt_real scale, cadt_real scale_again) {
  CADT_FOR(i, count, grain) { sorted[i] = cadt_multiplied_point(points[order[i]], scale, scale_again); }
}
#endif

#endif
