/* SPDX-License-Identifier: Apache-2.0
 *
 * A piece of a segment that is no edge becomes one: the triangles that it crosses, its cavity, are replaced by those of
 * the two polygons on its sides, at once. Their vertices lie in a ring, counterclockwise from a:
 *
 *          1 ----- 2 ----- 3                  place 0: a, 1 2 3: the upper chain, 4: b, 5 6: the lower chain, 7: a
 * again / \     / \     / \                 edge x of the ring is that from place x to x + 1
 *        /   \   /   \   /   \
 *       a . . . . . . . . . . b               k crossed triangles have k vertices beside a and b (a vertex counts as
 *        \   /   \   /   \   /                often as the ring comes by: dangling edges are walked along twice), and
 *         \ /     \ /     \ /                 the two polygons take k triangles: each vertex brings one, so no memory
 * is 6 ----- - ----- 5                  allocated. The triangle of a vertex is written where a crossed one was.
 *
 * Conflicts. Each launch claims the crossed triangles of all pieces: the lowest key stays. A piece goes on if it holds
 * all of its triangles, and none beyond its ring is held by a lower key; pieces that only share a neighbour write
 * different edges of it. The others wait for the next launch. The lowest key of all meets no lower one: each launch
 * finishes a piece for good.
 */
#ifndef CADT_CONSTRAINTS_SEGMENT_RINGS_H
#define CADT_CONSTRAINTS_SEGMENT_RINGS_H

#include "common/constraints/insert/segment_strides.dev.h"

/* The places of all rings, an element each. */
typedef struct {
  CADT_GLOBAL cadt_u32* vertex;
  CADT_GLOBAL cadt_u32* triangle; /* of the vertex; CADT_RING_NONE at a and b; with the two bits below, of the edge */
  CADT_GLOBAL cadt_u32* edge;     /* its half-edge in the cavity, first the old, then the new one; CADT_NONE: none */
  CADT_GLOBAL cadt_u32* outer;    /* the half-edge across */
  CADT_GLOBAL cadt_u32* piece;
  cadt_u32 room;
} cadt_rings;
#define CADT_RINGS_PARAMETERS                                                                              \
  CADT_GLOBAL cadt_u32 *ring_vertex, CADT_GLOBAL cadt_u32 *ring_triangle, CADT_GLOBAL cadt_u32 *ring_edge, \
      CADT_GLOBAL cadt_u32 *ring_outer, CADT_GLOBAL cadt_u32 *ring_piece, cadt_u32 room
#define CADT_RINGS(rings) const cadt_rings rings = {ring_vertex, ring_triangle, ring_edge, ring_outer, ring_piece, room}

#define CADT_RING_NONE 0x3FFFFFFFu    /* also the mask of the triangle */
#define CADT_RING_FLAGGED 0x80000000u /* the edge is constrained */
#define CADT_RING_DANGLES 0x40000000u /* the edge is in the ring once more, from the other side */

/* Another key for each piece, at random: where many cross one triangle, the one that goes on is then somewhere in their
 * middle and parts the others, so that n of them take about log n launches. Keys that grow with s, even in part, take
 * the pieces from one side to the other, in n launches. (The steps are one to one on 31 bits.) */
CADT_FN cadt_u32 cadt_key_of_piece(cadt_u32 s) {
  cadt_u32 key = (s + 0x1E3779B9u) & 0x7FFFFFFFu;
  key = (key ^ key >> 16) * 0x7FEB352Du & 0x7FFFFFFFu;
  key = (key ^ key >> 15) * 0x846CA68Bu & 0x7FFFFFFFu;
  return key ^ key >> 16;
}
CADT_FN cadt_u32 cadt_has_ring(const cadt_pieces* all, const cadt_rings* rings, cadt_u32 s) {
  const cadt_u32 places = all->sizes[s];
  return places && places != CADT_NONE && all->begins[s] + places <= rings->room ? 1u : 0u;
}

