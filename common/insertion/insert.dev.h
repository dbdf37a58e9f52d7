/* SPDX-License-Identifier: Apache-2.0
 *
 * Insertion: locate, split and legalise in one flow, without a barrier between them (paper, section 4.4, "unified
 * execution flow"). A point that gets no locks in a bounded number of tries is deferred to the next launch.
 */
#ifndef CADT_INSERTION_INSERT_H
#define CADT_INSERTION_INSERT_H

#include "common/insertion/legalize.dev.h"
#include "common/insertion/split.dev.h"

enum { CADT_INSERT_TRIES = 12 /* walks for one point in one launch */ };

/* Walks from triangle `*start` and inserts vertex i where the walk ends. Returns the number of `edges` opposite of it;
 * 0: try again, from the new `*start`. */
CADT_FN cadt_u32 cadt_try_insert(const cadt_locked_mesh* m, cadt_u32 i, cadt_point p, cadt_u32* start, cadt_u32* edges,
                                 cadt_counters* counters) {
  cadt_place place = {CADT_LOST, *start, 0u, {0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u}};
  cadt_u32 size = 0u;
  CADT_ADD_TIME(counters, CADT_TIME_OTHER);
  CADT_NOISE_AT(m, CADT_SITE_WALK_START);
  cadt_locate(m, p, *start, &place, counters);
  CADT_ADD_TIME(counters, CADT_TIME_LOCATE);
  if (place.kind != CADT_LOST)
    size = place.kind == CADT_IN_FACE ? cadt_split_face(m, i, &place, edges, counters)
                                      : cadt_split_edge(m, i, &place, edges, counters);
  *start = place.triangle;
  return size;
}

/* Block b of level l holds the positions from b * 2^l on, 2^l of them. One position represents the block: that of one
 * of its two halves, chosen by a hash. (Always the left one would do for most sets; but where every other point in
 * sorted order is of another kind, two lines for instance, the last level would insert all of one kind into a mesh of
 * the other, with n / 8 flips a point.) Eight neighbouring blocks share their choice: evenly spaced points then need
 * fewer flips.
 *
 *     blocks of level 2  |       3       |
 *     blocks of level 1  |   1   |   3   |      level 1 inserts 1, with a walk from 3
 *     blocks of level 0  | 0 | 1 | 2 | 3 |      level 0 inserts 0, with a walk from 1, and 2, with a walk from 3
 */
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

/* On GPUs the points are stored in the order of insertion, level after level, each along the curve: while few points
 * are in the mesh they lie close together and fill cache lines. This is the place, in that order, of the point that
 * represents `block` of `level`: it is inserted at the first level from there on at which its block does not represent
 * the two. */
CADT_FN cadt_u32 cadt_blocks_of(cadt_u32 level, cadt_u32 n) { return ((n - 1u) >> level) + 1u; }
CADT_FN cadt_u32 cadt_rank_of(cadt_u32 level, cadt_u32 block, cadt_u32 n) {
  for (;; ++level, block >>= 1) {
    const cadt_u32 blocks = cadt_blocks_of(level, n);
    if (blocks == 1u) return 0u;
    const cadt_u32 right = (block | 1u) < blocks ? cadt_right_half(level + 1u, block >> 1) : 0u;
    if ((block & 1u) != right) return cadt_blocks_of(level + 1u, n) + (block >> 1);
  }
}

/* The vertex that represents `block` of `level`, by its place among the points. */
CADT_FN cadt_u32 cadt_representing_vertex(cadt_u32 level, cadt_u32 block, cadt_u32 n) {
#if CADT_CONTIGUOUS
  return cadt_representative(level, block, n);
#else
  return cadt_rank_of(level, block, n);
#endif
}

/* The position in sorted order of vertex i, which does not represent all. */
CADT_FN cadt_u32 cadt_position_of(cadt_u32 i, cadt_u32 n) {
#if CADT_CONTIGUOUS
  (void)n;
  return i;
#else
  cadt_u32 level = 0u;
  while (i < cadt_blocks_of(level + 1u, n)) ++level;
  const cadt_u32 block = i - cadt_blocks_of(level + 1u, n);
  return cadt_representative(level, 2u * block + (cadt_right_half(level + 1u, block) ^ 1u), n);
#endif
}

/* Where the walk to p, vertex i, starts when the blocks of `level` are in the mesh: at the nearer one of the two
 * vertices beside it in sorted order, that of its block and that of the block on its other side. The curve leaves a row
 * of points and comes back to it from elsewhere, so one of them may be far away, with thousands of triangles in
 * between.
 *
 *     blocks         [ .  2 ][ 5  . ][ .  9 ]
 *     inserted now     1          6    8         6: from 5 or from 9
 */
CADT_FN cadt_u32 cadt_start_beside(const cadt_locked_mesh* m, cadt_u32 level, cadt_u32 i, cadt_u32 n, cadt_point p) {
  const cadt_u32 position = cadt_position_of(i, n), block = position >> level;
  const cadt_u32 beside = position < cadt_representative(level, block, n) ? block - 1u : block + 1u;
  const cadt_u32 v = cadt_representing_vertex(level, block, n);
  const cadt_u32 w = beside < cadt_blocks_of(level, n) ? cadt_representing_vertex(level, beside, n) : v;
  const cadt_u32 at_v = cadt_load_relaxed(m->vertex_to_triangle + v),
                 at_w = cadt_load_relaxed(m->vertex_to_triangle + w);
  const cadt_point a = cadt_point_of(m, v), b = cadt_point_of(m, w);
  return cadt_fabs(a.x - p.x) + cadt_fabs(a.y - p.y) <= cadt_fabs(b.x - p.x) + cadt_fabs(b.y - p.y) ? at_v : at_w;
}

