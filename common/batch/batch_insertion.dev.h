/* SPDX-License-Identifier: Apache-2.0
 *
 * Batches (batch.dev.h) on CPUs: one work-item triangulates a set and inserts its points level by level as cadt_insert
 * does. No other work-item touches the mesh of the set, so inner triangles need no locks (partitioned.dev.h), and
 * locking those at the ghost always succeeds.
 */
#ifndef CADT_BATCH_BATCH_INSERTION_H
#define CADT_BATCH_BATCH_INSERTION_H

#include "common/batch/batch.dev.h"
#include "common/insertion/partitioned.dev.h"
#include "common/insertion/seed_triangle.dev.h"

#if CADT_CONTIGUOUS
/* Three points of `n` that are not collinear, as find_seed_triangle of the driver chooses them; returns 0 if there are
 * none. */
CADT_FN cadt_u32 cadt_choose_first(cadt_locked_mesh* m, cadt_u32 n, cadt_u32 levels, cadt_counters* counters) {
  m->first = cadt_representative(levels, 0u, n);
  m->second = n / 2u == m->first ? 0u : n / 2u;
  const cadt_point a = m->points[m->first], b = m->points[m->second];
  for (m->third = 0u; m->third < n; ++m->third) {
    const cadt_point c = m->points[m->third];
    if (cadt_orientation(a, b, c, counters) == 0) continue;
    m->center.x = a.x / 3.0 + b.x / 3.0 + c.x / 3.0;
    m->center.y = a.y / 3.0 + b.y / 3.0 + c.y / 3.0;
    return 1u;
  }
  return 0u;
}

/* The mesh of n points; returns 0 if a point could not be placed. \pre the triangle slots are zero */
CADT_FN cadt_u32 cadt_insert_set(cadt_locked_mesh* m, cadt_u32 n, const cadt_deferred* deferred,
                                 cadt_counters* counters) {
  const cadt_u32 levels = 64u - cadt_clz64(n - 1u);
  if (!cadt_choose_first(m, n, levels, counters)) return 0u;
  cadt_make_seed_mesh(m, counters);
  cadt_locked_mesh own = *m;
  CADT_SET_PARTITION(own, 0u, n);
  const cadt_partition partition = {0u, n};
  CADT_DECLARE_WORKLIST(work);
  for (cadt_u32 level = levels; level-- > 0u;) {
    const cadt_u32 blocks = (((n - 1u) >> level) + 1u) / 2u;
    for (cadt_u32 block = 0u; block < blocks; ++block) {
      const cadt_u32 standing = 2u * block + cadt_right_half(level + 1u, block);
      const cadt_u32 i = cadt_representative(level, standing ^ 1u, n);
      const cadt_u32 start = cadt_load_relaxed(m->vertex_to_triangle + cadt_representative(level, standing, n));
      if (i == m->first || i == m->second || i == m->third) continue;
      if (cadt_insert_in_partition(&own, &partition, i, start, counters)) continue;
      cadt_worklist_begin(&work, i, CADT_FLIP_LIMIT);
      work.apex_point = cadt_point_of(m, i);
      cadt_u32 from = cadt_load_relaxed(m->vertex_to_triangle + i);
      for (cadt_u32 tries = 0u; !work.size && tries < CADT_CAST(cadt_u32, CADT_INSERT_TRIES); ++tries)
        work.size = cadt_try_insert(m, i, work.apex_point, &from, work.half_edge, counters);
      cadt_store_relaxed(m->vertex_to_triangle + i, from);
      if (!work.size) return 0u;
      cadt_legalize(m, &work, deferred, counters);
    }
  }
  return 1u;
}
#endif

/* The meshes of all batched sets, each in its slots. A failure is counted in states[set]: then its triangles are void.
 * The legality sweep finds edges that are left over. */
CADT_KERNEL(cadt_batch_insert, CADT_GLOBAL cadt_locked_triangle* locked, CADT_GLOBAL const cadt_point* points,
            CADT_GLOBAL cadt_u32* vertex_to_triangle, CADT_GLOBAL const cadt_u32* starts, cadt_u32 set_count,
            CADT_GLOBAL cadt_u32* states, cadt_u32 grain, CADT_GLOBAL cadt_u32* deferred_counts,
            CADT_GLOBAL cadt_u32* counter_rows) {
#if CADT_CONTIGUOUS
  CADT_GROUP_COUNTERS(counters, counter_rows);
  const cadt_deferred none = {deferred_counts, deferred_counts, 0u};
  CADT_FOR(s, set_count, grain) {
    if (states[s] != CADT_SET_BATCHED) continue;
    const cadt_u32 begin = starts[s], n = starts[s + 1u] - begin;
    cadt_locked_mesh mesh;
    mesh.locked = locked + 2u * begin;
    mesh.points = points + begin;
    mesh.vertex_to_triangle = vertex_to_triangle + begin;
    mesh.edge_flags = 0;
    mesh.stabilize = CADT_STABILIZE_OFF;
    mesh.threshold = 0u;
    mesh.epsilon = 0.0;
    CADT_SET_PARTITION(mesh, 0u, 0u);
    CADT_NOISE_BEGIN(mesh, s, 0.0);
    if (!cadt_insert_set(&mesh, n, &none, &counters)) {
      states[s] += CADT_SET_FAILURE;
      for (cadt_u32 t = 0u; t < 2u * n; ++t) mesh.locked[t].word[CADT_WORD_LOCK] = 0u;
      continue;
    }
    for (cadt_u32 t = 0u; t < 2u * n; ++t)
      if (mesh.locked[t].word[CADT_WORD_LOCK] != 0u) cadt_move_triangle(mesh.locked[t].word, begin);
  }
  CADT_FLUSH_COUNTERS(&counters, counter_rows);
#endif
}

#endif
