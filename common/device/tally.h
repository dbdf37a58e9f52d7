/* SPDX-License-Identifier: Apache-2.0
 *
 * Counters of work and conflicts. A work-item counts privately and adds its counts once, to one of several rows, so the
 * counters cost next to nothing. The driver adds the rows up (common/host/counters.cpp).
 */
#ifndef CADT_DEVICE_TALLY_H
#define CADT_DEVICE_TALLY_H

#include "common/device/atomics.h"
#include "common/device/layout.h"

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
