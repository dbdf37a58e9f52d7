/* SPDX-License-Identifier: Apache-2.0
 *
 * The legality sweep: tests every edge of the mesh once and repairs illegal ones. With many threads the mesh is correct
 * only after it: what a thread has tested may have been old, and on CPUs it tests the edges opposite of its point
 * alone, which is enough only if nobody else changes the star of the point meanwhile. The last sweep finds nothing and
 * so certifies the mesh.
 */
#ifndef CADT_INSERTION_LEGALITY_SWEEP_H
#define CADT_INSERTION_LEGALITY_SWEEP_H

#include "common/insertion/insert.dev.h"
#include "common/points/spatial_sort.dev.h"

/* Whether the boundary turns back on itself at the edge a, b to the ghost, with p and q beside it: the three points lie
 * on a line, and the middle one is not between the others. The orientation tests accept that and no flip can repair it:
 * it is no valid mesh. */
CADT_FN cadt_u32 cadt_turns_back(const cadt_locked_mesh* m, cadt_u32 p, cadt_u32 a, cadt_u32 b, cadt_u32 q,
                                 cadt_counters* counters) {
  if ((a != CADT_GHOST && b != CADT_GHOST) || p == CADT_GHOST || q == CADT_GHOST || p == q) return 0u;
  const cadt_u32 v = a == CADT_GHOST ? b : a;
  if (v == CADT_GHOST) return 0u; /* torn read */
  const cadt_point x = cadt_point_of(m, p), y = cadt_point_of(m, v), z = cadt_point_of(m, q);
  if (cadt_orientation(x, y, z, counters) != 0) return 0u;
  return cadt_lexicographic(x, p, y, v) == cadt_lexicographic(z, q, y, v) ? 1u : 0u;
}

#if CADT_CONTIGUOUS
enum { CADT_SWEEP_BATCH = 192 /* edges that are listed before they are tested */ };

typedef struct {
  cadt_u32 examined, illegal, unsettled, stabilized, broken;
} cadt_findings;

/* Flips an illegal edge, and the edges that become illegal by that. Inlined, this rare case makes the loop below take a
 * tenth longer. */
CADT_FN_SLOW void cadt_repair_edge(const cadt_locked_mesh* m, cadt_u32 half_edge, const cadt_deferred* deferred,
                                   cadt_counters* counters) {
  CADT_DECLARE_WORKLIST(work);
  cadt_worklist_begin(&work, CADT_NONE, CADT_EDGE_FLIP_LIMIT);
  cadt_worklist_add(&work, half_edge);
  cadt_legalize(m, &work, deferred, counters);
}

/* Tests listed edges and repairs illegal ones. Nothing is known of an edge but its half-edge: repairs
 * change the mesh. */
CADT_FN void cadt_sweep_edges(const cadt_locked_mesh* m, const cadt_u32* half_edges, cadt_u32 count,
                              const cadt_deferred* deferred, cadt_findings* found, cadt_counters* counters) {
  for (cadt_u32 e = 0u; e < count; ++e) {
    const cadt_u32 k = CADT_EDGE_OF(half_edges[e]);
    CADT_GLOBAL cadt_u32* t = m->locked[CADT_TRIANGLE_OF(half_edges[e])].word;
    const cadt_u32 lock = cadt_load_field(t + CADT_WORD_LOCK), across = cadt_load_field(t + CADT_WORD_HALF_EDGE + k);
    const cadt_u32 p = cadt_load_field(t + k), a = cadt_load_field(t + CADT_NEXT(k));
    const cadt_u32 b = cadt_load_field(t + CADT_PREV(k)), j = CADT_EDGE_OF(across);
    CADT_GLOBAL cadt_u32* n = m->locked[CADT_TRIANGLE_OF(across)].word;
    const cadt_u32 lock_across = cadt_load_field(n + CADT_WORD_LOCK), q = cadt_load_field(n + j);
    if (!cadt_is_unlocked(lock) || !cadt_is_unlocked(lock_across) ||
        cadt_load_field(n + CADT_WORD_HALF_EDGE + j) != half_edges[e]) {
      found->unsettled++;
    } else if (cadt_is_illegal(m, p, a, b, q, counters)) {
      if (cadt_edge_is_constrained(m, CADT_TRIANGLE_OF(half_edges[e]), k)) continue;
      if (cadt_is_stabilized(m, CADT_TRIANGLE_OF(half_edges[e]), k, p, a, b, q)) {
        found->stabilized++;
        continue;
      }
      found->illegal++;
      CADT_SKIP_TIME(counters); /* testing all edges is not part of the insertion's time, repairs are */
      cadt_repair_edge(m, half_edges[e], deferred, counters);
    } else if (cadt_turns_back(m, p, a, b, q, counters)) {
      found->broken++;
    }
  }
  found->examined += count;
}
#endif

