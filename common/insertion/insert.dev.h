/* SPDX-License-Identifier: Apache-2.0
 *
 * Insertion and legalisation in one flow, without a barrier between them (paper, section 4.4, "unified execution
 * flow"). What could not get its locks in a bounded number of tries goes on a list for the next launch.
 */
#ifndef CADT_INSERTION_INSERT_H
#define CADT_INSERTION_INSERT_H

#include "common/insertion/split_and_flip.dev.h"

enum {
  CADT_WORKLIST = 64,       /* edges a work-item can have pending, a power of two */
  CADT_WORKLIST_STACK = 48, /* above, the oldest is next: a long row of flips leaves a legal edge behind at each one */
  CADT_INSERT_TRIES = 12,   /* walks for one point in one launch */
  CADT_EDGE_TRIES = 24,     /* conflicts in the worklist of one point */
/* Flips for one point or edge in one launch: a launch ends in bounded time, and a long row of flips, which a lane of a
 * GPU alone does slowly, is shared with others as soon as it forks. */
#if CADT_CONTIGUOUS
  CADT_FLIP_LIMIT = 1 << 14,
  CADT_EDGE_FLIP_LIMIT = CADT_FLIP_LIMIT
#else
  CADT_FLIP_LIMIT = 64,
  CADT_EDGE_FLIP_LIMIT = 16
#endif
};

/* Where edges go that are left for the next launch. An edge that finds its list full is dropped: the closing pass will
 * meet it. */
typedef struct {
  CADT_GLOBAL cadt_u32* edges;
  CADT_GLOBAL cadt_u32* counts; /* points, edges, work-items that changed the mesh */
  cadt_u32 edge_capacity;
} cadt_deferred;

CADT_FN cadt_deferred cadt_lists(CADT_GLOBAL cadt_u32* edges, CADT_GLOBAL cadt_u32* counts, cadt_u32 edge_capacity) {
  cadt_deferred lists;
  lists.edges = edges;
  lists.counts = counts;
  lists.edge_capacity = edge_capacity;
  return lists;
}

CADT_FN void cadt_defer_edge(const cadt_deferred* deferred, cadt_u32 half_edge, cadt_counters* counters) {
  cadt_u32 at = cadt_add_relaxed(deferred->counts + 1, 1u);
  if (at < deferred->edge_capacity) deferred->edges[at] = half_edge;
  CADT_COUNT_NOW(counters, CADT_COUNT_DEFERRED_EDGES);
}

/* Tells the driver that this work-item got on. For launches of what others left over only: in those of a level it would
 * be one more addition to one address for each point. */
CADT_FN void cadt_report_changes(const cadt_counters* counters, CADT_GLOBAL cadt_u32* counts) {
  if (counters->count[CADT_COUNT_SPLITS] | counters->count[CADT_COUNT_EDGE_SPLITS] | counters->count[CADT_COUNT_FLIPS])
    cadt_add_relaxed(counts + 2, 1u);
}

/* Edges that a work-item has yet to look at: `next`, if there is one, then those in a ring from `first` on, the newest
 * before others, so that a fan of flips stays small. `apex` is the inserted vertex: then only edges opposite of it can
 * become illegal by its flips (paper, Algorithm 3); CADT_NONE: any edge, all four sides are checked. */
typedef struct {
  cadt_u32* half_edge; /* the ring, CADT_WORKLIST of them */
  cadt_u32 next, first, size, apex;
  cadt_point apex_point;
  cadt_u32 flips; /* flips left, and one; after them what becomes illegal is left for the next launch */
  cadt_u32 conflicts;
} cadt_worklist;

/* The ring apart from the rest: a struct with an array that is indexed at run time is in memory as a whole, and on a
 * GPU each store to it goes on to the L2 cache. */
#define CADT_WORKLIST_HERE(work)          \
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

