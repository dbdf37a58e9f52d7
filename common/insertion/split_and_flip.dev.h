/* SPDX-License-Identifier: Apache-2.0
 *
 * The three changes of the mesh: split of a face 1 -> 3, split of an edge 2 -> 4 (paper, section 4.3, Algorithm 2) and
 * flip of an edge (section 4.4, Algorithm 3). Each claims what it writes, which validates what was read, then commits.
 */
#ifndef CADT_INSERTION_SPLIT_AND_FLIP_H
#define CADT_INSERTION_SPLIT_AND_FLIP_H

#include "common/insertion/locate.dev.h"

enum { CADT_EDGE_LEGAL, CADT_EDGE_FLIPPED, CADT_EDGE_CONFLICT, CADT_EDGE_LEFT };

CADT_FN void cadt_relink(const cadt_locked_mesh* m, cadt_u32 outer, cadt_u32 half_edge) {
  cadt_store_half_edge(m, CADT_TRIANGLE_OF(outer), CADT_EDGE_OF(outer), half_edge);
}

/* A flip takes a vertex away from each of its records; with its hint kept on a record of its own, walks take 3.3 steps
 * instead of 5.8 (1M uniform points). Splits do the same, but there it makes no difference. */
CADT_FN void cadt_set_vertex_triangle(const cadt_locked_mesh* m, cadt_u32 vertex, cadt_u32 t) {
  if (vertex != CADT_GHOST) cadt_store_relaxed(m->vertex_to_triangle + vertex, t);
}

/* Gives back a claim whose records turned out to have changed. Returns 0. */
CADT_FN cadt_u32 cadt_unlock_invalid(const cadt_locked_mesh* m, const cadt_lock_set* locks, cadt_counters* counters) {
  cadt_unlock_unchanged(m, locks, 4u);
  CADT_COUNT_NOW(counters, CADT_COUNT_LOCK_FAILURES);
  CADT_COUNT_NOW(counters, CADT_COUNT_INVALIDATED);
  CADT_LAP(counters, CADT_TIME_LOCK);
  return 0u;
}

/* A record that is not visible yet. */
CADT_FN void cadt_new_triangle(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 v0, cadt_u32 v1, cadt_u32 v2,
                               cadt_u32 n0, cadt_u32 n1, cadt_u32 n2, cadt_u32 flips) {
  cadt_store_vertices(m, t, v0, v1, v2);
  cadt_store_half_edge(m, t, 0u, n0);
  cadt_store_half_edge(m, t, 1u, n1);
  cadt_store_half_edge(m, t, 2u, n2);
  cadt_store_flips(m, t, flips);
}

/* The stores of a split of face t, seen as `s`, by vertex i. `edges` gets the three links opposite i. \pre nobody else
 * changes t, or the links of its neighbours 1 and 2 back to it */
CADT_FN void cadt_write_face(const cadt_locked_mesh* m, cadt_u32 i, cadt_u32 t, const cadt_snapshot* s, cadt_u32* edges,
                             cadt_counters* counters) {
  const cadt_u32 t1 = 2u * i, t2 = 2u * i + 1u;
  /* i takes the place of v0 in t, of v1 in t1, of v2 in t2 */
  CADT_NOISE_AT(m, CADT_AT_WRITE);
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
  CADT_NOISE_AT(m, CADT_AT_NEXT_TRIANGLE);
  cadt_store_from(m, t, 0u, &r0);
#else
  cadt_new_triangle(m, t1, s->v0, i, s->v2, CADT_HALF_EDGE(t, 1u), s->n1, CADT_HALF_EDGE(t2, 1u),
                    cadt_flips_set(0u, 1u, cadt_flips_get(s->flips, 1u)));
  cadt_new_triangle(m, t2, s->v0, s->v1, i, CADT_HALF_EDGE(t, 2u), CADT_HALF_EDGE(t1, 2u), s->n2,
                    cadt_flips_set(0u, 2u, cadt_flips_get(s->flips, 2u)));
  CADT_NOISE_AT(m, CADT_AT_NEXT_TRIANGLE);
  cadt_store_vertex(m, t, 0u, i);
  cadt_store_half_edge(m, t, 1u, CADT_HALF_EDGE(t1, 0u));
  cadt_store_half_edge(m, t, 2u, CADT_HALF_EDGE(t2, 0u));
  cadt_store_flips(m, t, cadt_flips_set(0u, 0u, cadt_flips_get(s->flips, 0u)));
#endif
  CADT_LAP(counters, CADT_TIME_SPLIT);
  CADT_NOISE_AT(m, CADT_AT_HALF_EDGES);
  cadt_relink(m, s->n1, CADT_HALF_EDGE(t1, 1u));
  CADT_NOISE_AT(m, CADT_AT_NEXT_HALF_EDGE);
  cadt_relink(m, s->n2, CADT_HALF_EDGE(t2, 2u));
  CADT_LAP(counters, CADT_TIME_NEIGHBORS);
  edges[0] = CADT_HALF_EDGE(t, 0u);
  edges[1] = CADT_HALF_EDGE(t1, 1u);
  edges[2] = CADT_HALF_EDGE(t2, 2u);
  counters->count[CADT_COUNT_SPLITS]++;
}

