/* SPDX-License-Identifier: Apache-2.0
 *
 * A piece of a segment that is no edge becomes one: the triangles that it crosses, its cavity, are replaced by those of
 * the two polygons on its sides, at once. Their vertices lie in a ring, counterclockwise from a:
 *
 *          1 ----- 2 ----- 3                  ring  0 1 2 3 4 5 6 0   a = 0, upper chain 1 2 3, b = 4, lower chain 5 6
 *         / \     / \     / \                 edge x of the ring is that from place x to x + 1
 *        /   \   /   \   /   \
 *       a . . . . . . . . . . b               k crossed triangles have k vertices beside a and b (a vertex counts as
 *        \   /   \   /   \   /                often as the ring comes by: dangling edges are walked along twice), and
 *         \ /     \ /     \ /                 the two polygons take k triangles: each vertex brings one, so no memory is
 *          6 ----- - ----- 5                  allocated. The triangle of a vertex is written where a crossed one was.
 *
 * A polygon's triangle at the base p q has as apex the vertex of the chain for which no other one lies in the circle.
 * Every vertex of the chain is visible from the base, so this triangle belongs to the constrained Delaunay triangulation
 * of the polygon; the chains on its sides are polygons of the same kind (M. V. Anglada, "An improved incremental
 * algorithm for constructing restricted Delaunay triangulations", 1997). Where a vertex comes more than once, the
 * triangle takes the time after what hangs on its left side and before what hangs on its right side.
 *
 * Conflicts. Each launch claims the crossed triangles of all pieces: the lowest key stays. A piece goes on if it holds
 * all of its triangles, and none beyond its ring is held by a lower key; pieces that only share a neighbour write
 * different edges of it. The others wait for the next launch. The lowest key of all meets no lower one: each launch
 * finishes a piece for good.
 */
#ifndef CADT_CONSTRAINTS_SEGMENT_CAVITY_H
#define CADT_CONSTRAINTS_SEGMENT_CAVITY_H

#include "common/constraints/find_segments.dev.h"

/* What is known of the pieces of a launch, an element each. */
typedef struct {
  CADT_GLOBAL cadt_u32* ends;   /* two: a and b, the segment entered from a */
  CADT_GLOBAL cadt_u32* entry;  /* the half-edge by which it leaves the first triangle */
  CADT_GLOBAL cadt_u32* sizes;  /* places of the ring; 0: it is an edge now; CADT_NONE: it waits */
  CADT_GLOBAL cadt_u32* begins; /* the scan of the sizes: where its places begin */
  CADT_GLOBAL cadt_u32* upper;  /* vertices of the upper chain */
} cadt_pieces;
#define CADT_PIECES_PARAMETERS                                                                           \
  CADT_GLOBAL cadt_u32 *ends, CADT_GLOBAL cadt_u32 *entry, CADT_GLOBAL cadt_u32 *sizes,                  \
      CADT_GLOBAL cadt_u32 *begins, CADT_GLOBAL cadt_u32 *upper
#define CADT_PIECES(pieces) const cadt_pieces pieces = {ends, entry, sizes, begins, upper}

/* The places of all rings, an element each. */
typedef struct {
  CADT_GLOBAL cadt_u32* vertex;
  CADT_GLOBAL cadt_u32* triangle; /* of the vertex; CADT_RING_NONE at a and b; with the two bits below, of the edge */
  CADT_GLOBAL cadt_u32* edge;     /* its half-edge in the cavity, first the old, then the new one; CADT_NONE: none */
  CADT_GLOBAL cadt_u32* outer;    /* the half-edge across */
  cadt_u32 room;
} cadt_rings;
#define CADT_RINGS_PARAMETERS                                                                            \
  CADT_GLOBAL cadt_u32 *ring_vertex, CADT_GLOBAL cadt_u32 *ring_triangle, CADT_GLOBAL cadt_u32 *ring_edge, \
      CADT_GLOBAL cadt_u32 *ring_outer, cadt_u32 room
#define CADT_RINGS(rings) const cadt_rings rings = {ring_vertex, ring_triangle, ring_edge, ring_outer, room}

#define CADT_RING_NONE 0x3FFFFFFFu    /* also the mask of the triangle */
#define CADT_RING_FLAGGED 0x80000000u /* the edge is constrained */
#define CADT_RING_DANGLES 0x40000000u /* the edge is in the ring once more, from the other side */

