/* SPDX-License-Identifier: Apache-2.0
 *
 * The polygon of a chain that cannot be divided well (segment_cavity.dev.h): the tips of a comb, or points on an arc,
 * have their apex next to an end each time, and looking for it takes quadratic time. If the chain ascends in one
 * direction all along, its polygon is a monotone mountain, and so is that of any part of its vertices:
 *
 *              . 3 .                  Vertices are inserted in a random order, each beyond the edge between those on
 *         1 . .     . . 4               its sides, here 2 between 1 and 3: first by flips until its triangles have an
 *        . \          /  .              area (where it lies below that edge), then until all edges are legal. Nothing
 *       .    \  2   /     .             has to be located; expected time is that of a randomised incremental
 *      p ================= q            construction, near linear (N. Amenta, S. Choi, G. Rote, "Incremental
 *                                       constructions con BRIO", 2003: the order by levels).
 *
 * Meanwhile triangles have places as corners instead of vertices, CADT_NONE stands across the edges of the polygon, the
 * word of its flags (`next_queued`) links a triangle to the next one in the queue of those to be looked at, and
 * ring.piece has the next place that is inserted.
 */
#ifndef CADT_CONSTRAINTS_SEGMENT_MOUNTAIN_H
#define CADT_CONSTRAINTS_SEGMENT_MOUNTAIN_H

#include "common/constraints/insert/segment_rings.dev.h"

/* A part of a ring: the polygon with the base from place `low` to place `high` and the chain between. */
typedef struct {
  cadt_u32 low, high;
  cadt_u32 parent; /* the half-edge on the other side of the base; CADT_NONE: the other polygon */
  cadt_u32 piece;
} cadt_chain;

typedef struct {
  const cadt_segment_mesh* m;
  const cadt_rings* rings;
  cadt_u32 high;        /* the last place */
  cadt_u32 base;        /* the half-edge of the base */
  cadt_u32 first, last; /* of the queue; CADT_NONE: it is empty */
} cadt_mountain;

#define CADT_QUEUE_END 0xFFFFFFFEu /* the last triangle of the queue has it, one that is not in it 0 */

CADT_FN cadt_point cadt_point_at(const cadt_mountain* a, cadt_u32 place) {
  return cadt_load_point(a->m->points + a->rings->vertex[place]);
}

/* The edge to a place from the one before, of about unit length. */
CADT_FN cadt_point cadt_edge_to(const cadt_segment_mesh* m, const cadt_rings* rings, cadt_u32 place) {
  const cadt_point a = cadt_load_point(m->points + rings->vertex[place - 1u]),
                   b = cadt_load_point(m->points + rings->vertex[place]);
  const cadt_real x = b.x - a.x, y = b.y - a.y, length = cadt_fabs(x) + cadt_fabs(y);
  const cadt_point edge = {x / length, y / length};
  return edge;
}
CADT_FN cadt_real cadt_cross_of(cadt_point a, cadt_point b) { return a.x * b.y - a.y * b.x; }

/* Whether the chain certainly ascends in one direction all along: between the two of its edges that turn furthest to
 * the left and to the right, if all turn by less than half a circle. */
CADT_FN cadt_u32 cadt_is_mountain(const cadt_segment_mesh* m, const cadt_rings* rings, const cadt_chain* c) {
  cadt_point left = cadt_edge_to(m, rings, c->low + 1u), right = left;
  for (cadt_u32 i = c->low + 2u; i <= c->high; ++i) {
    const cadt_point edge = cadt_edge_to(m, rings, i);
    if (cadt_cross_of(left, edge) > CADT_CAST(cadt_real, 0)) left = edge;
    if (cadt_cross_of(right, edge) < CADT_CAST(cadt_real, 0)) right = edge;
  }
  const cadt_u32 narrow = left.x * right.x + left.y * right.y > CADT_CAST(cadt_real, 0) ? 1u : 0u;
  const cadt_point up = {narrow ? left.x + right.x : left.y - right.y, narrow ? left.y + right.y : right.x - left.x};
  for (cadt_u32 i = c->low + 1u; i <= c->high; ++i) {
    const cadt_point edge = cadt_edge_to(m, rings, i);
    const cadt_real x = up.x * edge.x, y = up.y * edge.y;
    if (!(x + y > CADT_CAST(cadt_real, 1e-5) * (cadt_fabs(x) + cadt_fabs(y)))) return 0u; /* or NaN */
  }
  return 1u;
}

