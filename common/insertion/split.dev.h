/* SPDX-License-Identifier: Apache-2.0
 *
 * Where a triangle is split: a face 1 -> 3, an edge and its two triangles 2 -> 4 (paper, section 4.3, Algorithm 2). A
 * split locks what it writes, stores, and unlocks. That what was read still holds is proved by the lock itself on CPUs,
 * and on GPUs by reading it again (cadt_validate). In the figures `t.k` is the
 * half-edge of edge k of triangle t; a row lists the vertices of a triangle by slot, and what lies across its edges.
 */
#ifndef CADT_INSERTION_SPLIT_H
#define CADT_INSERTION_SPLIT_H

#include "common/insertion/locate.dev.h"

/* Stores a triangle that no half-edge names yet. */
CADT_FN void cadt_new_triangle(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 v0, cadt_u32 v1, cadt_u32 v2,
                               cadt_u32 n0, cadt_u32 n1, cadt_u32 n2, cadt_u32 flips) {
  cadt_store_vertices(m, t, v0, v1, v2);
  cadt_store_half_edge(m, t, 0u, n0);
  cadt_store_half_edge(m, t, 1u, n1);
  cadt_store_half_edge(m, t, 2u, n2);
  cadt_store_flips(m, t, flips);
}

/* The stores of a split of face t by vertex i; `s` is t before. i replaces v0 in t, v1 in t1 = 2i, v2 in t2 = 2i + 1:
 *
 *            v0                         v0
 *           /  \                       / | \
 *      n2  /    \  n1            n2   /  |  \   n1        t  = (i,  v1, v2)    n0,  t1.0, t2.0
 *         /  t   \                   /t2 | t1\            t1 = (v0, i,  v2)    t.1, n1,   t2.1
 *        /        \                 /   .i.   \           t2 = (v0, v1, i)     t.2, t1.2, n2
 *       /          \               / .   t  .  \
 *      v1 --------- v2            v1 ---------- v2        locked: t and the triangles of n1 and n2, which now name
 *           n0                         n0                 t1.1 and t2.2; the triangle of n0 still names t.0
 *
 * `edges` gets the three half-edges opposite i. \pre nobody else changes t, or the half-edges of its neighbours 1 and 2
 * back to it */
