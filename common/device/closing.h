/* SPDX-License-Identifier: Apache-2.0
 *
 * The closing pass: looks at every edge of the mesh once and repairs what it finds illegal. With many threads it is
 * needed for correctness: the thread that inserts a point checks the edges opposite of it, which is enough only if
 * nobody else changes the star of the point meanwhile. The last pass finds nothing and so certifies the mesh.
 */
#ifndef CADT_DEVICE_CLOSING_H
#define CADT_DEVICE_CLOSING_H

#include "common/device/insert.h"

/* found: edges examined, illegal ones that are to be flipped, ones that could not be read because somebody was changing
 * them, illegal ones that are left as they are (CADT_STABILIZE_PAPER). \pre records of
 * vertices that are not in the mesh have lock word 0 */
CADT_KERNEL(cadt_closing_pass, CADT_MESH_PARAMETERS, cadt_u32 begin, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* found, CADT_GLOBAL cadt_u32* left_edges, CADT_GLOBAL cadt_u32* left_counts,
            cadt_u32 edge_capacity, CADT_GLOBAL cadt_u32* counters) {
  CADT_GROUP_TALLY(tally, counters);
  CADT_MESH_VIEW(mesh);
  const cadt_deferred deferred = cadt_lists(left_edges, left_counts, edge_capacity);
#if CADT_CONTIGUOUS
  cadt_worklist work;
#endif
  cadt_u32 examined = 0u, illegal = 0u, unsettled = 0u, left = 0u;
  CADT_FOR(r, count, grain) {
    const cadt_u32 t = begin + r;
    const cadt_snapshot s = cadt_look(&mesh, t);
    if (s.lock == 0u) continue;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 across = CADT_NEIGHBOR(s, k), n = CADT_LINK_RECORD(across), j = CADT_LINK_EDGE(across);
      if (n < t) continue; /* seen from the other side */
      const cadt_snapshot u = cadt_look_from(&mesh, n, j);
      ++examined;
      if (!cadt_is_free(s.lock) || !cadt_is_free(u.lock) || u.n0 != CADT_LINK(t, k)) {
        ++unsettled;
      } else if (cadt_is_illegal(&mesh, CADT_VERTEX(s, k), CADT_VERTEX(s, CADT_NEXT(k)), CADT_VERTEX(s, CADT_PREV(k)),
                                 u.v0, &tally)) {
        if (cadt_is_left(&mesh, cadt_flips_get(s.flips, k), CADT_VERTEX(s, k), CADT_VERTEX(s, CADT_NEXT(k)),
                         CADT_VERTEX(s, CADT_PREV(k)), u.v0)) {
          ++left;
          continue;
        }
        ++illegal;
#if CADT_CONTIGUOUS
        CADT_LAP_SKIP(&tally); /* looking at all edges is no part of the insertion, repairs are */
        cadt_worklist_begin(&work, CADT_NONE, CADT_EDGE_FLIP_LIMIT);
        cadt_worklist_add(&work, CADT_LINK(t, k));
        cadt_legalize(&mesh, &work, &deferred, &tally);
        break; /* the snapshot is out of date; the next pass sees the rest */
#else
        /* to cadt_legalize_edges: without the repairs this kernel is small and runs at full occupancy */
        cadt_defer_edge(&deferred, CADT_LINK(t, k), &tally);
#endif
      }
    }
  }
  if (examined) cadt_add_relaxed(found, examined);
  if (illegal) cadt_add_relaxed(found + 1, illegal);
  if (unsettled) cadt_add_relaxed(found + 2, unsettled);
  if (left) cadt_add_relaxed(found + 3, left);
  CADT_LAP_SKIP(&tally);
  CADT_FLUSH_TALLY(&tally, counters);
}

#endif