CADT_FN cadt_u32 cadt_key_of_piece(cadt_u32 s) { return s * 2654435761u & 0x7FFFFFFFu; }
CADT_FN cadt_u32 cadt_has_ring(const cadt_pieces* all, const cadt_rings* rings, cadt_u32 s) {
  const cadt_u32 places = all->sizes[s];
  return places && places != CADT_NONE && all->begins[s] + places <= rings->room ? 1u : 0u;
}

/* Walks along the first `taken` pieces: sizes and entries. `begins` become what is to be scanned. One with more than
 * `most` places waits, so that the sum fits in a word. */
CADT_KERNEL(cadt_walk_segments, CADT_SEGMENT_MESH_PARAMETERS, CADT_PIECES_PARAMETERS, cadt_u32 taken, cadt_u32 most,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_PIECES(pieces);
  CADT_DECLARE_COUNTERS(counters);
  if (cadt_item == 0u) pieces.begins[count] = 0u;
  CADT_FOR(s, count, grain) {
    pieces.begins[s] = 0u;
    pieces.sizes[s] = CADT_NONE;
    if (s >= taken) continue;
    const cadt_u32 a = pieces.ends[2u * s], b = pieces.ends[2u * s + 1u];
    const cadt_segment_step step = cadt_next_step(&mesh, a, b, &counters);
    pieces.sizes[s] = 0u;
    if (step.kind == CADT_STEP_EDGE && step.vertex == (step.from_b ? a : b)) {
      cadt_flag_edge(&mesh, step.half_edge);
      continue;
    }
    if (step.kind != CADT_STEP_ENTER) {
      cadt_add_relaxed(words + CADT_SEGMENTS_BROKEN, 1u);
      continue;
    }
    const cadt_u32 from = step.from_b ? b : a, to = step.from_b ? a : b;
    const cadt_point p = cadt_load_point(mesh.points + from), q = cadt_load_point(mesh.points + to);
    cadt_crossed at = {step.half_edge, CADT_NONE, CADT_NONE, 1};
    cadt_u32 left = 1u, triangles = 1u;
    do {
      cadt_cross(&mesh, &at, p, to, q, &counters);
      ++triangles;
      if (at.side > 0) ++left;
    } while (at.side != 0);
    if (at.apex != to) cadt_add_relaxed(words + CADT_SEGMENTS_BROKEN, 1u); /* a vertex on the piece */
    pieces.ends[2u * s] = from;
    pieces.ends[2u * s + 1u] = to;
    pieces.entry[s] = step.half_edge;
    pieces.upper[s] = left;
    if (triangles + 3u > most) {
      pieces.sizes[s] = CADT_NONE;
      continue;
    }
    pieces.sizes[s] = pieces.begins[s] = triangles + 3u;
  }
}

/* Writes the rings and claims the crossed triangles; counts pieces that cross constrained edges. \pre claims are
 * CADT_NONE */
