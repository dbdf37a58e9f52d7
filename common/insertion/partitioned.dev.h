/* SPDX-License-Identifier: Apache-2.0
 *
 * Insertion without locks, for CPUs. Each work-item owns a partition: consecutive positions, and so a compact piece of
 * the plane, since positions are sorted along a curve. It inserts the points of its partition into a mesh of few points
 * that is already there.
 *
 * It changes a triangle only if it owns all three vertices, and flips an edge only if it owns all four vertices of the
 * two triangles. So no two work-items change the same triangle, and triangles with vertices of several partitions, or
 * with the ghost, keep their vertices: they form a border around each partition that does not move.
 *
 *      o---o---o . . . x---x---x         o, x     vertices of two partitions
 *      | \ | \ | .   . | \ | \ |         --- |    edges of triangles with one owner, who splits and flips them
 *      o---o---o . . . x---x---x         . .      the border: triangles with vertices of both
 *
 * In a triangle of the border, only the owner of both ends of an edge writes the half-edge across it. So no word of a
 * locked triangle is written by two work-items, and what a work-item reads of its own triangles is what it wrote: no
 * lock is needed. A walk may stray to where others work; what it reads there may be torn, as in every walk, and a
 * triangle that it finds with three vertices of its own partition is its own.
 *
 * A point in a triangle of the border is deferred to a launch with locks, and edges of such a triangle stay as they
 * are: within its border each partition has a constrained Delaunay mesh. When all partitions are done,
 * cadt_border_sweep tests the edges of the border and repairs them, with locks.
 */
#ifndef CADT_INSERTION_PARTITIONED_H
#define CADT_INSERTION_PARTITIONED_H

#include "common/insertion/insert.dev.h"

typedef struct {
  cadt_u32 begin, size;
} cadt_partition;

CADT_FN cadt_u32 cadt_owns(const cadt_partition* partition, cadt_u32 vertex) {
  return vertex - partition->begin < partition->size ? 1u : 0u;
}
CADT_FN cadt_u32 cadt_owns_all(const cadt_partition* partition, const cadt_snapshot* s) {
  return cadt_owns(partition, s->v0) & cadt_owns(partition, s->v1) & cadt_owns(partition, s->v2);
}

/* Incircle of the counterclockwise triangle of vertices a, b, c and p; u, v, w are a, b, c as seen from p. */
CADT_FN cadt_i32 cadt_incircle_lifted(const cadt_locked_mesh* m, cadt_u32 a, cadt_u32 b, cadt_u32 c, cadt_point p,
                                      cadt_lifted_vector u, cadt_lifted_vector v, cadt_lifted_vector w,
                                      cadt_counters* counters) {
#if CADT_SHARED_LIFTS
  const cadt_i32 sign = cadt_incircle_loose_filter(u, v, w);
  if (sign != 0) return sign;
#else
  (void)u, (void)v, (void)w;
#endif
  return cadt_incircle_staged(m->points[a], m->points[b], m->points[c], p, counters);
}

/* Legalises the edges opposite a new vertex at p, of own triangles, one after the other around it from `half_edge` on.
 * A flip replaces one edge by two, and the first of them is next. */
