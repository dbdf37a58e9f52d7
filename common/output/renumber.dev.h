/* SPDX-License-Identifier: Apache-2.0
 *
 * The mesh as arrays of input ids: vertices become input ids, half-edges become numbers of triangles.
 */
#ifndef CADT_OUTPUT_RENUMBER_H
#define CADT_OUTPUT_RENUMBER_H

#include "common/certify/certify.dev.h"
#include "common/overlay/flip_histogram.dev.h"

/* A triangle in input ids, rotated so that the smallest comes first; `slot` is where that vertex was. */
typedef struct {
  cadt_u32 a, b, c, slot;
} cadt_triangle;

/* Null `input_ids`: the vertices are input ids already. */
CADT_FN cadt_triangle cadt_in_input_ids(CADT_GLOBAL const cadt_u32* input_ids, cadt_u32 v0, cadt_u32 v1, cadt_u32 v2) {
  const cadt_u32 x = input_ids ? input_ids[v0] : v0, y = input_ids ? input_ids[v1] : v1,
                 z = input_ids ? input_ids[v2] : v2;
  cadt_triangle t;
  t.slot = x < y ? (x < z ? 0u : 2u) : (y < z ? 1u : 2u);
  t.a = CADT_PICK(t.slot, x, y, z);
  t.b = CADT_PICK(t.slot, y, z, x);
  t.c = CADT_PICK(t.slot, z, x, y);
  return t;
}

/* Whether the triangle exists and has no ghost. */
CADT_FN cadt_u32 cadt_is_real(const cadt_locked_triangle* r) {
  return r->word[CADT_WORD_LOCK] != 0u && r->word[0] != CADT_GHOST && r->word[1] != CADT_GHOST &&
                 r->word[2] != CADT_GHOST
             ? 1u
             : 0u;
}

/* The vertices of triangle t, of the locked mesh or, if that is null, of arrays, of which only real
 * triangles are read. */
CADT_FN void cadt_read_vertices(CADT_GLOBAL const cadt_locked_triangle* locked, CADT_GLOBAL const cadt_u32* vertices,
                                cadt_u32 t, cadt_locked_triangle* r) {
  if (locked) {
    *r = locked[t];
    return;
  }
  for (cadt_u32 k = 0u; k < 3u; ++k) r->word[k] = cadt_word_of_three(vertices, t, k);
  r->word[CADT_WORD_LOCK] = 2u;
  r->word[CADT_WORD_FLIPS] = 0u;
}

/* Writes a triangle to place `at`. n0, n1, n2: the triangles across its edges by the slots of the mesh. */
CADT_FN void cadt_write_triangle(const cadt_triangle t, cadt_u32 at, cadt_u32 n0, cadt_u32 n1, cadt_u32 n2,
                                 CADT_GLOBAL cadt_u32* triangles, CADT_GLOBAL cadt_u32* neighbors) {
  if (triangles) {
    triangles[3u * at] = t.a;
    triangles[3u * at + 1u] = t.b;
    triangles[3u * at + 2u] = t.c;
  }
  if (neighbors) {
    neighbors[3u * at] = CADT_PICK(t.slot, n0, n1, n2);
    neighbors[3u * at + 1u] = CADT_PICK(t.slot, n1, n2, n0);
    neighbors[3u * at + 2u] = CADT_PICK(t.slot, n2, n0, n1);
  }
}

/* Writes the triangles to their places, behind `first` others that have nothing to do with them. In the order of the
 * mesh, so that what is read (numbers of neighbours, input ids) is near. */
CADT_KERNEL(cadt_write_triangles, CADT_GLOBAL const cadt_locked_triangle* locked, CADT_GLOBAL const cadt_u32* input_ids,
            CADT_GLOBAL const cadt_u32* numbers, CADT_GLOBAL cadt_u32* triangles, CADT_GLOBAL cadt_u32* neighbors,
            cadt_u32 first, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(triangle, count, grain) {
    const cadt_u32 i = numbers[triangle];
    if (i == CADT_NONE) continue;
    const cadt_locked_triangle r = locked[triangle];
    /* ghosts have no number: CADT_NONE is -1 */
    cadt_write_triangle(cadt_in_input_ids(input_ids, r.word[0], r.word[1], r.word[2]), first + i,
                        numbers[CADT_TRIANGLE_OF(r.word[4])], numbers[CADT_TRIANGLE_OF(r.word[5])],
                        numbers[CADT_TRIANGLE_OF(r.word[6])], triangles, neighbors);
  }
}

/* For the order of the mesh: 1 for each real triangle; flags[count] becomes 0, so that its scan is the total. Counts
 * edges by flips as well. */
