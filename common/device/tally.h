/* SPDX-License-Identifier: Apache-2.0
 *
 * Counters of work and conflicts, and clocks. A work-item counts privately and adds its counts once; they end in one of
 * several rows, so the counters cost little. What happens seldom in the insertion is counted by CADT_TALLY_NOW: on a
 * GPU at once in the memory of the group, since no register is free for it. The driver adds the rows up
 * (common/host/counters.cpp).
 *
 * Clocks are in the timed build only. A lap ends where CADT_LAP stands: the time since the last one goes to the named
 * account. On a GPU that is the time of the lane, in which lanes of its warp that went another way may have worked.
 */
#ifndef CADT_DEVICE_TALLY_H
#define CADT_DEVICE_TALLY_H

#include "common/device/atomics.h"
#include "common/device/layout.h"

typedef struct {
  cadt_u32 count[CADT_COUNTERS];
#if CADT_GROUP_SUMS
  CADT_LOCAL_PTR cadt_u32* sums; /* of the group */
  cadt_u32 wanted;               /* whether anybody wants to know */
#endif
#if CADT_TIMED
  cadt_u64 ticks[CADT_TIMES];
  cadt_u64 lap;
#endif
} cadt_tally;

#if CADT_GROUP_SUMS
#define CADT_TALLY_NOW(tally, c) cadt_tally_now((tally), (c))
CADT_FN void cadt_tally_now(const cadt_tally* tally, cadt_u32 c) {
  if (tally->wanted) cadt_add_local(tally->sums + c, 1u);
}
#else
#define CADT_TALLY_NOW(tally, c) ((tally)->count[c]++)
#endif
#if CADT_TIMED
#define CADT_LAP(tally, account) cadt_lap((tally), (account))
CADT_FN void cadt_lap(cadt_tally* tally, cadt_u32 account) {
  const cadt_u64 now = cadt_clock();
  tally->ticks[account] += now - tally->lap;
  tally->lap = now;
}
#else
#define CADT_LAP(tally, account) ((void)0)
#endif
/* What was done since the last lap is nobody's account. */
#if CADT_TIMED
#define CADT_LAP_SKIP(tally) ((tally)->lap = cadt_clock())
#else
#define CADT_LAP_SKIP(tally) ((void)0)
#endif
/* Where lanes of a GPU's warp wait for each other; a CPU's thread waits for nobody. */
#if CADT_CONTIGUOUS
#define CADT_LAP_WAIT(tally) ((void)0)
#else
#define CADT_LAP_WAIT(tally) CADT_LAP((tally), CADT_TIME_WAIT)
#endif

CADT_FN void cadt_tally_clear(cadt_tally* tally) {
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_COUNTERS); ++c) tally->count[c] = 0u;
#if CADT_GROUP_SUMS
  tally->sums = 0;
  tally->wanted = 0u;
#endif
#if CADT_TIMED
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_TIMES); ++c) tally->ticks[c] = 0u;
  tally->lap = cadt_clock();
#endif
}

CADT_FN CADT_GLOBAL cadt_u32* cadt_counter_row(CADT_GLOBAL cadt_u32* counters, cadt_u32 item) {
  return counters + item % CADT_COUNTER_ROWS * CADT_COUNTER_STRIDE;
}

/* A group of a GPU adds up in its own memory, and who comes last passes the sums on: lanes leave their loops one by
 * one, so that there would be one addition in the device's memory for each lane and counter (5 % of the time of 10M
 * points on an H200), and letting the lanes of a warp wait for each other, to add together, costs 3 %. CADT_GROUP_TALLY
 * stands once in a kernel, before anything else; `counters` is null if nobody wants to know. */
