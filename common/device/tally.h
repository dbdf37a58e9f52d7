/* SPDX-License-Identifier: Apache-2.0
 *
 * Counters of work and conflicts, and clocks. A work-item counts privately and adds its counts once, to one of several
 * rows, so the counters cost next to nothing. The driver adds the rows up (common/host/counters.cpp).
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
#if CADT_TIMED
  cadt_u64 ticks[CADT_TIMES];
  cadt_u64 lap;
#endif
} cadt_tally;

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
/* Where lanes of a GPU's warp wait for each other; a CPU's thread waits for nobody. */
#if CADT_CONTIGUOUS
#define CADT_LAP_WAIT(tally) ((void)0)
#else
#define CADT_LAP_WAIT(tally) CADT_LAP((tally), CADT_TIME_WAIT)
#endif

CADT_FN void cadt_tally_clear(cadt_tally* tally) {
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_COUNTERS); ++c) tally->count[c] = 0u;
#if CADT_TIMED
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_TIMES); ++c) tally->ticks[c] = 0u;
  tally->lap = cadt_clock();
#endif
}

CADT_FN CADT_GLOBAL cadt_u32* cadt_counter_row(CADT_GLOBAL cadt_u32* counters, cadt_u32 item) {
  return counters + (item >> CADT_ROW_SHIFT) % CADT_COUNTER_ROWS * CADT_COUNTER_STRIDE;
}

/* `counters` is null if nobody wants to know. \pre all lanes of a warp come here */
CADT_FN void cadt_tally_flush(cadt_tally* tally, CADT_GLOBAL cadt_u32* counters, cadt_u32 item) {
  if (!counters) return;
  cadt_converge();
  CADT_GLOBAL cadt_u32* row = cadt_counter_row(counters, item);
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_COUNTERS); ++c) cadt_add_together(row + c, tally->count[c]);
#if CADT_TIMED
  CADT_LAP_WAIT(tally);
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_TIMES); ++c) {
    cadt_add_together(row + CADT_ROW_TIMES + c, CADT_CAST(cadt_u32, tally->ticks[c] >> CADT_TIME_SHIFT));
  }
#endif
}

#endif