CADT_KERNEL(cadt_flag_triangles, CADT_GLOBAL const cadt_locked_triangle* locked, CADT_GLOBAL cadt_u32* flags,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* flips) {
  CADT_FLIPS_BEGIN(bins, flips);
  if (cadt_item == 0u) flags[count] = 0u;
  CADT_FOR(t, count, grain) {
    const cadt_locked_triangle r = locked[t];
    flags[t] = cadt_is_real(&r);
    if (r.word[CADT_WORD_LOCK] != 0u) {
      CADT_FLIPS_COUNT(bins, flips, r);
    }
  }
  CADT_FLIPS_END(bins, flips);
}

/* The number of the triangle of a half-edge, from the exclusive scan of the flags. */
CADT_FN cadt_u32 cadt_rank(CADT_GLOBAL const cadt_u32* ranks, cadt_u32 half_edge) {
  const cadt_u32 t = CADT_TRIANGLE_OF(half_edge), rank = ranks[t];
  return ranks[t + 1u] != rank ? rank : CADT_NONE;
}

/* As cadt_write_triangles, in the order of the mesh. `ranks` is the exclusive scan of the flags. */
CADT_KERNEL(cadt_write_ranked, CADT_GLOBAL const cadt_locked_triangle* locked, CADT_GLOBAL const cadt_u32* input_ids,
            CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL cadt_u32* triangles, CADT_GLOBAL cadt_u32* neighbors,
            cadt_u32 first, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(triangle, count, grain) {
    const cadt_u32 i = ranks[triangle];
    if (ranks[triangle + 1u] == i) continue;
    const cadt_locked_triangle r = locked[triangle];
    cadt_write_triangle(cadt_in_input_ids(input_ids, r.word[0], r.word[1], r.word[2]), first + i,
                        cadt_rank(ranks, r.word[4]), cadt_rank(ranks, r.word[5]), cadt_rank(ranks, r.word[6]),
                        triangles, neighbors);
  }
}

/* The number of the triangle of a half-edge in arrays; null `numbers`: its index. */
CADT_FN cadt_u32 cadt_number_across(CADT_GLOBAL const cadt_u32* numbers, cadt_u32 half_edge, cadt_u32 count) {
  const cadt_u32 t = CADT_TRIANGLE_OF(half_edge);
  return t >= count ? CADT_NONE : (numbers ? numbers[t] : t);
}

/* As cadt_write_triangles, from arrays whose first `count` triangles are real; if either result is null, only the other
 * is written. Without numbers the results may be the arrays themselves. */
CADT_KERNEL(cadt_write_arrays, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* half_edges,
            CADT_GLOBAL const cadt_u32* input_ids, CADT_GLOBAL const cadt_u32* numbers, CADT_GLOBAL cadt_u32* triangles,
            CADT_GLOBAL cadt_u32* neighbors, cadt_u32 first, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
    const cadt_triangle triangle =
        cadt_in_input_ids(input_ids, cadt_word_of_three(vertices, t, 0u), cadt_word_of_three(vertices, t, 1u),
                          cadt_word_of_three(vertices, t, 2u));
    cadt_u32 n0 = CADT_NONE, n1 = CADT_NONE, n2 = CADT_NONE;
    if (neighbors) { /* else the half-edges may be gone already */
      n0 = cadt_number_across(numbers, cadt_word_of_three(half_edges, t, 0u), count);
      n1 = cadt_number_across(numbers, cadt_word_of_three(half_edges, t, 1u), count);
      n2 = cadt_number_across(numbers, cadt_word_of_three(half_edges, t, 2u), count);
    }
    cadt_write_triangle(triangle, first + (numbers ? numbers[t] : t), n0, n1, n2, triangles, neighbors);
  }
}

/* Moves the triangles of a finished array to their places in three steps, one for each word `k` of a triangle, by way
 * of `moved`. It takes more time than a second array and a third of its memory. `neighbors`: the words are triangles.
 */
CADT_KERNEL(cadt_move_words, CADT_GLOBAL const cadt_u32* words, CADT_GLOBAL const cadt_u32* numbers, cadt_u32 k,
            cadt_u32 neighbors, CADT_GLOBAL cadt_u32* moved, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
    const cadt_u32 value = cadt_word_of_three(words, t, k);
    moved[numbers[t]] = neighbors && value != CADT_NONE ? numbers[value] : value;
  }
}

CADT_KERNEL(cadt_put_words, CADT_GLOBAL const cadt_u32* moved, CADT_GLOBAL cadt_u32* words, cadt_u32 k, cadt_u32 count,
            cadt_u32 grain) {
  CADT_FOR(t, count, grain) { words[3u * t + k] = moved[t]; }
}

#endif