/* What stands across edge k of triangle t, and there its edge in turn; an edge of the polygon is known by the place
 * that it goes to. */
CADT_FN void cadt_set_side(cadt_mountain* a, cadt_u32 t, cadt_u32 k, cadt_u32 across) {
  const cadt_u32 half_edge = CADT_HALF_EDGE(t, k), to = cadt_corner_of(a->m, t, CADT_PREV(k));
  a->m->across[3u * t + k] = across;
  if (across != CADT_NONE)
    a->m->across[3u * CADT_TRIANGLE_OF(across) + CADT_EDGE_OF(across)] = half_edge;
  else if (to == a->high)
    a->base = half_edge;
  else
    a->rings->edge[to] = half_edge;
}

CADT_FN void cadt_set_corners(const cadt_mountain* a, cadt_u32 t, cadt_u32 u, cadt_u32 v, cadt_u32 w) {
  a->m->vertices[3u * t] = u;
  a->m->vertices[3u * t + 1u] = v;
  a->m->vertices[3u * t + 2u] = w;
}

/* The triangle behind all others in the queue, unless it is in it. */
CADT_FN void cadt_enqueue(cadt_mountain* a, cadt_u32 t) {
  CADT_GLOBAL cadt_u32* next_queued = a->m->edge_flags;
  if (next_queued[t]) return;
  next_queued[t] = CADT_QUEUE_END;
  if (a->first == CADT_NONE)
    a->first = t;
  else
    next_queued[a->last] = t + 1u;
  a->last = t;
}

/* Flips edge k of triangle t: x v w and y w v become x v y and x y w, the first one in t. Returns the other one. */
CADT_FN cadt_u32 cadt_flip_edge(cadt_mountain* a, cadt_u32 t, cadt_u32 k) {
  const cadt_u32 behind = a->m->across[3u * t + k], u = CADT_TRIANGLE_OF(behind), j = CADT_EDGE_OF(behind);
  const cadt_u32 x = cadt_corner_of(a->m, t, k), v = cadt_corner_of(a->m, t, CADT_NEXT(k)),
                 w = cadt_corner_of(a->m, t, CADT_PREV(k)), y = cadt_corner_of(a->m, u, j);
  const cadt_u32 wx = a->m->across[3u * t + CADT_NEXT(k)], xv = a->m->across[3u * t + CADT_PREV(k)];
  const cadt_u32 vy = a->m->across[3u * u + CADT_NEXT(j)], yw = a->m->across[3u * u + CADT_PREV(j)];
  cadt_set_corners(a, t, x, v, y);
  cadt_set_corners(a, u, x, y, w);
  cadt_set_side(a, t, 0u, vy);
  cadt_set_side(a, t, 2u, xv);
  cadt_set_side(a, u, 0u, yw);
  cadt_set_side(a, u, 1u, wx);
  cadt_set_side(a, t, 1u, CADT_HALF_EDGE(u, 2u));
  return u;
}

/* Inserts place x between places v and w, next to each other so far, in triangle t. Returns whether it could. */
CADT_FN cadt_u32 cadt_insert_place(cadt_mountain* a, cadt_u32 v, cadt_u32 x, cadt_u32 w, cadt_u32 t,
                                   cadt_counters* counters) {
  const cadt_u32 behind = a->rings->edge[v];
  a->rings->piece[v] = x;
  a->rings->piece[x] = w;
  cadt_set_corners(a, t, x, v, w);
  cadt_set_side(a, t, 0u, behind);
  cadt_set_side(a, t, 1u, CADT_NONE);
  cadt_set_side(a, t, 2u, CADT_NONE);
  a->m->edge_flags[t] = 0u;
  const cadt_point p = cadt_point_at(a, x);
  for (;;) { /* around x, from v to w; t has x as corner 0 */
    while (cadt_orientation(p, cadt_point_at(a, cadt_corner_of(a->m, t, 1u)),
                            cadt_point_at(a, cadt_corner_of(a->m, t, 2u)), counters) <= 0) {
      if (a->m->across[3u * t] == CADT_NONE) return 0u;
      cadt_flip_edge(a, t, 0u);
    }
    cadt_enqueue(a, t);
    const cadt_u32 next = a->m->across[3u * t + 1u];
    if (next == CADT_NONE) return 1u;
    t = CADT_TRIANGLE_OF(next);
  }
}