/* What is to be scanned: the sizes of the first `taken` pieces. One with more than `most` places waits, so that the sum
 * fits in a word. */
CADT_KERNEL(cadt_places_of_pieces, CADT_PIECES_PARAMETERS, cadt_u32 taken, cadt_u32 most, cadt_u32 count,
            cadt_u32 grain) {
  CADT_PIECES(pieces);
  if (cadt_item == 0u) pieces.begins[count] = 0u;
  CADT_FOR(s, count, grain) {
    if (s >= taken || pieces.sizes[s] > most) pieces.sizes[s] = CADT_NONE;
    pieces.begins[s] = pieces.sizes[s] == CADT_NONE ? 0u : pieces.sizes[s];
  }
}

/* A walk that writes a ring and claims the triangles that it enters. */
typedef struct {
  cadt_u32 high, low,
      waiting; /* the last places on the left and on the right; the one that the next triangle goes to */
} cadt_ring_writer;

CADT_FN void cadt_put_vertex(const cadt_rings* rings, cadt_u32 place, cadt_u32 vertex, cadt_u32 piece) {
  rings->vertex[place] = vertex;
  rings->piece[place] = piece;
}

/* From half-edge `start` on, `steps` triangles or, for CADT_NONE, to the end b. Returns whether it has crossed a
 * constrained edge. */
CADT_FN cadt_u32 cadt_write_ring(const cadt_segment_mesh* m, const cadt_pieces* pieces, const cadt_rings* rings,
                                 cadt_u32 s, cadt_u32 start, cadt_u32 steps, cadt_ring_writer at,
                                 CADT_GLOBAL cadt_u32* claims, cadt_counters* counters) {
  const cadt_u32 b = pieces->ends[2u * s + 1u], key = cadt_key_of_piece(s);
  const cadt_point p = cadt_load_point(m->points + pieces->ends[2u * s]), q = cadt_load_point(m->points + b);
  cadt_crossed walk = {start, CADT_NONE, CADT_NONE, 1};
  cadt_u32 crossed = 0u;
  for (cadt_u32 i = 0u; i != steps && walk.side != 0; ++i) {
    crossed |= cadt_is_flagged(m, walk.half_edge);
    cadt_cross(m, &walk, p, b, q, counters);
    const cadt_u32 t = CADT_TRIANGLE_OF(walk.entry), e = CADT_EDGE_OF(walk.entry);
    cadt_min_relaxed(claims + t, key);
    rings->triangle[at.waiting] = t;
    if (walk.side >= 0) rings->edge[at.high] = CADT_HALF_EDGE(t, CADT_PREV(e));
    if (walk.side > 0) cadt_put_vertex(rings, at.waiting = ++at.high, walk.apex, s);
    if (walk.side < 0) cadt_put_vertex(rings, at.waiting = --at.low, walk.apex, s);
    if (walk.side <= 0) rings->edge[walk.side < 0 ? at.low : at.low - 1u] = CADT_HALF_EDGE(t, CADT_NEXT(e));
  }
  return crossed;
}

/* Writes the ring of a piece, of a long one only how it begins and ends, and claims its triangles; counts pieces that
 * cross constrained edges. */
