/* SPDX-License-Identifier: Apache-2.0
 *
 * The mesh while points are inserted. A locked triangle takes 32 bytes: three vertices, the lock word, three half-edges
 * and the flip counters.
 *
 *           v0
 *          /  \             counterclockwise; edge k lies opposite vertex k
 *     n2  /    \  n1
 *        /  t   \           nk = u * 4 + j: across edge k of t lies edge j of triangle u,
 *      v1 ------ v2         and nj of u is t * 4 + k
 *           n0
 *
 * A vertex is the index of its point: in sorted order, or on GPUs in the order of insertion. One ghost vertex at
 * infinity closes the mesh to a sphere: each hull edge has a ghost triangle, and n vertices have exactly 2n - 2
 * triangles. Triangles are never removed: inserting point i rewrites one or two triangles and creates triangles 2i and
 * 2i + 1; a flip rewrites two. So no allocation counter is needed.
 *
 * Vertices keep their slots in splits and flips. So a half-edge stays right where the edge it names does not change,
 * and the triangle that holds it need not be locked: a split 1->3 locks three triangles, a split 2->4 and a flip lock
 * four (docs/insertion.md).
 */
#ifndef CADT_MESH_LOCKED_MESH_H
#define CADT_MESH_LOCKED_MESH_H

#include "common/overlay/schedule_noise.dev.h"
#include "common/portable/layout.dev.h"
#include "common/predicates/filtered_predicates.dev.h"

/* The mesh as the kernels see it. `center` is the centroid of three vertices, the first ones
 * (seed_triangle.dev.h) or of the base (base_mesh.dev.h), rounded. */
typedef struct {
  CADT_GLOBAL cadt_locked_triangle* locked;
  CADT_GLOBAL const cadt_point* points;
  CADT_GLOBAL cadt_u32* vertex_to_triangle; /* position -> a triangle near it, CADT_NONE until the point is inserted */
  CADT_GLOBAL cadt_u32* edge_flags;         /* a word a triangle, bit k: its edge k is constrained; null: none is */
  cadt_point center;
  cadt_u32 first, second, third; /* positions of these three vertices */
  cadt_u32 stabilize,
      threshold; /* what happens to edges flipped more than `threshold` times (stabilized_flips.dev.h) */
  cadt_real epsilon;
#if defined(CADT_CHECKED)
  cadt_u32 partition_begin,
      partition_size; /* the partition of a work-item that takes no locks (partitioned.dev.h), else empty */
#endif
#if defined(CADT_SCHEDULE_NOISE)
  cadt_noise* noise;
#endif
} cadt_locked_mesh;

#define CADT_LOCKED_MESH_PARAMETERS                                                                                \
  CADT_GLOBAL cadt_locked_triangle *locked, CADT_GLOBAL const cadt_point *points,                                  \
      CADT_GLOBAL cadt_u32 *vertex_to_triangle, CADT_GLOBAL cadt_u32 *edge_flags, cadt_real center_x,              \
      cadt_real center_y, cadt_u32 first, cadt_u32 second, cadt_u32 third, cadt_u32 stabilize, cadt_u32 threshold, \
      cadt_real epsilon
#if defined(CADT_CHECKED)
#define CADT_SET_PARTITION(mesh, begin, size) mesh.partition_begin = (begin), mesh.partition_size = (size)
#else
#define CADT_SET_PARTITION(mesh, begin, size) ((void)0)
#endif
#define CADT_LOCKED_MESH(mesh)                  \
  cadt_locked_mesh mesh;                        \
  mesh.locked = locked;                         \
  mesh.points = points;                         \
  mesh.vertex_to_triangle = vertex_to_triangle; \
  mesh.edge_flags = edge_flags;                 \
  mesh.center.x = center_x;                     \
  mesh.center.y = center_y;                     \
  mesh.first = first;                           \
  mesh.second = second;                         \
  mesh.third = third;                           \
  mesh.stabilize = stabilize;                   \
  mesh.threshold = threshold;                   \
  mesh.epsilon = epsilon;                       \
  CADT_SET_PARTITION(mesh, 0u, 0u);             \
  CADT_NOISE_BEGIN(mesh, cadt_item, epsilon)