CADT_FN_INLINE void cadt_legalize_around(const cadt_locked_mesh* m, const cadt_partition* partition, cadt_u32 half_edge,
                                         cadt_point p, cadt_counters* counters) {
  cadt_snapshot s = cadt_snapshot_from(m, CADT_TRIANGLE_OF(half_edge), CADT_EDGE_OF(half_edge));
  const cadt_u32 first = s.v1;
  cadt_lifted_vector a = cadt_lifted_vector_of(p, m->points[s.v1]), b = cadt_lifted_vector_of(p, m->points[s.v2]);
  for (;;) {
    const cadt_u32 n = CADT_TRIANGLE_OF(s.n0), j = CADT_EDGE_OF(s.n0);
    const cadt_snapshot u = cadt_snapshot_from(m, n, j);
    if (cadt_owns(partition, u.v0)) {
      const cadt_lifted_vector q = cadt_lifted_vector_of(p, m->points[u.v0]);
      counters->count[CADT_COUNT_INCIRCLE_TESTS]++;
      const cadt_i32 side = cadt_incircle_lifted(m, s.v1, u.v0, s.v2, p, a, q, b, counters);
      CADT_ADD_TIME(counters, CADT_TIME_TEST);
      if (side > 0 && !cadt_edge_is_constrained(m, CADT_TRIANGLE_OF(half_edge), CADT_EDGE_OF(half_edge))) {
        cadt_write_flip(m, half_edge, &s, &u, counters);
        cadt_store_relaxed(m->vertex_to_triangle + s.v1, CADT_TRIANGLE_OF(half_edge));
        cadt_store_relaxed(m->vertex_to_triangle + s.v2, n);
        counters->count[CADT_COUNT_LOCK_ATTEMPTS]++;
        s.v2 = u.v0;
        s.n0 = u.n1;
        s.n1 = CADT_HALF_EDGE(n, CADT_NEXT(j));
        s.flips = cadt_load_relaxed(m->locked[CADT_TRIANGLE_OF(half_edge)].word + CADT_WORD_FLIPS);
        b = q;
        CADT_ADD_TIME(counters, CADT_TIME_FLIP);
        continue;
      }
    }
    if (s.v2 == first) break;
    /* in the next triangle, p follows the vertex opposite the edge that it shares with this one */
    half_edge = CADT_HALF_EDGE(CADT_TRIANGLE_OF(s.n1), CADT_NEXT(CADT_EDGE_OF(s.n1)));
    s = cadt_snapshot_from(m, CADT_TRIANGLE_OF(half_edge), CADT_EDGE_OF(half_edge));
    a = b;
    b = cadt_lifted_vector_of(p, m->points[s.v2]);
    CADT_ADD_TIME(counters, CADT_TIME_OTHER);
  }
}

enum { CADT_PARTITION_WALK_LIMIT = 64 /* steps of a walk that does not try edges in random order */ };

/* Walks from triangle `start` through own triangles. Nobody else changes them, so an edge tested from one side need not
 * be tested from the other. \post 1: `place` is that of p, in own triangles; 0: `place->triangle` is where the walk
 * ended */
CADT_FN_INLINE cadt_u32 cadt_locate_in_partition(const cadt_locked_mesh* m, const cadt_partition* partition,
                                                 cadt_point p, cadt_u32 start, cadt_place* place,
                                                 cadt_counters* counters) {
  cadt_u32 steps = 0u, leave = 3u, t = start;
  cadt_snapshot s = cadt_snapshot_of(m, t);
  place->triangle = t;
  if (s.lock == 0u || !cadt_owns_all(partition, &s)) return 0u;
  cadt_u32 on = 0u;
  leave = cadt_leave_face(m, &s, 3u, 0u, p, &on, counters);
  while (leave != 3u) {
    const cadt_u32 half_edge = CADT_NEIGHBOR(s, leave), j = CADT_EDGE_OF(half_edge);
    place->triangle = t = CADT_TRIANGLE_OF(half_edge);
    if (++steps > CADT_CAST(cadt_u32, CADT_PARTITION_WALK_LIMIT)) break;
    s = cadt_snapshot_of(m, t);
    const cadt_snapshot r = cadt_snapshot_from(m, t, j);
    if (!cadt_owns(partition, r.v0)) break;
    const cadt_point q = m->points[r.v0];
    const cadt_i32 o1 = cadt_orientation(m->points[r.v2], q, p, counters);
    if (o1 < 0) {
      leave = CADT_NEXT(j);
      continue;
    }
    const cadt_i32 o2 = cadt_orientation(q, m->points[r.v1], p, counters);
    if (o2 < 0) {
      leave = CADT_PREV(j);
      continue;
    }
    on = (o1 == 0 ? 1u << CADT_NEXT(j) : 0u) | (o2 == 0 ? 1u << CADT_PREV(j) : 0u);
    leave = 3u;
  }
  counters->count[CADT_COUNT_WALK_STEPS] += steps;
  if (leave != 3u || (on & (on - 1u))) return 0u;
  place->kind = on ? CADT_ON_EDGE : CADT_IN_FACE;
  place->edge = on >> 1;
  place->at = s;
  return 1u;
}