CADT_FN void cadt_write_face_split(const cadt_locked_mesh* m, cadt_u32 i, cadt_u32 t, const cadt_snapshot* s,
                                   cadt_u32* edges, cadt_counters* counters) {
  const cadt_u32 t1 = 2u * i, t2 = 2u * i + 1u;
  CADT_NOISE_AT(m, CADT_SITE_WRITE);
#if !CADT_CONTIGUOUS
  const cadt_u32 f0 = cadt_flips_get(s->flips, 0u), f1 = cadt_flips_get(s->flips, 1u);
  const cadt_snapshot r1 = {
      s->v0, i, s->v2, 0u, CADT_HALF_EDGE(t, 1u), s->n1, CADT_HALF_EDGE(t2, 1u), cadt_flips_set(0u, 1u, f1)};
  const cadt_snapshot r2 = {s->v0,
                            s->v1,
                            i,
                            0u,
                            CADT_HALF_EDGE(t, 2u),
                            CADT_HALF_EDGE(t1, 2u),
                            s->n2,
                            cadt_flips_set(0u, 2u, cadt_flips_get(s->flips, 2u))};
  const cadt_snapshot r0 = {
      i, s->v1, s->v2, s->lock | 1u, s->n0, CADT_HALF_EDGE(t1, 0u), CADT_HALF_EDGE(t2, 0u), cadt_flips_set(0u, 0u, f0)};
  cadt_store_from(m, t1, 0u, &r1);
  cadt_store_from(m, t2, 0u, &r2);
  CADT_NOISE_AT(m, CADT_SITE_NEXT_TRIANGLE);
  cadt_store_from(m, t, 0u, &r0);
#else
  cadt_new_triangle(m, t1, s->v0, i, s->v2, CADT_HALF_EDGE(t, 1u), s->n1, CADT_HALF_EDGE(t2, 1u),
                    cadt_flips_set(0u, 1u, cadt_flips_get(s->flips, 1u)));
  cadt_new_triangle(m, t2, s->v0, s->v1, i, CADT_HALF_EDGE(t, 2u), CADT_HALF_EDGE(t1, 2u), s->n2,
                    cadt_flips_set(0u, 2u, cadt_flips_get(s->flips, 2u)));
  CADT_NOISE_AT(m, CADT_SITE_NEXT_TRIANGLE);
  cadt_store_vertex(m, t, 0u, i);
  cadt_store_half_edge(m, t, 1u, CADT_HALF_EDGE(t1, 0u));
  cadt_store_half_edge(m, t, 2u, CADT_HALF_EDGE(t2, 0u));
  cadt_store_flips(m, t, cadt_flips_set(0u, 0u, cadt_flips_get(s->flips, 0u)));
#endif
  if (m->edge_flags) { /* each triangle keeps that of its old edge */
    const cadt_u32 flags = cadt_load_field(m->edge_flags + t);
    cadt_store_field(m->edge_flags + t1, flags & 2u);
    cadt_store_field(m->edge_flags + t2, flags & 4u);
    cadt_store_field(m->edge_flags + t, flags & 1u);
  }
  CADT_ADD_TIME(counters, CADT_TIME_SPLIT);
  cadt_relink(m, s->n1, CADT_HALF_EDGE(t1, 1u));
  cadt_relink(m, s->n2, CADT_HALF_EDGE(t2, 2u));
  CADT_ADD_TIME(counters, CADT_TIME_NEIGHBORS);
  edges[0] = CADT_HALF_EDGE(t, 0u);
  edges[1] = CADT_HALF_EDGE(t1, 1u);
  edges[2] = CADT_HALF_EDGE(t2, 2u);
  counters->count[CADT_COUNT_SPLITS]++;
}

/* Splits the face at `place` by vertex i. \post 3: `edges` has the three half-edges opposite i; 0: nothing changed. */
CADT_FN cadt_u32 cadt_split_face(const cadt_locked_mesh* m, cadt_u32 i, const cadt_place* place, cadt_u32* edges,
                                 cadt_counters* counters) {
  const cadt_u32 t = place->triangle, t1 = 2u * i, t2 = 2u * i + 1u;
  cadt_snapshot s = place->at;
  if (!cadt_is_unlocked(s.lock)) {
    counters->count[CADT_COUNT_LOCK_ATTEMPTS]++;
    CADT_COUNT_NOW(counters, CADT_COUNT_LOCK_FAILURES);
    CADT_LOST_LOCK(counters, t);
    return 0u;
  }
  cadt_lock_set locks = {{t, CADT_TRIANGLE_OF(s.n1), CADT_TRIANGLE_OF(s.n2), CADT_NONE},
                         {s.lock, CADT_ANY_VERSION, CADT_ANY_VERSION, 0u}};
  if (!cadt_try_lock(m, &locks, counters)) return 0u;
  if (!cadt_validate(m, t, 0u, CADT_HALF_EDGES_12, &s)) {
    CADT_LOST_LOCK(counters, t);
    return cadt_unlock_invalid(m, &locks, counters);
  }
  cadt_write_face_split(m, i, t, &s, edges, counters);
  cadt_fence_before_unlock();
  cadt_publish_triangle(m, t1);
  cadt_publish_triangle(m, t2);
  cadt_unlock(m, &locks);
  CADT_ADD_TIME(counters, CADT_TIME_LOCK);
  return 3u;
}