/* What a triangle held at one moment, if its lock is then taken with this lock word (lock.dev.h; GPUs read again); else
 * it may be torn. */
typedef struct {
  cadt_u32 v0, v1, v2, lock, n0, n1, n2, flips;
} cadt_snapshot;

#define CADT_VERTEX(s, k) CADT_PICK((k), (s).v0, (s).v1, (s).v2)
#define CADT_NEIGHBOR(s, k) CADT_PICK((k), (s).n0, (s).n1, (s).n2)

CADT_FN cadt_point cadt_point_of(const cadt_locked_mesh* m, cadt_u32 vertex) {
  return cadt_load_point(m->points + vertex);
}

CADT_FN cadt_snapshot cadt_snapshot_of(const cadt_locked_mesh* m, cadt_u32 t) {
  cadt_snapshot s;
  cadt_load_triangle(m->locked[t].word, &s.v0, &s.v1, &s.v2, &s.lock, &s.n0, &s.n1, &s.n2, &s.flips);
  return s;
}

/* The same seen from edge k: v0 is the vertex opposite, n0 the half-edge across. CPUs load by index, since choosing by
 * k would be a branch that cannot be predicted; GPUs load the whole triangle and rotate it in registers. */
CADT_FN cadt_snapshot cadt_snapshot_from(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 k) {
#if CADT_CONTIGUOUS
  CADT_GLOBAL cadt_u32* w = m->locked[t].word;
  const cadt_u32 k1 = CADT_NEXT(k), k2 = CADT_PREV(k);
  cadt_snapshot s;
  s.lock = cadt_load_field(w + CADT_WORD_LOCK);
  CADT_NOISE_AT(m, CADT_SITE_FIELDS);
  s.v0 = cadt_load_field(w + k);
  s.v1 = cadt_load_field(w + k1);
  s.v2 = cadt_load_field(w + k2);
  s.n0 = cadt_load_field(w + CADT_WORD_HALF_EDGE + k);
  s.n1 = cadt_load_field(w + CADT_WORD_HALF_EDGE + k1);
  s.n2 = cadt_load_field(w + CADT_WORD_HALF_EDGE + k2);
  s.flips = cadt_load_field(w + CADT_WORD_FLIPS);
  return s;
#else
  const cadt_snapshot s = cadt_snapshot_of(m, t);
  const cadt_snapshot r = {
      CADT_PICK(k, s.v0, s.v1, s.v2), CADT_PICK(k, s.v1, s.v2, s.v0), CADT_PICK(k, s.v2, s.v0, s.v1), s.lock,
      CADT_PICK(k, s.n0, s.n1, s.n2), CADT_PICK(k, s.n1, s.n2, s.n0), CADT_PICK(k, s.n2, s.n0, s.n1), s.flips};
  return r;
#endif
}

#if defined(CADT_CHECKED)
/* Whether triangle t may be changed: it is locked or not there yet, or its vertices lie in the own partition, of which
 * vertex `any` (3: none) need not. */
CADT_FN cadt_u32 cadt_may_store(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 any) {
  const cadt_u32 lock = cadt_load_relaxed(m->locked[t].word + CADT_WORD_LOCK);
  if (m->partition_size == 0u) return lock == 0u || (lock & 1u) ? 1u : 0u;
  for (cadt_u32 k = 0u; lock != 0u && k < 3u; ++k)
    if (k != any && cadt_load_relaxed(m->locked[t].word + k) - m->partition_begin >= m->partition_size) return 0u;
  return 1u;
}
#define CADT_ASSERT_OWNED(m, t, any) cadt_assert_owned(cadt_may_store((m), (t), (any)))
#else
#define CADT_ASSERT_OWNED(m, t, any) ((void)0)
#endif

