/* SPDX-License-Identifier: Apache-2.0
 *
 * The two polygons of a ring (segment_rings.dev.h). A polygon's triangle at the base p q has as apex the vertex of the
 * chain for which no other one lies in the circle:
 *
 *            c                      Every vertex of the chain is visible from the base, so this triangle belongs to the
 *       .   / \   .                 constrained Delaunay triangulation of the polygon; the chains on its sides, with
 *     .    /   \    .               bases p c and c q, are polygons of the same kind (M. V. Anglada, "An improved
 *    .    /     \    .              incremental algorithm for constructing restricted Delaunay triangulations", 1997).
 *    p =========== q
 *
 * The chain comes to an apex only once, although it may touch itself. Each time that it comes to a vertex X, a crossed
 * edge of X meets the base; a vertex Y in between is visible from the base between two of these edges, so it lies in
 * the triangle of them and the base, in that of X and the base as well, and in the circle of X: X is not the apex. For
 * the same reason the chain does not come to the ends of its base again, which have been apexes, or are a and b.
 */
#ifndef CADT_CONSTRAINTS_SEGMENT_CAVITY_H
#define CADT_CONSTRAINTS_SEGMENT_CAVITY_H

#include "common/constraints/insert/random_insertion.dev.h"
#include "common/portable/teams.dev.h"

/* ---- the two polygons ---- */
/* The better of two places as apex over p q. */
CADT_FN cadt_u32 cadt_better_apex(const cadt_segment_mesh* m, const cadt_rings* rings, cadt_point p, cadt_point q,
                                  cadt_u32 x, cadt_u32 y, cadt_counters* counters) {
  if (x == CADT_NONE || y == CADT_NONE) return cadt_min_u32(x, y);
  const cadt_u32 u = rings->vertex[x], v = rings->vertex[y];
  if (u == v) return cadt_min_u32(x, y);
  return cadt_incircle(p, q, cadt_load_point(m->points + u), cadt_load_point(m->points + v), counters) > 0 ? y : x;
}

/* The place of the apex among every `lanes`-th place from the lane's on; CADT_NONE: there is none. */
CADT_FN cadt_u32 cadt_apex_of_chain(const cadt_segment_mesh* m, const cadt_rings* rings, const cadt_chain* c,
                                    cadt_u32 lane, cadt_u32 lanes, cadt_counters* counters) {
  const cadt_point p = cadt_load_point(m->points + rings->vertex[c->low]),
                   q = cadt_load_point(m->points + rings->vertex[c->high]);
  cadt_u32 best = CADT_NONE;
  for (cadt_u32 x = c->low + 1u + lane; x < c->high; x += lanes)
    best = cadt_better_apex(m, rings, p, q, best, x, counters);
  return best;
}

/* The place of the apex, by the lanes of a team. `shared`: a word for each of them. Apart from what single work-items
 * call: no barrier may be in their way, even if they never come to it. */
CADT_FN cadt_u32 cadt_apex_by_team(const cadt_segment_mesh* m, const cadt_rings* rings, const cadt_chain* c,
                                   CADT_TEAM_PTR cadt_u32* shared, cadt_u32 lane, cadt_u32 lanes,
                                   cadt_counters* counters) {
  const cadt_point p = cadt_load_point(m->points + rings->vertex[c->low]),
                   q = cadt_load_point(m->points + rings->vertex[c->high]);
  shared[lane] = cadt_apex_of_chain(m, rings, c, lane, lanes, counters);
  for (cadt_u32 step = lanes / 2u; step != 0u; step /= 2u) {
    CADT_TEAM_SYNC();
    if (lane < step) shared[lane] = cadt_better_apex(m, rings, p, q, shared[lane], shared[lane + step], counters);
  }
  CADT_TEAM_SYNC();
  return shared[0];
}

/* The first of the two root triangles leaves its half-edge in `bases`, the second one links both. */
CADT_FN void cadt_link_base(const cadt_segment_mesh* m, CADT_GLOBAL cadt_u32* base, cadt_u32 half_edge) {
  if (cadt_cas_relaxed(base, CADT_NONE, half_edge)) return;
  const cadt_u32 other = cadt_load_relaxed(base);
  m->across[3u * CADT_TRIANGLE_OF(half_edge) + CADT_EDGE_OF(half_edge)] = other;
  m->across[3u * CADT_TRIANGLE_OF(other) + CADT_EDGE_OF(other)] = half_edge;
}

