/* SPDX-License-Identifier: Apache-2.0
 *
 * Assembly: the mesh in arrays (certify.dev.h) from proven stars. A triangle with a proven vertex is in the star of
 * each of its proven vertices; the proven vertex with the lowest position owns it and numbers it: the triangles that a
 * vertex owns have consecutive numbers, in the order of its star. So a vertex finds the numbers of all its triangles in
 * the stars of its neighbours.
 *
 *              9                    vertex 5 and its star 2, 7, 9, 3, all proven;
 *            / | \                  in each triangle its owner
 *          /   |   \                triangle   owner
 *        /  3  |  5  \              5 2 7      2      number and slot are found in the star of 2
 *      3 ----- 5 ----- 7            5 7 9      5      the first number of 5
 *        \  2  |  2  /              5 9 3      3      found in the star of 3
 *          \   |   /                5 3 2      2      found in the star of 2
 *            \ | /
 *              2                    If 2 had no proven star, 5 2 7 would belong to 5, and 5 3 2 to 3.
 */
#ifndef CADT_STARS_ASSEMBLE_H
#define CADT_STARS_ASSEMBLE_H

#include "common/mesh/locked_mesh.dev.h"
#include "common/stars/local_star.dev.h"

typedef struct {
  CADT_GLOBAL const cadt_u32* star_vertices;
  CADT_GLOBAL const cadt_u32* begins;   /* first word of each star */
  CADT_GLOBAL const cadt_u16* marks;    /* size of each star, and a bit for each triangle that is owned */
  CADT_GLOBAL const cadt_u32* bases;    /* number of the first owned triangle */
  CADT_GLOBAL const cadt_u32* has_star; /* one bit a vertex */
} cadt_star_set;

#define CADT_MARK_SIZE(mark) (CADT_CAST(cadt_u32, mark) >> CADT_STAR_DEGREE)
#define CADT_MARK_OWNED(mark) (CADT_CAST(cadt_u32, mark) & ((1u << CADT_STAR_DEGREE) - 1u))

CADT_FN cadt_u32 cadt_has_star(CADT_GLOBAL const cadt_u32* has_star, cadt_u32 v) {
  return (has_star[v >> 5] >> (v & 31u)) & 1u;
}

/* has_star: one bit a vertex. All vertices read the bits of their neighbours, and bits are in the cache more often than
 * words. */
CADT_KERNEL(cadt_pack_proven, CADT_GLOBAL const cadt_u32* sizes, cadt_u32 n, cadt_u32 words, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* proven) {
  CADT_FOR(w, words, grain) {
    const cadt_u32 begin = 32u * w, count = cadt_min_u32(32u, n - begin);
    cadt_u32 bits = 0u;
    for (cadt_u32 k = 0u; k < count; ++k) bits |= (sizes[begin + k] ? 1u : 0u) << k;
    proven[w] = bits;
  }
}

/* Counts the owned triangles of each vertex, and flags the vertices without a star, both with a 0 at the end;
 * totals[0]: owned triangles without another proven vertex. */
CADT_KERNEL(cadt_star_counts, CADT_GLOBAL const cadt_u32* star_vertices, CADT_GLOBAL const cadt_u32* begins,
            CADT_GLOBAL const cadt_u32* sizes, CADT_GLOBAL const cadt_u32* has_star, cadt_u32 n, cadt_u32 grain,
            CADT_GLOBAL cadt_u16* marks, CADT_GLOBAL cadt_u32* owned, CADT_GLOBAL cadt_u32* unproven,
            CADT_GLOBAL cadt_u32* totals) {
  cadt_u32 open = 0u;
  if (cadt_item == 0u) owned[n] = unproven[n] = 0u;
  CADT_FOR(v, n, grain) {
    const cadt_u32 size = sizes[v], all = (1u << size) - 1u, last = size ? size - 1u : 0u;
    CADT_GLOBAL const cadt_u32* star = star_vertices + (size ? begins[v] : 0u);
    cadt_u32 proven = 0u, lower = 0u; /* star vertices that are proven; of these those that come before v */
    for (cadt_u32 k = 0u; k < size; ++k) {
      const cadt_u32 a = star[k];
      proven |= cadt_has_star(has_star, a) << k;
      lower |= (a < v ? 1u : 0u) << k;
    }
    lower &= proven;
    /* of a star vertex or the next one: one bit a triangle */
    const cadt_u32 some_lower = lower | (lower >> 1) | ((lower & 1u) << last);
    const cadt_u32 some_proven = proven | (proven >> 1) | ((proven & 1u) << last);
    const cadt_u32 mask = all & ~some_lower;
    open += cadt_popcount(mask & ~some_proven);
    marks[v] = CADT_CAST(cadt_u16, (size << CADT_STAR_DEGREE) | mask);
    owned[v] = cadt_popcount(mask);
    unproven[v] = size ? 0u : 1u;
  }
  if (open) cadt_add_relaxed(totals, open);
}

