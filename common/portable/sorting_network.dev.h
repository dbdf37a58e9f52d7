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
#define CADT_SORT_KEYS     \
  CADT_ORDER_KEYS(0, 1);   \
  CADT_ORDER_KEYS(2, 3);   \
  CADT_ORDER_KEYS(4, 5);   \
  CADT_ORDER_KEYS(6, 7);   \
  CADT_ORDER_KEYS(8, 9);   \
  CADT_ORDER_KEYS(10, 11); \
  CADT_ORDER_KEYS(12, 13); \
  CADT_ORDER_KEYS(14, 15); \
  CADT_ORDER_KEYS(0, 2);   \
  CADT_ORDER_KEYS(1, 3);   \
  CADT_ORDER_KEYS(4, 6);   \
  CADT_ORDER_KEYS(5, 7);   \
  CADT_ORDER_KEYS(8, 10);  \
  CADT_ORDER_KEYS(9, 11);  \
  CADT_ORDER_KEYS(12, 14); \
  CADT_ORDER_KEYS(13, 15); \
  CADT_ORDER_KEYS(1, 2);   \
  CADT_ORDER_KEYS(5, 6);   \
  CADT_ORDER_KEYS(9, 10);  \
  CADT_ORDER_KEYS(13, 14); \
  CADT_ORDER_KEYS(0, 4);   \
  CADT_ORDER_KEYS(1, 5);   \
  CADT_ORDER_KEYS(2, 6);   \
  CADT_ORDER_KEYS(3, 7);   \
  CADT_ORDER_KEYS(8, 12);  \
  CADT_ORDER_KEYS(9, 13);  \
  CADT_ORDER_KEYS(10, 14); \
  CADT_ORDER_KEYS(11, 15); \
  CADT_ORDER_KEYS(2, 4);   \
  CADT_ORDER_KEYS(3, 5);   \
  CADT_ORDER_KEYS(10, 12); \
  CADT_ORDER_KEYS(11, 13); \
  CADT_ORDER_KEYS(1, 2);   \
  CADT_ORDER_KEYS(3, 4);   \
  CADT_ORDER_KEYS(5, 6);   \
  CADT_ORDER_KEYS(9, 10);  \
  CADT_ORDER_KEYS(11, 12); \
  CADT_ORDER_KEYS(13, 14); \
  CADT_ORDER_KEYS(0, 8);   \
  CADT_ORDER_KEYS(1, 9);   \
  CADT_ORDER_KEYS(2, 10);  \
  CADT_ORDER_KEYS(3, 11);  \
  CADT_ORDER_KEYS(4, 12);  \
  CADT_ORDER_KEYS(5, 13);  \
  CADT_ORDER_KEYS(6, 14);  \
  CADT_ORDER_KEYS(7, 15);  \
  CADT_ORDER_KEYS(4, 8);   \
  CADT_ORDER_KEYS(5, 9);   \
  CADT_ORDER_KEYS(6, 10);  \
  CADT_ORDER_KEYS(7, 11);  \
  CADT_ORDER_KEYS(2, 4);   \
  CADT_ORDER_KEYS(3, 5);   \
  CADT_ORDER_KEYS(6, 8);   \
  CADT_ORDER_KEYS(7, 9);   \
  CADT_ORDER_KEYS(10, 12); \
  CADT_ORDER_KEYS(11, 13); \
  CADT_ORDER_KEYS(1, 2);   \
  CADT_ORDER_KEYS(3, 4);   \
  CADT_ORDER_KEYS(5, 6);   \
  CADT_ORDER_KEYS(7, 8);   \
  CADT_ORDER_KEYS(9, 10);  \
  CADT_ORDER_KEYS(11, 12); \
  CADT_ORDER_KEYS(13, 14);

#endif
