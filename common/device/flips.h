/* SPDX-License-Identifier: Apache-2.0
 *
 * Edges by the number of their flips (paper, Fig. 9 and 10).
 */
#ifndef CADT_DEVICE_FLIPS_H
#define CADT_DEVICE_FLIPS_H

#include "common/device/mesh.h"
#include "common/device/tally.h"

/* The slot of the ghost, 3 if there is none. */
CADT_FN cadt_u32 cadt_ghost_slot(const cadt_record r) {
  return r.word[0] == CADT_GHOST ? 0u : (r.word[1] == CADT_GHOST ? 1u : (r.word[2] == CADT_GHOST ? 2u : 3u));
}

#if CADT_GROUP_SUMS
/* Counts of edges with 0, 1, ..., 15 or more flips: 8 bits each, in two words. */
typedef struct {
  cadt_u64 low, high;
} cadt_flip_bins;

enum { CADT_BINS_FULL = 255 / 3 }; /* triangles until the sums must be passed on */

CADT_FN void cadt_bins_add(cadt_flip_bins* bins, cadt_u32 flips) {
  const cadt_u32 bin = cadt_min_u32(flips, CADT_FLIP_BINS - 1u);
  const cadt_u64 one = CADT_CAST(cadt_u64, 1u) << (8u * (bin & 7u));
  if (bin < 8u)
    bins->low += one;
  else
    bins->high += one;
}

CADT_FN cadt_u32 cadt_bins_get(const cadt_flip_bins* bins, cadt_u32 bin) {
  return CADT_CAST(cadt_u32, (bin < 8u ? bins->low : bins->high) >> (8u * (bin & 7u))) & 255u;
}

CADT_FN void cadt_bins_pass_on(cadt_flip_bins* bins, CADT_SUMS cadt_u32* sums) {
  for (cadt_u32 bin = 0u; bin < CADT_CAST(cadt_u32, CADT_FLIP_BINS); ++bin)
    if (cadt_bins_get(bins, bin)) cadt_add_sum(sums + bin, cadt_bins_get(bins, bin));
  bins->low = bins->high = 0u;
}

#endif

/* Adds the edges of the finished mesh, ghost edges left out, to the bins of the counters' rows: each edge twice, once
 * from each side. */
CADT_KERNEL(cadt_count_flips, CADT_GLOBAL const cadt_record* records, cadt_u32 slots, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* counters) {
#if CADT_GROUP_SUMS
  CADT_LOCAL cadt_u32 sums[CADT_GROUP_WORDS];
  cadt_clear_group_sums(sums);
  cadt_flip_bins bins = {0u, 0u};
  cadt_u32 triangles = 0u;
  CADT_FOR(t, slots, grain) {
    const cadt_record r = records[t];
    const cadt_u32 flips = r.word[CADT_WORD_FLIPS];
    if (r.word[CADT_WORD_LOCK] == 0u) continue;
    const cadt_u32 ghost = cadt_ghost_slot(r);
    if (flips == 0u && ghost == 3u) {
      bins.low += 3u;
    } else {
      for (cadt_u32 k = 0u; k < 3u; ++k)
        if (ghost == 3u || ghost == k) cadt_bins_add(&bins, cadt_flips_get(flips, k));
    }
    if (++triangles % CADT_BINS_FULL == 0u) cadt_bins_pass_on(&bins, sums);
  }
  cadt_bins_pass_on(&bins, sums);
  if (!cadt_is_last_of_group(sums + CADT_GROUP_DONE)) return;
  CADT_GLOBAL cadt_u32* row = cadt_counter_row(counters, cadt_item / cadt_group_items) + CADT_ROW_FLIPS;
  for (cadt_u32 bin = 0u; bin < CADT_CAST(cadt_u32, CADT_FLIP_BINS); ++bin) {
    const cadt_u32 sum = cadt_add_local(sums + bin, 0u);
    if (sum) cadt_add_relaxed(row + bin, sum);
  }
#else
  /* One row of bins for each slot: most edges have the same few numbers of flips, and an addition would wait for the
   * one before. */
  cadt_u32 bins[3][CADT_FLIP_BINS];
  for (cadt_u32 k = 0u; k < 3u; ++k)
    for (cadt_u32 bin = 0u; bin < CADT_CAST(cadt_u32, CADT_FLIP_BINS); ++bin) bins[k][bin] = 0u;
  CADT_FOR(t, slots, grain) {
    const cadt_record r = records[t];
    if (r.word[CADT_WORD_LOCK] == 0u) continue;
    const cadt_u32 ghost = cadt_ghost_slot(r);
    for (cadt_u32 k = 0u; k < 3u; ++k)
      if (ghost == 3u || ghost == k)
        bins[k][cadt_min_u32(cadt_flips_get(r.word[CADT_WORD_FLIPS], k), CADT_FLIP_BINS - 1u)]++;
  }
  CADT_GLOBAL cadt_u32* sums = cadt_counter_row(counters, cadt_item) + CADT_ROW_FLIPS;
  for (cadt_u32 bin = 0u; bin < CADT_CAST(cadt_u32, CADT_FLIP_BINS); ++bin) {
    const cadt_u32 sum = bins[0][bin] + bins[1][bin] + bins[2][bin];
    if (sum) cadt_add_relaxed(sums + bin, sum);
  }
#endif
}

#endif
