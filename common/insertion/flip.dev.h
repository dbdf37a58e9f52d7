/* SPDX-License-Identifier: Apache-2.0
 *
 * Where an edge is tested and flipped (paper, section 4.4, Algorithm 3). A flip locks what it writes, stores, and
 * unlocks, as a split does (split.dev.h).
 */
#ifndef CADT_INSERTION_FLIP_H
#define CADT_INSERTION_FLIP_H

#include "common/insertion/lock.dev.h"
#include "common/overlay/stabilized_flips.dev.h"

enum { CADT_EDGE_LEGAL, CADT_EDGE_FLIPPED, CADT_EDGE_CONFLICT, CADT_EDGE_STABILIZED };

/* Whether the edge a, b between the triangles p, a, b and q, b, a is illegal. The circle through the ghost and a hull
 * edge is the half-plane outside of that edge. */
CADT_FN cadt_u32 cadt_is_illegal(const cadt_locked_mesh* m, cadt_u32 p, cadt_u32 a, cadt_u32 b, cadt_u32 q,
                                 cadt_counters* counters) {
  counters->count[CADT_COUNT_INCIRCLE_TESTS]++;
  if (p == CADT_GHOST || q == CADT_GHOST) return 0u;
  if (a == CADT_GHOST && b == CADT_GHOST) return 0u; /* torn read */
  if (a == CADT_GHOST)
    return cadt_orientation(cadt_point_of(m, p), cadt_point_of(m, q), cadt_point_of(m, b), counters) > 0 ? 1u : 0u;
  if (b == CADT_GHOST)
    return cadt_orientation(cadt_point_of(m, q), cadt_point_of(m, p), cadt_point_of(m, a), counters) > 0 ? 1u : 0u;
  return cadt_incircle(cadt_point_of(m, p), cadt_point_of(m, a), cadt_point_of(m, b), cadt_point_of(m, q), counters) > 0
             ? 1u
             : 0u;
}

/* The stores of a flip of edge `half_edge` = t.k; `s` and `u` are its two triangles t and n before, seen from it (from
 * k and j on). In each triangle the new vertex takes the slot of the one that goes:
 *
 *            p                          p
 *           / \                        /|\
 *          /   \                      / | \               t = (p, a, q)    aq, n.j1, pa
 *         /  t  \                    /  |  \              n = (q, b, p)    bp, t.k1, qb
 *        a ----- b                  a t | n b
 *         \  n  /                    \  |  /              locked: t, n and the triangles across bp and aq, which now
 *          \   /                      \ | /               name n.j and t.k; those across pa and qb still name t.k2
 *           \ /                        \|/                and n.j2
 *            q                          q
 *
 * \pre nobody else changes t and n, or the half-edges back to them across bp and aq */