CADT_FN void cadt_claim_cavity(const cadt_segment_mesh* m, const cadt_pieces* pieces, const cadt_rings* rings,
                               cadt_u32 s, CADT_GLOBAL cadt_u32* claims, CADT_GLOBAL cadt_u32* words,
                               cadt_counters* counters) {
  const cadt_u32 begin = pieces->begins[s], last = begin + pieces->sizes[s] - 1u, b = begin + pieces->upper[s] + 1u;
  const cadt_u32 t = CADT_TRIANGLE_OF(pieces->entry[s]), k = CADT_EDGE_OF(pieces->entry[s]);
  const cadt_ring_writer at = {begin + 1u, last - 1u, last - 1u};
  cadt_put_vertex(rings, begin, pieces->ends[2u * s], s);
  cadt_put_vertex(rings, last, pieces->ends[2u * s], s);
  cadt_put_vertex(rings, b, pieces->ends[2u * s + 1u], s);
  cadt_put_vertex(rings, at.high, cadt_corner_of(m, t, CADT_PREV(k)), s);
  cadt_put_vertex(rings, at.low, cadt_corner_of(m, t, CADT_NEXT(k)), s);
  rings->triangle[begin] = rings->triangle[last] = rings->triangle[b] = CADT_RING_NONE;
  rings->triangle[at.high] = t;
  rings->edge[begin] = CADT_HALF_EDGE(t, CADT_NEXT(k));
  rings->edge[at.low] = CADT_HALF_EDGE(t, CADT_PREV(k));
  rings->edge[last] = CADT_NONE;
  cadt_min_relaxed(claims + t, cadt_key_of_piece(s));
  if (pieces->strides[s] != CADT_NONE) return;
  if (cadt_write_ring(m, pieces, rings, s, pieces->entry[s], CADT_NONE, at, claims, counters))
    cadt_add_relaxed(words + CADT_SEGMENTS_CROSSED, 1u);
}

/* Those of all pieces. \pre claims are CADT_NONE */
CADT_KERNEL(cadt_claim_cavities, CADT_SEGMENT_MESH_PARAMETERS, CADT_PIECES_PARAMETERS, CADT_RINGS_PARAMETERS,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* claims, CADT_GLOBAL cadt_u32* wins,
            CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_PIECES(pieces);
  CADT_RINGS(rings);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(s, count, grain) {
    const cadt_u32 begin = pieces.begins[s], size = pieces.sizes[s] == CADT_NONE ? 0u : pieces.sizes[s];
    wins[s] = cadt_has_ring(&pieces, &rings, s);
    if (!wins[s]) {
      for (cadt_u32 x = begin; x < cadt_min_u32(begin + size, rings.room); ++x) {
        cadt_put_vertex(&rings, x, CADT_NONE, s);
        rings.edge[x] = CADT_NONE;
        rings.triangle[x] = CADT_RING_NONE;
      }
      continue;
    }
    cadt_claim_cavity(&mesh, &pieces, &rings, s, claims, words, &counters);
  }
}

/* The same for the strides of long pieces. */
CADT_KERNEL(cadt_claim_strides, CADT_SEGMENT_MESH_PARAMETERS, CADT_PIECES_PARAMETERS, CADT_RINGS_PARAMETERS,
            CADT_STRIDES_PARAMETERS, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* claims,
            CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_PIECES(pieces);
  CADT_RINGS(rings);
  CADT_STRIDES(strides);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(i, count, grain) {
    const cadt_u32 s = strides.piece[i], start = strides.start[i];
    if (start == CADT_NONE || !cadt_has_ring(&pieces, &rings, s)) continue;
    const cadt_u32 begin = pieces.begins[s], size = pieces.sizes[s];
    const cadt_u32 before = strides.steps[i], left = strides.left[i], right = before + 2u - left;
    cadt_u32 j = i + 1u;
    while (j < count && strides.piece[j] == s && strides.start[j] == CADT_NONE) ++j;
    const cadt_u32 steps = j < count && strides.piece[j] == s ? strides.steps[j] - before : CADT_NONE;
    /* The vertex that came last is the one that the edge before had not: it is opposite of neither edge. */
    const cadt_point p = cadt_load_point(mesh.points + pieces.ends[2u * s]),
                     q = cadt_load_point(mesh.points + pieces.ends[2u * s + 1u]);
    cadt_ring_writer at = {begin + left, begin + size - 1u - right, 0u};
    at.waiting = at.low;
    if (before != 0u) {
      const cadt_u32 behind = cadt_corner_of(&mesh, CADT_TRIANGLE_OF(start), CADT_EDGE_OF(start));
      if (cadt_side_of(&mesh, p, q, behind, &counters) > 0) at.waiting = at.high;
    }
    if (cadt_write_ring(&mesh, &pieces, &rings, s, start, steps, at, claims, &counters))
      cadt_add_relaxed(words + CADT_SEGMENTS_CROSSED, 1u);
  }
}