/* A bit for each of four words that equals `vertex`, shifted. */
CADT_FN cadt_u32 cadt_match_words(CADT_GLOBAL const cadt_u32* words, cadt_u32 vertex, cadt_u32 shift) {
  cadt_u32 four[4], same = 0u;
  cadt_load_four(words, four);
  for (cadt_u32 k = 0u; k < 4u; ++k)
    if (four[k] == vertex) same |= 1u << (shift + k);
  return same;
}

/* Triangle v, a, b in the star of v, owned by another vertex: its number, and the slot of v in it, as a half-edge.
 * Slots are the owner, then counterclockwise. A single search whoever is the owner, so that lanes stay converged; the
 * first words are loaded at once, since each load has a long latency. */
CADT_FN cadt_u32 cadt_find_triangle_of_star(const cadt_star_set* s, cadt_u32 v, cadt_u32 a, cadt_u32 b,
                                            cadt_u32 a_owns) {
  const cadt_u32 owner = a_owns ? a : b, next = a_owns ? b : v;
  const cadt_u32 base = s->bases[owner], begin = s->begins[owner], skip = begin & 3u;
  const cadt_u32 owned = CADT_MARK_OWNED(s->marks[owner]);
  CADT_GLOBAL const cadt_u32* words = s->star_vertices + (begin - skip);
  cadt_u32 same = cadt_match_words(words, next, 0u) | cadt_match_words(words + 4u, next, 4u);
  same >>= skip; /* the words in front belong to another star; those behind come later */
  for (cadt_u32 k = 8u; k < 16u && !same; k += 4u) same = cadt_match_words(words + k, next, k) >> skip;
  return CADT_HALF_EDGE(base + cadt_popcount(owned & ((same & (0u - same)) - 1u)), a_owns ? 2u : 1u);
}

/* The triangles of a group of vertices have consecutive numbers. A team collects them in its memory and writes them to
 * the mesh in one piece: scattered writes of single words would dominate the kernel. */
typedef struct {
  cadt_u32 word[3 * CADT_TRIANGLES_OF_TEAM];
} cadt_triangle_page;
#define CADT_UNWRITTEN 0xFFFFFFFEu /* not a half-edge */

typedef struct {
  CADT_TEAM_PTR cadt_triangle_page* page;
  CADT_GLOBAL cadt_u32* words; /* 3 a triangle */
  cadt_u32 first, count;       /* triangles of the group, and how many of them the page holds */
  cadt_u32 triangles;          /* number of all triangles; contradictory stars may ask for more */
} cadt_triangle_sink;

CADT_FN cadt_triangle_sink cadt_sink_of(CADT_TEAM_PTR cadt_triangle_page* page, CADT_GLOBAL cadt_u32* words,
                                        cadt_u32 first, cadt_u32 end, cadt_u32 triangles) {
  const cadt_triangle_sink sink = {page, words, first, cadt_min_u32(end - first, CADT_TRIANGLES_OF_TEAM), triangles};
  return sink;
}

CADT_FN void cadt_put_word(const cadt_triangle_sink* s, cadt_u32 triangle, cadt_u32 slot, cadt_u32 value) {
  if (triangle - s->first < s->count)
    s->page->word[3u * (triangle - s->first) + slot] = value;
  else if (triangle < s->triangles)
    cadt_store_relaxed(s->words + 3u * triangle + slot, value);
}

CADT_FN void cadt_put_triangle(const cadt_triangle_sink* s, cadt_u32 triangle, cadt_u32 a, cadt_u32 b, cadt_u32 c) {
  if (triangle - s->first < s->count) {
    CADT_TEAM_PTR cadt_u32* word = s->page->word + 3u * (triangle - s->first);
    word[0] = a;
    word[1] = b;
    word[2] = c;
  } else {
    cadt_put_word(s, triangle, 0u, a);
    cadt_put_word(s, triangle, 1u, b);
    cadt_put_word(s, triangle, 2u, c);
  }
}

CADT_FN void cadt_empty_page(const cadt_triangle_sink* s) {
  CADT_TEAM_FOR(i, s->count) { s->page->word[3u * i] = CADT_UNWRITTEN; }
  CADT_TEAM_SYNC();
}

