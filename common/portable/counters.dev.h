/* SPDX-License-Identifier: Apache-2.0
 *
 * Counters of work and conflicts, and timers. A work-item counts privately and adds its counts once, to one of several
 * rows, so the counters cost little. CADT_COUNT_NOW counts what happens rarely in the insertion: on a GPU at once in
 * the memory of the group, since no register is free for it. The driver adds the rows up (common/driver/counters.cpp).
 *
 * Timers exist in the timed variant only. CADT_ADD_TIME adds the time since the last reading of the clock to a timer.
 * On a GPU that is the time of the lane, during which divergent lanes of its warp may have run.
 */
#ifndef CADT_PORTABLE_COUNTERS_H
#define CADT_PORTABLE_COUNTERS_H

#include "common/portable/atomics.dev.h"
#include "common/portable/layout.dev.h"

typedef struct {
  cadt_u32 count[CADT_COUNTERS];
#if CADT_GROUP_SUMS
  CADT_LOCAL_PTR cadt_u32* sums; /* of the group */
  cadt_u32 wanted;               /* whether counters are requested */
#endif
#if CADT_TIMED
  cadt_u64 ticks[CADT_TIMERS];
  cadt_u64 last_clock;
  CADT_GLOBAL cadt_u32* lost_locks; /* a word a triangle, or null (lost_locks.dev.h) */
#endif
} cadt_counters;

#if CADT_GROUP_SUMS
#define CADT_COUNT_NOW(counters, c) cadt_count_now((counters), (c))
CADT_FN void cadt_count_now(const cadt_counters* counters, cadt_u32 c) {
  if (counters->wanted) cadt_team_add(counters->sums + c, 1u);
}
#else
#define CADT_COUNT_NOW(counters, c) ((counters)->count[c]++)
#endif
#if CADT_TIMED
#define CADT_ADD_TIME(counters, timer) cadt_add_time((counters), (timer))
CADT_FN void cadt_add_time(cadt_counters* counters, cadt_u32 timer) {
  const cadt_u64 now = cadt_clock();
  counters->ticks[timer] += now - counters->last_clock;
  counters->last_clock = now;
}
/* The time since the last reading goes to no timer. */
#define CADT_SKIP_TIME(counters) ((counters)->last_clock = cadt_clock())
#else
#define CADT_ADD_TIME(counters, timer) ((void)0)
#define CADT_SKIP_TIME(counters) ((void)0)
#endif
/* Where lanes of a GPU's warp wait for each other; a CPU's thread does not. */
#if CADT_CONTIGUOUS
#define CADT_ADD_WAIT_TIME(counters) ((void)0)
#else
#define CADT_ADD_WAIT_TIME(counters) CADT_ADD_TIME((counters), CADT_TIME_WAIT)
#endif

CADT_FN void cadt_counters_clear(cadt_counters* counters) {
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_COUNTERS); ++c) counters->count[c] = 0u;
#if CADT_GROUP_SUMS
  counters->sums = 0;
  counters->wanted = 0u;
#endif
#if CADT_TIMED
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_TIMERS); ++c) counters->ticks[c] = 0u;
  counters->last_clock = cadt_clock();
  counters->lost_locks = 0;
#endif
}

/* Counters of a work-item that start at 0. */
#define CADT_DECLARE_COUNTERS(counters) \
  cadt_counters counters;               \
  cadt_counters_clear(&counters)

/* Adds the numbers of exact orientations, exact incircles and ties to the three words from `found` on. */
CADT_FN void cadt_flush_exact(const cadt_counters* counters, CADT_GLOBAL cadt_u32* found) {
  for (cadt_u32 k = 0u; k < 3u; ++k) {
    const cadt_u32 count = counters->count[CADT_COUNT_EXACT_ORIENTATIONS + k];
    if (count) cadt_add_relaxed(found + k, count);
  }
}

CADT_FN CADT_GLOBAL cadt_u32* cadt_counter_row(CADT_GLOBAL cadt_u32* counter_rows, cadt_u32 item) {
  return counter_rows + item % CADT_COUNTER_ROWS * CADT_COUNTER_STRIDE;
}

/* A group of a GPU adds up in its own memory, and its last lane passes the sums on: lanes leave their loops one by one,
 * so there would be one addition in device memory for each lane and counter (5 % of the time of 10M points on an H200),
 * and letting the lanes of a warp wait for each other to add together costs 3 %. CADT_GROUP_COUNTERS stands once in a
 * kernel, before anything else; null `counter_rows`: nothing is counted. */