/* The stores of a split of the edge at `place`, edge k of t, and its two triangles by vertex i; `u` is the second
 * triangle n before. New are ts = 2i and ns = 2i + 1. Slots count from k in t and ts, from j in n and ns:
 *
 *            c                          c
 *           / \                        /|\
 *          /   \                      / | \               t  = (c, a, i)    ns.j, ts.k2, ca
 *         /  t  \                    /t | ts\             ts = (c, i, b)    n.j,  bc,    t.k1
 *        a ----- b                  a - i -- b            n  = (d, b, i)    ts.k, ns.j2, db
 *         \  n  /                    \ns|  n/             ns = (d, i, a)    t.k,  ad,    n.j1
 *          \   /                      \ | /
 *           \ /                        \|/                locked: t, n and the triangles across bc and ad; those
 *            d                          d                 across ca and db still name t.k2 and n.j2
 *
 * `edges` gets the four half-edges opposite i. \pre nobody else changes t and n, or the half-edges back to them across
 * bc and ad */
CADT_FN void cadt_write_edge_split(const cadt_locked_mesh* m, cadt_u32 i, const cadt_place* place,
                                   const cadt_snapshot* u, cadt_u32* edges, cadt_counters* counters) {
  const cadt_snapshot* s = &place->at;
  const cadt_u32 t = place->triangle, k = place->edge, k1 = CADT_NEXT(k), k2 = CADT_PREV(k);
  const cadt_u32 across = CADT_NEIGHBOR(*s, k), n = CADT_TRIANGLE_OF(across), j = CADT_EDGE_OF(across);
  const cadt_u32 j1 = CADT_NEXT(j), j2 = CADT_PREV(j), ts = 2u * i, ns = 2u * i + 1u;
  /* t = (c, a, b), n = (d, b, a) from vertices k and j on; i lies between a and b */
  const cadt_u32 a = CADT_VERTEX(*s, k1), b = CADT_VERTEX(*s, k2), c = CADT_VERTEX(*s, k), d = CADT_VERTEX(*u, j);
  const cadt_u32 outer_bc = CADT_NEIGHBOR(*s, k1), outer_ad = CADT_NEIGHBOR(*u, j1);
  /* new triangles, each in the slots of its parent: ts = (c, i, b), ns = (d, i, a) */
  cadt_store_vertex(m, ts, k, c);
  cadt_store_vertex(m, ts, k1, i);
  cadt_store_vertex(m, ts, k2, b);
  cadt_store_half_edge(m, ts, k, CADT_HALF_EDGE(n, j));
  cadt_store_half_edge(m, ts, k1, outer_bc);
  cadt_store_half_edge(m, ts, k2, CADT_HALF_EDGE(t, k1));
  cadt_store_flips(m, ts, cadt_flips_set(0u, k1, cadt_flips_get(s->flips, k1)));
  cadt_store_vertex(m, ns, j, d);
  cadt_store_vertex(m, ns, j1, i);
  cadt_store_vertex(m, ns, j2, a);
  cadt_store_half_edge(m, ns, j, CADT_HALF_EDGE(t, k));
  cadt_store_half_edge(m, ns, j1, outer_ad);
  cadt_store_half_edge(m, ns, j2, CADT_HALF_EDGE(n, j1));
  cadt_store_flips(m, ns, cadt_flips_set(0u, j1, cadt_flips_get(u->flips, j1)));
  /* t = (c, a, i), n = (d, b, i) */
  CADT_NOISE_AT(m, CADT_SITE_WRITE);
  cadt_store_vertex(m, t, k2, i);
  cadt_store_half_edge(m, t, k, CADT_HALF_EDGE(ns, j));
  cadt_store_half_edge(m, t, k1, CADT_HALF_EDGE(ts, k2));
  cadt_store_flips(m, t, cadt_flips_set(0u, k2, cadt_flips_get(s->flips, k2)));
  CADT_NOISE_AT(m, CADT_SITE_NEXT_TRIANGLE);
  cadt_store_vertex(m, n, j2, i);
  cadt_store_half_edge(m, n, j, CADT_HALF_EDGE(ts, k));
  cadt_store_half_edge(m, n, j1, CADT_HALF_EDGE(ns, j2));
  cadt_store_flips(m, n, cadt_flips_set(0u, j2, cadt_flips_get(u->flips, j2)));
  if (m->edge_flags) { /* of a constrained edge both halves are */
    const cadt_u32 ft = cadt_load_field(m->edge_flags + t), fn = cadt_load_field(m->edge_flags + n);
    const cadt_u32 flag = cadt_edge_flag(ft, k);
    cadt_store_field(m->edge_flags + ts, flag << k | cadt_edge_flag(ft, k1) << k1);
    cadt_store_field(m->edge_flags + ns, flag << j | cadt_edge_flag(fn, j1) << j1);
    cadt_store_field(m->edge_flags + t, flag << k | cadt_edge_flag(ft, k2) << k2);
    cadt_store_field(m->edge_flags + n, flag << j | cadt_edge_flag(fn, j2) << j2);
  }
  CADT_ADD_TIME(counters, CADT_TIME_SPLIT);
  cadt_relink(m, outer_bc, CADT_HALF_EDGE(ts, k1));
  cadt_relink(m, outer_ad, CADT_HALF_EDGE(ns, j1));
  CADT_ADD_TIME(counters, CADT_TIME_NEIGHBORS);
  edges[0] = CADT_HALF_EDGE(t, k2);
  edges[1] = CADT_HALF_EDGE(ts, k1);
  edges[2] = CADT_HALF_EDGE(n, j2);
  edges[3] = CADT_HALF_EDGE(ns, j1);
  counters->count[CADT_COUNT_EDGE_SPLITS]++;
}

