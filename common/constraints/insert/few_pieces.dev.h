/* SPDX-License-Identifier: Apache-2.0
 *
 * Few short pieces, all steps of segment_rings.dev.h and segment_cavity.dev.h in one launch. Where pieces lie side by
 * side, as along a coast, half of them have to wait at each turn. The last turns have next to nothing to do, and a
 * dozen launches each would take longer than their work. So one team takes all turns, with barriers for launches:
 *
 *     +--> find  |  claim  |  decide  |  settle  |  fill  |  link  |  give up claims --+
 *     |                         barriers of the team                                   |
 *     +--------------------------- pieces that have to wait <--------------------------+
 */
#ifndef CADT_CONSTRAINTS_FEW_PIECES_H
#define CADT_CONSTRAINTS_FEW_PIECES_H

#include "common/constraints/insert/segment_cavity.dev.h"

enum {
  CADT_FEW_PIECES = 1024,                /* at most, */
  CADT_FEW_TRIANGLES = CADT_CHAIN_LONG,  /* short: that cross no more triangles; one work-item fills their chains, */
  CADT_FEW_PLACES = CADT_CHAIN_LONG + 4, /* and this is room for their rings */
  CADT_FEW_TURNS = 256,                  /* of a launch, at most */
  CADT_FEW_LANES = 512
};

/* Finds piece s between vertices a and b. Its size is 0 if it is an edge, CADT_NONE if it is not short, or if a vertex
 * lies on it, which nobody has seen yet on one that has been too long for a walk. */
CADT_FN void cadt_find_short_piece(const cadt_segment_mesh* m, const cadt_pieces* pieces, cadt_u32 s, cadt_u32 a,
                                   cadt_u32 b, CADT_GLOBAL cadt_u32* words, cadt_counters* counters) {
  const cadt_segment_step step = cadt_next_step(m, a, b, counters);
  const cadt_u32 from = step.from_b ? b : a, to = step.from_b ? a : b;
  pieces->sizes[s] = CADT_NONE;
  if (step.kind == CADT_STEP_ENTER) {
    cadt_crossed at = {step.half_edge, CADT_NONE, CADT_NONE, 1};
    cadt_u32 triangles = 1u, left = 1u;
    const cadt_u32 whole =
        cadt_walk_piece(m, &at, cadt_load_point(m->points + from), to, cadt_load_point(m->points + to),
                        CADT_FEW_TRIANGLES, &triangles, &left, counters);
    if (whole && at.apex == to) cadt_put_piece(pieces, s, from, to, step.half_edge, 1u, triangles, left);
  } else if (step.kind == CADT_STEP_NOWHERE) {
    cadt_add_relaxed(words + CADT_SEGMENTS_BROKEN, 1u);
  } else if (step.vertex == to) {
    cadt_flag_edge(m, step.half_edge);
    pieces->sizes[s] = 0u;
  }
}

/* Inserts the `count` pieces between the vertices of `pairs`, as far as they are short. Those that are left are in
 * `pairs` again, and counted; so is how often a short one had to wait. `others`: room for as many pairs. A piece that
 * crosses a constrained edge ends it. \pre claims are CADT_NONE; there is room for CADT_FEW_PLACES a piece */
CADT_TEAM_KERNEL(CADT_FEW_LANES, 1, cadt_insert_few_pieces, CADT_SEGMENT_MESH_PARAMETERS, CADT_PIECES_PARAMETERS,
                 CADT_RINGS_PARAMETERS, cadt_u32 count, CADT_GLOBAL cadt_u32* pairs, CADT_GLOBAL cadt_u32* others,
                 CADT_GLOBAL cadt_u32* claims, CADT_GLOBAL cadt_u32* wins, CADT_GLOBAL cadt_u32* bases,
                 CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_PIECES(pieces);
  CADT_RINGS(rings);
  CADT_DECLARE_COUNTERS(counters);
  CADT_TEAM_MEMORY cadt_u32 places[1], won[1], waited[1];
  CADT_FOR_TEAMS(team, 1u, 1u) {
    CADT_GLOBAL cadt_u32* now = pairs;
    CADT_GLOBAL cadt_u32* next = others;
    cadt_u32 over = 0u;
    if (cadt_team_lane == 0u) waited[0] = 0u;
    for (cadt_u32 turn = 0u; !over && count && turn < CADT_CAST(cadt_u32, CADT_FEW_TURNS); ++turn) {
      if (cadt_team_lane == 0u) places[0] = won[0] = words[CADT_SEGMENTS_LEFT] = 0u;
      CADT_TEAM_SYNC_ALL();
      CADT_TEAM_FOR(s, count) {
        cadt_find_short_piece(&mesh, &pieces, s, now[2u * s], now[2u * s + 1u], words, &counters);
        const cadt_u32 size = pieces.sizes[s] == CADT_NONE ? 0u : pieces.sizes[s];
        pieces.begins[s] = cadt_team_add(places, size);
        bases[s] = CADT_NONE;
        wins[s] = cadt_has_ring(&pieces, &rings, s);
      }
      CADT_TEAM_SYNC_ALL(); /* whoever crosses what has just become an edge sees its flag */
      CADT_TEAM_FOR(s, count) {
        if (wins[s]) cadt_claim_cavity(&mesh, &pieces, &rings, s, claims, words, &counters);
      }
      CADT_TEAM_SYNC_ALL();
      const cadt_u32 all = places[0];
      CADT_TEAM_FOR(x, all) { cadt_decide_place(&mesh, &rings, x, claims, wins); }
      CADT_TEAM_SYNC_ALL();
      CADT_TEAM_FOR(x, all) { cadt_settle_place(&rings, x, claims, wins); }
      CADT_TEAM_SYNC_ALL();
      CADT_TEAM_FOR(s, count) {
        if (wins[s]) {
          cadt_chain sides[2];
          cadt_chains_of_piece(&pieces, s, sides);
          cadt_team_add(won, 1u);
          for (cadt_u32 k = 0u; k < 2u; ++k)
            if (sides[k].high - sides[k].low > 1u) cadt_fill_chain(&mesh, &rings, sides[k], bases, words, &counters);
        } else if (pieces.sizes[s]) {
          if (pieces.sizes[s] != CADT_NONE) cadt_team_add(waited, 1u);
          cadt_keep_piece(now, s, next, words);
        }
      }
      CADT_TEAM_SYNC_ALL();
      CADT_TEAM_FOR(x, all) { cadt_link_place(&mesh, &rings, x, claims); }
      CADT_TEAM_SYNC_ALL();
      CADT_TEAM_FOR(x, all) { cadt_release_place(ring_triangle, x, claims); }
      count = cadt_load_relaxed(words + CADT_SEGMENTS_LEFT);
      over =
          !won[0] || cadt_load_relaxed(words + CADT_SEGMENTS_CROSSED) || cadt_load_relaxed(words + CADT_SEGMENTS_BROKEN)
              ? 1u
              : 0u;
      CADT_GLOBAL cadt_u32* const before = now;
      now = next;
      next = before;
      CADT_TEAM_SYNC_ALL();
    }
    if (now != pairs) {
      CADT_TEAM_FOR(i, 2u * count) { pairs[i] = now[i]; }
    }
    if (cadt_team_lane == 0u) words[CADT_SEGMENTS_RETRIES] = waited[0];
  }
}

#endif