CADT_KERNEL(cadt_claim_cavities, CADT_SEGMENT_MESH_PARAMETERS, CADT_PIECES_PARAMETERS, CADT_RINGS_PARAMETERS,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* claims, CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_PIECES(pieces);
  CADT_RINGS(rings);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(s, count, grain) {
    if (!cadt_has_ring(&pieces, &rings, s)) {
      if (pieces.sizes[s] == CADT_NONE) continue;
      for (cadt_u32 x = pieces.begins[s]; x < cadt_min_u32(pieces.begins[s] + pieces.sizes[s], rings.room); ++x) {
        rings.edge[x] = CADT_NONE;
        rings.triangle[x] = CADT_RING_NONE;
      }
      continue;
    }
    const cadt_u32 a = pieces.ends[2u * s], b = pieces.ends[2u * s + 1u], begin = pieces.begins[s];
    const cadt_u32 k = pieces.sizes[s] - 3u, u = pieces.upper[s], key = cadt_key_of_piece(s);
    CADT_GLOBAL cadt_u32 *v = rings.vertex + begin, *triangle = rings.triangle + begin, *edge = rings.edge + begin;
    const cadt_point p = cadt_load_point(mesh.points + a), q = cadt_load_point(mesh.points + b);
    const cadt_u32 t0 = CADT_TRIANGLE_OF(pieces.entry[s]), k0 = CADT_EDGE_OF(pieces.entry[s]);
    cadt_u32 high = 1u, low = k + 1u; /* the last places on the left and on the right */
    v[0] = v[k + 2u] = a;
    v[u + 1u] = b;
    triangle[0] = triangle[k + 2u] = triangle[u + 1u] = CADT_RING_NONE;
    edge[k + 2u] = CADT_NONE;
    v[high] = cadt_corner_of(&mesh, t0, CADT_PREV(k0));
    v[low] = cadt_corner_of(&mesh, t0, CADT_NEXT(k0));
    edge[0] = CADT_HALF_EDGE(t0, CADT_NEXT(k0));
    edge[low] = CADT_HALF_EDGE(t0, CADT_PREV(k0));
    triangle[high] = t0;
    cadt_min_relaxed(claims + t0, key);
    cadt_u32 waiting = low; /* the place that the next triangle goes to */
    cadt_crossed at = {pieces.entry[s], CADT_NONE, CADT_NONE, 1};
    cadt_u32 crossed = 0u;
    do {
      crossed |= cadt_is_flagged(&mesh, at.half_edge);
      cadt_cross(&mesh, &at, p, b, q, &counters);
      const cadt_u32 t = CADT_TRIANGLE_OF(at.entry), e = CADT_EDGE_OF(at.entry);
      const cadt_u32 left_edge = CADT_HALF_EDGE(t, CADT_PREV(e)), right_edge = CADT_HALF_EDGE(t, CADT_NEXT(e));
      cadt_min_relaxed(claims + t, key);
      triangle[waiting] = t;
      if (at.side >= 0) edge[high] = left_edge;
      if (at.side > 0) v[waiting = ++high] = at.apex;
      if (at.side < 0) v[waiting = --low] = at.apex;
      if (at.side <= 0) edge[at.side < 0 ? low : low - 1u] = right_edge;
    } while (at.side != 0);
    if (crossed) cadt_add_relaxed(words + CADT_SEGMENTS_CROSSED, 1u);
  }
}

/* Which pieces go on. The ends of the others go to `next`, and their rings have no edges any more. */
CADT_KERNEL(cadt_decide_cavities, CADT_SEGMENT_MESH_PARAMETERS, CADT_PIECES_PARAMETERS, CADT_RINGS_PARAMETERS,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL const cadt_u32* claims, CADT_GLOBAL cadt_u32* wins,
            CADT_GLOBAL cadt_u32* next, CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_PIECES(pieces);
  CADT_RINGS(rings);
  CADT_FOR(s, count, grain) {
    const cadt_u32 begin = pieces.begins[s], places = pieces.sizes[s], key = cadt_key_of_piece(s);
    const cadt_u32 ring = cadt_has_ring(&pieces, &rings, s);
    cadt_u32 won = ring;
    wins[s] = 0u;
    if (!places) continue;
    for (cadt_u32 x = begin; won && x < begin + places; ++x) {
      const cadt_u32 t = rings.triangle[x];
      if (t != CADT_RING_NONE && claims[t] != key) won = 0u;
    }
    for (cadt_u32 x = begin; won && x < begin + places - 1u; ++x) {
      const cadt_u32 outer = cadt_across_of(&mesh, rings.edge[x]), holder = claims[CADT_TRIANGLE_OF(outer)];
      if (holder < key) won = 0u;
      rings.outer[x] = outer;
      if (holder == key) rings.triangle[x] |= CADT_RING_DANGLES;
      if (cadt_is_flagged(&mesh, rings.edge[x])) rings.triangle[x] |= CADT_RING_FLAGGED;
    }
    wins[s] = won;
    if (won) continue;
    for (cadt_u32 x = begin; ring && x < begin + places; ++x) rings.edge[x] = CADT_NONE;
    const cadt_u32 place = cadt_add_relaxed(words + CADT_SEGMENTS_MISSING, 1u);
    next[2u * place] = pieces.ends[2u * s];
    next[2u * place + 1u] = pieces.ends[2u * s + 1u];
  }
}

/* ---- the two polygons ---- */
/* A part of a ring: the polygon with the base from place `low` to place `high` and the chain between. */
typedef struct {
  cadt_u32 low, high;
  cadt_u32 parent; /* the half-edge on the other side of the base; CADT_NONE: the other polygon */
  cadt_u32 piece;
} cadt_chain;