#if CADT_GROUP_SUMS
enum { CADT_GROUP_DONE = CADT_COUNTERS + CADT_TIMERS, CADT_GROUP_WORDS };
#define CADT_GROUP_COUNTERS(counters, counter_rows)          \
  CADT_LOCAL cadt_u32 sums[CADT_GROUP_WORDS];                \
  if (counter_rows) cadt_clear_sums(sums, CADT_GROUP_WORDS); \
  CADT_DECLARE_COUNTERS(counters);                           \
  counters.sums = sums;                                      \
  counters.wanted = (counter_rows) != 0 ? 1u : 0u
#define CADT_FLUSH_COUNTERS(counters, counter_rows) \
  if (counter_rows) cadt_flush_group((counters), sums, (counter_rows))

CADT_FN void cadt_clear_sums(CADT_LOCAL_PTR cadt_u32* sums, cadt_u32 count) {
  for (cadt_u32 c = cadt_item_of_group; c < count; c += cadt_group_items) sums[c] = 0u;
  cadt_group_barrier();
}

/* True for the work-item of the group that calls last: it sees the sums of all. */
CADT_FN cadt_u32 cadt_is_last_of_group(CADT_LOCAL_PTR cadt_u32* done) {
  cadt_fence_local();
  if (cadt_team_add(done, 1u) + 1u != cadt_group_items) return 0u;
  cadt_fence_local();
  return 1u;
}

/* Each lane executes this by itself, so instructions count: no branches for the common counters, one for all others. */
CADT_FN void cadt_flush_group(cadt_counters* counters, CADT_LOCAL_PTR cadt_u32* sums,
                              CADT_GLOBAL cadt_u32* counter_rows) {
  cadt_u32 others = 0u;
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_COUNTERS_COMMON); ++c) cadt_team_add(sums + c, counters->count[c]);
  for (cadt_u32 c = CADT_COUNTERS_COMMON; c < CADT_CAST(cadt_u32, CADT_COUNTERS); ++c) others |= counters->count[c];
  if (others) {
    for (cadt_u32 c = CADT_COUNTERS_COMMON; c < CADT_CAST(cadt_u32, CADT_COUNTERS); ++c)
      if (counters->count[c]) cadt_team_add(sums + c, counters->count[c]);
  }
#if CADT_TIMED
  CADT_ADD_WAIT_TIME(counters);
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_TIMERS); ++c)
    cadt_team_add(sums + CADT_COUNTERS + c, CADT_CAST(cadt_u32, counters->ticks[c] >> CADT_TIME_LANE_SHIFT));
#endif
  if (!cadt_is_last_of_group(sums + CADT_GROUP_DONE)) return;
  CADT_GLOBAL cadt_u32* row = cadt_counter_row(counter_rows, cadt_item / cadt_group_items);
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_GROUP_DONE); ++c) {
    const cadt_u32 sum = cadt_team_add(sums + c, 0u), counter = c < CADT_CAST(cadt_u32, CADT_COUNTERS) ? 1u : 0u;
    const cadt_u32 at = counter ? c : c - CADT_COUNTERS + CADT_ROW_TIMES;
    const cadt_u32 value = counter ? sum : sum >> CADT_TIME_GROUP_SHIFT;
    if (value) cadt_add_relaxed(row + at, value);
  }
}
#else
#define CADT_GROUP_COUNTERS(counters, counter_rows) CADT_DECLARE_COUNTERS(counters)
#define CADT_FLUSH_COUNTERS(counters, counter_rows) \
  if (counter_rows) cadt_flush_item((counters), (counter_rows), cadt_item)

CADT_FN void cadt_flush_item(const cadt_counters* counters, CADT_GLOBAL cadt_u32* counter_rows, cadt_u32 item) {
  CADT_GLOBAL cadt_u32* row = cadt_counter_row(counter_rows, item);
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_COUNTERS); ++c)
    if (counters->count[c]) cadt_add_relaxed(row + c, counters->count[c]);
#if CADT_TIMED
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_TIMERS); ++c) {
    const cadt_u32 time = CADT_CAST(cadt_u32, counters->ticks[c] >> CADT_TIME_ITEM_SHIFT);
    if (time) cadt_add_relaxed(row + CADT_ROW_TIMES + c, time);
  }
#endif
}
#endif

#endif