#if CADT_BUILDS(INSERTION)
/* Points and input ids in that order. */
CADT_KERNEL(cadt_by_level, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* input_ids, cadt_u32 n,
            cadt_u32 grain, CADT_GLOBAL cadt_point* sorted_points, CADT_GLOBAL cadt_u32* sorted_input_ids) {
  CADT_FOR(i, n, grain) {
    const cadt_u32 rank = cadt_rank_of(0u, i, n);
    sorted_points[rank] = points[i];
    sorted_input_ids[rank] = input_ids[i];
  }
}

/* Position of the point that represents all: the first of the mesh. */
CADT_KERNEL(cadt_first_representative, cadt_u32 n, cadt_u32 levels, CADT_GLOBAL cadt_u32* position) {
  if (cadt_item == 0u) *position = cadt_representative(levels, 0u, n);
}
#endif

#if CADT_CONTIGUOUS
/* Where the walk of a deferred point starts: at its own triangle or, if it has none yet, at that of the point from
 * which its level would have inserted it. */
CADT_FN cadt_u32 cadt_start_of_deferred(const cadt_locked_mesh* m, cadt_u32 i, cadt_u32 n) {
  cadt_u32 start = cadt_load_relaxed(m->vertex_to_triangle + i);
  for (cadt_u32 level = 0u; start == CADT_NONE; ++level)
    start = cadt_load_relaxed(m->vertex_to_triangle + cadt_representative(level + 1u, i >> (level + 1u), n));
  return start;
}
#endif

#if CADT_BUILDS(INSERTION)
/* Inserts `count` points: first `listed` deferred ones, each with a walk from its own triangle; then those of one level
 * or, on GPUs, several, whose walks start at the vertices of the blocks of `above`, the level before. CPUs: of each of
 * its blocks, from block `begin` on, the half that does not represent it; GPUs: the vertices from `begin` on. */
CADT_KERNEL(cadt_insert, CADT_LOCKED_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* list, cadt_u32 listed, cadt_u32 begin,
            cadt_u32 count, cadt_u32 n, cadt_u32 above, cadt_u32 grain, CADT_GLOBAL cadt_u32* deferred_points,
            CADT_GLOBAL cadt_u32* deferred_edges, CADT_GLOBAL cadt_u32* deferred_counts, cadt_u32 edge_capacity,
            CADT_GLOBAL cadt_u32* counter_rows) {
  CADT_GROUP_COUNTERS(counters, counter_rows);
  CADT_LOST_LOCKS_BEGIN(counters, counter_rows);
  CADT_LOCKED_MESH(mesh);
  const cadt_deferred deferred = {deferred_edges, deferred_counts, edge_capacity};
  CADT_DECLARE_WORKLIST(work);
  const cadt_u32 warp = cadt_lanes_of_warp();
  cadt_u32 u = CADT_SPREAD_BEGIN(count, grain), i = CADT_NONE, start = 0u, tries = 0u;
  cadt_worklist_begin(&work, CADT_NONE, 0u);
  /* Lanes of a warp stay together, so that all of them wait for memory at once; when the last one has no edge left, all
   * take their next points. */
  for (;;) {
    if (!cadt_any_lane(warp, cadt_worklist_pending(&work))) {
      const cadt_u32 idle = i != CADT_NONE || u < CADT_SPREAD_END(count, grain) ? 1u : 0u;
      if (!cadt_any_lane(warp, idle)) break;
      if (idle) {
        if (i == CADT_NONE) {
          if (u < listed) {
            i = list[u];
#if CADT_CONTIGUOUS
            start = cadt_start_of_deferred(&mesh, i, n);
#else
            start = cadt_load_relaxed(mesh.vertex_to_triangle + i);
#endif
          } else {
#if CADT_CONTIGUOUS
            const cadt_u32 block = begin + (u - listed);
            i = cadt_representative(above - 1u, 2u * block + (cadt_right_half(above, block) ^ 1u), n);
#else
            i = begin + (u - listed);
#endif
            start = cadt_start_beside(&mesh, above, i, n, cadt_point_of(&mesh, i));
          }
          u += CADT_SPREAD_STEP(grain);
          tries = 0u;
          if (i == first || i == second || i == third) i = CADT_NONE;
        }
        if (i != CADT_NONE) {
          cadt_worklist_begin(&work, i, CADT_FLIP_LIMIT);
          work.apex_point = cadt_point_of(&mesh, i);
          work.size = cadt_try_insert(&mesh, i, work.apex_point, &start, work.half_edge, &counters);
          if (work.size || ++tries == CADT_CAST(cadt_u32, CADT_INSERT_TRIES)) {
            cadt_store_relaxed(mesh.vertex_to_triangle + i, start);
            if (!work.size) {
              CADT_COUNT_NOW(&counters, CADT_COUNT_DEFERRED_POINTS);
              const cadt_u32 at = cadt_add_relaxed(deferred_counts, 1u);
              CADT_NOISE_AT(&mesh, CADT_SITE_PUSH_POINT);
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
    if (cadt_worklist_pending(&work)) cadt_legalize_next(&mesh, &work, &deferred, &counters);
    cadt_sync_lanes(warp);
  }
  if (listed == count) cadt_report_changes(&counters, deferred_counts);
  CADT_FLUSH_COUNTERS(&counters, counter_rows);
}
#endif

#endif