CADT_FN cadt_u32 cadt_worklist_left(const cadt_worklist* work) {
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

/* Looks at one edge of the worklist and flips it if it is illegal; then what may be illegal by that goes on the list.
 * \pre there is one */
CADT_FN void cadt_legalize_next(const cadt_locked_mesh* m, cadt_worklist* work, const cadt_deferred* deferred,
                                cadt_counters* counters) {
  const cadt_u32 mask = CADT_WORKLIST - 1u;
  cadt_u32 partner = 0u, all_sides = 0u;
  CADT_LAP_WAIT(counters);
  CADT_NOISE_AT(m, CADT_AT_TAKE);
  const cadt_u32 half_edge = cadt_worklist_take(work);
  CADT_LAP(counters, CADT_TIME_OTHER);
  const cadt_u32 outcome =
      cadt_legalize_edge(m, half_edge, work->apex, work->apex_point, &partner, &all_sides, counters);
  if (outcome == CADT_EDGE_CONFLICT) {
    if (++work->conflicts > CADT_CAST(cadt_u32, CADT_EDGE_TRIES)) {
      CADT_NOISE_AT(m, CADT_AT_PUSH_EDGE);
      cadt_defer_edge(deferred, half_edge, counters);
    } else { /* to the far end: the other edges first, meanwhile the owner gets on */
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
      CADT_NOISE_AT(m, CADT_AT_PUSH_EDGE);
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
  CADT_LAP(counters, CADT_TIME_OTHER);
}

/* Legalises the edges of the worklist and whatever becomes illegal by the flips. */
CADT_FN void cadt_legalize(const cadt_locked_mesh* m, cadt_worklist* work, const cadt_deferred* deferred,
                           cadt_counters* counters) {
  while (cadt_worklist_left(work)) cadt_legalize_next(m, work, deferred, counters);
}

/* Walks from `*hint` and inserts vertex i where the walk ends. Returns the number of `edges` opposite of it; 0 if that
 * is to be tried again, from the new `*hint`. */
CADT_FN cadt_u32 cadt_try_vertex(const cadt_locked_mesh* m, cadt_u32 i, cadt_point p, cadt_u32* hint, cadt_u32* edges,
                                 cadt_counters* counters) {
  cadt_place place = {CADT_LOST, *hint, 0u, {0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u}};
  cadt_u32 size = 0u;
  CADT_LAP(counters, CADT_TIME_OTHER);
  CADT_NOISE_AT(m, CADT_AT_START);
  cadt_locate(m, p, *hint, &place, counters);
  CADT_LAP(counters, CADT_TIME_LOCATE);
  if (place.kind != CADT_LOST)
    size = place.kind == CADT_IN_FACE ? cadt_split_face(m, i, &place, edges, counters)
                                      : cadt_split_edge(m, i, &place, edges, counters);
  *hint = place.triangle;
  return size;
}

/* Block b of level l holds the positions from b * 2^l on, 2^l of them. One of them stands for the block: that of one of
 * its two halves, chosen by a hash. (Always the left one would do for most sets; but where every other point in sorted
 * order is of another kind, two lines for instance, the last level would insert all of one kind into a mesh of the
 * other, with n / 8 flips a point.) Eight neighbouring blocks share their choice: evenly spaced points need fewer
 * flips. */
CADT_FN cadt_u32 cadt_right_half(cadt_u32 level, cadt_u32 block) {
  cadt_u32 x = (block >> 3) * 2654435761u + level * 0x9E3779B9u;
  x ^= x >> 15;
  x *= 0x85EBCA6Bu;
  return (x >> 16) & 1u;
}
CADT_FN cadt_u32 cadt_representative(cadt_u32 level, cadt_u32 block, cadt_u32 n) {
  while (level > 0u) {
    const cadt_u32 right = cadt_right_half(level, block);
    --level;
    block = 2u * block + right;
    /* the last block may have no right half */
    if (right && (CADT_CAST(cadt_u64, block) << level) >= n) --block;
  }
  return block;
}

/* On GPUs the points are in the order in which they are inserted, level after level, each along the curve: what is in
 * the mesh when few are is close together, and lines of the cache are full of it. In this order, the place of the point
 * that stands for `block` of `level`: it is inserted at the first level from there on at which its block does not stand
 * for the two. */
CADT_FN cadt_u32 cadt_blocks_of(cadt_u32 level, cadt_u32 n) { return ((n - 1u) >> level) + 1u; }
CADT_FN cadt_u32 cadt_rank_of(cadt_u32 level, cadt_u32 block, cadt_u32 n) {
  for (;; ++level, block >>= 1) {
    const cadt_u32 blocks = cadt_blocks_of(level, n);
    if (blocks == 1u) return 0u;
    const cadt_u32 right = (block | 1u) < blocks ? cadt_right_half(level + 1u, block >> 1) : 0u;
    if ((block & 1u) != right) return cadt_blocks_of(level + 1u, n) + (block >> 1);
  }
}

/* Points and labels in that order. */
CADT_KERNEL(cadt_by_level, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* input_ids, cadt_u32 n,
            cadt_u32 grain, CADT_GLOBAL cadt_point* sorted_points, CADT_GLOBAL cadt_u32* sorted_input_ids) {
  CADT_FOR(i, n, grain) {
    const cadt_u32 rank = cadt_rank_of(0u, i, n);
    sorted_points[rank] = points[i];
    sorted_input_ids[rank] = input_ids[i];
  }
}

/* Position of the point that stands for all: the first of the mesh. */
CADT_KERNEL(cadt_first_representative, cadt_u32 n, cadt_u32 levels, CADT_GLOBAL cadt_u32* position) {
  if (cadt_item == 0u) *position = cadt_representative(levels, 0u, n);
}

#if CADT_CONTIGUOUS
/* The hint of a point that an earlier launch left over: its own, or if it has none yet that of the point from which it
 * would have been inserted in its turn. */
CADT_FN cadt_u32 cadt_start_of_deferred(const cadt_locked_mesh* m, cadt_u32 i, cadt_u32 n) {
  cadt_u32 hint = cadt_load_relaxed(m->vertex_to_triangle + i);
  for (cadt_u32 level = 0u; hint == CADT_NONE; ++level)
    hint = cadt_load_relaxed(m->vertex_to_triangle + cadt_representative(level + 1u, i >> (level + 1u), n));
  return hint;
}
#endif

/* Inserts `count` points: first `listed` ones that earlier launches left over, with their own hints; then one level: of
 * each block of 2^(level+1) positions, from block `begin` on, the half that does not stand for it, with a walk from the
 * point that does, which is in the mesh and near in sorted order. */
CADT_KERNEL(cadt_insert, CADT_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* list, cadt_u32 listed, cadt_u32 begin,
            cadt_u32 count, cadt_u32 n, cadt_u32 level, cadt_u32 grain, CADT_GLOBAL cadt_u32* deferred_points,
            CADT_GLOBAL cadt_u32* deferred_edges, CADT_GLOBAL cadt_u32* deferred_counts, cadt_u32 edge_capacity,
            CADT_GLOBAL cadt_u32* counter_rows) {
  CADT_GROUP_COUNTERS(counters, counter_rows);
  CADT_MESH_VIEW(mesh);
  const cadt_deferred deferred = cadt_lists(deferred_edges, deferred_counts, edge_capacity);
  CADT_WORKLIST_HERE(work);
  const cadt_u32 warp = cadt_lanes_of_warp();
  cadt_u32 u = CADT_SPREAD_BEGIN(count, grain), i = CADT_NONE, hint = 0u, tries = 0u;
  cadt_worklist_begin(&work, CADT_NONE, 0u);
  /* Lanes of a warp stay together, so that memory is waited for once for all of them; when the last one has no edge
   * left, all have their next points. */
  for (;;) {
    if (!cadt_any_lane(warp, cadt_worklist_left(&work))) {
      const cadt_u32 idle = i != CADT_NONE || u < CADT_SPREAD_END(count, grain) ? 1u : 0u;
      if (!cadt_any_lane(warp, idle)) break;
      if (idle) {
        if (i == CADT_NONE) {
          if (u < listed) {
            i = list[u];
#if CADT_CONTIGUOUS
            hint = cadt_start_of_deferred(&mesh, i, n);
#else
            hint = cadt_load_relaxed(mesh.vertex_to_triangle + i);
#endif
          } else {
            const cadt_u32 block = begin + (u - listed);
#if CADT_CONTIGUOUS
            const cadt_u32 standing = 2u * block + cadt_right_half(level + 1u, block);
            i = cadt_representative(level, standing ^ 1u, n);
            hint = cadt_load_relaxed(mesh.vertex_to_triangle + cadt_representative(level, standing, n));
#else
            i = cadt_blocks_of(level + 1u, n) + block;
            hint = cadt_load_relaxed(mesh.vertex_to_triangle + cadt_rank_of(level + 1u, block, n));
#endif
          }
          u += CADT_SPREAD_STEP(grain);
          tries = 0u;
          if (i == first || i == second || i == third) i = CADT_NONE;
        }
        if (i != CADT_NONE) {
          cadt_worklist_begin(&work, i, CADT_FLIP_LIMIT);
          work.apex_point = cadt_point_of(&mesh, i);
          work.size = cadt_try_vertex(&mesh, i, work.apex_point, &hint, work.half_edge, &counters);
          if (work.size || ++tries == CADT_CAST(cadt_u32, CADT_INSERT_TRIES)) {
            cadt_store_relaxed(mesh.vertex_to_triangle + i, hint);
            if (!work.size) {
              CADT_COUNT_NOW(&counters, CADT_COUNT_DEFERRED_POINTS);
              const cadt_u32 at = cadt_add_relaxed(deferred_counts, 1u);
              CADT_NOISE_AT(&mesh, CADT_AT_PUSH_POINT);
              deferred_points[at] = i;
            }
            i = CADT_NONE;
          } else {
            CADT_COUNT_NOW(&counters, CADT_COUNT_INSERT_RETRIES);
          }
        }
      }
      cadt_sync_lanes(warp);
    }
    if (cadt_worklist_left(&work)) cadt_legalize_next(&mesh, &work, &deferred, &counters);
    cadt_sync_lanes(warp);
  }
  if (listed == count) cadt_report_changes(&counters, deferred_counts);
  CADT_FLUSH_COUNTERS(&counters, counter_rows);
}

/* Edges that earlier launches left over. */
CADT_KERNEL(cadt_legalize_edges, CADT_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* list, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* deferred_edges, CADT_GLOBAL cadt_u32* deferred_counts, cadt_u32 edge_capacity,
            CADT_GLOBAL cadt_u32* counter_rows) {
  CADT_GROUP_COUNTERS(counters, counter_rows);
  CADT_MESH_VIEW(mesh);
  const cadt_deferred deferred = cadt_lists(deferred_edges, deferred_counts, edge_capacity);
  CADT_WORKLIST_HERE(work);
  const cadt_u32 warp = cadt_lanes_of_warp();
  cadt_u32 e = CADT_SPREAD_BEGIN(count, grain);
  cadt_worklist_begin(&work, CADT_NONE, 0u);
  for (;;) {
    if (!cadt_worklist_left(&work) && e < CADT_SPREAD_END(count, grain)) {
      cadt_worklist_begin(&work, CADT_NONE, CADT_EDGE_FLIP_LIMIT);
      work.next = list[e];
      e += CADT_SPREAD_STEP(grain);
    }
    if (!cadt_any_lane(warp, cadt_worklist_left(&work))) break;
    if (cadt_worklist_left(&work)) cadt_legalize_next(&mesh, &work, &deferred, &counters);
    cadt_sync_lanes(warp);
  }
  cadt_report_changes(&counters, deferred_counts);
  CADT_FLUSH_COUNTERS(&counters, counter_rows);
}

#endif