CADT_FN void cadt_write_flip(const cadt_locked_mesh* m, cadt_u32 half_edge, const cadt_snapshot* s,
                             const cadt_snapshot* u, cadt_counters* counters) {
  const cadt_u32 t = CADT_TRIANGLE_OF(half_edge), k = CADT_EDGE_OF(half_edge), k1 = CADT_NEXT(k), k2 = CADT_PREV(k);
  const cadt_u32 n = CADT_TRIANGLE_OF(s->n0), j = CADT_EDGE_OF(s->n0), j1 = CADT_NEXT(j), j2 = CADT_PREV(j);
  const cadt_u32 outer_bp = s->n1, outer_aq = u->n1;
  /* t = (p, a, b) becomes (p, a, q), n = (q, b, a) becomes (q, b, p); the flip counter of a-b goes on as that of p-q */
  const cadt_u32 flips = cadt_flips_get(s->flips, k) + 1u;
  CADT_NOISE_AT(m, CADT_SITE_WRITE);
#if !CADT_CONTIGUOUS
  const cadt_snapshot rt = {
      s->v0,    s->v1,
      u->v0,    s->lock | 1u,
      outer_aq, CADT_HALF_EDGE(n, j1),
      s->n2,    cadt_flips_set(cadt_flips_set(s->flips, k, cadt_flips_get(u->flips, j1)), k1, flips)};
  const cadt_snapshot rn = {
      u->v0,    u->v1,
      s->v0,    u->lock | 1u,
      outer_bp, CADT_HALF_EDGE(t, k1),
      u->n2,    cadt_flips_set(cadt_flips_set(u->flips, j, cadt_flips_get(s->flips, k1)), j1, flips)};
  cadt_store_from(m, t, k, &rt);
  CADT_NOISE_AT(m, CADT_SITE_NEXT_TRIANGLE);
  cadt_store_from(m, n, j, &rn);
  (void)k2, (void)j2;
#else
  cadt_store_vertex(m, t, k2, u->v0);
  cadt_store_half_edge(m, t, k, outer_aq);
  cadt_store_half_edge(m, t, k1, CADT_HALF_EDGE(n, j1));
  cadt_store_flips(m, t, cadt_flips_set(cadt_flips_set(s->flips, k, cadt_flips_get(u->flips, j1)), k1, flips));
  CADT_NOISE_AT(m, CADT_SITE_NEXT_TRIANGLE);
  cadt_store_vertex(m, n, j2, s->v0);
  cadt_store_half_edge(m, n, j, outer_bp);
  cadt_store_half_edge(m, n, j1, CADT_HALF_EDGE(t, k1));
  cadt_store_flips(m, n, cadt_flips_set(cadt_flips_set(u->flips, j, cadt_flips_get(s->flips, k1)), j1, flips));
#endif
  if (m->edge_flags) { /* aq and bp take theirs along, pq is a new edge */
    const cadt_u32 ft = cadt_load_field(m->edge_flags + t), fn = cadt_load_field(m->edge_flags + n);
    cadt_store_field(m->edge_flags + t, cadt_edge_flag_set(cadt_edge_flag_set(ft, k, cadt_edge_flag(fn, j1)), k1, 0u));
    cadt_store_field(m->edge_flags + n, cadt_edge_flag_set(cadt_edge_flag_set(fn, j, cadt_edge_flag(ft, k1)), j1, 0u));
  }
  CADT_ADD_TIME(counters, CADT_TIME_FLIP);
  cadt_relink(m, outer_aq, CADT_HALF_EDGE(t, k));
  cadt_relink(m, outer_bp, CADT_HALF_EDGE(n, j));
  CADT_ADD_TIME(counters, CADT_TIME_NEIGHBORS);
  counters->count[CADT_COUNT_FLIPS]++;
}

/* Tests an edge and flips it if it is illegal and not constrained. `apex` is the vertex expected opposite, at
 * `apex_point`, or CADT_NONE for any. \post CADT_EDGE_STABILIZED: the edge is illegal and stays so, for now or for good
 * (stabilized_flips.dev.h). CADT_EDGE_FLIPPED: `half_edge` still names an edge opposite the apex, and `*partner` the
 * other one, in the other triangle; `*all_sides`: all four sides of the quadrilateral may be illegal, and not only
 * these two: the apex is not the expected one, or others work close by. */