/* Links the half-edge of a chain's base with what is on its other side. */
CADT_FN void cadt_close_base(const cadt_segment_mesh* m, const cadt_chain* c, cadt_u32 base,
                             CADT_GLOBAL cadt_u32* bases) {
  m->edge_flags[CADT_TRIANGLE_OF(base)] = c->parent == CADT_NONE ? 1u << CADT_EDGE_OF(base) : 0u;
  if (c->parent == CADT_NONE) {
    cadt_link_base(m, bases + c->piece, base);
  } else {
    m->across[3u * CADT_TRIANGLE_OF(base) + CADT_EDGE_OF(base)] = c->parent;
    m->across[3u * CADT_TRIANGLE_OF(c->parent) + CADT_EDGE_OF(c->parent)] = base;
  }
}

/* The chains on the sides of the triangle at the base of a chain: sides[0] on the left. One without vertices is an edge
 * of the ring, and has low + 1 = high. Returns which one is longer. */
CADT_FN cadt_u32 cadt_divide_chain(const cadt_rings* rings, const cadt_chain* c, cadt_u32 apex, cadt_chain* sides) {
  const cadt_u32 t = rings->triangle[apex] & CADT_RING_NONE;
  const cadt_chain left = {c->low, apex, CADT_HALF_EDGE(t, 1u), c->piece},
                   right = {apex, c->high, CADT_HALF_EDGE(t, 0u), c->piece};
  sides[0] = left;
  sides[1] = right;
  return apex - c->low > c->high - apex ? 0u : 1u;
}

/* Writes that triangle. */
CADT_FN void cadt_write_base(const cadt_segment_mesh* m, const cadt_rings* rings, const cadt_chain* c, cadt_u32 apex,
                             CADT_GLOBAL cadt_u32* bases, const cadt_chain* sides) {
  const cadt_u32 t = rings->triangle[apex] & CADT_RING_NONE;
  CADT_GLOBAL cadt_u32* corners = m->vertices + 3u * t;
  corners[0] = rings->vertex[c->low];
  corners[1] = rings->vertex[c->high];
  corners[2] = rings->vertex[apex];
  for (cadt_u32 k = 0u; k < 3u; ++k) cadt_store_relaxed(m->vertex_triangle + corners[k], t);
  cadt_close_base(m, c, CADT_HALF_EDGE(t, 2u), bases);
  for (cadt_u32 i = 0u; i < 2u; ++i)
    if (sides[i].low + 1u == sides[i].high) rings->edge[sides[i].low] = sides[i].parent;
}

enum { CADT_CHAIN_STACK = 32 /* the longer side of each triangle waits: each next one is at most half as long */ };

/* A chain that divides well takes a few times its length and its logarithm to be filled. What is left, above
 * CADT_CHAIN_SMALL, once that has cost CADT_CHAIN_WORK times the length is filled by random insertion, where a vertex
 * takes as long as about so many places. */
#ifndef CADT_CHAIN_WORK /* a test takes less */
#define CADT_CHAIN_WORK (CADT_CONTIGUOUS ? 40 : 8)
#define CADT_CHAIN_SMALL 64
#endif

/* All triangles of a chain. */
CADT_FN void cadt_fill_chain(const cadt_segment_mesh* m, const cadt_rings* rings, cadt_chain c,
                             CADT_GLOBAL cadt_u32* bases, CADT_GLOBAL cadt_u32* words, cadt_counters* counters) {
  cadt_chain stack[CADT_CHAIN_STACK], sides[2];
  cadt_u32 waiting = 0u;
  cadt_u64 work = CADT_CAST(cadt_u64, c.high - c.low) * CADT_CAST(cadt_u64, CADT_CHAIN_WORK);
  for (;;) {
    const cadt_u32 size = c.high - c.low;
    if (work < size && size > CADT_CAST(cadt_u32, CADT_CHAIN_SMALL)) {
      const cadt_u32 base = cadt_fill_at_random(m, rings, &c, counters);
      if (base != CADT_NONE) {
        cadt_close_base(m, &c, base, bases);
        if (!waiting) return;
        c = stack[--waiting];
        continue;
      }
      work = CADT_CAST(cadt_u64, size) * CADT_CAST(cadt_u64, CADT_CHAIN_WORK);
    }
    work = work < size ? 0u : work - size;
    const cadt_u32 apex = cadt_apex_of_chain(m, rings, &c, 0u, 1u, counters);
    if (apex == CADT_NONE) {
      cadt_add_relaxed(words + CADT_SEGMENTS_BROKEN, 1u);
      return;
    }
    const cadt_u32 longer = cadt_divide_chain(rings, &c, apex, sides);
    cadt_write_base(m, rings, &c, apex, bases, sides);
    if (sides[longer].high > sides[longer].low + 1u) stack[waiting++] = sides[longer];
    if (sides[1u - longer].high > sides[1u - longer].low + 1u)
      c = sides[1u - longer];
    else if (waiting)
      c = stack[--waiting];
    else
      return;
  }
}