/* The place of the apex. */
CADT_FN cadt_u32 cadt_apex_of_chain(const cadt_segment_mesh* m, const cadt_rings* rings, const cadt_chain* c,
                                    cadt_counters* counters) {
  const cadt_u32 v = rings->vertex[c->low], w = rings->vertex[c->high];
  const cadt_point p = cadt_load_point(m->points + v), q = cadt_load_point(m->points + w);
  cadt_u32 best = CADT_NONE, apex = CADT_NONE;
  cadt_point at = p;
  for (cadt_u32 x = c->low + 1u; x < c->high; ++x) {
    const cadt_u32 u = rings->vertex[x];
    if (u == v || u == w) continue;
    const cadt_point r = cadt_load_point(m->points + u);
    if (u == apex) {
      /* The chain has come back to it. What hung between lies on the left side of the triangle, or on its right. */
      if (cadt_orientation(p, r, cadt_load_point(m->points + rings->vertex[best + 1u]), counters) > 0) best = x;
    } else if (best == CADT_NONE || cadt_incircle(p, q, at, r, counters) > 0) {
      best = x;
      apex = u;
      at = r;
    }
  }
  return best;
}

/* The first of the two root triangles leaves its half-edge in `bases`, the second one links both. */
CADT_FN void cadt_link_base(const cadt_segment_mesh* m, CADT_GLOBAL cadt_u32* base, cadt_u32 half_edge) {
  if (cadt_cas_relaxed(base, CADT_NONE, half_edge)) return;
  const cadt_u32 other = cadt_load_relaxed(base);
  m->across[3u * CADT_TRIANGLE_OF(half_edge) + 2u] = other;
  m->across[3u * CADT_TRIANGLE_OF(other) + 2u] = half_edge;
}

/* Writes the triangle at the base of a chain. The chains on its sides are `sides`, [0] on the left; one without
 * vertices is an edge of the ring, and has low + 1 = high. 0: the mesh is wrong */
CADT_FN cadt_u32 cadt_write_base(const cadt_segment_mesh* m, const cadt_rings* rings, const cadt_chain* c,
                                 CADT_GLOBAL cadt_u32* bases, cadt_chain* sides, cadt_counters* counters) {
  const cadt_u32 apex = cadt_apex_of_chain(m, rings, c, counters);
  if (apex == CADT_NONE) return 0u;
  const cadt_u32 t = rings->triangle[apex] & CADT_RING_NONE;
  CADT_GLOBAL cadt_u32* corners = m->vertices + 3u * t;
  corners[0] = rings->vertex[c->low];
  corners[1] = rings->vertex[c->high];
  corners[2] = rings->vertex[apex];
  for (cadt_u32 k = 0u; k < 3u; ++k) cadt_store_relaxed(m->vertex_triangle + corners[k], t);
  const cadt_u32 base = CADT_HALF_EDGE(t, 2u);
  if (c->parent == CADT_NONE) {
    m->edge_flags[t] = 4u;
    cadt_link_base(m, bases + c->piece, base);
  } else {
    m->edge_flags[t] = 0u;
    m->across[3u * t + 2u] = c->parent;
    m->across[3u * CADT_TRIANGLE_OF(c->parent) + CADT_EDGE_OF(c->parent)] = base;
  }
  const cadt_chain left = {c->low, apex, CADT_HALF_EDGE(t, 1u), c->piece},
                   right = {apex, c->high, CADT_HALF_EDGE(t, 0u), c->piece};
  sides[0] = left;
  sides[1] = right;
  for (cadt_u32 i = 0u; i < 2u; ++i)
    if (sides[i].low + 1u == sides[i].high) rings->edge[sides[i].low] = sides[i].parent;
  return 1u;
}

enum {
  CADT_CHAIN_STACK = 32, /* the longer side of each triangle waits: each next one is at most half as long */
  CADT_CHAIN_LONG = 64   /* on GPUs longer chains are divided among work-items, a triangle a launch */
};

CADT_FN cadt_u32 cadt_is_long(cadt_chain c) {
#if CADT_CONTIGUOUS
  (void)c;
  return 0u;
#else
  return c.high - c.low > CADT_CAST(cadt_u32, CADT_CHAIN_LONG) ? 1u : 0u;
#endif
}