/* Splits the face at `place` by vertex i. \post 1: `edges` has the three links opposite i; 0: nothing changed. */
CADT_FN cadt_u32 cadt_split_face(const cadt_locked_mesh* m, cadt_u32 i, const cadt_place* place, cadt_u32* edges,
                                 cadt_counters* counters) {
  const cadt_u32 t = place->triangle, t1 = 2u * i, t2 = 2u * i + 1u;
  cadt_snapshot s = place->at;
  if (!cadt_is_unlocked(s.lock)) {
    counters->count[CADT_COUNT_LOCK_ATTEMPTS]++;
    CADT_COUNT_NOW(counters, CADT_COUNT_LOCK_FAILURES);
    return 0u;
  }
  cadt_lock_set locks;
  locks.triangle[0] = t;
  locks.version[0] = s.lock;
  locks.triangle[1] = CADT_TRIANGLE_OF(s.n1);
  locks.triangle[2] = CADT_TRIANGLE_OF(s.n2);
  locks.version[1] = locks.version[2] = CADT_ANY_VERSION;
  locks.triangle[3] = CADT_NONE;
  locks.version[3] = 0u;
  if (!cadt_try_lock(m, &locks, counters)) return 0u;
  if (!cadt_validate(m, t, 0u, CADT_HALF_EDGES_12, &s)) return cadt_unlock_invalid(m, &locks, counters);
  cadt_write_face(m, i, t, &s, edges, counters);
  cadt_fence_before_unlock();
  CADT_NOISE_AT(m, CADT_AT_PUBLISH);
  cadt_publish_triangle(m, t1);
  CADT_NOISE_AT(m, CADT_AT_NEXT_PUBLISH);
  cadt_publish_triangle(m, t2);
  cadt_unlock(m, &locks);
  CADT_LAP(counters, CADT_TIME_LOCK);
  return 3u;
}

/* The stores of a split by vertex i of the edge at `place` and its two triangles, the second one seen as `u`. `edges`
 * gets the four links opposite i. \pre nobody else changes the two, or the links back to them across the edges that go
 * to new records */
