/* SPDX-License-Identifier: Apache-2.0
 *
 * Stitching: the proven part of the mesh and the residual mesh become one. A triangle without a proven vertex belongs
 * to the Delaunay triangulation of the unproven (residual) vertices alone, since an empty circle stays empty in a
 * subset (docs/stars.md, "Stitching"). Gift wrapping builds that residual mesh, or insertion where it cannot; here
 * those of its triangles are found that fill the holes of the proven part, and both parts are connected.
 *
 *    proven part with a hole     residual mesh               whole mesh
 *
 *       p -- u === u -- p             u --- u.                  p -- u --- u -- p
 *       | \  |     |  / | \           | k / |  '.               | \  | k / |  / | \    p proven, u unproven
 *       |  p | hole| p  |  u          |  /  | h   u             |  p |  /  | p  |  u   = edges where both meet
 *       | /  |     |  \ | /           | / k |  .'               | /  | / k |  \ | /
 *       p -- u === u -- p             u --- u'                  p -- u --- u -- p
 *
 *                            k kept, h hidden: the proven part covers it
 *
 * An open triangle has one proven vertex; its edge 0 is opposite of that. The two parts meet in such edges: an open
 * triangle on one side, the residual mesh on the other. They cut the residual mesh into components; a component is
 * hidden if an open triangle lies on the same side of an edge as one of its triangles: there the proven part covers it.
 * The whole mesh is in two arrays (certify.dev.h), the residual mesh consists of locked triangles.
 */
#ifndef CADT_STARS_STITCH_H
#define CADT_STARS_STITCH_H

#include "common/overlay/flip_histogram.dev.h"
#include "common/portable/union_find.dev.h"

/* Gathers the residual vertices. `ranks` is the scan of 1 for each. */
CADT_KERNEL(cadt_pack_residual, CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL const cadt_point* points,
            CADT_GLOBAL cadt_point* subset, CADT_GLOBAL cadt_u32* positions, cadt_u32 n, cadt_u32 grain) {
  CADT_FOR(v, n, grain) {
    const cadt_u32 rank = ranks[v];
    if (ranks[v + 1u] == rank) continue;
    subset[rank] = points[v];
    positions[rank] = v;
  }
}

CADT_FN cadt_u32 cadt_edge_hash(cadt_u32 a, cadt_u32 b) {
  cadt_u32 x = a * 2654435761u ^ (b * 0x85EBCA6Bu + 0x9E3779B9u);
  x ^= x >> 15;
  x *= 0x2C1B3C6Du;
  return x ^ (x >> 13);
}

/* A hash table of the open triangles by the ends of their edge 0, from the first to the second; `mask` + 1 places, a
 * power of two. \pre the table is CADT_NONE */
CADT_KERNEL(cadt_stitch_enter, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* open, cadt_u32 count,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* table, cadt_u32 mask) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 t = open[i];
    CADT_GLOBAL const cadt_u32* v = vertices + 3u * t;
    cadt_u32 at = cadt_edge_hash(v[1], v[2]) & mask;
    while (!cadt_cas_relaxed(table + at, CADT_NONE, t)) at = (at + 1u) & mask;
  }
}

/* covers[3 r + k]: the open triangle on the same side of edge k as triangle r of the residual mesh, or CADT_NONE. */
CADT_KERNEL(cadt_stitch_cover, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_locked_triangle* smaller,
            CADT_GLOBAL const cadt_u32* positions, cadt_u32 slots, cadt_u32 grain, CADT_GLOBAL const cadt_u32* table,
            cadt_u32 mask, CADT_GLOBAL cadt_u32* covers, CADT_GLOBAL cadt_u32* roots) {
  CADT_FOR(r, slots, grain) {
    const cadt_locked_triangle s = smaller[r];
    roots[r] = r;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      cadt_u32 cover = CADT_NONE;
      const cadt_u32 from = CADT_PICK(k, s.word[1], s.word[2], s.word[0]);
      const cadt_u32 to = CADT_PICK(k, s.word[2], s.word[0], s.word[1]);
      if (s.word[CADT_WORD_LOCK] != 0u && from != CADT_GHOST && to != CADT_GHOST) {
        const cadt_u32 a = positions[from], b = positions[to];
        cadt_u32 at = cadt_edge_hash(a, b) & mask;
        for (cover = table[at]; cover != CADT_NONE; cover = table[at]) {
          CADT_GLOBAL const cadt_u32* v = vertices + 3u * cover;
          if (v[1] == a && v[2] == b) break;
          at = (at + 1u) & mask;
        }
      }
      covers[3u * r + k] = cover;
    }
  }
}

/* Components of the residual mesh without the edges that have an open triangle on either side. */
CADT_KERNEL(cadt_stitch_components, CADT_GLOBAL const cadt_locked_triangle* smaller, cadt_u32 slots, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* covers, CADT_GLOBAL cadt_u32* roots) {
  CADT_FOR(r, slots, grain) {
    const cadt_locked_triangle s = smaller[r];
    if (s.word[CADT_WORD_LOCK] == 0u) continue;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 half_edge = CADT_PICK(k, s.word[4], s.word[5], s.word[6]), other = CADT_TRIANGLE_OF(half_edge);
      if (other < r || covers[3u * r + k] != CADT_NONE || covers[3u * other + CADT_EDGE_OF(half_edge)] != CADT_NONE)
        continue;
      cadt_unite(roots, r, other);
    }
  }
}