CADT_FN void cadt_write_page(const cadt_triangle_sink* s) {
  CADT_TEAM_SYNC();
  CADT_TEAM_FOR(i, 3u * s->count) {
    const cadt_u32 value = s->page->word[i];
    if (value != CADT_UNWRITTEN) cadt_store_relaxed(s->words + 3u * s->first + i, value);
  }
  CADT_TEAM_SYNC();
}

/* Half-edges of the triangles around v. Of a triangle that v owns, v writes those across its two edges at v; of another
 * triangle, and of one without another proven vertex, it writes the half-edge across the third edge. */
CADT_FN void cadt_write_star(const cadt_star_set* stars, const cadt_triangle_sink* sink, cadt_u32 v,
                             CADT_GLOBAL cadt_u32* open, CADT_GLOBAL cadt_u32* totals) {
  const cadt_u32 mark = stars->marks[v], size = CADT_MARK_SIZE(mark), owned = CADT_MARK_OWNED(mark),
                 all = (1u << size) - 1u;
  if (!size) return;
  CADT_GLOBAL const cadt_u32* star = stars->star_vertices + stars->begins[v];
  cadt_u32 proven = 0u, number = stars->bases[v];
  cadt_u32 at[CADT_STAR_DEGREE]; /* its triangles: number and slot of v */
  for (cadt_u32 k = 0u; k < size; ++k) {
    proven |= cadt_has_star(stars->has_star, star[k]) << k;
    at[k] = CADT_HALF_EDGE(number, 0u);
    number += (owned >> k) & 1u;
  }
  for (cadt_u32 left = all & ~owned; left; left &= left - 1u) {
    const cadt_u32 k = cadt_popcount((left & (0u - left)) - 1u), k1 = k + 1u < size ? k + 1u : 0u;
    const cadt_u32 a = star[k], b = star[k1];
    const cadt_u32 a_owns = ((proven >> k) & 1u) && a < v && !(((proven >> k1) & 1u) && b < a) ? 1u : 0u;
    at[k] = cadt_find_triangle_of_star(stars, v, a, b, a_owns);
  }
  for (cadt_u32 k = 0u; k < size; ++k) {
    const cadt_u32 k1 = k + 1u < size ? k + 1u : 0u, after = at[k1], before = at[k ? k - 1u : size - 1u];
    /* across the edges at v: beyond the next star vertex, beyond this one */
    const cadt_u32 link_after = CADT_HALF_EDGE(CADT_TRIANGLE_OF(after), CADT_PREV(CADT_EDGE_OF(after)));
    const cadt_u32 link_before = CADT_HALF_EDGE(CADT_TRIANGLE_OF(before), CADT_NEXT(CADT_EDGE_OF(before)));
    const cadt_u32 triangle = CADT_TRIANGLE_OF(at[k]), a_proven = (proven >> k) & 1u, b_proven = (proven >> k1) & 1u;
    if ((owned >> k) & 1u) {
      if (!a_proven && !b_proven) {
        cadt_put_word(sink, triangle, 0u, CADT_NONE);
        open[cadt_add_relaxed(totals + 1, 1u)] = triangle;
      }
      cadt_put_word(sink, triangle, 1u, link_after);
      cadt_put_word(sink, triangle, 2u, link_before);
    } else {
      /* edge 0 is at v; if both of its ends are proven, the lower one writes */
      const cadt_u32 b_owns = CADT_EDGE_OF(at[k]) == 1u ? 1u : 0u, other = b_owns ? star[k] : star[k1];
      if (!(b_owns ? a_proven : b_proven) || v < other)
        cadt_put_word(sink, triangle, 0u, b_owns ? link_before : link_after);
    }
  }
}

/* Half-edges of all triangles that have a proven vertex. `open` lists those whose edge 0 has no proven vertex:
 * stitching finds what is across (stitch.dev.h). firsts[t]: the first triangle of group t, and one more for the end. */