#if CADT_BUILDS(INSERTION)
/* deferred_counts, behind those of the lists: edges examined; illegal edges to be flipped; edges that could not be read
 * because a thread was changing them; illegal edges that stay (CADT_STABILIZE_PAPER); edges to the ghost at which the
 * boundary turns back. `n`: the points are in the order of levels (cadt_by_level), and triangles are visited along the
 * curve; 0: in the order of their indices. \pre triangles of vertices that are not in the mesh have lock word 0 */
CADT_KERNEL(cadt_legality_sweep, CADT_LOCKED_MESH_PARAMETERS, cadt_u32 begin, cadt_u32 count, cadt_u32 grain,
            cadt_u32 n, CADT_GLOBAL cadt_u32* deferred_edges, CADT_GLOBAL cadt_u32* deferred_counts,
            cadt_u32 edge_capacity, CADT_GLOBAL cadt_u32* counter_rows) {
  CADT_GROUP_COUNTERS(counters, counter_rows);
  CADT_LOCKED_MESH(mesh);
  const cadt_deferred deferred = {deferred_edges, deferred_counts, edge_capacity};
#if CADT_CONTIGUOUS
  (void)n;
  /* An edge is seen from two triangles. Which of them takes it is settled without a branch, which would be mispredicted
   * half of the time, before a batch of edges is tested. */
  cadt_u32 batch[CADT_SWEEP_BATCH + 3], listed = 0u;
  cadt_findings all = {0u, 0u, 0u, 0u, 0u};
  CADT_FOR(r, count, grain) {
    const cadt_u32 t = begin + r;
    CADT_GLOBAL cadt_u32* word = mesh.locked[t].word;
    if (cadt_load_field(word + CADT_WORD_LOCK) != 0u) {
      for (cadt_u32 k = 0u; k < 3u; ++k) {
        batch[listed] = CADT_HALF_EDGE(t, k);
        listed += CADT_TRIANGLE_OF(cadt_load_field(word + CADT_WORD_HALF_EDGE + k)) > t ? 1u : 0u;
      }
    }
    if (listed < CADT_CAST(cadt_u32, CADT_SWEEP_BATCH)) continue;
    cadt_sweep_edges(&mesh, batch, listed, &deferred, &all, &counters);
    listed = 0u;
  }
  cadt_sweep_edges(&mesh, batch, listed, &deferred, &all, &counters);
  const cadt_u32 examined = all.examined, illegal = all.illegal, unsettled = all.unsettled, stabilized = all.stabilized,
                 broken = all.broken;
#else
  cadt_u32 examined = 0u, illegal = 0u, unsettled = 0u, stabilized = 0u, broken = 0u;
  CADT_FOR(r, count, grain) {
    const cadt_u32 slot = begin + r, t = n ? 2u * cadt_rank_of(0u, slot >> 1, n) + (slot & 1u) : slot;
    const cadt_snapshot s = cadt_snapshot_of(&mesh, t);
    if (s.lock == 0u) continue;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 across = CADT_NEIGHBOR(s, k), n = CADT_TRIANGLE_OF(across), j = CADT_EDGE_OF(across);
      if (n < t) continue; /* tested from the other side */
      const cadt_snapshot u = cadt_snapshot_from(&mesh, n, j);
      ++examined;
      if (!cadt_is_unlocked(s.lock) || !cadt_is_unlocked(u.lock) || u.n0 != CADT_HALF_EDGE(t, k)) {
        ++unsettled;
      } else if (cadt_is_illegal(&mesh, CADT_VERTEX(s, k), CADT_VERTEX(s, CADT_NEXT(k)), CADT_VERTEX(s, CADT_PREV(k)),
                                 u.v0, &counters)) {
        if (cadt_edge_is_constrained(&mesh, t, k)) continue;
        if (cadt_is_stabilized(&mesh, t, k, CADT_VERTEX(s, k), CADT_VERTEX(s, CADT_NEXT(k)),
                               CADT_VERTEX(s, CADT_PREV(k)), u.v0)) {
          ++stabilized;
          continue;
        }
        ++illegal;
        /* to cadt_legalize_edges: without the repairs this kernel needs fewer registers */
        cadt_defer_edge(&deferred, CADT_HALF_EDGE(t, k), &counters);
      } else if (cadt_turns_back(&mesh, CADT_VERTEX(s, k), CADT_VERTEX(s, CADT_NEXT(k)), CADT_VERTEX(s, CADT_PREV(k)),
                                 u.v0, &counters)) {
        ++broken;
      }
    }
  }
#endif
  CADT_GLOBAL cadt_u32* found = deferred_counts + CADT_DEFERRED_COUNTS;
  if (examined) cadt_add_relaxed(found, examined);
  if (illegal) cadt_add_relaxed(found + 1, illegal);
  if (unsettled) cadt_add_relaxed(found + 2, unsettled);
  if (stabilized) cadt_add_relaxed(found + 3, stabilized);
  if (broken) cadt_add_relaxed(found + 4, broken);
  CADT_SKIP_TIME(&counters);
  CADT_FLUSH_COUNTERS(&counters, counter_rows);
}
#endif

#endif
