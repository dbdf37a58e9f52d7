/* SPDX-License-Identifier: Apache-2.0
 *
 * Triangles of three vertices without stars, which no star tells of: of three hubs, or of two and the ghost. They fill
 * gaps whose edges are known from the other side. All three hubs are Delaunay neighbours, so the triangle behind an
 * edge is the one that it has in the Delaunay triangulation of the hubs alone: a step of gift wrapping among few points
 * (docs/algorithm.md, "Gift wrapping").
 */
#ifndef CADT_DEVICE_WRAP_HUBS_H
#define CADT_DEVICE_WRAP_HUBS_H

#include "common/device/wrap_store.h"

typedef struct {
  cadt_u32 from[CADT_WRAP_EDGES], to[CADT_WRAP_EDGES]; /* half-edges whose triangle is known */
  cadt_u32 hubs[CADT_WRAP_HUBS], best[CADT_WRAP_HUBS];
  cadt_u32 hub_count;
  cadt_steps steps;
} cadt_hub_memory;

CADT_FN cadt_u32 cadt_hub_knows(CADT_TEAM_PTR const cadt_hub_memory* m, cadt_u32 count, cadt_u32 from, cadt_u32 to) {
  for (cadt_u32 e = 0u; e < count; ++e)
    if (m->from[e] == from && m->to[e] == to) return 1u;
  return 0u;
}

/* The first half-edge whose other side is not known, CADT_NONE if there is none; those to the ghost only if asked for:
 * they need no search, since the edges of the hull lead to all of its triangles. */
CADT_FN cadt_u32 cadt_hub_open(CADT_TEAM_PTR cadt_hub_memory* m, cadt_u32* step, cadt_u32 count, cadt_u32 ghosts) {
  cadt_u32 first = CADT_NONE, unused;
  CADT_TEAM_FOR(e, count) {
    if (!ghosts && (m->from[e] == CADT_GHOST || m->to[e] == CADT_GHOST)) continue;
    if (!cadt_hub_knows(m, count, m->to[e], m->from[e])) first = cadt_min_u32(first, e);
  }
  return cadt_end_step(&m->steps, step, first, &unused);
}

/* The hub to the left of the edge from a to b whose circle with both has no other in it; the ghost if there is none. */
CADT_FN cadt_u32 cadt_hub_behind(CADT_TEAM_PTR cadt_hub_memory* m, CADT_GLOBAL const cadt_point* points, cadt_u32 a,
                                 cadt_u32 b, cadt_tally* tally) {
  CADT_TEAM_FOR(k, m->hub_count) {
    const cadt_u32 c = m->hubs[k];
    const cadt_u32 left = c != a && c != b && cadt_orientation(points[a], points[b], points[c], tally) > 0 ? 1u : 0u;
    m->best[k] = left ? c : CADT_GHOST;
  }
  CADT_TEAM_SYNC();
  for (cadt_u32 width = m->hub_count; width > 1u;) {
    const cadt_u32 middle = (width + 1u) / 2u;
    CADT_TEAM_FOR(k, width - middle) {
      const cadt_u32 one = m->best[k], other = m->best[k + middle];
      if (one == CADT_GHOST)
        m->best[k] = other;
      else if (other != CADT_GHOST)
        m->best[k] = cadt_wrap_better_of(points, a, b, 1, one, other, tally);
    }
    width = middle;
    CADT_TEAM_SYNC();
  }
  const cadt_u32 best = m->best[0];
  CADT_TEAM_SYNC();
  return best;
}

/* Fills the gaps between `count` half-edges with `wanted` triangles, three half-edges more for each. Returns how many
 * half-edges there are then; CADT_NONE if that does not fill all gaps. */
CADT_FN cadt_u32 cadt_hub_triangles(CADT_TEAM_PTR cadt_hub_memory* m, CADT_GLOBAL const cadt_point* points,
                                    cadt_u32 count, cadt_u32 wanted, CADT_GLOBAL cadt_wrap_edge* edges,
                                    cadt_tally* tally) {
  cadt_u32 made = 0u, step = 0u, open = cadt_hub_open(m, &step, count, 0u);
  while (open != CADT_NONE && made < wanted && count + 3u <= CADT_CAST(cadt_u32, CADT_WRAP_EDGES)) {
    const cadt_u32 a = m->to[open], b = m->from[open], c = cadt_hub_behind(m, points, a, b, tally);
    CADT_TEAM_FOR(k, 3u) {
      const cadt_u32 from = CADT_PICK(k, a, b, c), to = CADT_PICK(k, b, c, a);
      m->from[count + k] = edges[count + k].from = from;
      m->to[count + k] = edges[count + k].to = to;
      edges[count + k].left = CADT_PICK(k, c, a, b);
    }
    CADT_TEAM_SYNC();
    count += 3u;
    ++made;
    open = cadt_hub_open(m, &step, count, 0u);
  }
  return cadt_hub_open(m, &step, count, 1u) == CADT_NONE && made == wanted ? count : CADT_NONE;
}

/* edges: the found[6] half-edges that are known; behind them come those of the `wanted` triangles, and found[6] is what
 * cadt_hub_triangles returns. \pre at most CADT_WRAP_HUBS sizes are 0, at most CADT_WRAP_EDGES half-edges */
CADT_TEAM_KERNEL(64, 1, cadt_wrap_hubs, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* sizes,
                 cadt_u32 n, cadt_u32 wanted, CADT_GLOBAL cadt_wrap_edge* edges, CADT_GLOBAL cadt_u32* found) {
  CADT_TEAM_MEMORY cadt_hub_memory memory;
  cadt_tally tally;
  cadt_tally_clear(&tally);
  CADT_FOR_TEAMS(team, 1u, 1u) { /* groups may be smaller than was asked for, and then there are several */
    const cadt_u32 count = found[6];
    cadt_begin_steps(&memory.steps);
    if (cadt_team_lane == 0u) memory.hub_count = 0u;
    CADT_TEAM_FOR(e, count) {
      memory.from[e] = edges[e].from;
      memory.to[e] = edges[e].to;
    }
    CADT_TEAM_SYNC();
    CADT_TEAM_FOR(v, n) {
      if (sizes[v] == 0u) memory.hubs[cadt_team_add(&memory.hub_count, 1u)] = v;
    }
    CADT_TEAM_SYNC();
    const cadt_u32 all = cadt_hub_triangles(&memory, points, count, wanted, edges, &tally);
    if (cadt_team_lane == 0u) found[6] = all;
  }
  cadt_wrap_pass_on(&tally, found);
}

#endif