/* Flips until no edge is illegal. */
CADT_FN void cadt_make_legal(cadt_mountain* a, cadt_counters* counters) {
  CADT_GLOBAL cadt_u32* next_queued = a->m->edge_flags;
  while (a->first != CADT_NONE) {
    const cadt_u32 t = a->first;
    a->first = next_queued[t] == CADT_QUEUE_END ? CADT_NONE : next_queued[t] - 1u;
    next_queued[t] = 0u;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 behind = a->m->across[3u * t + k];
      if (behind == CADT_NONE) continue;
      const cadt_u32 y = cadt_corner_of(a->m, CADT_TRIANGLE_OF(behind), CADT_EDGE_OF(behind));
      if (cadt_incircle(cadt_point_at(a, cadt_corner_of(a->m, t, 0u)), cadt_point_at(a, cadt_corner_of(a->m, t, 1u)),
                        cadt_point_at(a, cadt_corner_of(a->m, t, 2u)), cadt_point_at(a, y), counters) <= 0)
        continue;
      cadt_enqueue(a, cadt_flip_edge(a, t, k));
      cadt_enqueue(a, t);
      break;
    }
  }
}

/* How late a place is inserted: level 0, half of all, comes last. */
CADT_FN cadt_u32 cadt_level_of_place(cadt_u32 place, cadt_u32 top) {
  cadt_u32 bits = cadt_key_of_piece(place), level = 0u;
  while (level < top && !(bits & 1u)) {
    bits >>= 1;
    ++level;
  }
  return level;
}

/* All triangles of a mountain, but for the other side of its base, whose half-edge is returned; CADT_NONE: the chain is
 * none. */
CADT_FN cadt_u32 cadt_fill_mountain(const cadt_segment_mesh* m, const cadt_rings* rings, const cadt_chain* c,
                                    cadt_counters* counters) {
  cadt_mountain a = {m, rings, c->high, CADT_NONE, CADT_NONE, CADT_NONE};
  cadt_u32 top = 0u;
  while ((c->high - c->low) >> top > 1u) ++top;
  rings->piece[c->low] = c->high;
  for (cadt_u32 level = top + 1u; level-- > 0u;) {
    cadt_u32 before = c->low;
    for (cadt_u32 x = c->low + 1u; x < c->high; ++x) {
      if (rings->piece[before] == x) {
        before = x;
        continue;
      }
      if (cadt_level_of_place(x, top) != level) continue;
      const cadt_u32 t = rings->triangle[x] & CADT_RING_NONE, after = rings->piece[before];
      if (a.base == CADT_NONE) { /* the first one, whose triangle has the base in place of an edge of the polygon */
        rings->piece[before] = x;
        rings->piece[x] = after;
        cadt_set_corners(&a, t, x, before, after);
        for (cadt_u32 k = 0u; k < 3u; ++k) cadt_set_side(&a, t, k, CADT_NONE);
        m->edge_flags[t] = 0u;
      } else if (!cadt_insert_place(&a, before, x, after, t, counters)) {
        return CADT_NONE;
      }
      before = x;
      cadt_make_legal(&a, counters);
    }
  }
  for (cadt_u32 x = c->low + 1u; x < c->high; ++x) {
    const cadt_u32 t = rings->triangle[x] & CADT_RING_NONE;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 vertex = rings->vertex[cadt_corner_of(m, t, k)];
      m->vertices[3u * t + k] = vertex;
      cadt_store_relaxed(m->vertex_triangle + vertex, t);
    }
  }
  return a.base;
}

#endif
