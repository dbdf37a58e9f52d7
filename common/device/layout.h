/* SPDX-License-Identifier: Apache-2.0
 *
 * Layout of what the kernels and the driver share in memory.
 */
#ifndef CADT_DEVICE_LAYOUT_H
#define CADT_DEVICE_LAYOUT_H

#include "common/device/lang.h"

#define CADT_GHOST 0xFFFFFFFFu

typedef struct {
  cadt_u32 word[8]; /* v0 v1 v2 lock n0 n1 n2 flips */
} cadt_record;

enum { CADT_WORD_LOCK = 3, CADT_WORD_LINK = 4, CADT_WORD_FLIPS = 7 };

/* Rows of partial results of cadt_bounds. */
enum {
  CADT_BOUNDS_DOUBLES = 4, /* min x, max x, min y, max y */
  CADT_BOUNDS_WORDS = 3    /* lowest exponent + 4096, highest exponent + 4096, first bad point */
};

/* Counters of work and conflicts (tally.h). */
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
  CADT_COUNTERS,
  CADT_COUNTER_STRIDE = 32, /* words a row, so rows do not share cache lines */
  CADT_COUNTER_ROWS = 64
};

#endif