CADT_FN void cadt_write_edge(const cadt_locked_mesh* m, cadt_u32 i, const cadt_place* place, const cadt_snapshot* u,
                             cadt_u32* edges, cadt_counters* counters) {
  const cadt_snapshot* s = &place->at;
  const cadt_u32 t = place->triangle, k = place->edge, k1 = CADT_NEXT(k), k2 = CADT_PREV(k);
  const cadt_u32 across = CADT_NEIGHBOR(*s, k), n = CADT_TRIANGLE_OF(across), j = CADT_EDGE_OF(across);
  const cadt_u32 j1 = CADT_NEXT(j), j2 = CADT_PREV(j), ts = 2u * i, ns = 2u * i + 1u;
  /* t = (c, a, b), n = (d, b, a) from vertices k and j on; i is between a and b */
  const cadt_u32 a = CADT_VERTEX(*s, k1), b = CADT_VERTEX(*s, k2), c = CADT_VERTEX(*s, k), d = CADT_VERTEX(*u, j);
  const cadt_u32 outer_bc = CADT_NEIGHBOR(*s, k1), outer_ad = CADT_NEIGHBOR(*u, j1);
  /* new records, each in the slots of its parent: ts = (c, i, b), ns = (d, i, a) */
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
  CADT_NOISE_AT(m, CADT_AT_WRITE);
  cadt_store_vertex(m, t, k2, i);
  cadt_store_half_edge(m, t, k, CADT_HALF_EDGE(ns, j));
  cadt_store_half_edge(m, t, k1, CADT_HALF_EDGE(ts, k2));
  cadt_store_flips(m, t, cadt_flips_set(0u, k2, cadt_flips_get(s->flips, k2)));
  CADT_NOISE_AT(m, CADT_AT_NEXT_TRIANGLE);
  cadt_store_vertex(m, n, j2, i);
  cadt_store_half_edge(m, n, j, CADT_HALF_EDGE(ts, k));
  cadt_store_half_edge(m, n, j1, CADT_HALF_EDGE(ns, j2));
  cadt_store_flips(m, n, cadt_flips_set(0u, j2, cadt_flips_get(u->flips, j2)));
  CADT_LAP(counters, CADT_TIME_SPLIT);
  CADT_NOISE_AT(m, CADT_AT_HALF_EDGES);
  cadt_relink(m, outer_bc, CADT_HALF_EDGE(ts, k1));
  CADT_NOISE_AT(m, CADT_AT_NEXT_HALF_EDGE);
  cadt_relink(m, outer_ad, CADT_HALF_EDGE(ns, j1));
  CADT_LAP(counters, CADT_TIME_NEIGHBORS);
  edges[0] = CADT_HALF_EDGE(t, k2);
  edges[1] = CADT_HALF_EDGE(ts, k1);
  edges[2] = CADT_HALF_EDGE(n, j2);
  edges[3] = CADT_HALF_EDGE(ns, j1);
  counters->count[CADT_COUNT_EDGE_SPLITS]++;
}

/* Splits the edge at `place` and its two triangles by vertex i. \post 4: `edges` has the four links opposite i; 0:
 * nothing changed. */
CADT_FN cadt_u32 cadt_split_edge(const cadt_locked_mesh* m, cadt_u32 i, const cadt_place* place, cadt_u32* edges,
                                 cadt_counters* counters) {
  const cadt_u32 t = place->triangle, k = place->edge, k1 = CADT_NEXT(k);
  cadt_snapshot s = place->at;
  const cadt_u32 across = CADT_NEIGHBOR(s, k), n = CADT_TRIANGLE_OF(across), j = CADT_EDGE_OF(across);
  const cadt_u32 j1 = CADT_NEXT(j), ts = 2u * i, ns = 2u * i + 1u;
  CADT_NOISE_AT(m, CADT_AT_SECOND);
  cadt_snapshot u = cadt_look(m, n);
  if (CADT_NEIGHBOR(u, j) != CADT_HALF_EDGE(t, k)) {
    counters->count[CADT_COUNT_LOCK_ATTEMPTS]++;
    CADT_COUNT_NOW(counters, CADT_COUNT_LOCK_FAILURES);
    CADT_COUNT_NOW(counters, CADT_COUNT_INVALIDATED);
    return 0u;
  }
  const cadt_u32 outer_bc = CADT_NEIGHBOR(s, k1), outer_ad = CADT_NEIGHBOR(u, j1);
  cadt_lock_set locks;
  locks.triangle[0] = t;
  locks.version[0] = s.lock;
  locks.triangle[1] = n;
  locks.version[1] = u.lock ? u.lock : 1u;
  locks.triangle[2] = CADT_TRIANGLE_OF(outer_bc);
  locks.triangle[3] = CADT_TRIANGLE_OF(outer_ad);
  locks.version[2] = locks.version[3] = CADT_ANY_VERSION;
  if (!cadt_try_lock(m, &locks, counters)) return 0u;
  if (!cadt_validate(m, t, 0u, CADT_HALF_EDGES_ALL, &s) || !cadt_validate(m, n, 0u, CADT_HALF_EDGES_ALL, &u))
    return cadt_unlock_invalid(m, &locks, counters);
  cadt_write_edge(m, i, place, &u, edges, counters);
  cadt_fence_before_unlock();
  CADT_NOISE_AT(m, CADT_AT_PUBLISH);
  cadt_publish_triangle(m, ts);
  CADT_NOISE_AT(m, CADT_AT_NEXT_PUBLISH);
  cadt_publish_triangle(m, ns);
  cadt_unlock(m, &locks);
  CADT_LAP(counters, CADT_TIME_LOCK);
  return 4u;
}