#if CADT_GROUP_SUMS
enum { CADT_GROUP_DONE = CADT_COUNTERS + CADT_TIMES, CADT_GROUP_WORDS };
#define CADT_GROUP_TALLY(tally, counters)                \
  CADT_LOCAL cadt_u32 sums[CADT_GROUP_WORDS];            \
  if (counters) cadt_clear_sums(sums, CADT_GROUP_WORDS); \
  cadt_tally tally;                                      \
  cadt_tally_clear(&tally);                              \
  tally.sums = sums;                                     \
  tally.wanted = (counters) != 0 ? 1u : 0u
#define CADT_FLUSH_TALLY(tally, counters) \
  if (counters) cadt_flush_group((tally), sums, (counters))

CADT_FN void cadt_clear_sums(CADT_LOCAL_PTR cadt_u32* sums, cadt_u32 count) {
  for (cadt_u32 c = cadt_item_of_group; c < count; c += cadt_group_items) sums[c] = 0u;
  cadt_group_barrier();
}

/* True for the work-item of the group that asks last: it sees the sums of all. */
CADT_FN cadt_u32 cadt_is_last_of_group(CADT_LOCAL_PTR cadt_u32* done) {
  cadt_fence_local();
  if (cadt_add_local(done, 1u) + 1u != cadt_group_items) return 0u;
  cadt_fence_local();
  return 1u;
}

/* Instructions count here, since each lane executes this by itself: no branches for the common counters, one for all
 * others. */
CADT_FN void cadt_flush_group(cadt_tally* tally, CADT_LOCAL_PTR cadt_u32* sums, CADT_GLOBAL cadt_u32* counters) {
  cadt_u32 others = 0u;
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_COUNTERS_COMMON); ++c) cadt_add_local(sums + c, tally->count[c]);
  for (cadt_u32 c = CADT_COUNTERS_COMMON; c < CADT_CAST(cadt_u32, CADT_COUNTERS); ++c) others |= tally->count[c];
  if (others) {
    for (cadt_u32 c = CADT_COUNTERS_COMMON; c < CADT_CAST(cadt_u32, CADT_COUNTERS); ++c)
      if (tally->count[c]) cadt_add_local(sums + c, tally->count[c]);
  }
#if CADT_TIMED
  CADT_LAP_WAIT(tally);
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_TIMES); ++c)
    cadt_add_local(sums + CADT_COUNTERS + c, CADT_CAST(cadt_u32, tally->ticks[c] >> CADT_TIME_LANE_SHIFT));
#endif
  if (!cadt_is_last_of_group(sums + CADT_GROUP_DONE)) return;
  CADT_GLOBAL cadt_u32* row = cadt_counter_row(counters, cadt_item / cadt_group_items);
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_GROUP_DONE); ++c) {
    const cadt_u32 sum = cadt_add_local(sums + c, 0u), counter = c < CADT_CAST(cadt_u32, CADT_COUNTERS) ? 1u : 0u;
    const cadt_u32 at = counter ? c : c - CADT_COUNTERS + CADT_ROW_TIMES;
    const cadt_u32 value = counter ? sum : sum >> CADT_TIME_GROUP_SHIFT;
    if (value) cadt_add_relaxed(row + at, value);
  }
}
#else
#define CADT_GROUP_TALLY(tally, counters) \
  cadt_tally tally;                       \
  cadt_tally_clear(&tally)
#define CADT_FLUSH_TALLY(tally, counters) \
  if (counters) cadt_flush_item((tally), (counters), cadt_item)

CADT_FN void cadt_flush_item(const cadt_tally* tally, CADT_GLOBAL cadt_u32* counters, cadt_u32 item) {
  CADT_GLOBAL cadt_u32* row = cadt_counter_row(counters, item);
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_COUNTERS); ++c)
    if (tally->count[c]) cadt_add_relaxed(row + c, tally->count[c]);
#if CADT_TIMED
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_TIMES); ++c) {
    const cadt_u32 time = CADT_CAST(cadt_u32, tally->ticks[c] >> CADT_TIME_ITEM_SHIFT);
    if (time) cadt_add_relaxed(row + CADT_ROW_TIMES + c, time);
  }
#endif
}
#endif

#endif
