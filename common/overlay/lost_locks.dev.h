/* SPDX-License-Identifier: Apache-2.0
 *
 * Lost locks of each triangle, for Snapshot::lost_locks. Like the clocks, they are in the timed variant alone: without
 * CADT_TIMED both macros are empty. The words, one a triangle, lie behind the rows of counters, if the driver says so
 * in word CADT_ROW_LOST_LOCKS of the first row (common/driver/counters.cpp).
 */
#ifndef CADT_OVERLAY_LOST_LOCKS_H
#define CADT_OVERLAY_LOST_LOCKS_H

#include "common/portable/counters.dev.h"

#if CADT_TIMED
CADT_FN CADT_GLOBAL cadt_u32* cadt_lost_locks_of(CADT_GLOBAL cadt_u32* counter_rows) {
  if (!counter_rows || !counter_rows[CADT_ROW_LOST_LOCKS]) return 0;
  return counter_rows + CADT_COUNTER_ROWS * CADT_COUNTER_STRIDE;
}
CADT_FN void cadt_count_lost_lock(const cadt_counters* counters, cadt_u32 t) {
  if (counters->lost_locks) cadt_add_relaxed(counters->lost_locks + t, 1u);
}

/* Behind CADT_GROUP_COUNTERS in a kernel. */
#define CADT_LOST_LOCKS_BEGIN(counters, counter_rows) (counters).lost_locks = cadt_lost_locks_of(counter_rows)
/* An attempt to lock triangle t failed, or it had changed: beside CADT_COUNT_LOCK_FAILURES. */
#define CADT_LOST_LOCK(counters, t) cadt_count_lost_lock((counters), (t))
#else
#define CADT_LOST_LOCKS_BEGIN(counters, counter_rows) ((void)0)
#define CADT_LOST_LOCK(counters, t) ((void)0)
#endif

#endif