/* Inserts vertex i with a walk from `start`, in own triangles, and legalises. 0 if it cannot be done there. */
CADT_FN_INLINE cadt_u32 cadt_insert_in_partition(const cadt_locked_mesh* m, const cadt_partition* partition, cadt_u32 i,
                                                 cadt_u32 start, cadt_counters* counters) {
  const cadt_point p = m->points[i];
  cadt_place place = {CADT_LOST, start, 0u, {0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u}};
  cadt_u32 edges[4], done = 0u;
  CADT_ADD_TIME(counters, CADT_TIME_OTHER);
  if (!cadt_locate_in_partition(m, partition, p, start, &place, counters)) {
    cadt_locate(m, p, place.triangle, &place, counters);
    if (place.kind == CADT_LOST || !cadt_owns_all(partition, &place.at)) place.kind = CADT_LOST;
  }
  CADT_ADD_TIME(counters, CADT_TIME_LOCATE);
  if (place.kind == CADT_IN_FACE) {
    cadt_write_face_split(m, i, place.triangle, &place.at, edges, counters);
    done = 1u;
  } else if (place.kind == CADT_ON_EDGE) {
    const cadt_snapshot u = cadt_snapshot_of(m, CADT_TRIANGLE_OF(CADT_NEIGHBOR(place.at, place.edge)));
    if (cadt_owns_all(partition, &u)) {
      cadt_write_edge_split(m, i, &place, &u, edges, counters);
      done = 1u;
    }
  }
  cadt_store_relaxed(m->vertex_to_triangle + i, place.triangle);
  if (!done) return 0u;
  CADT_NOISE_AT(m, CADT_SITE_PARTITION);
  cadt_publish_triangle(m, 2u * i);
  cadt_publish_triangle(m, 2u * i + 1u);
  counters->count[CADT_COUNT_LOCK_ATTEMPTS]++;
  cadt_legalize_around(m, partition, edges[0], p, counters);
  return 1u;
}

#if CADT_BUILDS(INSERTION)
/* Inserts, in each of the `partitions` of 2^level * blocks positions, the points of blocks `from` to `to` - 1 but the
 * blocks' representatives. A block is finished before the next, so that what is read again is still in the cache. \pre
 * the representatives of all blocks are in the mesh */
