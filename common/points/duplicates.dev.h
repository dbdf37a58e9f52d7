/* SPDX-License-Identifier: Apache-2.0
 *
 * Duplicates: equal points stand side by side in sorted order, the one with the lowest index first. It represents the
 * others.
 */
#ifndef CADT_POINTS_DUPLICATES_H
#define CADT_POINTS_DUPLICATES_H

#include "common/points/point_profile.dev.h"

/* flags[i] = 1 where a point differs from the one before, else 0; equal points of different sets have different keys.
 * totals[CADT_EQUAL] counts the zeros; from CADT_SHAPE_BESIDE on stand the counts of the sample: CADT_SHAPE_BESIDE is
 * positive if some point is beside the line, the others are numbers of points. The sample needs many registers, but
 * most work-items only compare: the launch bound keeps as many resident as possible. \pre totals are 0 */
CADT_TEAM_KERNEL(128, 12, cadt_unique_flags, CADT_GLOBAL const cadt_point* sorted, CADT_GLOBAL const cadt_u32* keys,
                 CADT_GLOBAL cadt_u32* flags, cadt_u32 count, cadt_u32 grain, cadt_u32 neighbours,
                 CADT_GLOBAL cadt_u32* totals) {
  const cadt_u32 samples = cadt_min_u32(count, CADT_POINT_SAMPLES);
  cadt_u32 sum = 0u;
  for (cadt_u32 s = cadt_item; s < samples; s += cadt_items)
    cadt_count_shapes(sorted, count, s * (count / samples), neighbours, totals);
  CADT_FOR(i, count, grain) {
    const cadt_u32 flag = i == 0u || keys[i] != keys[i - 1u] || !cadt_same(sorted[i].x, sorted[i - 1u].x) ||
                                  !cadt_same(sorted[i].y, sorted[i - 1u].y)
                              ? 1u
                              : 0u;
    flags[i] = flag;
    sum += 1u - flag;
  }
  if (sum) cadt_add_relaxed(totals + CADT_EQUAL, sum);
}

/* Moves the distinct points together. `ranks` is the exclusive scan of the flags. */
CADT_KERNEL(cadt_unique_pack, CADT_GLOBAL const cadt_point* sorted, CADT_GLOBAL const cadt_u32* order,
            CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL cadt_point* points, CADT_GLOBAL cadt_u32* input_ids,
            cadt_u32 count, cadt_u32 distinct, cadt_u32 grain) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 rank = ranks[i], next = i + 1u < count ? ranks[i + 1u] : distinct;
    if (next == rank) continue;
    points[rank] = sorted[i];
    input_ids[rank] = order[i];
  }
}

/* The duplicates: each point that equals an earlier one, and the representative of both. */
CADT_KERNEL(cadt_duplicate_pairs, CADT_GLOBAL const cadt_u32* order, CADT_GLOBAL const cadt_u32* ranks,
            CADT_GLOBAL const cadt_u32* input_ids, CADT_GLOBAL cadt_u32* duplicates,
            CADT_GLOBAL cadt_u32* representatives, cadt_u32 count, cadt_u32 distinct, cadt_u32 grain) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 rank = ranks[i], next = i + 1u < count ? ranks[i + 1u] : distinct;
    if (next != rank) continue;
    const cadt_u32 at = i - rank; /* number of duplicates before this one */
    duplicates[at] = order[i];
    representatives[at] = input_ids[rank - 1u];
  }
}

#endif
