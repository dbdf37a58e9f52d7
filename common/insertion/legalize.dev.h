/* SPDX-License-Identifier: Apache-2.0
 *
 * Legalisation: the edges that a work-item has yet to test, and the flips that follow from them (paper, section 4.4).
 * What is not done within a work limit, or gets no lock, goes on a list for the next launch.
 */
#ifndef CADT_INSERTION_LEGALIZE_H
#define CADT_INSERTION_LEGALIZE_H

#include "common/insertion/flip.dev.h"

enum {
  CADT_WORKLIST = 64,       /* edges that a work-item can have pending, a power of two */
  CADT_WORKLIST_STACK = 48, /* with more, the oldest is next: a flip cascade leaves a legal edge behind at each flip */
  CADT_EDGE_TRIES = 24,     /* lock failures in the worklist of one point */
/* Flips for one point or edge in one launch. So a launch ends in bounded time, and a long flip cascade, slow work for
 * one lane of a GPU, is shared with others as soon as it forks. */
#if CADT_CONTIGUOUS
  CADT_FLIP_LIMIT = 1 << 14,
  CADT_EDGE_FLIP_LIMIT = CADT_FLIP_LIMIT
#else
  CADT_FLIP_LIMIT = 64,
  CADT_EDGE_FLIP_LIMIT = 16
#endif
};

/* Where deferred edges go. An edge that finds the list full is dropped: the legality sweep will meet it. */
typedef struct {
  CADT_GLOBAL cadt_u32* edges;
  CADT_GLOBAL cadt_u32* counts; /* points, edges, work-items that changed the mesh */
  cadt_u32 edge_capacity;
} cadt_deferred;

CADT_FN void cadt_defer_edge(const cadt_deferred* deferred, cadt_u32 half_edge, cadt_counters* counters) {
  cadt_u32 at = cadt_add_relaxed(deferred->counts + 1, 1u);
  if (at < deferred->edge_capacity) deferred->edges[at] = half_edge;
  CADT_COUNT_NOW(counters, CADT_COUNT_DEFERRED_EDGES);
}

/* Tells the driver that this work-item made progress. Only in launches of deferred points and edges alone: in those of
 * a level it would be one more addition to the same address for each point. */
CADT_FN void cadt_report_changes(const cadt_counters* counters, CADT_GLOBAL cadt_u32* counts) {
  if (counters->count[CADT_COUNT_SPLITS] | counters->count[CADT_COUNT_EDGE_SPLITS] | counters->count[CADT_COUNT_FLIPS])
    cadt_add_relaxed(counts + 2, 1u);
}

/* Edges that a work-item has yet to test: `next`, if there is one, then those in a ring from `first` on, the newest
 * before others, so that a fan of flips stays small. `apex` is the inserted vertex: then, if nobody else works close
 * by, only edges opposite of it can become illegal by its flips (paper, Algorithm 3); CADT_NONE: any edge, and a flip
 * adds all four sides, as all flips do on GPUs (docs/insertion.md, "Legalization"). */
typedef struct {
  cadt_u32* half_edge; /* the ring, of CADT_WORKLIST */
  cadt_u32 next, first, size, apex;
  cadt_point apex_point;
  cadt_u32 flips; /* flips still allowed, plus one; at 0 what becomes illegal is deferred */
  cadt_u32 conflicts;
} cadt_worklist;

/* The ring is no member: a struct with an array that is indexed at run time lies in memory as a whole, and on a GPU
 * each store to it goes on to the L2 cache. */
#define CADT_DECLARE_WORKLIST(work)       \
  cadt_u32 ring_of_##work[CADT_WORKLIST]; \
  cadt_worklist work;                     \
  work.half_edge = ring_of_##work

CADT_FN void cadt_worklist_begin(cadt_worklist* work, cadt_u32 apex, cadt_u32 flips) {
  work->next = CADT_NONE;
  work->first = work->size = work->conflicts = 0u;
  work->apex = apex;
  work->apex_point.x = work->apex_point.y = 0.0;
  work->flips = flips;
}

CADT_FN cadt_u32 cadt_worklist_pending(const cadt_worklist* work) {
  return work->next != CADT_NONE || work->size > 0u ? 1u : 0u;
}

CADT_FN void cadt_worklist_add(cadt_worklist* work, cadt_u32 half_edge) {
  work->half_edge[(work->first + work->size++) & (CADT_WORKLIST - 1u)] = half_edge;
}

CADT_FN cadt_u32 cadt_worklist_take(cadt_worklist* work) {
  const cadt_u32 oldest = work->size > CADT_CAST(cadt_u32, CADT_WORKLIST_STACK) ? 1u : 0u;
  cadt_u32 half_edge = work->next;
  if (half_edge != CADT_NONE && !oldest) {
    work->next = CADT_NONE;
    return half_edge;
  }
  half_edge = work->half_edge[(oldest ? work->first : work->first + work->size - 1u) & (CADT_WORKLIST - 1u)];
  work->size--;
  work->first += oldest;
  return half_edge;
}

