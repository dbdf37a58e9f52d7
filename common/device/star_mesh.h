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

/* Place of a vertex in the star of another. The first eight come at once: few stars have more, and each wait is long.
 * \pre it is there */
CADT_FN cadt_u32 cadt_place_in_star(CADT_GLOBAL const cadt_u32* star, cadt_u32 vertex) {
  cadt_u32 near[8], far[4];
  cadt_load_four(star, near);
  cadt_load_four(star + 4, near + 4);
  for (cadt_u32 k = 0u; k < 8u; ++k)
    if (near[k] == vertex) return k;
  cadt_load_four(star + 8, far);
  for (cadt_u32 k = 0u; k < 3u; ++k)
    if (far[k] == vertex) return 8u + k;
  return CADT_CAST(cadt_u32, CADT_STAR_DEGREE) - 1u;
}

/* Triangle v, a, b in the star of v: its record, and the slot of v in it as the edge of a link. Slots are owner, next,
 * next. One search whoever owns it, so that lanes stay together, and nothing waits for it that need not. */
CADT_FN cadt_u32 cadt_find_triangle_of_star(const cadt_star_set* s, cadt_u32 v, cadt_u32 a, cadt_u32 b,
                                            cadt_u32 a_proven, cadt_u32 b_proven) {
  const cadt_u32 a_owns = a_proven && a < v && !(b_proven && b < a) ? 1u : 0u;
  const cadt_u32 owner = a_owns ? a : b, next = a_owns ? b : v;
  const cadt_u32 base = s->bases[owner], owned = s->sizes[owner] >> CADT_STAR_OWNED;
  const cadt_u32 k = cadt_place_in_star(cadt_star_of(s, owner), next);
  return CADT_LINK(base + cadt_popcount(owned & ((1u << k) - 1u)), a_owns ? 2u : 1u);
}

/* The triangles of a group of vertices come one after another. Their records are put together in the memory of the
 * team, a plane for each word, and written to the mesh in one go: single words at places of their own would be what the
 * kernel waits for. */
typedef struct {
  cadt_u32 word[8 * CADT_RECORD_PLANE];
} cadt_record_pages;
#define CADT_UNWRITTEN 0xFFFFFFFEu /* no link */
#define CADT_PLANE(word) (CADT_CAST(cadt_u32, word) * CADT_CAST(cadt_u32, CADT_RECORD_PLANE))

/* Where a word goes. */
typedef struct {
  CADT_TEAM_PTR cadt_record_pages* pages;
  CADT_GLOBAL cadt_record* records;
  cadt_u32 first, count; /* records of the group that are in the pages */
} cadt_record_sink;

/* `across`: CADT_UNWRITTEN if it is put by another vertex. */
CADT_FN void cadt_put_record(const cadt_record_sink* s, cadt_u32 record, cadt_u32 owner, cadt_u32 a, cadt_u32 b,
                             cadt_u32 across, cadt_u32 link_1, cadt_u32 link_2) {
  const cadt_u32 place = record - s->first;
  if (place < s->count) {
    CADT_TEAM_PTR cadt_u32* word = s->pages->word + place;
    word[0] = owner;
    word[CADT_PLANE(1)] = a;
    word[CADT_PLANE(2)] = b;
    word[CADT_PLANE(CADT_WORD_LOCK)] = 2u;
    if (across != CADT_UNWRITTEN) word[CADT_PLANE(CADT_WORD_LINK)] = across;
    word[CADT_PLANE(CADT_WORD_LINK + 1)] = link_1;
    word[CADT_PLANE(CADT_WORD_LINK + 2)] = link_2;
    word[CADT_PLANE(CADT_WORD_FLIPS)] = 0u;
  } else {
    CADT_GLOBAL cadt_u32* word = s->records[record].word;
    cadt_store_four(word, owner, a, b, 2u);
    if (across != CADT_UNWRITTEN) word[CADT_WORD_LINK] = across;
    word[CADT_WORD_LINK + 1] = link_1;
    cadt_store_two(word + CADT_WORD_LINK + 2, link_2, 0u);
  }
}

CADT_FN void cadt_put_across(const cadt_record_sink* s, cadt_u32 record, cadt_u32 link) {
  const cadt_u32 place = record - s->first;
  if (place < s->count)
    s->pages->word[CADT_PLANE(CADT_WORD_LINK) + place] = link;
  else
    cadt_store_relaxed(&s->records[record].word[CADT_WORD_LINK], link);
}