/* Whether the edge a, b between the triangles p, a, b and q, b, a must be flipped. A circle through the ghost is the
 * outer side of a hull edge. */
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

/* Smallest angle of the triangle of points 0, u and v. The one between the longer sides: it has the largest scalar
 * product, and the three have the vector product in common. */
CADT_FN cadt_real cadt_smallest_angle(cadt_real ux, cadt_real uy, cadt_real vx, cadt_real vy) {
  const cadt_real at_0 = ux * vx + uy * vy, at_u = ux * (ux - vx) + uy * (uy - vy),
                  at_v = vx * (vx - ux) + vy * (vy - uy);
  cadt_real largest = at_0 > at_u ? at_0 : at_u;
  if (at_v > largest) largest = at_v;
  return cadt_atan2(cadt_fabs(ux * vy - uy * vx), largest);
}

/* The quality check of Algorithm 4 of the paper: whether a flip of the illegal edge a, b to p, q is worth while. It is
 * if the determinant, with lengths in units of the largest coordinate difference, is not near zero, or if the smallest
 * angle grows, in degrees. (The paper names no units. With radians, or with the determinant alone, the mesh of
 * perturbed circles would differ by 2.8 to 4.3 %, and not by less than the paper's 0.3 %: docs/evaluation.md.) */
CADT_FN_SLOW cadt_u32 cadt_flip_gains(cadt_point p, cadt_point a, cadt_point b, cadt_point q, cadt_real epsilon) {
  cadt_real d[6], unit = 0.0;
  d[0] = p.x - q.x, d[1] = p.y - q.y, d[2] = a.x - q.x, d[3] = a.y - q.y, d[4] = b.x - q.x, d[5] = b.y - q.y;
  for (cadt_u32 i = 0u; i < 6u; ++i)
    if (cadt_fabs(d[i]) > unit) unit = cadt_fabs(d[i]);
  for (cadt_u32 i = 0u; i < 6u; ++i) d[i] /= unit;
  const cadt_real px = d[0], py = d[1], ax = d[2], ay = d[3], bx = d[4], by = d[5];
  const cadt_real p2 = px * px + py * py, a2 = ax * ax + ay * ay, b2 = bx * bx + by * by;
  const cadt_real det = p2 * (ax * by - bx * ay) + a2 * (bx * py - px * by) + b2 * (px * ay - ax * py);
  if (det >= epsilon) return 1u;
  /* from q: the triangles q, b, a and p, a, b before; p, a, q and q, b, p after */
  const cadt_real before_1 = cadt_smallest_angle(bx, by, ax, ay);
  const cadt_real before_2 = cadt_smallest_angle(ax - px, ay - py, bx - px, by - py);
  const cadt_real after_1 = cadt_smallest_angle(px, py, ax, ay), after_2 = cadt_smallest_angle(bx, by, px, py);
  const cadt_real before = before_1 < before_2 ? before_1 : before_2, after = after_1 < after_2 ? after_1 : after_2;
  return (after - before) * 57.295779513082323 > epsilon ? 1u
                                                         : 0u; /* no number (a difference has overflowed): no gain */
}

/* Whether the illegal edge a, b, edge k of record t, is left as it is because of its flips (paper, section 4.4.4). Hull
 * edges are not: the hull shall be convex. */
CADT_FN cadt_u32 cadt_is_left(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 k, cadt_u32 p, cadt_u32 a, cadt_u32 b,
                              cadt_u32 q) {
  if (m->stabilize == CADT_CAST(cadt_u32, CADT_STABILIZE_OFF)) return 0u;
  if (cadt_flips_get(cadt_load_field(m->locked[t].word + CADT_WORD_FLIPS), k) <= m->threshold) return 0u;
  if (a == CADT_GHOST || b == CADT_GHOST) return 0u;
  if (m->stabilize == CADT_CAST(cadt_u32, CADT_STABILIZE_DEFER)) return 1u;
  return cadt_flip_gains(cadt_point_of(m, p), cadt_point_of(m, a), cadt_point_of(m, b), cadt_point_of(m, q), m->epsilon)
             ? 0u
             : 1u;
}