/* Splits the edge at `place` and its two triangles by vertex i. \post 4: `edges` has the four half-edges opposite i; 0:
 * nothing changed. */
CADT_FN cadt_u32 cadt_split_edge(const cadt_locked_mesh* m, cadt_u32 i, const cadt_place* place, cadt_u32* edges,
                                 cadt_counters* counters) {
  const cadt_u32 t = place->triangle, k = place->edge, k1 = CADT_NEXT(k);
  cadt_snapshot s = place->at;
  const cadt_u32 across = CADT_NEIGHBOR(s, k), n = CADT_TRIANGLE_OF(across), j = CADT_EDGE_OF(across);
  const cadt_u32 j1 = CADT_NEXT(j), ts = 2u * i, ns = 2u * i + 1u;
  CADT_NOISE_AT(m, CADT_SITE_SECOND_TRIANGLE);
  cadt_snapshot u = cadt_snapshot_of(m, n);
  if (CADT_NEIGHBOR(u, j) != CADT_HALF_EDGE(t, k)) {
    counters->count[CADT_COUNT_LOCK_ATTEMPTS]++;
    CADT_COUNT_NOW(counters, CADT_COUNT_LOCK_FAILURES);
    CADT_COUNT_NOW(counters, CADT_COUNT_INVALIDATED);
    CADT_LOST_LOCK(counters, n);
    return 0u;
  }
  const cadt_u32 outer_bc = CADT_NEIGHBOR(s, k1), outer_ad = CADT_NEIGHBOR(u, j1);
  cadt_lock_set locks = {{t, n, CADT_TRIANGLE_OF(outer_bc), CADT_TRIANGLE_OF(outer_ad)},
                         {s.lock, u.lock ? u.lock : 1u, CADT_ANY_VERSION, CADT_ANY_VERSION}};
  if (!cadt_try_lock(m, &locks, counters)) return 0u;
  if (!cadt_validate(m, t, 0u, CADT_HALF_EDGES_ALL, &s) || !cadt_validate(m, n, 0u, CADT_HALF_EDGES_ALL, &u)) {
    CADT_LOST_LOCK(counters, t);
    return cadt_unlock_invalid(m, &locks, counters);
  }
  cadt_write_edge_split(m, i, place, &u, edges, counters);
  cadt_fence_before_unlock();
  cadt_publish_triangle(m, ts);
  cadt_publish_triangle(m, ns);
  cadt_unlock(m, &locks);
  CADT_ADD_TIME(counters, CADT_TIME_LOCK);
  return 4u;
}

#endif