/* \pre the caller owns triangle t, or no half-edge names it yet */
CADT_FN void cadt_store_vertices(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 v0, cadt_u32 v1, cadt_u32 v2) {
  CADT_GLOBAL cadt_u32* w = m->locked[t].word;
  CADT_ASSERT_OWNED(m, t, 3u);
  cadt_store_field(w, v0);
  cadt_store_field(w + 1, v1);
  cadt_store_field(w + 2, v2);
}
CADT_FN void cadt_store_vertex(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 k, cadt_u32 v) {
  CADT_ASSERT_OWNED(m, t, 3u);
  cadt_store_field(m->locked[t].word + k, v);
}
CADT_FN void cadt_store_half_edge(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 k, cadt_u32 half_edge) {
  CADT_ASSERT_OWNED(m, t, k); /* whoever owns both ends of an edge may change the half-edge across it */
  cadt_store_field(m->locked[t].word + CADT_WORD_HALF_EDGE + k, half_edge);
}
CADT_FN void cadt_store_flips(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 flips) {
  CADT_ASSERT_OWNED(m, t, 3u);
  cadt_store_field(m->locked[t].word + CADT_WORD_FLIPS, flips);
}

CADT_FN void cadt_relink(const cadt_locked_mesh* m, cadt_u32 outer, cadt_u32 half_edge) {
  CADT_NOISE_AT(m, CADT_SITE_HALF_EDGE);
  cadt_store_half_edge(m, CADT_TRIANGLE_OF(outer), CADT_EDGE_OF(outer), half_edge);
}

/* A flip takes a vertex out of each of its triangles. To point that vertex at a triangle that still has it shortens
 * walks from 5.8 to 3.3 steps (1M uniform points). After splits it makes no difference. */
CADT_FN void cadt_set_vertex_triangle(const cadt_locked_mesh* m, cadt_u32 vertex, cadt_u32 t) {
  if (vertex != CADT_GHOST) cadt_store_relaxed(m->vertex_to_triangle + vertex, t);
}

#if !CADT_CONTIGUOUS
/* All of triangle t as seen from edge k, with the lock word as its owner has it: two accesses on GPUs. */
CADT_FN void cadt_store_from(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 k, const cadt_snapshot* s) {
  CADT_ASSERT_OWNED(m, t, 3u);
  cadt_store_triangle(m->locked[t].word, CADT_PICK(k, s->v0, s->v2, s->v1), CADT_PICK(k, s->v1, s->v0, s->v2),
                      CADT_PICK(k, s->v2, s->v1, s->v0), s->lock, CADT_PICK(k, s->n0, s->n2, s->n1),
                      CADT_PICK(k, s->n1, s->n0, s->n2), CADT_PICK(k, s->n2, s->n1, s->n0), s->flips);
}
#endif

/* Constrained edges: each of the two triangles has a bit for the edge. Whoever owns a triangle may change its word. */
CADT_FN cadt_u32 cadt_edge_flag(cadt_u32 flags, cadt_u32 k) { return flags >> k & 1u; }
CADT_FN cadt_u32 cadt_edge_flag_set(cadt_u32 flags, cadt_u32 k, cadt_u32 flag) {
  return (flags & ~(1u << k)) | flag << k;
}
CADT_FN cadt_u32 cadt_edge_is_constrained(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 k) {
  return m->edge_flags ? cadt_edge_flag(cadt_load_field(m->edge_flags + t), k) : 0u;
}

/* Flip counters: ten bits for each edge slot, saturating. */
CADT_FN cadt_u32 cadt_flips_get(cadt_u32 flips, cadt_u32 k) { return (flips >> (10u * k)) & 1023u; }
CADT_FN cadt_u32 cadt_flips_set(cadt_u32 flips, cadt_u32 k, cadt_u32 count) {
  return (flips & ~(1023u << (10u * k))) | (cadt_min_u32(count, 1023u) << (10u * k));
}

#endif
