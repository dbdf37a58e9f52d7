/* SPDX-License-Identifier: Apache-2.0
 *
 * Refinement of over-full cells. Sort keys of 32 bits are too coarse for skewed data: 99.9 % of the points may share
 * one key, and a walk among unsorted points of a cell is long. Runs of equal keys longer than CADT_RUN are therefore
 * sorted again by more bits: those of the coordinates as ordered integers, 16 bits an axis and round. After four rounds
 * (two for floats) all bits have been used, so points that still share a key are equal.
 */
#ifndef CADT_POINTS_KEY_REFINEMENT_H
#define CADT_POINTS_KEY_REFINEMENT_H

#include "common/points/hilbert_keys.dev.h"
#include "common/points/spatial_sort.dev.h"

/* Flags the members of runs longer than CADT_RUN; totals[0] counts them. */
CADT_KERNEL(cadt_flag_overfull, CADT_GLOBAL const cadt_u32* keys, CADT_GLOBAL cadt_u32* flags, cadt_u32 count,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* totals) {
  cadt_u32 sum = 0u;
  CADT_FOR(i, count, grain) {
    const cadt_u32 key = keys[i];
    /* a run is long if it has CADT_RUN + 1 members: look for two members that far apart around i */
    cadt_u32 begin = i, end = i;
    while (begin > 0u && i - begin < CADT_RUN && keys[begin - 1u] == key) --begin;
    while (end + 1u < count && end - begin < CADT_RUN && keys[end + 1u] == key) ++end;
    const cadt_u32 flag = end - begin >= CADT_RUN ? 1u : 0u;
    flags[i] = flag;
    sum += flag;
  }
  if (sum) cadt_add_relaxed(totals, sum);
}

/* Places of the flagged points. `ranks` is the exclusive scan of the flags, `total` its sum. */
CADT_KERNEL(cadt_pack_overfull, CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL cadt_u32* places, cadt_u32 count,
            cadt_u32 total, cadt_u32 grain) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 next = i + 1u < count ? ranks[i + 1u] : total;
    if (next != ranks[i]) places[ranks[i]] = i;
  }
}

/* A coordinate as an integer in the same order; -0.0 and 0.0 are equal. */
CADT_FN cadt_u64 cadt_ordered_bits(cadt_real x) {
#if CADT_GRADUAL_UNDERFLOW
  const cadt_u64 bits = cadt_bits_of_double(x + 0.0);
  return bits >> 63 ? ~bits : bits | 0x8000000000000000ul;
#else
  return CADT_CAST(cadt_u64, CADT_CAST(cadt_u32, cadt_float_order(x)) + 0x80000000u) << 32;
#endif
}

/* Keys of a round (0 to 3) for the members at `places`, their points, and tails[j] = 1 where a run ends: the exclusive
 * scan of the tails numbers the runs. `fresh` counts the members that differ from the next one of their run: if there
 * are none, the round changes nothing. */
CADT_KERNEL(cadt_refined_keys, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* order,
            CADT_GLOBAL const cadt_u32* keys, CADT_GLOBAL const cadt_u32* places, CADT_GLOBAL cadt_u32* round_keys,
            CADT_GLOBAL cadt_u32* members, CADT_GLOBAL cadt_u32* tails, cadt_u32 total, cadt_u32 round, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* fresh) {
  const cadt_u32 shift = 48u - 16u * round;
  cadt_u32 sum = 0u;
  CADT_FOR(j, total, grain) {
    const cadt_u32 at = places[j], id = order[at];
    const cadt_point p = points[id];
    const cadt_u64 x = cadt_ordered_bits(p.x), y = cadt_ordered_bits(p.y);
    round_keys[j] = cadt_spread_bits(CADT_CAST(cadt_u32, (x >> shift) & 0xFFFFul)) |
                    (cadt_spread_bits(CADT_CAST(cadt_u32, (y >> shift) & 0xFFFFul)) << 1);
    members[j] = id;
    const cadt_u32 tail = j + 1u == total || keys[at] != keys[places[j + 1u]] ? 1u : 0u;
    tails[j] = tail;
    if (!tail) {
      const cadt_point q = points[order[places[j + 1u]]];
      if (((((x ^ cadt_ordered_bits(q.x)) | (y ^ cadt_ordered_bits(q.y))) >> shift) & 0xFFFFul) != 0ul) ++sum;
    }
  }
  if (sum) cadt_add_relaxed(fresh, sum);
}

CADT_KERNEL(cadt_copy_words, CADT_GLOBAL const cadt_u32* in, CADT_GLOBAL cadt_u32* out, cadt_u32 first, cadt_u32 count,
            cadt_u32 grain) {
  CADT_FOR(j, count, grain) { out[first + j] = in[j]; }
}

/* 0, 1, 2, ... */
CADT_KERNEL(cadt_identity, CADT_GLOBAL cadt_u32* out, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(j, count, grain) { out[j] = j; }
}

/* out[j] = in[index[j]] */
CADT_KERNEL(cadt_gather_words, CADT_GLOBAL const cadt_u32* in, CADT_GLOBAL const cadt_u32* index,
            CADT_GLOBAL cadt_u32* out, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(j, count, grain) { out[j] = in[index[j]]; }
}

/* 1 where a run of equal keys ends. `low`: the low words of the keys, or null. */
CADT_KERNEL(cadt_run_tails, CADT_GLOBAL const cadt_u32* keys, CADT_GLOBAL const cadt_u32* low,
            CADT_GLOBAL cadt_u32* tails, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(i, count, grain) {
    tails[i] = i + 1u == count || keys[i] != keys[i + 1u] || (low && low[i] != low[i + 1u]) ? 1u : 0u;
  }
}

/* Stores the members in their new order at the old places, and flags the ends of their new runs. \pre `from` lists the
 * members sorted by run, then by key of the round */
CADT_KERNEL(cadt_store_refined, CADT_GLOBAL const cadt_u32* places, CADT_GLOBAL const cadt_u32* members,
            CADT_GLOBAL const cadt_u32* from, CADT_GLOBAL const cadt_u32* runs, CADT_GLOBAL const cadt_u32* round_keys,
            CADT_GLOBAL cadt_u32* order, CADT_GLOBAL cadt_u32* tails, cadt_u32 total, cadt_u32 grain) {
  CADT_FOR(j, total, grain) {
    const cadt_u32 f = from[j], g = j + 1u < total ? from[j + 1u] : f;
    order[places[j]] = members[f];
    tails[places[j]] = j + 1u == total || runs[f] != runs[g] || round_keys[f] != round_keys[g] ? 1u : 0u;
  }
}

#endif