/* hidden[root] = 1 for components that the proven part covers. \pre hidden is 0 */
CADT_KERNEL(cadt_stitch_hide, CADT_GLOBAL const cadt_u32* covers, CADT_GLOBAL cadt_u32* roots, cadt_u32 slots,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* hidden) {
  CADT_FOR(r, slots, grain) {
    if (covers[3u * r] != CADT_NONE || covers[3u * r + 1u] != CADT_NONE || covers[3u * r + 2u] != CADT_NONE)
      cadt_store_relaxed(hidden + cadt_find_root(roots, r), 1u);
  }
}

/* 1 for triangles that belong to the whole mesh, those of the ghost behind the others; their scan, with a 0 at the end,
 * numbers them. */
CADT_KERNEL(cadt_stitch_flags, CADT_GLOBAL const cadt_locked_triangle* smaller, CADT_GLOBAL cadt_u32* roots,
            CADT_GLOBAL const cadt_u32* hidden, cadt_u32 slots, cadt_u32 grain, CADT_GLOBAL cadt_u32* flags) {
  if (cadt_item == 0u) flags[2u * slots] = 0u;
  CADT_FOR(r, slots, grain) {
    const cadt_locked_triangle s = smaller[r];
    const cadt_u32 taken = s.word[CADT_WORD_LOCK] != 0u && !hidden[cadt_find_root(roots, r)] ? 1u : 0u;
    const cadt_u32 ghost = cadt_ghost_slot(&s) != 3u ? 1u : 0u;
    flags[r] = taken && !ghost ? 1u : 0u;
    flags[slots + r] = taken && ghost ? 1u : 0u;
  }
}

/* Number of triangle r among those that belong to the whole mesh, or CADT_NONE. */
CADT_FN cadt_u32 cadt_stitch_number(CADT_GLOBAL const cadt_u32* ranks, cadt_u32 slots, cadt_u32 r) {
  const cadt_u32 real = ranks[r], ghost = ranks[slots + r];
  if (ranks[r + 1u] != real) return real;
  return ranks[slots + r + 1u] != ghost ? ghost : CADT_NONE;
}

/* Copies the triangles behind the `before` triangles of the proven part, and connects both. Also counts edges by flips,
 * except those of the ghost; an edge between the parts counts for both of its sides. */
CADT_KERNEL(cadt_stitch_residual, CADT_GLOBAL const cadt_locked_triangle* smaller, CADT_GLOBAL const cadt_u32* covers,
            CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL const cadt_u32* positions, cadt_u32 slots, cadt_u32 grain,
            cadt_u32 before, CADT_GLOBAL cadt_u32* vertices, CADT_GLOBAL cadt_u32* half_edges,
            CADT_GLOBAL cadt_u32* flips) {
  CADT_FLIPS_BEGIN(bins, flips);
  CADT_FOR(r, slots, grain) {
    const cadt_locked_triangle s = smaller[r];
    if (s.word[CADT_WORD_LOCK] == 0u) continue;
    const cadt_u32 number = cadt_stitch_number(ranks, slots, r), t = before + number;
    if (number != CADT_NONE) {
      CADT_FLIPS_COUNT(bins, flips, s);
    }
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 half_edge = CADT_PICK(k, s.word[4], s.word[5], s.word[6]), other = CADT_TRIANGLE_OF(half_edge);
      const cadt_u32 cover = covers[3u * r + k], beyond = covers[3u * other + CADT_EDGE_OF(half_edge)];
      if (number != CADT_NONE) {
        const cadt_u32 v = CADT_PICK(k, s.word[0], s.word[1], s.word[2]);
        cadt_u32 across = CADT_HALF_EDGE(beyond, 0u);
        if (beyond != CADT_NONE) {
          cadt_locked_triangle side; /* a ghost triangle, so that its edge 0 alone counts */
          side.word[0] = CADT_GHOST;
          side.word[1] = side.word[2] = 0u;
          side.word[CADT_WORD_FLIPS] = cadt_flips_set(0u, 0u, cadt_flips_get(s.word[CADT_WORD_FLIPS], k));
          CADT_FLIPS_COUNT(bins, flips, side);
          half_edges[3u * beyond] = CADT_HALF_EDGE(t, k);
        } else {
          across = CADT_HALF_EDGE(before + cadt_stitch_number(ranks, slots, other), CADT_EDGE_OF(half_edge));
        }
        half_edges[3u * t + k] = across;
        vertices[3u * t + k] = v == CADT_GHOST ? v : positions[v];
      } else if (cover != CADT_NONE && beyond != CADT_NONE) { /* proven on both sides */
        half_edges[3u * cover] = CADT_HALF_EDGE(beyond, 0u);
      }
    }
  }
  CADT_FLIPS_END(bins, flips);
}

#endif
