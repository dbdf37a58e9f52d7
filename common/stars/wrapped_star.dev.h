/* SPDX-License-Identifier: Apache-2.0
 *
 * Where the kernels of gift wrapping (wrap_fast.dev.h, wrap_exact.dev.h) store a star: sizes[v] words of star_vertices
 * from begins[v] on, with CADT_GHOST behind the last star vertex on the hull. The driver has set begins[v] for stars of
 * at most `row` words; longer ones stand behind the rows. `counts`: CADT_WRAP_... (layout.dev.h).
 */
#ifndef CADT_STARS_WRAPPED_STAR_H
#define CADT_STARS_WRAPPED_STAR_H

#include "common/stars/aabb_tree.dev.h"

/* The head of a partial star, which a vertex has until its star is found: twice the number of star vertices, less than
 * CADT_WRAP_ROW, plus 1 if they go all the way round; and a bit if the triangle of star vertex k and the next one is
 * proven. */
#define CADT_WRAP_HEAD_SIZE 63u
#define CADT_WRAP_HEAD_PROVEN(k) (64u << (k))
/* In the memory of a team: the same bit, with the number of star vertex k. */
#define CADT_WRAP_PROVEN 0x80000000u

typedef struct {
  cadt_u32 n, row, star_words;
  CADT_GLOBAL cadt_u32* star_vertices;
  CADT_GLOBAL cadt_u32* begins;
  CADT_GLOBAL cadt_u32* sizes;
  CADT_GLOBAL cadt_u32* counts;
} cadt_wrap_sink;

/* Stores the star of v: `size` star vertices, counterclockwise or clockwise, by their numbers in a span that begins at
 * `first`. Kind 0: there is none; 1: v is an inner vertex; 2: v is on the hull. All lanes call it; there is a barrier
 * before it writes *place. */
CADT_FN void cadt_wrap_store(const cadt_wrap_sink* s, CADT_TEAM_PTR cadt_u32* place, cadt_u32 v, cadt_u32 first,
                             CADT_TEAM_PTR const cadt_u32* star, cadt_u32 size, cadt_u32 counterclockwise,
                             cadt_u32 kind) {
  const cadt_u32 words = kind == 2u ? size + 1u : size;
  CADT_TEAM_SYNC();
  if (cadt_team_lane == 0u && kind) {
    *place = words <= s->row ? s->begins[v] : s->n * s->row + cadt_add_relaxed(s->counts + CADT_WRAP_OVERFLOWED, words);
    s->begins[v] = *place;
    s->sizes[v] = words;
  }
  CADT_TEAM_SYNC();
  if (kind &&
      *place + words <= s->star_words) { /* else the driver sees from CADT_WRAP_OVERFLOWED that stars are wrong */
    CADT_GLOBAL cadt_u32* out = s->star_vertices + *place;
    CADT_TEAM_FOR(k, size) { out[k] = first + star[counterclockwise ? k : size - 1u - k]; }
    if (cadt_team_lane == 0u && kind == 2u) out[size] = CADT_GHOST;
  }
  CADT_TEAM_SYNC();
}

#endif
