/* SPDX-License-Identifier: Apache-2.0
 *
 * Records of the mesh from proven stars. A triangle with a proven vertex is in the star of each of its proven vertices;
 * the one of them with the lowest position owns it and numbers it: its owned triangles come one after another, in the
 * order of its star. So each vertex finds the numbers of all its triangles in the stars of its neighbours.
 */
#ifndef CADT_DEVICE_STAR_MESH_H
#define CADT_DEVICE_STAR_MESH_H

#include "common/device/mesh.h"
#include "common/device/star.h"

typedef struct {
  CADT_GLOBAL const cadt_u32* links; /* CADT_STAR_DEGREE words a vertex */
  CADT_GLOBAL const cadt_u32* sizes; /* neighbours; owned triangles in bits above CADT_STAR_OWNED */
  CADT_GLOBAL const cadt_u32* bases; /* number of the first owned triangle */
} cadt_star_set;

#define CADT_STAR_OWNED 8u
#define CADT_STAR_SIZE(word) ((word)&255u)

CADT_FN CADT_GLOBAL const cadt_u32* cadt_star_of(const cadt_star_set* s, cadt_u32 v) {
  return s->links + CADT_CAST(cadt_u64, v) * CADT_STAR_DEGREE;
}

/* Number of triangle k of the star of its owner. */
CADT_FN cadt_u32 cadt_owned_number(const cadt_star_set* s, cadt_u32 owner, cadt_u32 k) {
  return s->bases[owner] + cadt_popcount((s->sizes[owner] >> CADT_STAR_OWNED) & ((1u << k) - 1u));
}

/* Counts: owned triangles of each vertex, vertices without a star (1 each), both with a 0 at the end; totals[0]: owned
 * triangles with no other proven vertex. */
CADT_KERNEL(cadt_star_counts, CADT_GLOBAL const cadt_u32* links, CADT_GLOBAL cadt_u32* sizes, cadt_u32 n,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* owned, CADT_GLOBAL cadt_u32* unproven, CADT_GLOBAL cadt_u32* totals) {
  cadt_u32 open = 0u;
  if (cadt_item == 0u) owned[n] = unproven[n] = 0u;
  CADT_FOR(v, n, grain) {
    const cadt_u32 size = CADT_STAR_SIZE(sizes[v]); /* others may have the bits of owned triangles already */
    CADT_GLOBAL const cadt_u32* link = links + CADT_CAST(cadt_u64, v) * CADT_STAR_DEGREE;
    cadt_u32 mask = 0u, before = 0u, first = 0u, proven_before = 0u, proven_first = 0u;
    for (cadt_u32 k = 0u; k <= size && size; ++k) {
      const cadt_u32 a = k < size ? link[k] : link[0];
      const cadt_u32 proven = k < size ? (CADT_STAR_SIZE(cadt_load_relaxed(sizes + a)) != 0u ? 1u : 0u) : proven_first;
      const cadt_u32 lower = k < size ? (proven && a < v ? 1u : 0u) : first;
      if (k == 0u) {
        first = lower;
        proven_first = proven;
      } else if (!lower && !before) {
        mask |= 1u << (k - 1u);
        if (!proven && !proven_before) ++open;
      }
      before = lower;
      proven_before = proven;
    }
    cadt_store_relaxed(sizes + v, size | (mask << CADT_STAR_OWNED));
    owned[v] = cadt_popcount(mask);
    unproven[v] = size ? 0u : 1u;
  }
  if (open) cadt_add_relaxed(totals, open);
}

/* Place of a vertex in the star of another. \pre it is there */
CADT_FN cadt_u32 cadt_place_in_star(CADT_GLOBAL const cadt_u32* star, cadt_u32 vertex) {
  for (cadt_u32 k = 0u;; k += 4u) {
    cadt_u32 four[4];
    cadt_load_four(star + k, four);
    if (four[0] == vertex) return k;
    if (four[1] == vertex) return k + 1u;
    if (four[2] == vertex) return k + 2u;
    if (four[3] == vertex || k + 4u >= CADT_CAST(cadt_u32, CADT_STAR_DEGREE)) return k + 3u;
  }
}