/* On GPUs, chains longer than CADT_CHAIN_LONG are divided by teams, those above CADT_CHAIN_SHORT filled by work-items
 * of their own afterwards. A team goes on with the longer side of each triangle and leaves the other one, which is at
 * most half as long, to another team in the next launch. What is long after so many triangles does not divide well: a
 * work-item fills it. */
enum { CADT_CHAIN_SHORT = 8, CADT_CHAIN_LONG = 24, CADT_CHAIN_LANES = 256, CADT_CHAIN_TURNS = 4096 };

/* Chains that are left to another launch. */
typedef struct {
  CADT_GLOBAL cadt_chain* longer;
  CADT_GLOBAL cadt_chain* others;
} cadt_chain_queues;

/* Fills a chain, or leaves it to another launch; one of more than `longest` places to a team. */
CADT_FN void cadt_fill_or_queue(const cadt_segment_mesh* m, const cadt_rings* rings, const cadt_chain* c,
                                CADT_GLOBAL cadt_u32* bases, const cadt_chain_queues* queues, cadt_u32 shortest,
                                cadt_u32 longest, CADT_GLOBAL cadt_u32* words, cadt_counters* counters) {
  const cadt_u32 size = c->high - c->low;
#if CADT_CONTIGUOUS
  (void)queues, (void)shortest, (void)longest;
#else
  if (size > longest) {
    queues->longer[cadt_add_relaxed(words + CADT_SEGMENTS_LONG_CHAINS, 1u)] = *c;
    return;
  }
  if (size > shortest) {
    queues->others[cadt_add_relaxed(words + CADT_SEGMENTS_CHAINS, 1u)] = *c;
    return;
  }
#endif
  if (size > 1u) cadt_fill_chain(m, rings, *c, bases, words, counters);
}

/* The chains on both sides of a piece. */
CADT_FN void cadt_chains_of_piece(const cadt_pieces* pieces, cadt_u32 s, cadt_chain* sides) {
  const cadt_u32 begin = pieces->begins[s], end = begin + pieces->sizes[s] - 1u, b = begin + pieces->upper[s] + 1u;
  const cadt_chain above = {begin, b, CADT_NONE, s}, below = {b, end, CADT_NONE, s};
  sides[0] = above;
  sides[1] = below;
}

/* Both polygons of the pieces that go on. \pre bases are CADT_NONE */
CADT_KERNEL(cadt_fill_cavities, CADT_SEGMENT_MESH_PARAMETERS, CADT_PIECES_PARAMETERS, CADT_RINGS_PARAMETERS,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL const cadt_u32* wins, CADT_GLOBAL cadt_u32* bases,
            CADT_GLOBAL cadt_chain* longer, CADT_GLOBAL cadt_chain* others, CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_PIECES(pieces);
  CADT_RINGS(rings);
  CADT_DECLARE_COUNTERS(counters);
  const cadt_chain_queues queues = {longer, others};
  CADT_FOR(s, count, grain) {
    if (!wins[s]) continue;
    cadt_chain sides[2];
    cadt_chains_of_piece(&pieces, s, sides);
    for (cadt_u32 k = 0u; k < 2u; ++k)
      cadt_fill_or_queue(&mesh, &rings, sides + k, bases, &queues, CADT_CHAIN_LONG, CADT_CHAIN_LONG, words, &counters);
  }
}

