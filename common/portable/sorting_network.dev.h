/* SPDX-License-Identifier: Apache-2.0
 *
 * A sorting network for 16 keys.
 */
#ifndef CADT_PORTABLE_SORTING_NETWORK_H
#define CADT_PORTABLE_SORTING_NETWORK_H

#include "common/portable/dialect.dev.h"

/* K. E. Batcher's odd-even merge sort ("Sorting networks and their applications", 1968) of 16 keys in registers. */
#define CADT_ORDER_KEYS(i, j)                   \
  do {                                          \
    const cadt_u32 low = key[i], high = key[j]; \
    key[i] = low < high ? low : high;           \
    key[j] = low < high ? high : low;           \
  } while (0)
#define CADT_ORDER_TWO(i, j) \
  CADT_ORDER_KEYS(i, j);     \
  CADT_ORDER_KEYS((i) + 1, (j) + 1)
#define CADT_ORDER_FOUR(i, j) \
  CADT_ORDER_TWO(i, j);       \
  CADT_ORDER_TWO((i) + 2, (j) + 2)
/* Three and four pairs of neighbours, from i on. */
#define CADT_ORDER_THREE_PAIRS(i)    \
  CADT_ORDER_KEYS(i, (i) + 1);       \
  CADT_ORDER_KEYS((i) + 2, (i) + 3); \
  CADT_ORDER_KEYS((i) + 4, (i) + 5)
#define CADT_ORDER_FOUR_PAIRS(i) \
  CADT_ORDER_THREE_PAIRS(i);     \
  CADT_ORDER_KEYS((i) + 6, (i) + 7)
/* Layer by layer: compilers for CPUs make less of other orders. */
#define CADT_SORT_KEYS       \
  CADT_ORDER_FOUR_PAIRS(0);  \
  CADT_ORDER_FOUR_PAIRS(8);  \
  CADT_ORDER_TWO(0, 2);      \
  CADT_ORDER_TWO(4, 6);      \
  CADT_ORDER_TWO(8, 10);     \
  CADT_ORDER_TWO(12, 14);    \
  CADT_ORDER_KEYS(1, 2);     \
  CADT_ORDER_KEYS(5, 6);     \
  CADT_ORDER_KEYS(9, 10);    \
  CADT_ORDER_KEYS(13, 14);   \
  CADT_ORDER_FOUR(0, 4);     \
  CADT_ORDER_FOUR(8, 12);    \
  CADT_ORDER_TWO(2, 4);      \
  CADT_ORDER_TWO(10, 12);    \
  CADT_ORDER_THREE_PAIRS(1); \
  CADT_ORDER_THREE_PAIRS(9); \
  CADT_ORDER_FOUR(0, 8);     \
  CADT_ORDER_FOUR(4, 12);    \
  CADT_ORDER_FOUR(4, 8);     \
  CADT_ORDER_TWO(2, 4);      \
  CADT_ORDER_TWO(6, 8);      \
  CADT_ORDER_TWO(10, 12);    \
  CADT_ORDER_FOUR_PAIRS(1);  \
  CADT_ORDER_THREE_PAIRS(9)

#endif
