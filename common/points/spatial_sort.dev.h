/* SPDX-License-Identifier: Apache-2.0
 *
 * Ties of the spatial sort. Points are sorted by their Hilbert keys (hilbert_keys.dev.h, radix_sort.dev.h). Points with
 * equal keys form a run: short runs are sorted in place here, those in over-full cells by key refinement.
 */
#ifndef CADT_POINTS_SPATIAL_SORT_H
#define CADT_POINTS_SPATIAL_SORT_H

#include "common/portable/atomics.dev.h"
#include "common/portable/layout.dev.h"

enum {
  CADT_RUN = 32 /* longest run of equal keys that is sorted in place; longer ones are refined (key_refinement.dev.h) */
};

CADT_FN cadt_u32 cadt_lexicographic(cadt_point a, cadt_u32 i, cadt_point b, cadt_u32 j) {
  if (!cadt_same(a.x, b.x)) return cadt_less(a.x, b.x) ? 1u : 0u;
  if (!cadt_same(a.y, b.y)) return cadt_less(a.y, b.y) ? 1u : 0u;
  return i < j ? 1u : 0u;
}

#if CADT_BUILDS(POINTS)
/* Sorts each run of at most CADT_RUN equal keys lexicographically, equal points by index. Longer runs stay as they are,
 * and totals[CADT_OVERFULL] becomes 1; after refinement (key_refinement.dev.h) they are equal points ordered by index.
 */
CADT_KERNEL(cadt_sort_runs, CADT_GLOBAL const cadt_u32* keys, CADT_GLOBAL cadt_point* sorted,
            CADT_GLOBAL cadt_u32* order, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* totals) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 key = keys[i];
    if ((i > 0u && keys[i - 1u] == key) || i + 1u >= count || keys[i + 1u] != key) continue;
    cadt_u32 end = i + 2u;
    while (end < count && end <= i + CADT_RUN && keys[end] == key) ++end;
    if (end > i + CADT_RUN) {
      cadt_store_relaxed(totals + CADT_OVERFULL, 1u);
      continue;
    }
    for (cadt_u32 a = i + 1u; a < end; ++a) {
      const cadt_point p = sorted[a];
      const cadt_u32 id = order[a];
      cadt_u32 b = a;
      for (; b > i && cadt_lexicographic(p, id, sorted[b - 1u], order[b - 1u]); --b) {
        sorted[b] = sorted[b - 1u];
        order[b] = order[b - 1u];
      }
      sorted[b] = p;
      order[b] = id;
    }
  }
}
#endif

#endif