CADT_TEAM_KERNEL(CADT_ASSEMBLY_LANES, 12, cadt_star_half_edges, CADT_GLOBAL const cadt_u32* star_vertices,
                 CADT_GLOBAL const cadt_u32* begins, CADT_GLOBAL const cadt_u16* marks,
                 CADT_GLOBAL const cadt_u32* bases, CADT_GLOBAL const cadt_u32* has_star, cadt_u32 n, cadt_u32 groups,
                 cadt_u32 grain, CADT_GLOBAL cadt_u32* half_edges, CADT_GLOBAL cadt_u32* firsts,
                 CADT_GLOBAL cadt_u32* open, CADT_GLOBAL cadt_u32* totals) {
  CADT_TEAM_MEMORY cadt_triangle_page page;
  const cadt_star_set stars = {star_vertices, begins, marks, bases, has_star};
  if (cadt_item == 0u) firsts[groups] = bases[n];
  CADT_FOR_TEAMS(t, groups, grain) {
    const cadt_u32 begin = t * CADT_ASSEMBLY_LANES, vertices = cadt_min_u32(CADT_ASSEMBLY_LANES, n - begin);
    const cadt_triangle_sink sink = cadt_sink_of(&page, half_edges, bases[begin], bases[begin + vertices], bases[n]);
    if (cadt_team_lane == 0u) firsts[t] = bases[begin];
    cadt_empty_page(&sink); /* the half-edge across edge 0 may come from another group */
    CADT_TEAM_FOR(i, vertices) { cadt_write_star(&stars, &sink, begin + i, open, totals); }
    cadt_write_page(&sink);
  }
}

/* Vertices of the same triangles, of `groups` groups from `from` on: the owner and two of its star vertices. The first
 * triangle of these groups stands at mesh_vertices. A kernel of its own, so that `bases` can be freed before it:
 * together with these vertices they would set the peak of memory. Therefore a vertex counts the triangles of the
 * vertices before it in its group, by blocks. */
enum { CADT_OWNED_BLOCK = 16, CADT_OWNED_BLOCKS = CADT_ASSEMBLY_LANES / CADT_OWNED_BLOCK };

typedef struct {
  cadt_triangle_page page;
  cadt_u32 owned[CADT_ASSEMBLY_LANES], blocks[CADT_OWNED_BLOCKS];
} cadt_vertex_page;

CADT_TEAM_KERNEL(CADT_ASSEMBLY_LANES, 16, cadt_star_vertices, CADT_GLOBAL const cadt_u32* star_vertices,
                 CADT_GLOBAL const cadt_u32* begins, CADT_GLOBAL const cadt_u16* marks,
                 CADT_GLOBAL const cadt_u32* firsts, cadt_u32 n, cadt_u32 from, cadt_u32 groups, cadt_u32 grain,
                 CADT_GLOBAL cadt_u32* mesh_vertices) {
  CADT_TEAM_MEMORY cadt_vertex_page memory;
  const cadt_u32 base = firsts[from];
  CADT_FOR_TEAMS(g, groups, grain) {
    const cadt_u32 t = from + g, begin = t * CADT_ASSEMBLY_LANES;
    const cadt_u32 vertices = cadt_min_u32(CADT_ASSEMBLY_LANES, n - begin);
    const cadt_triangle_sink sink = cadt_sink_of(&memory.page, mesh_vertices, firsts[t] - base, firsts[t + 1u] - base,
                                                 firsts[from + groups] - base);
    CADT_TEAM_FOR(i, CADT_CAST(cadt_u32, CADT_ASSEMBLY_LANES)) {
      memory.owned[i] = i < vertices ? cadt_popcount(CADT_MARK_OWNED(marks[begin + i])) : 0u;
    }
    CADT_TEAM_SYNC();
    CADT_TEAM_FOR(block, CADT_CAST(cadt_u32, CADT_OWNED_BLOCKS)) {
      cadt_u32 sum = 0u;
      for (cadt_u32 i = 0u; i < CADT_CAST(cadt_u32, CADT_OWNED_BLOCK); ++i)
        sum += memory.owned[block * CADT_OWNED_BLOCK + i];
      memory.blocks[block] = sum;
    }
    CADT_TEAM_SYNC();
    CADT_TEAM_FOR(i, vertices) {
      const cadt_u32 v = begin + i, block = i / CADT_OWNED_BLOCK, mark = marks[v], size = CADT_MARK_SIZE(mark);
      CADT_GLOBAL const cadt_u32* star = star_vertices + (size ? begins[v] : 0u);
      cadt_u32 number = sink.first;
      for (cadt_u32 k = 0u; k < block; ++k) number += memory.blocks[k];
      for (cadt_u32 k = block * CADT_OWNED_BLOCK; k < i; ++k) number += memory.owned[k];
      for (cadt_u32 left = CADT_MARK_OWNED(mark); left; left &= left - 1u) {
        const cadt_u32 k = cadt_popcount((left & (0u - left)) - 1u);
        cadt_put_triangle(&sink, number, v, star[k], star[k + 1u < size ? k + 1u : 0u]);
        ++number;
      }
    }
    cadt_write_page(&sink);
  }
}

#endif