CADT_KERNEL(cadt_insert_partitions, CADT_LOCKED_MESH_PARAMETERS, cadt_u32 n, cadt_u32 level, cadt_u32 partitions,
            cadt_u32 blocks, cadt_u32 from, cadt_u32 to, CADT_GLOBAL cadt_u32* deferred_points,
            CADT_GLOBAL cadt_u32* deferred_counts, CADT_GLOBAL cadt_u32* counter_rows) {
#if CADT_CONTIGUOUS
  if (cadt_item >= partitions) return;
  CADT_GROUP_COUNTERS(counters, counter_rows);
  CADT_LOCKED_MESH(mesh);
  const cadt_u32 own = cadt_begin_of(cadt_item, blocks << level, n);
  const cadt_partition partition = {own, cadt_min_u32(blocks << level, n - own)};
  CADT_SET_PARTITION(mesh, partition.begin, partition.size);
  cadt_u32 stalled_blocks = 0u; /* consecutive blocks of which most points were deferred */
  for (cadt_u32 block = (partition.begin >> level) + from; block < (partition.begin >> level) + to; ++block) {
    /* Where all points lie on the hull, or all triangles have a vertex in common, hardly a triangle belongs to one
     * partition: after sixteen stalled blocks, more than lie along a border by chance, only one of sixteen is tried. */
    const cadt_u32 stalled = stalled_blocks > 16u && stalled_blocks % 16u != 0u ? 1u : 0u;
    cadt_u32 inserted = 0u, deferred = 0u;
    for (cadt_u32 l = level; l-- > 0u;) {
      const cadt_u32 begin = block << (level - l - 1u), end = begin + (1u << (level - l - 1u));
      for (cadt_u32 b = begin; b < end && CADT_CAST(cadt_u64, 2u * b + 1u) << l < n; ++b) {
        const cadt_u32 inserted_half = 2u * b + cadt_right_half(l + 1u, b);
        const cadt_u32 i = cadt_representative(l, inserted_half ^ 1u, n);
        const cadt_u32 start = cadt_load_relaxed(mesh.vertex_to_triangle + cadt_representative(l, inserted_half, n));
        if (i == first || i == second || i == third) continue;
        if (stalled) {
          cadt_store_relaxed(mesh.vertex_to_triangle + i, CADT_NONE);
        } else if (cadt_insert_in_partition(&mesh, &partition, i, start, &counters)) {
          ++inserted;
          continue;
        }
        deferred_points[cadt_add_relaxed(deferred_counts, 1u)] = i;
        ++deferred;
      }
    }
    counters.count[CADT_COUNT_DEFERRED_POINTS] += deferred;
    stalled_blocks = deferred <= inserted ? 0u : stalled_blocks + 1u;
  }
  CADT_FLUSH_COUNTERS(&counters, counter_rows);
#endif
}
#endif

/* Whether all three vertices are in the same partition of `size` positions. */
CADT_FN cadt_u32 cadt_in_same_partition(cadt_u32 a, cadt_u32 b, cadt_u32 c, cadt_u32 size) {
  const cadt_partition partition = {a - a % size, size};
  return a != CADT_GHOST && cadt_owns(&partition, b) && cadt_owns(&partition, c) ? 1u : 0u;
}

#if CADT_BUILDS(INSERTION)
/* Tests the edges between triangles with all vertices in one partition of `size` positions and other triangles, and
 * repairs illegal ones. The edges between two of the others have not changed. */
CADT_KERNEL(cadt_border_sweep, CADT_LOCKED_MESH_PARAMETERS, cadt_u32 count, cadt_u32 grain, cadt_u32 size,
            CADT_GLOBAL cadt_u32* deferred_edges, CADT_GLOBAL cadt_u32* deferred_counts, cadt_u32 edge_capacity,
            CADT_GLOBAL cadt_u32* counter_rows) {
#if CADT_CONTIGUOUS
  CADT_GROUP_COUNTERS(counters, counter_rows);
  CADT_LOCKED_MESH(mesh);
  const cadt_deferred deferred = {deferred_edges, deferred_counts, edge_capacity};
  CADT_DECLARE_WORKLIST(work);
  CADT_FOR(t, count, grain) {
    const cadt_snapshot s = cadt_snapshot_of(&mesh, t);
    if (s.lock == 0u || cadt_in_same_partition(s.v0, s.v1, s.v2, size)) continue;
    cadt_worklist_begin(&work, CADT_NONE, CADT_EDGE_FLIP_LIMIT);
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 across = CADT_NEIGHBOR(s, k);
      const cadt_u32 q = cadt_load_field(locked[CADT_TRIANGLE_OF(across)].word + CADT_EDGE_OF(across));
      if (cadt_in_same_partition(CADT_VERTEX(s, CADT_NEXT(k)), CADT_VERTEX(s, CADT_PREV(k)), q, size))
        cadt_worklist_add(&work, CADT_HALF_EDGE(t, k));
    }
    cadt_legalize(&mesh, &work, &deferred, &counters);
  }
  CADT_FLUSH_COUNTERS(&counters, counter_rows);
#endif
}
#endif

#endif
