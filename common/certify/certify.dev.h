/* SPDX-License-Identifier: Apache-2.0
 *
 * Certification of a mesh in two arrays: examines every edge and repairs nothing. Locked triangles, as insertion makes
 * them, are certified by the last legality sweep, which repairs nothing either
 * (common/insertion/legality_sweep.dev.h).
 *
 * The arrays, vertices and half-edges, have three words a triangle, as in locked_mesh.dev.h but without lock words and
 * flip counters, since nothing is flipped any more. Ghost triangles come last, so what is before them already has the
 * form of the result.
 */
#ifndef CADT_CERTIFY_CERTIFY_H
#define CADT_CERTIFY_CERTIFY_H

#include "common/insertion/legality_sweep.dev.h"

CADT_FN cadt_u32 cadt_word_of_three(CADT_GLOBAL const cadt_u32* words, cadt_u32 triangle, cadt_u32 k) {
  return words[3u * triangle + k];
}

/* Examines each edge of the mesh once, from the triangle that comes first. `known` of the `all` triangles are not of
 * the ghost. words[row] and on: edges examined; illegal edges; edges whose sides do not fit together, and ghost
 * triangles among the others; edges to the ghost at which the boundary turns back; the number of real triangles if
 * `known` is CADT_NONE, 0: there is no mesh. If `counted`, the rows behind are counters of work. */
CADT_KERNEL(cadt_certify, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* half_edges,
            CADT_GLOBAL const cadt_point* points, cadt_u32 all, cadt_u32 known, cadt_u32 begin, cadt_u32 count,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* words, cadt_u32 row, cadt_u32 counted) {
  CADT_GROUP_COUNTERS(counters, counted);
  CADT_GLOBAL cadt_u32* found = words + row;
  const cadt_u32 real = known != CADT_NONE ? known : found[CADT_CERTIFY_REAL];
  if (!real) return;
  cadt_locked_mesh mesh; /* the predicates read only its points */
  mesh.points = points;
  cadt_u32 examined = 0u, illegal = 0u, wrong = 0u, broken = 0u;
  CADT_FOR(i, count, grain) {
    const cadt_u32 t = begin + i;
    cadt_u32 v[3], half_edge[3];
    for (cadt_u32 k = 0u; k < 3u; ++k) v[k] = cadt_word_of_three(vertices, t, k);
    for (cadt_u32 k = 0u; k < 3u; ++k) half_edge[k] = cadt_word_of_three(half_edges, t, k);
    const cadt_u32 ghost = v[0] == CADT_GHOST || v[1] == CADT_GHOST || v[2] == CADT_GHOST ? 1u : 0u;
    if (ghost != (t >= real ? 1u : 0u)) ++wrong;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 u = CADT_TRIANGLE_OF(half_edge[k]), j = CADT_EDGE_OF(half_edge[k]);
      if (u < t) continue; /* examined from the other side */
      ++examined;
      if (u >= all || j > 2u || cadt_word_of_three(half_edges, u, j) != CADT_HALF_EDGE(t, k)) {
        ++wrong;
        continue;
      }
      const cadt_u32 p = CADT_PICK(k, v[0], v[1], v[2]), a = CADT_PICK(k, v[1], v[2], v[0]),
                     b = CADT_PICK(k, v[2], v[0], v[1]), q = cadt_word_of_three(vertices, u, j);
      if (cadt_word_of_three(vertices, u, CADT_NEXT(j)) != b || cadt_word_of_three(vertices, u, CADT_PREV(j)) != a)
        ++wrong;
      else if (cadt_is_illegal(&mesh, p, a, b, q, &counters))
        ++illegal;
      else if (cadt_turns_back(&mesh, p, a, b, q, &counters))
        ++broken;
    }
  }
  if (examined) cadt_add_relaxed(found, examined);
  if (illegal) cadt_add_relaxed(found + 1, illegal);
  if (wrong) cadt_add_relaxed(found + 2, wrong);
  if (broken) cadt_add_relaxed(found + 3, broken);
  CADT_SKIP_TIME(&counters);
  CADT_GLOBAL cadt_u32* counter_rows = counted ? found + CADT_COUNTER_STRIDE : 0;
  CADT_FLUSH_COUNTERS(&counters, counter_rows);
}

#endif
