/* SPDX-License-Identifier: Apache-2.0
 *
 * Histogram of edges by the number of their flips (paper, Fig. 9 and 10), without ghost edges. A kernel that reads all
 * locked triangles of the finished mesh anyway counts each edge twice, once from each side.
 *
 *   CADT_FLIPS_BEGIN(bins, rows);              before anything else in the kernel
 *   CADT_FLIPS_COUNT(bins, rows, triangle);    in its loop
 *   CADT_FLIPS_END(bins, rows);                behind it
 *
 * `rows` has CADT_FLIP_BINS words for each of CADT_COUNTER_ROWS, or is null: then nothing is counted.
 */
#ifndef CADT_OVERLAY_FLIP_HISTOGRAM_H
#define CADT_OVERLAY_FLIP_HISTOGRAM_H

#include "common/mesh/locked_mesh.dev.h"
#include "common/portable/counters.dev.h"

/* The slot of the ghost, 3 if there is none. */
CADT_FN cadt_u32 cadt_ghost_slot(const cadt_locked_triangle* r) {
  return r->word[0] == CADT_GHOST ? 0u : (r->word[1] == CADT_GHOST ? 1u : (r->word[2] == CADT_GHOST ? 2u : 3u));
}

#if CADT_GROUP_SUMS
/* Edges with 0, 1, ..., 15 or more flips: 8 bits each, in two words. */
typedef struct {
  cadt_u64 low, high;
  cadt_u32 triangles; /* since the last flush */
} cadt_flip_bins;

enum { CADT_BINS_FULL = 255 / 3 }; /* triangles until the bins must be flushed */

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

CADT_FN void cadt_bins_flush(cadt_flip_bins* bins, CADT_LOCAL_PTR cadt_u32* sums) {
  for (cadt_u32 bin = 0u; bin < CADT_CAST(cadt_u32, CADT_FLIP_BINS); ++bin)
    if (cadt_bins_get(bins, bin)) cadt_team_add(sums + bin, cadt_bins_get(bins, bin));
  bins->low = bins->high = 0u;
  bins->triangles = 0u;
}

CADT_FN void cadt_bins_add_triangle(cadt_flip_bins* bins, CADT_LOCAL_PTR cadt_u32* sums,
                                    const cadt_locked_triangle* r) {
  const cadt_u32 flips = r->word[CADT_WORD_FLIPS], ghost = cadt_ghost_slot(r);
  if (flips == 0u && ghost == 3u) {
    bins->low += 3u;
  } else {
    for (cadt_u32 k = 0u; k < 3u; ++k)
      if (ghost == 3u || ghost == k) cadt_bins_add(bins, cadt_flips_get(flips, k));
  }
  if (++bins->triangles == CADT_CAST(cadt_u32, CADT_BINS_FULL)) cadt_bins_flush(bins, sums);
}

CADT_FN void cadt_bins_end(cadt_flip_bins* bins, CADT_LOCAL_PTR cadt_u32* sums, CADT_GLOBAL cadt_u32* rows) {
  cadt_bins_flush(bins, sums);
  cadt_group_barrier();
  CADT_GLOBAL cadt_u32* row = rows + cadt_item / cadt_group_items % CADT_COUNTER_ROWS * CADT_FLIP_BINS;
  for (cadt_u32 bin = cadt_item_of_group; bin < CADT_CAST(cadt_u32, CADT_FLIP_BINS); bin += cadt_group_items)
    if (sums[bin]) cadt_add_relaxed(row + bin, sums[bin]);
}

#define CADT_FLIPS_BEGIN(bins, rows)                    \
  CADT_LOCAL cadt_u32 flip_sums[CADT_FLIP_BINS];        \
  if (rows) cadt_clear_sums(flip_sums, CADT_FLIP_BINS); \
  cadt_flip_bins bins = {0u, 0u, 0u}
#define CADT_FLIPS_COUNT(bins, rows, triangle) \
  if (rows) cadt_bins_add_triangle(&bins, flip_sums, &(triangle))
#define CADT_FLIPS_END(bins, rows) \
  if (rows) cadt_bins_end(&bins, flip_sums, (rows))
#else
/* One row of bins for each slot: most edges have the same few flip counts, and an addition would wait for the one
 * before. */
typedef struct {
  cadt_u32 bin[3][CADT_FLIP_BINS];
} cadt_flip_bins;

CADT_FN void cadt_bins_clear(cadt_flip_bins* bins) {
  for (cadt_u32 k = 0u; k < 3u; ++k)
    for (cadt_u32 bin = 0u; bin < CADT_CAST(cadt_u32, CADT_FLIP_BINS); ++bin) bins->bin[k][bin] = 0u;
}

CADT_FN void cadt_bins_add_triangle(cadt_flip_bins* bins, const cadt_locked_triangle* r) {
  const cadt_u32 ghost = cadt_ghost_slot(r);
  for (cadt_u32 k = 0u; k < 3u; ++k)
    if (ghost == 3u || ghost == k)
      bins->bin[k][cadt_min_u32(cadt_flips_get(r->word[CADT_WORD_FLIPS], k), CADT_FLIP_BINS - 1u)]++;
}

CADT_FN void cadt_bins_end(const cadt_flip_bins* bins, CADT_GLOBAL cadt_u32* rows, cadt_u32 item) {
  CADT_GLOBAL cadt_u32* row = rows + item % CADT_COUNTER_ROWS * CADT_FLIP_BINS;
  for (cadt_u32 bin = 0u; bin < CADT_CAST(cadt_u32, CADT_FLIP_BINS); ++bin) {
    const cadt_u32 sum = bins->bin[0][bin] + bins->bin[1][bin] + bins->bin[2][bin];
    if (sum) cadt_add_relaxed(row + bin, sum);
  }
}

#define CADT_FLIPS_BEGIN(bins, rows) \
  cadt_flip_bins bins;               \
  cadt_bins_clear(&bins)
#define CADT_FLIPS_COUNT(bins, rows, triangle) \
  if (rows) cadt_bins_add_triangle(&bins, &(triangle))
#define CADT_FLIPS_END(bins, rows) \
  if (rows) cadt_bins_end(&bins, (rows), cadt_item)
#endif

#endif
