/* SPDX-License-Identifier: Apache-2.0
 *
 * The polygon of a chain that does not divide well (segment_cavity.dev.h): the tips of a comb, or points on an arc,
 * have their apex next to an end each time, and looking for it takes quadratic time. Vertices are taken out in a random
 * order instead, then inserted again, the last one first, each beyond the edge between those that were on its sides:
 *
 *              . 3 .                  Here 2 between 1 and 3: first by flips until its triangles have an area (where it
 *         1 . .     . . 4             lies below that edge), then until all edges are legal. Nothing has to be located;
 *        . \          /  .            expected time is that of a randomised incremental construction, near linear (N.
 *       .    \  2   /     .           Amenta, S. Choi, G. Rote, "Incremental constructions con BRIO", 2003: the order
 *      p ================= q          by rounds).
 *
 * A vertex that is closer to the base than both of those on its sides is not taken out: without it the chain could be
 * one that no triangle strip along the base has (J. R. Shewchuk, B. C. Brown, "Fast segment insertion and incremental
 * construction of constrained Delaunay triangulations", 2015). Then triangles around a vertex have an area in the end,
 * though others of the polygon so far may lie upon them; those of the whole chain do not, as it does not cross itself.
 * Distances are rounded: should that fail, the chain is divided after all.
 *
 * Meanwhile triangles have places as corners instead of vertices, CADT_NONE stands across the edges of the polygon, and
 * the word of its flags (`next_queued`) links a triangle to the next one in the queue of those to be looked at. While a
 * place is not in the polygon its triangle has as corners the place before it and the one that was taken out before,
 * and ring.piece the place behind it.
 */
#ifndef CADT_CONSTRAINTS_RANDOM_INSERTION_H
#define CADT_CONSTRAINTS_RANDOM_INSERTION_H

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
} cadt_growing_polygon;

#define CADT_QUEUE_END 0xFFFFFFFEu /* the last triangle of the queue has it, one that is not in it 0 */

CADT_FN cadt_point cadt_point_at(const cadt_growing_polygon* a, cadt_u32 place) {
  return cadt_load_point(a->m->points + a->rings->vertex[place]);
}

/* What stands across edge k of triangle t, and there its edge in turn; an edge of the polygon is known by the place
 * that it goes to. */
CADT_FN void cadt_set_side(cadt_growing_polygon* a, cadt_u32 t, cadt_u32 k, cadt_u32 across) {
  const cadt_u32 half_edge = CADT_HALF_EDGE(t, k), to = cadt_corner_of(a->m, t, CADT_PREV(k));
  a->m->across[3u * t + k] = across;
  if (across != CADT_NONE)
    a->m->across[3u * CADT_TRIANGLE_OF(across) + CADT_EDGE_OF(across)] = half_edge;
  else if (to == a->high)
    a->base = half_edge;
  else
    a->rings->edge[to] = half_edge;
}

CADT_FN void cadt_set_corners(const cadt_growing_polygon* a, cadt_u32 t, cadt_u32 u, cadt_u32 v, cadt_u32 w) {
  a->m->vertices[3u * t] = u;
  a->m->vertices[3u * t + 1u] = v;
  a->m->vertices[3u * t + 2u] = w;
}

/* The triangle behind all others in the queue, unless it is in it. */
CADT_FN void cadt_enqueue(cadt_growing_polygon* a, cadt_u32 t) {
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
CADT_FN cadt_u32 cadt_flip_edge(cadt_growing_polygon* a, cadt_u32 t, cadt_u32 k) {
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
CADT_FN cadt_u32 cadt_insert_place(cadt_growing_polygon* a, cadt_u32 v, cadt_u32 x, cadt_u32 w, cadt_u32 t,
                                   cadt_counters* counters) {
  const cadt_u32 behind = a->base == CADT_NONE ? CADT_NONE : a->rings->edge[v];
  cadt_set_corners(a, t, x, v, w);
  cadt_set_side(a, t, 0u, behind); /* of the first one, the base */
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
CADT_FN void cadt_make_legal(cadt_growing_polygon* a, cadt_counters* counters) {
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

/* The distance of a place from the base, times its length, rounded: by sums of two doubles where there are such, as
 * vertices may be an ulp from the base. */
CADT_FN cadt_real cadt_height_of(const cadt_growing_polygon* a, cadt_u32 low, cadt_u32 place) {
  const cadt_point p = cadt_point_at(a, low), q = cadt_point_at(a, a->high), x = cadt_point_at(a, place);
#if CADT_GRADUAL_UNDERFLOW
  cadt_pair right = cadt_pair_product(cadt_pair_difference(q.y, p.y), cadt_pair_difference(x.x, p.x));
  right.high = -right.high;
  right.low = -right.low;
  return cadt_pair_sum(cadt_pair_product(cadt_pair_difference(q.x, p.x), cadt_pair_difference(x.y, p.y)), right).high;
#else
  return (q.x - p.x) * (x.y - p.y) - (q.y - p.y) * (x.x - p.x);
#endif
}

enum { CADT_TAKE_OUT_ROUNDS = 256 /* each one takes out about a quarter at least */ };

/* Takes out all places of a chain but one. Returns the last one; CADT_NONE: it does not come to an end. */
CADT_FN cadt_u32 cadt_take_out(const cadt_growing_polygon* a, cadt_u32 low) {
  cadt_u32 left = a->high - low - 1u, out = CADT_NONE;
  for (cadt_u32 x = low; x < a->high; ++x) a->rings->piece[x] = x + 1u;
  for (cadt_u32 round = 0u; left; ++round) {
    if (round == CADT_CAST(cadt_u32, CADT_TAKE_OUT_ROUNDS)) return CADT_NONE;
    const cadt_u32 seed = cadt_key_of_piece(round);
    cadt_u32 before = low, x = a->rings->piece[low];
    cadt_real height_before = CADT_CAST(cadt_real, 0), height = cadt_height_of(a, low, x);
    while (x != a->high) {
      const cadt_u32 after = a->rings->piece[x];
      const cadt_real height_after = cadt_height_of(a, low, after);
      const cadt_u32 stays =
          (height < height_before && height < height_after) || (left > 1u && (cadt_key_of_piece(x ^ seed) & 1u)) ? 1u
                                                                                                                 : 0u;
      if (stays) {
        before = x;
        height_before = height;
      } else {
        CADT_GLOBAL cadt_u32* corners = a->m->vertices + 3u * (a->rings->triangle[x] & CADT_RING_NONE);
        corners[0] = before;
        corners[1] = out;
        out = x;
        a->rings->piece[before] = after;
        --left;
      }
      x = after;
      height = height_after;
    }
  }
  return out;
}

/* All triangles of a chain, but for the other side of its base, whose half-edge is returned; CADT_NONE: not so. */
CADT_FN cadt_u32 cadt_fill_at_random(const cadt_segment_mesh* m, const cadt_rings* rings, const cadt_chain* c,
                                     cadt_counters* counters) {
  cadt_growing_polygon a = {m, rings, c->high, CADT_NONE, CADT_NONE, CADT_NONE};
  cadt_u32 x = cadt_take_out(&a, c->low);
  if (x == CADT_NONE) return CADT_NONE;
  while (x != CADT_NONE) {
    const cadt_u32 t = rings->triangle[x] & CADT_RING_NONE, before = m->vertices[3u * t],
                   next = m->vertices[3u * t + 1u];
    if (!cadt_insert_place(&a, before, x, rings->piece[x], t, counters)) return CADT_NONE;
    cadt_make_legal(&a, counters);
    x = next;
  }
  for (x = c->low + 1u; x < c->high; ++x) {
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
