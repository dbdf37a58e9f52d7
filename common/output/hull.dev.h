/* SPDX-License-Identifier: Apache-2.0
 *
 * The hull: edges of the result without a neighbour.
 */
#ifndef CADT_OUTPUT_HULL_H
#define CADT_OUTPUT_HULL_H

#include "common/portable/atomics.dev.h"

/* Lists the boundary edges, counterclockwise, as pairs of input ids in any order. `size` counts them. */
CADT_KERNEL(cadt_boundary_edges, CADT_GLOBAL const cadt_u32* triangles, CADT_GLOBAL const cadt_u32* neighbors,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* pairs, CADT_GLOBAL cadt_u32* size,
            cadt_u32 capacity) {
  CADT_FOR(t, count, grain) {
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      if (neighbors[3u * t + k] != CADT_NONE) continue;
      const cadt_u32 at = cadt_add_relaxed(size, 1u);
      if (at >= capacity) continue;
      pairs[2u * at] = triangles[3u * t + CADT_NEXT(k)];
      pairs[2u * at + 1u] = triangles[3u * t + CADT_PREV(k)];
    }
  }
}

#endif