CADT_FN cadt_u32 cadt_flip_if_illegal(const cadt_locked_mesh* m, cadt_u32 half_edge, cadt_u32 apex,
                                      cadt_point apex_point, cadt_u32* partner, cadt_u32* all_sides,
                                      cadt_counters* counters) {
  const cadt_u32 t = CADT_TRIANGLE_OF(half_edge), k = CADT_EDGE_OF(half_edge);
  cadt_snapshot s = cadt_snapshot_from(m, t, k);
  const cadt_u32 p = s.v0;
  if (!cadt_is_unlocked(s.lock)) {
    counters->count[CADT_COUNT_LOCK_ATTEMPTS]++; /* an attempt that ends before its first compare-and-swap */
    CADT_COUNT_NOW(counters, CADT_COUNT_LOCK_FAILURES);
    CADT_LOST_LOCK(counters, t);
    CADT_ADD_TIME(counters, CADT_TIME_TEST);
    return CADT_EDGE_CONFLICT;
  }
  /* On GPUs others insert points close by: they may have tested the four sides with what lay across before. */
  *all_sides = CADT_CONTIGUOUS ? (p != apex ? 1u : 0u) : 1u;
  /* Another thread flipped the expected apex away, and did not know that this edge had yet to be tested: it still has
   * to be. */
  if (p != apex && apex != CADT_NONE) CADT_COUNT_NOW(counters, CADT_COUNT_STALE_EDGES);
  const cadt_u32 across = s.n0, n = CADT_TRIANGLE_OF(across), j = CADT_EDGE_OF(across);
  CADT_NOISE_AT(m, CADT_SITE_SECOND_TRIANGLE);
  cadt_snapshot u = cadt_snapshot_from(m, n, j);
  if (!cadt_is_unlocked(u.lock) || u.n0 != half_edge) {
    counters->count[CADT_COUNT_LOCK_ATTEMPTS]++;
    CADT_COUNT_NOW(counters, CADT_COUNT_LOCK_FAILURES);
    if (cadt_is_unlocked(u.lock)) CADT_COUNT_NOW(counters, CADT_COUNT_INVALIDATED);
    CADT_LOST_LOCK(counters, n);
    CADT_ADD_TIME(counters, CADT_TIME_TEST);
    return CADT_EDGE_CONFLICT;
  }
  const cadt_u32 q = u.v0;
  cadt_u32 illegal;
  /* the ghost is CADT_NONE as well */
  if (p == apex && p != CADT_GHOST && s.v1 != CADT_GHOST && s.v2 != CADT_GHOST && q != CADT_GHOST) {
    counters->count[CADT_COUNT_INCIRCLE_TESTS]++;
    illegal =
        cadt_incircle(apex_point, cadt_point_of(m, s.v1), cadt_point_of(m, s.v2), cadt_point_of(m, q), counters) > 0;
  } else {
    illegal = cadt_is_illegal(m, p, s.v1, s.v2, q, counters);
  }
  CADT_ADD_TIME(counters, CADT_TIME_TEST);
  if (!illegal) return CADT_EDGE_LEGAL;
  if (cadt_is_stabilized(m, t, k, p, s.v1, s.v2, q)) {
    CADT_COUNT_NOW(counters, CADT_COUNT_STABILIZED);
    CADT_ADD_TIME(counters, CADT_TIME_TEST);
    return CADT_EDGE_STABILIZED;
  }
  const cadt_u32 outer_bp = s.n1, outer_aq = u.n1;
  cadt_lock_set locks = {{t, n, CADT_TRIANGLE_OF(outer_bp), CADT_TRIANGLE_OF(outer_aq)},
                         {s.lock, u.lock, CADT_ANY_VERSION, CADT_ANY_VERSION}};
  if (!cadt_try_lock(m, &locks, counters)) return CADT_EDGE_CONFLICT;
  u.v1 = s.v2; /* as both triangles have it in common: what was read need not stay in registers until here */
  u.v2 = s.v1;
  u.n0 = half_edge;
  const cadt_u32 same = cadt_validate(m, t, k, CADT_HALF_EDGES_01, &s); /* both at once: their loads overlap */
  if (!(same & cadt_validate(m, n, j, CADT_HALF_EDGES_01, &u))) {
    CADT_LOST_LOCK(counters, t);
    cadt_unlock_invalid(m, &locks, counters);
    return CADT_EDGE_CONFLICT;
  }
  if (cadt_edge_is_constrained(m, t, k)) { /* certain only under the lock */
    cadt_unlock_unchanged(m, &locks, 4u);
    return CADT_EDGE_LEGAL;
  }
  cadt_write_flip(m, half_edge, &s, &u, counters);
  cadt_fence_before_unlock();
  cadt_unlock(m, &locks);
  CADT_ADD_TIME(counters, CADT_TIME_LOCK);
  CADT_NOISE_AT(m, CADT_SITE_VERTEX_TRIANGLE);
  cadt_set_vertex_triangle(m, s.v1, t);
  cadt_set_vertex_triangle(m, s.v2, n);
  CADT_ADD_TIME(counters, CADT_TIME_FLIP);
  *partner = CADT_HALF_EDGE(n, CADT_PREV(j));
  return CADT_EDGE_FLIPPED;
}

#endif