/* Tests one edge of the worklist and flips it if it is illegal; the edges that this may have made illegal join the
 * list. \pre there is one */
CADT_FN void cadt_legalize_next(const cadt_locked_mesh* m, cadt_worklist* work, const cadt_deferred* deferred,
                                cadt_counters* counters) {
  const cadt_u32 mask = CADT_WORKLIST - 1u;
  cadt_u32 partner = 0u, all_sides = 0u;
  CADT_ADD_WAIT_TIME(counters);
  CADT_NOISE_AT(m, CADT_SITE_TAKE_EDGE);
  const cadt_u32 half_edge = cadt_worklist_take(work);
  CADT_ADD_TIME(counters, CADT_TIME_OTHER);
  const cadt_u32 outcome =
      cadt_flip_if_illegal(m, half_edge, work->apex, work->apex_point, &partner, &all_sides, counters);
  if (outcome == CADT_EDGE_CONFLICT) {
    if (++work->conflicts > CADT_CAST(cadt_u32, CADT_EDGE_TRIES)) {
      CADT_NOISE_AT(m, CADT_SITE_PUSH_EDGE);
      cadt_defer_edge(deferred, half_edge, counters);
    } else { /* to the far end: the other edges come first, and the owner of the lock can finish */
      work->first--;
      work->half_edge[work->first & mask] = half_edge;
      work->size++;
    }
  } else if (outcome == CADT_EDGE_FLIPPED) {
    cadt_u32 sides[4];
    sides[0] = partner;
    sides[1] = CADT_HALF_EDGE(CADT_TRIANGLE_OF(half_edge), CADT_PREV(CADT_EDGE_OF(half_edge)));
    sides[2] = CADT_HALF_EDGE(CADT_TRIANGLE_OF(partner), CADT_NEXT(CADT_EDGE_OF(partner)));
    if (work->flips) work->flips--;
    const cadt_u32 room = work->flips ? CADT_CAST(cadt_u32, CADT_WORKLIST) - 2u : 0u;
    for (cadt_u32 e = 0u; e < (all_sides ? 3u : 1u); ++e) {
      if (work->size < room)
        cadt_worklist_add(work, sides[e]);
      else
        cadt_defer_edge(deferred, sides[e], counters);
      CADT_NOISE_AT(m, CADT_SITE_PUSH_EDGE);
    }
    if (!work->flips)
      cadt_defer_edge(deferred, half_edge, counters);
    else if (work->next == CADT_NONE)
      work->next = half_edge;
    else if (work->size < room)
      cadt_worklist_add(work, half_edge);
    else
      cadt_defer_edge(deferred, half_edge, counters);
  }
  CADT_ADD_TIME(counters, CADT_TIME_OTHER);
}

/* Legalises the edges of the worklist and whatever becomes illegal by the flips. */
CADT_FN void cadt_legalize(const cadt_locked_mesh* m, cadt_worklist* work, const cadt_deferred* deferred,
                           cadt_counters* counters) {
  while (cadt_worklist_pending(work)) cadt_legalize_next(m, work, deferred, counters);
}

#if CADT_BUILDS(INSERTION)
/* Legalises edges that earlier launches deferred. */
CADT_KERNEL(cadt_legalize_edges, CADT_LOCKED_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* list, cadt_u32 count,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* deferred_edges, CADT_GLOBAL cadt_u32* deferred_counts,
            cadt_u32 edge_capacity, CADT_GLOBAL cadt_u32* counter_rows) {
  CADT_GROUP_COUNTERS(counters, counter_rows);
  CADT_LOST_LOCKS_BEGIN(counters, counter_rows);
  CADT_LOCKED_MESH(mesh);
  const cadt_deferred deferred = {deferred_edges, deferred_counts, edge_capacity};
  CADT_DECLARE_WORKLIST(work);
  const cadt_u32 warp = cadt_lanes_of_warp();
  cadt_u32 e = CADT_SPREAD_BEGIN(count, grain);
  cadt_worklist_begin(&work, CADT_NONE, 0u);
  for (;;) {
    if (!cadt_worklist_pending(&work) && e < CADT_SPREAD_END(count, grain)) {
      cadt_worklist_begin(&work, CADT_NONE, CADT_EDGE_FLIP_LIMIT);
      work.next = list[e];
      e += CADT_SPREAD_STEP(grain);
    }
    if (!cadt_any_lane(warp, cadt_worklist_pending(&work))) break;
    if (cadt_worklist_pending(&work)) cadt_legalize_next(&mesh, &work, &deferred, &counters);
    cadt_sync_lanes(warp);
  }
  cadt_report_changes(&counters, deferred_counts);
  CADT_FLUSH_COUNTERS(&counters, counter_rows);
}
#endif

#endif
