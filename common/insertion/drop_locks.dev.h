/* SPDX-License-Identifier: Apache-2.0
 *
 * After the last legality sweep nobody changes the mesh any more. The locked triangles become the arrays that all later
 * stages read (common/mesh/mesh_view.dev.h), without gaps: of a whole mesh those of the result, of a part that is to be
 * stitched half-edges, with the ghost triangles at the end.
 *
 *    slots     0   1   2   3   4   5   6   7        g: ghost, -: never used
 *              a   g   b   c   -   -   g   d
 *    ranks     0   1   1   2   3   3   3   3   4    real triangles before; the last is their number
 *    arrays    a   b   c   d   g   g                ghosts: real triangles (4) + slot - unused slots before - rank
 */
#ifndef CADT_INSERTION_DROP_LOCKS_H
#define CADT_INSERTION_DROP_LOCKS_H

#include "common/mesh/finished_triangle.dev.h"
#include "common/mesh/locked_mesh.dev.h"
#include "common/overlay/flip_histogram.dev.h"

/* 1 for each triangle without a ghost; flags[count] becomes 0, so that its scan is the total. Counts edges by flips as
 * well. */
CADT_KERNEL(cadt_flag_triangles, CADT_GLOBAL const cadt_locked_triangle* locked, CADT_GLOBAL cadt_u32* flags,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* flips) {
  CADT_FLIPS_BEGIN(bins, flips);
  if (cadt_item == 0u) flags[count] = 0u;
  CADT_FOR(t, count, grain) {
    const cadt_locked_triangle r = locked[t];
    flags[t] = r.word[CADT_WORD_LOCK] != 0u && cadt_ghost_slot(&r) == 3u ? 1u : 0u;
    if (r.word[CADT_WORD_LOCK] != 0u) {
      CADT_FLIPS_COUNT(bins, flips, r);
    }
  }
  CADT_FLIPS_END(bins, flips);
}

/* The number of the triangle in slot t, which is in use. `unused`: the first of the two slots that are not, or
 * CADT_NONE: ghosts are dropped. */
CADT_FN cadt_u32 cadt_number_of_slot(CADT_GLOBAL const cadt_u32* ranks, cadt_u32 real, cadt_u32 unused, cadt_u32 t) {
  const cadt_u32 rank = ranks[t];
  if (ranks[t + 1u] != rank) return rank;
  return unused == CADT_NONE ? CADT_NONE : real + (t - (t > unused ? 2u : 0u) - rank);
}

/* `ranks`: the exclusive scan of the flags of `count` slots. With `input_ids` the arrays are those of the result,
 * without ghosts: input ids, and triangles across. Else positions and half-edges. \pre nobody changes the mesh */
CADT_KERNEL(cadt_drop_locks, CADT_GLOBAL const cadt_locked_triangle* locked, CADT_GLOBAL const cadt_u32* slot_flags,
            CADT_GLOBAL const cadt_u32* ranks, cadt_u32 count, cadt_u32 unused, CADT_GLOBAL const cadt_u32* input_ids,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* vertices, CADT_GLOBAL cadt_u32* across,
            CADT_GLOBAL cadt_u32* edge_flags) {
  const cadt_u32 real = ranks[count];
  CADT_FOR(t, count, grain) {
    const cadt_u32 number = cadt_number_of_slot(ranks, real, unused, t);
    if (number == CADT_NONE) continue;
    const cadt_locked_triangle r = locked[t];
    if (r.word[CADT_WORD_LOCK] == 0u) continue;
    cadt_u32 n[3];
    for (cadt_u32 k = 0u; k < 3u; ++k)
      n[k] = cadt_number_of_slot(ranks, real, unused, CADT_TRIANGLE_OF(r.word[CADT_WORD_HALF_EDGE + k]));
    if (input_ids) {
      const cadt_triangle finished = cadt_in_input_ids(input_ids, r.word[0], r.word[1], r.word[2]);
      cadt_write_finished_vertices(vertices, number, &finished);
      cadt_write_finished_neighbors(across, number, finished.slot, n[0], n[1], n[2]);
      if (edge_flags) edge_flags[number] = cadt_turned_flags(slot_flags[t], finished.slot);
    } else {
      for (cadt_u32 k = 0u; k < 3u; ++k) {
        vertices[3u * number + k] = r.word[k];
        across[3u * number + k] = CADT_HALF_EDGE(n[k], CADT_EDGE_OF(r.word[CADT_WORD_HALF_EDGE + k]));
      }
      if (edge_flags) edge_flags[number] = slot_flags[t];
    }
  }
}

#endif
