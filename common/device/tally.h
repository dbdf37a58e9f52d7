/* SPDX-License-Identifier: Apache-2.0
 *
 * Counters of work and conflicts. A work-item counts privately and adds its counts once, to one of several rows, so the
 * counters cost next to nothing. The driver adds the rows up (common/host/counters.cpp).
 */
#ifndef CADT_DEVICE_TALLY_H
#define CADT_DEVICE_TALLY_H

#include "common/device/atomics.h"

enum {
  CADT_COUNT_WALK_STEPS,
  CADT_COUNT_CLAIMS,
  CADT_COUNT_LOST_CLAIMS,
  CADT_COUNT_INSERT_RETRIES,
  CADT_COUNT_STALE_EDGES,
  CADT_COUNT_DEFERRED_POINTS,
  CADT_COUNT_DEFERRED_EDGES,
  CADT_COUNT_SPLITS,
  CADT_COUNT_EDGE_SPLITS,
  CADT_COUNT_FLIPS,
  CADT_COUNT_INCIRCLE_TESTS,
  CADT_COUNT_EXACT_ORIENTATIONS,
  CADT_COUNT_EXACT_INCIRCLES,
  CADT_COUNT_TIES,
  CADT_COUNT_EDGES_EXAMINED, /* by the closing pass */
  CADT_COUNT_EDGES_ILLEGAL,  /* found by the closing pass */
  CADT_COUNT_UNOWNED_STORES, /* checked builds: stores to a record that the writer does not own */
  CADT_COUNTERS,
  CADT_COUNTER_STRIDE = 32, /* words a row, so rows do not share cache lines */
  CADT_COUNTER_ROWS = 64
};

typedef struct {
  cadt_u32 count[CADT_COUNTERS];
} cadt_tally;

CADT_FN void cadt_tally_clear(cadt_tally* tally) {
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_COUNTERS); ++c) tally->count[c] = 0u;
}

CADT_FN void cadt_tally_flush(const cadt_tally* tally, CADT_GLOBAL cadt_u32* counters, cadt_u32 item) {
  CADT_GLOBAL cadt_u32* row = counters + (item % CADT_COUNTER_ROWS) * CADT_COUNTER_STRIDE;
  for (cadt_u32 c = 0; c < CADT_CAST(cadt_u32, CADT_COUNTERS); ++c)
    if (tally->count[c]) cadt_add_relaxed(row + c, tally->count[c]);
}

#endif