/* Triangles of vertex v of the mesh. */
CADT_FN void cadt_put_star(const cadt_star_set* stars, const cadt_record_sink* sink, cadt_u32 v,
                           CADT_GLOBAL cadt_u32* open, CADT_GLOBAL cadt_u32* totals) {
  const cadt_u32 word = stars->sizes[v], size = CADT_STAR_SIZE(word), owned = word >> CADT_STAR_OWNED,
                 all = (1u << size) - 1u;
  if (!size) return;
  CADT_GLOBAL const cadt_u32* link = cadt_star_of(stars, v);
  cadt_u32 proven = 0u, number = stars->bases[v];
  cadt_u32 at[CADT_STAR_DEGREE]; /* its triangles: record and slot of v */
  for (cadt_u32 k = 0u; k < size; ++k) {
    if (CADT_STAR_SIZE(stars->sizes[link[k]])) proven |= 1u << k;
    at[k] = CADT_LINK(number, 0u);
    number += (owned >> k) & 1u;
  }
  for (cadt_u32 left = all & ~owned; left; left &= left - 1u) {
    const cadt_u32 k = cadt_popcount((left & (0u - left)) - 1u), k1 = k + 1u < size ? k + 1u : 0u;
    at[k] = cadt_find_triangle_of_star(stars, v, link[k], link[k1], (proven >> k) & 1u, (proven >> k1) & 1u);
  }
  for (cadt_u32 k = 0u; k < size; ++k) {
    const cadt_u32 k1 = k + 1u < size ? k + 1u : 0u, after = at[k1], before = at[k ? k - 1u : size - 1u];
    /* across the edges at v: behind the next neighbour, behind this one */
    const cadt_u32 link_after = CADT_LINK(CADT_LINK_RECORD(after), CADT_PREV(CADT_LINK_EDGE(after)));
    const cadt_u32 link_before = CADT_LINK(CADT_LINK_RECORD(before), CADT_NEXT(CADT_LINK_EDGE(before)));
    const cadt_u32 record = CADT_LINK_RECORD(at[k]), a_proven = (proven >> k) & 1u, b_proven = (proven >> k1) & 1u;
    if ((owned >> k) & 1u) {
      const cadt_u32 is_open = !a_proven && !b_proven ? 1u : 0u;
      cadt_put_record(sink, record, v, link[k], link[k1], is_open ? CADT_NONE : CADT_UNWRITTEN, link_after,
                      link_before);
      if (is_open) open[cadt_add_relaxed(totals + 1, 1u)] = record;
    } else {
      /* edge 0 is at v; if both of its ends are proven, the lower one stores */
      const cadt_u32 b_owns = CADT_LINK_EDGE(at[k]) == 1u ? 1u : 0u, other = b_owns ? link[k] : link[k1];
      if (!(b_owns ? a_proven : b_proven) || v < other)
        cadt_put_across(sink, record, b_owns ? link_before : link_after);
    }
  }
}

/* Records of all triangles that have a proven vertex. `open` lists those whose edge 0 has no proven vertex: what is
 * across it is found by the join (join.h). */
CADT_TEAM_KERNEL(CADT_RECORD_LANES, 12, cadt_star_records, CADT_GLOBAL const cadt_u32* links,
                 CADT_GLOBAL const cadt_u32* sizes, CADT_GLOBAL const cadt_u32* bases, cadt_u32 n, cadt_u32 groups,
                 cadt_u32 grain, CADT_GLOBAL cadt_record* records, CADT_GLOBAL cadt_u32* open,
                 CADT_GLOBAL cadt_u32* totals) {
  CADT_TEAM_MEMORY cadt_record_pages pages;
  cadt_star_set stars;
  stars.links = links;
  stars.sizes = sizes;
  stars.bases = bases;
  CADT_FOR_TEAMS(t, groups, grain) {
    const cadt_u32 begin = t * CADT_RECORD_LANES, vertices = cadt_min_u32(CADT_RECORD_LANES, n - begin);
    cadt_record_sink sink;
    sink.pages = &pages;
    sink.records = records;
    sink.first = bases[begin];
    sink.count = cadt_min_u32(bases[begin + vertices] - sink.first, CADT_RECORD_PLANE);
    /* the link across edge 0 may come from another group */
    CADT_TEAM_FOR(i, sink.count) { pages.word[CADT_PLANE(CADT_WORD_LINK) + i] = CADT_UNWRITTEN; }
    CADT_TEAM_SYNC();
    CADT_TEAM_FOR(i, vertices) { cadt_put_star(&stars, &sink, begin + i, open, totals); }
    CADT_TEAM_SYNC();
    CADT_TEAM_FOR(i, 8u * sink.count) {
      const cadt_u32 value = pages.word[CADT_PLANE(i & 7u) + (i >> 3)];
      if (value != CADT_UNWRITTEN) cadt_store_relaxed(&records[sink.first + (i >> 3)].word[i & 7u], value);
    }
    CADT_TEAM_SYNC();
  }
}

#endif