/* All triangles of a chain, but those of sides that are too long for one work-item: these go to `queue`. */
CADT_FN void cadt_fill_chain(const cadt_segment_mesh* m, const cadt_rings* rings, cadt_chain c,
                             CADT_GLOBAL cadt_u32* bases, CADT_GLOBAL cadt_chain* queue, CADT_GLOBAL cadt_u32* words,
                             cadt_counters* counters) {
  cadt_chain stack[CADT_CHAIN_STACK], sides[2];
  cadt_u32 waiting = 0u;
  for (;;) {
    if (!cadt_write_base(m, rings, &c, bases, sides, counters)) {
      cadt_add_relaxed(words + CADT_SEGMENTS_BROKEN, 1u);
      return;
    }
    for (cadt_u32 i = 0u; i < 2u; ++i) {
      if (!cadt_is_long(sides[i])) continue;
      queue[cadt_add_relaxed(words + CADT_SEGMENTS_QUEUED, 1u)] = sides[i];
      sides[i].high = sides[i].low; /* done here */
    }
    const cadt_u32 longer = sides[0].high - sides[0].low > sides[1].high - sides[1].low ? 0u : 1u;
    if (sides[longer].high > sides[longer].low + 1u) stack[waiting++] = sides[longer];
    if (sides[1u - longer].high > sides[1u - longer].low + 1u)
      c = sides[1u - longer];
    else if (waiting)
      c = stack[--waiting];
    else
      return;
  }
}

/* Both polygons of the pieces that go on. `bases` are CADT_NONE. */
CADT_KERNEL(cadt_fill_cavities, CADT_SEGMENT_MESH_PARAMETERS, CADT_PIECES_PARAMETERS, CADT_RINGS_PARAMETERS,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* claims, CADT_GLOBAL const cadt_u32* wins,
            CADT_GLOBAL cadt_u32* bases, CADT_GLOBAL cadt_chain* queue, CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_PIECES(pieces);
  CADT_RINGS(rings);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(s, count, grain) {
    if (!wins[s]) continue;
    const cadt_u32 begin = pieces.begins[s], end = begin + pieces.sizes[s] - 1u, b = begin + pieces.upper[s] + 1u;
    /* Nobody asks any more who holds a triangle: which edge of the ring it has. */
    for (cadt_u32 x = begin; x < end; ++x) claims[CADT_TRIANGLE_OF(rings.edge[x])] = x;
    const cadt_chain both[2] = {{begin, b, CADT_NONE, s}, {b, end, CADT_NONE, s}};
    for (cadt_u32 i = 0u; i < 2u; ++i) {
      if (cadt_is_long(both[i]))
        queue[cadt_add_relaxed(words + CADT_SEGMENTS_QUEUED, 1u)] = both[i];
      else
        cadt_fill_chain(&mesh, &rings, both[i], bases, queue, words, &counters);
    }
  }
}

/* Long chains of the launch before. */
CADT_KERNEL(cadt_fill_chains, CADT_SEGMENT_MESH_PARAMETERS, CADT_RINGS_PARAMETERS,
            CADT_GLOBAL const cadt_chain* chains, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* bases,
            CADT_GLOBAL cadt_chain* queue, CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_RINGS(rings);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(i, count, grain) { cadt_fill_chain(&mesh, &rings, chains[i], bases, queue, words, &counters); }
}

/* Links the new triangles with those around the cavities, by the edges of the rings. */
CADT_KERNEL(cadt_link_cavities, CADT_SEGMENT_MESH_PARAMETERS, CADT_RINGS_PARAMETERS, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* claims) {
  CADT_SEGMENT_MESH(mesh);
  CADT_RINGS(rings);
  CADT_FOR(x, count, grain) {
    const cadt_u32 half_edge = rings.edge[x], t = CADT_TRIANGLE_OF(half_edge), bits = rings.triangle[x];
    if (half_edge == CADT_NONE) continue;
    cadt_u32 outer = rings.outer[x];
    if (bits & CADT_RING_DANGLES) outer = rings.edge[claims[CADT_TRIANGLE_OF(outer)]];
    mesh.across[3u * t + CADT_EDGE_OF(half_edge)] = outer;
    if (!(bits & CADT_RING_DANGLES)) mesh.across[3u * CADT_TRIANGLE_OF(outer) + CADT_EDGE_OF(outer)] = half_edge;
    if (bits & CADT_RING_FLAGGED) cadt_or_relaxed(mesh.edge_flags + t, 1u << CADT_EDGE_OF(half_edge));
  }
}

/* Gives all claims up. */
CADT_KERNEL(cadt_release_cavities, CADT_GLOBAL const cadt_u32* ring_triangle, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* claims) {
  CADT_FOR(x, count, grain) {
    const cadt_u32 t = ring_triangle[x] & CADT_RING_NONE;
    if (t != CADT_RING_NONE) claims[t] = CADT_NONE;
  }
}

#endif