/* Whether the piece of place x goes on, as far as that place can tell: if not, wins becomes 0. */
CADT_FN void cadt_decide_place(const cadt_segment_mesh* m, const cadt_rings* rings, cadt_u32 x,
                               CADT_GLOBAL const cadt_u32* claims, CADT_GLOBAL cadt_u32* wins) {
  const cadt_u32 s = rings->piece[x], key = cadt_key_of_piece(s), t = rings->triangle[x], edge = rings->edge[x];
  cadt_u32 lost = t != CADT_RING_NONE && claims[t] != key ? 1u : 0u;
  if (edge != CADT_NONE) {
    const cadt_u32 outer = cadt_across_of(m, edge), holder = claims[CADT_TRIANGLE_OF(outer)];
    if (holder < key) lost = 1u;
    rings->outer[x] = outer;
    rings->triangle[x] =
        t | (holder == key ? CADT_RING_DANGLES : 0u) | (cadt_is_flagged(m, edge) ? CADT_RING_FLAGGED : 0u);
  }
  if (lost) cadt_store_relaxed(wins + s, 0u);
}
CADT_KERNEL(cadt_decide_cavities, CADT_SEGMENT_MESH_PARAMETERS, CADT_RINGS_PARAMETERS, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* claims, CADT_GLOBAL cadt_u32* wins) {
  CADT_SEGMENT_MESH(mesh);
  CADT_RINGS(rings);
  CADT_FOR(x, count, grain) { cadt_decide_place(&mesh, &rings, x, claims, wins); }
}

/* The rings of the other pieces lose their edges. Of those that go on nobody asks any more who holds a triangle: its
 * claim becomes the place of its edge in the ring. (The first and the last triangle have two, but no other edge of the
 * ring is on their other side.) */
CADT_FN void cadt_settle_place(const cadt_rings* rings, cadt_u32 x, CADT_GLOBAL cadt_u32* claims,
                               CADT_GLOBAL const cadt_u32* wins) {
  if (rings->edge[x] == CADT_NONE) return;
  if (wins[rings->piece[x]])
    cadt_store_relaxed(claims + CADT_TRIANGLE_OF(rings->edge[x]), x);
  else
    rings->edge[x] = CADT_NONE;
}
CADT_KERNEL(cadt_settle_cavities, CADT_RINGS_PARAMETERS, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* claims,
            CADT_GLOBAL const cadt_u32* wins) {
  CADT_RINGS(rings);
  CADT_FOR(x, count, grain) { cadt_settle_place(&rings, x, claims, wins); }
}

/* The ends of a piece that has to wait go to `pairs`. */
CADT_FN void cadt_keep_piece(CADT_GLOBAL const cadt_u32* ends, cadt_u32 s, CADT_GLOBAL cadt_u32* pairs,
                             CADT_GLOBAL cadt_u32* words) {
  const cadt_u32 place = cadt_add_relaxed(words + CADT_SEGMENTS_LEFT, 1u);
  pairs[2u * place] = ends[2u * s];
  pairs[2u * place + 1u] = ends[2u * s + 1u];
}
CADT_KERNEL(cadt_keep_pieces, CADT_PIECES_PARAMETERS, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL const cadt_u32* wins,
            CADT_GLOBAL cadt_u32* pairs, CADT_GLOBAL cadt_u32* words) {
  CADT_PIECES(pieces);
  CADT_FOR(s, count, grain) {
    if (!wins[s] && pieces.sizes[s]) cadt_keep_piece(pieces.ends, s, pairs, words);
  }
}

#endif
