/* SPDX-License-Identifier: Apache-2.0
 *
 * The lock protocol (common/insertion/lock.dev.h) on a mesh of a few triangles with a known answer. Each work-item
 * locks three triangles at a time and counts in them. A count stands in all vertices of its triangle, each time in
 * another form, so that the words of different states do not fit:
 *
 *     v0 = count      v1 = count * CADT_COUNT_FACTOR      v2 = ~count      lock word = 2 + 2 * count
 */
#ifndef CADT_SELF_TEST_LOCKS_H
#define CADT_SELF_TEST_LOCKS_H

#include "common/insertion/lock.dev.h"

#define CADT_COUNT_FACTOR 2654435761u

/* Counts in three triangles, and returns 1, if they can be locked as they were read. `torn` counts triangles whose
 * words do not fit. */
CADT_FN cadt_u32 cadt_count_in_three(const cadt_locked_mesh* m, const cadt_u32* t, cadt_counters* counters,
                                     cadt_u32* torn) {
  cadt_snapshot s[3];
  cadt_lock_set locks;
  for (cadt_u32 k = 0u; k < 3u; ++k) {
    s[k] = cadt_snapshot_of(m, t[k]);
    locks.triangle[k] = t[k];
    locks.version[k] = s[k].lock;
  }
  locks.triangle[3] = CADT_NONE;
  locks.version[3] = CADT_ANY_VERSION;
  for (cadt_u32 k = 0u; k < 3u; ++k)
    if (!cadt_is_unlocked(s[k].lock)) return 0u;
  if (!cadt_try_lock(m, &locks, counters)) return 0u;
  for (cadt_u32 k = 0u; k < 3u; ++k)
    if (!cadt_validate(m, t[k], 0u, CADT_HALF_EDGES_ALL, &s[k])) return cadt_unlock_invalid(m, &locks, counters);
  for (cadt_u32 k = 0u; k < 3u; ++k) {
    if (s[k].v1 != s[k].v0 * CADT_COUNT_FACTOR || s[k].v2 != ~s[k].v0) ++*torn;
    cadt_store_vertices(m, t[k], s[k].v0 + 1u, (s[k].v0 + 1u) * CADT_COUNT_FACTOR, ~(s[k].v0 + 1u));
  }
  cadt_fence_before_unlock();
  cadt_unlock(m, &locks);
  return 1u;
}

/* `count`: triangles, a prime number. The first `items` work-items try `rounds` times each. found: how often one has
 * counted, and how often words did not fit; and what a loop of so many `turns` leaves. */
CADT_KERNEL(cadt_selftest_locks, CADT_LOCKED_MESH_PARAMETERS, cadt_u32 count, cadt_u32 rounds, cadt_u32 items,
            cadt_u32 turns, CADT_GLOBAL cadt_u32* found) {
  CADT_LOCKED_MESH(mesh);
  CADT_DECLARE_COUNTERS(counters);
  if (cadt_item < items) {
    cadt_u32 done = 0u, torn = 0u, random = cadt_item;
    for (cadt_u32 round = 0u; round < rounds; ++round) {
      random = random * 1664525u + 1013904223u;
      const cadt_u32 a = (random >> 8) % count, step = 1u + (random >> 20) % (count - 1u);
      const cadt_u32 t[3] = {a, (a + step) % count, (a + 2u * step) % count};
      done += cadt_count_in_three(&mesh, t, &counters, &torn);
    }
    cadt_add_relaxed(found, done);
    if (torn) cadt_add_relaxed(found + 1, torn);
    for (cadt_u32 turn = 0u; turn < turns; ++turn) random = random * 1664525u + 1013904223u;
    if (turns) cadt_store_relaxed(found + 2, random);
  }
}

#endif