/* Divides the long chains of the launch before, a team each. */
CADT_TEAM_KERNEL(CADT_CHAIN_LANES, 4, cadt_divide_chains, CADT_SEGMENT_MESH_PARAMETERS, CADT_RINGS_PARAMETERS,
                 CADT_GLOBAL const cadt_chain* chains, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* bases,
                 CADT_GLOBAL cadt_chain* longer, CADT_GLOBAL cadt_chain* others, CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_RINGS(rings);
  CADT_DECLARE_COUNTERS(counters);
  const cadt_chain_queues queues = {longer, others};
  CADT_TEAM_MEMORY cadt_u32 shared[CADT_CHAIN_LANES];
  CADT_FOR_TEAMS(i, count, grain) {
    cadt_chain c = chains[i];
    for (cadt_u32 turn = 1u;; ++turn) { /* all lanes take the same way */
      const cadt_u32 apex = cadt_apex_by_team(&mesh, &rings, &c, shared, cadt_team_lane, cadt_team_lanes, &counters);
      CADT_TEAM_SYNC();
      if (apex == CADT_NONE) {
        if (cadt_team_lane == 0u) cadt_add_relaxed(words + CADT_SEGMENTS_BROKEN, 1u);
        break;
      }
      cadt_chain sides[2];
      const cadt_u32 further = cadt_divide_chain(&rings, &c, apex, sides);
      const cadt_u32 ends = sides[further].high - sides[further].low <= CADT_CAST(cadt_u32, CADT_CHAIN_LONG) ||
                                    turn == CADT_CAST(cadt_u32, CADT_CHAIN_TURNS)
                                ? 1u
                                : 0u;
      if (cadt_team_lane == 0u) {
        cadt_write_base(&mesh, &rings, &c, apex, bases, sides);
        for (cadt_u32 k = 0u; k < 2u; ++k)
          if (k != further || ends)
            cadt_fill_or_queue(&mesh, &rings, sides + k, bases, &queues, CADT_CHAIN_SHORT,
                               k == further ? CADT_NONE : CADT_CAST(cadt_u32, CADT_CHAIN_LONG), words, &counters);
      }
      if (ends) break;
      c = sides[further];
    }
  }
}

/* The other chains that were left. */
CADT_KERNEL(cadt_fill_chains, CADT_SEGMENT_MESH_PARAMETERS, CADT_RINGS_PARAMETERS, CADT_GLOBAL const cadt_chain* chains,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* bases, CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_RINGS(rings);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(i, count, grain) { cadt_fill_chain(&mesh, &rings, chains[i], bases, words, &counters); }
}

/* Links the new triangle at an edge of a ring with that around the cavity. */
CADT_FN void cadt_link_place(const cadt_segment_mesh* m, const cadt_rings* rings, cadt_u32 x,
                             CADT_GLOBAL const cadt_u32* claims) {
  const cadt_u32 half_edge = rings->edge[x], t = CADT_TRIANGLE_OF(half_edge), bits = rings->triangle[x];
  if (half_edge == CADT_NONE) return;
  cadt_u32 outer = rings->outer[x];
  if (bits & CADT_RING_DANGLES) outer = rings->edge[claims[CADT_TRIANGLE_OF(outer)]];
  m->across[3u * t + CADT_EDGE_OF(half_edge)] = outer;
  if (!(bits & CADT_RING_DANGLES)) m->across[3u * CADT_TRIANGLE_OF(outer) + CADT_EDGE_OF(outer)] = half_edge;
  if (bits & CADT_RING_FLAGGED) cadt_or_relaxed(m->edge_flags + t, 1u << CADT_EDGE_OF(half_edge));
}
CADT_KERNEL(cadt_link_cavities, CADT_SEGMENT_MESH_PARAMETERS, CADT_RINGS_PARAMETERS, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* claims) {
  CADT_SEGMENT_MESH(mesh);
  CADT_RINGS(rings);
  CADT_FOR(x, count, grain) { cadt_link_place(&mesh, &rings, x, claims); }
}

/* Gives a claim up. */
CADT_FN void cadt_release_place(CADT_GLOBAL const cadt_u32* ring_triangle, cadt_u32 x, CADT_GLOBAL cadt_u32* claims) {
  const cadt_u32 t = ring_triangle[x] & CADT_RING_NONE;
  if (t != CADT_RING_NONE) cadt_store_relaxed(claims + t, CADT_NONE); /* several had claimed it */
}
CADT_KERNEL(cadt_release_cavities, CADT_GLOBAL const cadt_u32* ring_triangle, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* claims) {
  CADT_FOR(x, count, grain) { cadt_release_place(ring_triangle, x, claims); }
}

#endif
