/* SPDX-License-Identifier: Apache-2.0
 *
 * Edges by the number of their flips (paper, Fig. 9 and 10).
 */
#ifndef CADT_DEVICE_FLIPS_H
#define CADT_DEVICE_FLIPS_H

#include "common/device/mesh.h"

/* Adds the edges of the finished mesh, ghost edges left out, to the bins of the counters' rows: each edge twice, once
 * from each side. */
CADT_KERNEL(cadt_count_flips, CADT_GLOBAL const cadt_record* records, cadt_u32 slots, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* counters) {
  cadt_u32 bins[CADT_FLIP_BINS];
  for (cadt_u32 bin = 0u; bin < CADT_CAST(cadt_u32, CADT_FLIP_BINS); ++bin) bins[bin] = 0u;
  CADT_FOR(t, slots, grain) {
    const cadt_record r = records[t];
    const cadt_u32 flips = r.word[CADT_WORD_FLIPS];
    if (r.word[CADT_WORD_LOCK] == 0u) continue;
    const cadt_u32 ghost =
        r.word[0] == CADT_GHOST ? 0u : (r.word[1] == CADT_GHOST ? 1u : (r.word[2] == CADT_GHOST ? 2u : 3u));
    if (flips == 0u && ghost == 3u) {
      bins[0] += 3u;
      continue;
    }
    for (cadt_u32 k = 0u; k < 3u; ++k)
      if (ghost == 3u || ghost == k) bins[cadt_min_u32(cadt_flips_get(flips, k), CADT_FLIP_BINS - 1u)]++;
  }
  CADT_GLOBAL cadt_u32* row = cadt_counter_row(counters, cadt_item) + CADT_ROW_FLIPS;
  for (cadt_u32 bin = 0u; bin < CADT_CAST(cadt_u32, CADT_FLIP_BINS); ++bin)
    if (bins[bin]) cadt_add_relaxed(row + bin, bins[bin]);
}

#endif