/* The stores of a flip of the edge `link`, with its two triangles seen from it as `s` and `u`. \pre nobody else changes
 * the two, or the links back to them across the edges that change sides */
CADT_FN void cadt_write_flip(const cadt_locked_mesh* m, cadt_u32 half_edge, const cadt_snapshot* s,
                             const cadt_snapshot* u, cadt_counters* counters) {
  const cadt_u32 t = CADT_TRIANGLE_OF(half_edge), k = CADT_EDGE_OF(half_edge), k1 = CADT_NEXT(k), k2 = CADT_PREV(k);
  const cadt_u32 n = CADT_TRIANGLE_OF(s->n0), j = CADT_EDGE_OF(s->n0), j1 = CADT_NEXT(j), j2 = CADT_PREV(j);
  const cadt_u32 outer_bp = s->n1, outer_aq = u->n1;
  /* t = (p, a, b) becomes (p, a, u->v0); n = (q, b, a) becomes (q, b, p); the counter of a-b goes on with p-q */
  const cadt_u32 flips = cadt_flips_get(s->flips, k) + 1u;
  CADT_NOISE_AT(m, CADT_AT_WRITE);
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
  CADT_NOISE_AT(m, CADT_AT_NEXT_TRIANGLE);
  cadt_store_from(m, n, j, &rn);
  (void)k2, (void)j2;
#else
  cadt_store_vertex(m, t, k2, u->v0);
  cadt_store_half_edge(m, t, k, outer_aq);
  cadt_store_half_edge(m, t, k1, CADT_HALF_EDGE(n, j1));
  cadt_store_flips(m, t, cadt_flips_set(cadt_flips_set(s->flips, k, cadt_flips_get(u->flips, j1)), k1, flips));
  CADT_NOISE_AT(m, CADT_AT_NEXT_TRIANGLE);
  cadt_store_vertex(m, n, j2, s->v0);
  cadt_store_half_edge(m, n, j, outer_bp);
  cadt_store_half_edge(m, n, j1, CADT_HALF_EDGE(t, k1));
  cadt_store_flips(m, n, cadt_flips_set(cadt_flips_set(u->flips, j, cadt_flips_get(s->flips, k1)), j1, flips));
#endif
  CADT_LAP(counters, CADT_TIME_FLIP);
  CADT_NOISE_AT(m, CADT_AT_HALF_EDGES);
  cadt_relink(m, outer_aq, CADT_HALF_EDGE(t, k));
  CADT_NOISE_AT(m, CADT_AT_NEXT_HALF_EDGE);
  cadt_relink(m, outer_bp, CADT_HALF_EDGE(n, j));
  CADT_LAP(counters, CADT_TIME_NEIGHBORS);
  counters->count[CADT_COUNT_FLIPS]++;
}

/* Tests an edge and flips it if it is illegal. `apex` is the vertex expected opposite of it, `apex_point` where it is,
 * or CADT_NONE for any.
 * \post CADT_EDGE_LEFT: it is illegal and stays so, for now or for good (cadt_is_left). CADT_EDGE_FLIPPED: the edge's
 * record keeps its link, `*partner` is the record and edge on the other side of the quadrilateral that is now opposite
 * the same apex; `*all_sides`: the apex is another one than expected, so all four sides of the quadrilateral may be
 * illegal. */
