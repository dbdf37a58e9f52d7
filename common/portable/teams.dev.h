/* SPDX-License-Identifier: Apache-2.0
 *
 * Work-items that work together: groups that share local memory, teams, and the lanes of a warp.
 */
#ifndef CADT_PORTABLE_TEAMS_H
#define CADT_PORTABLE_TEAMS_H

#include "common/portable/dialect.dev.h"

/* Whether work-items of a group share memory. */
#if CADT_CONTIGUOUS || defined(CADT_LANG_HOST)
#define CADT_GROUP_SUMS 0
#else
#define CADT_GROUP_SUMS 1
#endif

/* A team works on one item with memory of its own: on GPUs a group, elsewhere a single work-item. Lanes share the
 * elements of CADT_TEAM_FOR; after CADT_TEAM_SYNC, which all lanes must reach, they see what the others wrote to the
 * team's memory, after CADT_TEAM_SYNC_ALL also what they wrote to global memory. */
#if CADT_GROUP_SUMS
#define CADT_TEAM_MEMORY CADT_LOCAL
#define CADT_TEAM_PTR CADT_LOCAL_PTR
#define cadt_team_lane cadt_item_of_group
#define cadt_team_lanes cadt_group_items
#define CADT_TEAM_SYNC() cadt_group_barrier()
#define CADT_TEAM_SYNC_ALL() cadt_group_barrier_all()
#define CADT_FOR_TEAMS(t, count, grain) \
  for (cadt_u32 t = cadt_item / cadt_group_items; t < (count); t += cadt_items / cadt_group_items)
#else
#define CADT_TEAM_MEMORY
#define CADT_TEAM_PTR
#define cadt_team_lane 0u
#define cadt_team_lanes 1u
#define CADT_TEAM_SYNC() ((void)0)
#define CADT_TEAM_SYNC_ALL() ((void)0)
#define CADT_FOR_TEAMS(t, count, grain) CADT_FOR(t, count, grain)
#endif
#define CADT_TEAM_FOR(i, count) for (cadt_u32 i = cadt_team_lane; i < (count); i += cadt_team_lanes)

/* Divergent lanes of a warp meet at cadt_any_lane and cadt_sync_lanes, which all lanes of `warp` must reach. Elsewhere
 * each work-item is a warp of its own. */
#if defined(CADT_LANG_CUDA)
CADT_FN cadt_u32 cadt_lanes_of_warp() {
  const cadt_u32 left = blockDim.x - (threadIdx.x & ~31u);
  return left >= 32u ? 0xFFFFFFFFu : (1u << left) - 1u;
}
CADT_FN cadt_u32 cadt_any_lane(cadt_u32 warp, cadt_u32 yes) { return __any_sync(warp, yes != 0u) ? 1u : 0u; }
CADT_FN void cadt_sync_lanes(cadt_u32 warp) { __syncwarp(warp); }
#else
CADT_FN cadt_u32 cadt_lanes_of_warp(void) { return 1u; }
CADT_FN cadt_u32 cadt_any_lane(cadt_u32 warp, cadt_u32 yes) { return warp & yes; }
CADT_FN void cadt_sync_lanes(cadt_u32 warp) { (void)warp; }
#endif

#endif