/* Triangle v, a, b in the star of v: its record, and the slot of v in it as the edge of a link. Slots are owner, next,
 * next. */
CADT_FN cadt_u32 cadt_find_triangle_of_star(const cadt_star_set* s, cadt_u32 v, cadt_u32 a, cadt_u32 b,
                                            cadt_u32 a_proven, cadt_u32 b_proven) {
  if (a_proven && a < v && !(b_proven && b < a))
    return CADT_LINK(cadt_owned_number(s, a, cadt_place_in_star(cadt_star_of(s, a), b)), 2u);
  return CADT_LINK(cadt_owned_number(s, b, cadt_place_in_star(cadt_star_of(s, b), v)), 1u);
}

/* Records of all triangles that have a proven vertex. `open` lists those whose edge 0 has no proven vertex: what is
 * across it is found by the join (join.h). */
CADT_KERNEL(cadt_star_records, CADT_GLOBAL const cadt_u32* links, CADT_GLOBAL const cadt_u32* sizes,
            CADT_GLOBAL const cadt_u32* bases, cadt_u32 n, cadt_u32 grain, CADT_GLOBAL cadt_record* records,
            CADT_GLOBAL cadt_u32* open, CADT_GLOBAL cadt_u32* totals) {
  cadt_star_set stars;
  stars.links = links;
  stars.sizes = sizes;
  stars.bases = bases;
  CADT_FOR(v, n, grain) {
    const cadt_u32 word = sizes[v], size = CADT_STAR_SIZE(word), owned = word >> CADT_STAR_OWNED,
                   all = (1u << size) - 1u;
    if (!size) continue;
    CADT_GLOBAL const cadt_u32* link = cadt_star_of(&stars, v);
    const cadt_u32 base = bases[v];
    cadt_u32 proven = 0u, number = base;
    cadt_u32 at[CADT_STAR_DEGREE]; /* its triangles: record and slot of v */
    for (cadt_u32 k = 0u; k < size; ++k) {
      if (CADT_STAR_SIZE(sizes[link[k]])) proven |= 1u << k;
      at[k] = CADT_LINK(number, 0u);
      number += (owned >> k) & 1u;
    }
    for (cadt_u32 left = all & ~owned; left; left &= left - 1u) {
      const cadt_u32 k = cadt_popcount((left & (0u - left)) - 1u), k1 = k + 1u < size ? k + 1u : 0u;
      at[k] = cadt_find_triangle_of_star(&stars, v, link[k], link[k1], (proven >> k) & 1u, (proven >> k1) & 1u);
    }
    for (cadt_u32 k = 0u; k < size; ++k) {
      const cadt_u32 k1 = k + 1u < size ? k + 1u : 0u, after = at[k1], before = at[k ? k - 1u : size - 1u];
      /* across the edges at v: behind the next neighbour, behind this one */
      const cadt_u32 link_after = CADT_LINK(CADT_LINK_RECORD(after), CADT_PREV(CADT_LINK_EDGE(after)));
      const cadt_u32 link_before = CADT_LINK(CADT_LINK_RECORD(before), CADT_NEXT(CADT_LINK_EDGE(before)));
      CADT_GLOBAL cadt_u32* w = records[CADT_LINK_RECORD(at[k])].word;
      if ((owned >> k) & 1u) {
        /* few and long stores: they are what this kernel waits for */
        cadt_store_four(w, v, link[k], link[k1], 2u);
        w[CADT_WORD_LINK + 1] = link_after;
        cadt_store_two(w + CADT_WORD_LINK + 2, link_before, 0u);
        if (!((proven >> k) & 1u) && !((proven >> k1) & 1u)) {
          w[CADT_WORD_LINK] = CADT_NONE;
          open[cadt_add_relaxed(totals + 1, 1u)] = CADT_LINK_RECORD(at[k]);
        }
      } else {
        /* edge 0 is at v; if both of its ends are proven, both store the same */
        cadt_store_relaxed(w + CADT_WORD_LINK, CADT_LINK_EDGE(at[k]) == 2u ? link_after : link_before);
      }
    }
  }
}

#endif