CADT_FN cadt_u32 cadt_legalize_edge(const cadt_locked_mesh* m, cadt_u32 half_edge, cadt_u32 apex, cadt_point apex_point,
                                    cadt_u32* partner, cadt_u32* all_sides, cadt_counters* counters) {
  const cadt_u32 t = CADT_TRIANGLE_OF(half_edge), k = CADT_EDGE_OF(half_edge);
  cadt_snapshot s = cadt_look_from(m, t, k);
  const cadt_u32 p = s.v0;
  if (!cadt_is_unlocked(s.lock)) {
    counters->count[CADT_COUNT_LOCK_ATTEMPTS]++; /* an attempt that ends before its first compare-and-swap */
    CADT_COUNT_NOW(counters, CADT_COUNT_LOCK_FAILURES);
    CADT_LAP(counters, CADT_TIME_TEST);
    return CADT_EDGE_CONFLICT;
  }
  /* A vertex of the triangle was flipped away by another thread, which did not know that this edge had yet to be
   * checked: the check is owed all the same. */
  *all_sides = p != apex ? 1u : 0u;
  if (p != apex && apex != CADT_NONE) CADT_COUNT_NOW(counters, CADT_COUNT_STALE_EDGES);
  const cadt_u32 across = s.n0, n = CADT_TRIANGLE_OF(across), j = CADT_EDGE_OF(across);
  CADT_NOISE_AT(m, CADT_AT_SECOND);
  cadt_snapshot u = cadt_look_from(m, n, j);
  if (!cadt_is_unlocked(u.lock) || u.n0 != half_edge) {
    counters->count[CADT_COUNT_LOCK_ATTEMPTS]++;
    CADT_COUNT_NOW(counters, CADT_COUNT_LOCK_FAILURES);
    if (cadt_is_unlocked(u.lock)) CADT_COUNT_NOW(counters, CADT_COUNT_INVALIDATED);
    CADT_LAP(counters, CADT_TIME_TEST);
    return CADT_EDGE_CONFLICT;
  }
  const cadt_u32 q = u.v0;
  cadt_u32 illegal;
  /* the ghost is CADT_NONE, too */
  if (p == apex && p != CADT_GHOST && s.v1 != CADT_GHOST && s.v2 != CADT_GHOST && q != CADT_GHOST) {
    counters->count[CADT_COUNT_INCIRCLE_TESTS]++;
    illegal =
        cadt_incircle(apex_point, cadt_point_of(m, s.v1), cadt_point_of(m, s.v2), cadt_point_of(m, q), counters) > 0;
  } else {
    illegal = cadt_is_illegal(m, p, s.v1, s.v2, q, counters);
  }
  CADT_LAP(counters, CADT_TIME_TEST);
  if (!illegal) return CADT_EDGE_LEGAL;
  if (cadt_is_left(m, t, k, p, s.v1, s.v2, q)) {
    CADT_COUNT_NOW(counters, CADT_COUNT_STABILIZED);
    CADT_LAP(counters, CADT_TIME_TEST);
    return CADT_EDGE_LEFT;
  }
  const cadt_u32 outer_bp = s.n1, outer_aq = u.n1;
  cadt_lock_set locks;
  locks.triangle[0] = t;
  locks.version[0] = s.lock;
  locks.triangle[1] = n;
  locks.version[1] = u.lock;
  locks.triangle[2] = CADT_TRIANGLE_OF(outer_bp);
  locks.triangle[3] = CADT_TRIANGLE_OF(outer_aq);
  locks.version[2] = locks.version[3] = CADT_ANY_VERSION;
  if (!cadt_try_lock(m, &locks, counters)) return CADT_EDGE_CONFLICT;
  u.v1 = s.v2; /* as neighbours have it: what was read need not be kept until here */
  u.v2 = s.v1;
  u.n0 = half_edge;
  const cadt_u32 same = cadt_validate(m, t, k, CADT_HALF_EDGES_01, &s); /* both at once: reading takes long */
  if (!(same & cadt_validate(m, n, j, CADT_HALF_EDGES_01, &u))) {
    cadt_unlock_invalid(m, &locks, counters);
    return CADT_EDGE_CONFLICT;
  }
  cadt_write_flip(m, half_edge, &s, &u, counters);
  cadt_fence_before_unlock();
  cadt_unlock(m, &locks);
  CADT_LAP(counters, CADT_TIME_LOCK);
  CADT_NOISE_AT(m, CADT_AT_NEW_START);
  cadt_set_vertex_triangle(m, s.v1, t);
  cadt_set_vertex_triangle(m, s.v2, n);
  CADT_LAP(counters, CADT_TIME_FLIP);
  *partner = CADT_HALF_EDGE(n, CADT_PREV(j));
  return CADT_EDGE_FLIPPED;
}

#endif
