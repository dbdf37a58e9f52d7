/* SPDX-License-Identifier: Apache-2.0
 *
 * Exclusive prefix sums in three launches: sums of chunks, a scan of the sums by one work-item, then each chunk. No
 * barrier and no local memory, so it is the same on every device.
 */
#ifndef CADT_PORTABLE_SCAN_H
#define CADT_PORTABLE_SCAN_H

#include "common/portable/dialect.dev.h"

CADT_KERNEL(cadt_scan_sums, CADT_GLOBAL const cadt_u32* data, CADT_GLOBAL cadt_u32* sums, cadt_u32 count,
            cadt_u32 chunk) {
  const cadt_u32 begin = cadt_begin_of(cadt_item, chunk, count), end = cadt_min_u32(begin + chunk, count);
  if (begin == end) return;
  cadt_u32 sum = 0u;
  for (cadt_u32 i = begin; i < end; ++i) sum += data[i];
  sums[cadt_item] = sum;
}

CADT_KERNEL(cadt_scan_total, CADT_GLOBAL cadt_u32* sums, cadt_u32 chunks) {
  if (cadt_item != 0u) return;
  cadt_u32 sum = 0u;
  for (cadt_u32 i = 0u; i < chunks; ++i) {
    const cadt_u32 value = sums[i];
    sums[i] = sum;
    sum += value;
  }
}

CADT_KERNEL(cadt_scan_apply, CADT_GLOBAL cadt_u32* data, CADT_GLOBAL const cadt_u32* sums, cadt_u32 count,
            cadt_u32 chunk) {
  const cadt_u32 begin = cadt_begin_of(cadt_item, chunk, count), end = cadt_min_u32(begin + chunk, count);
  if (begin == end) return;
  cadt_u32 sum = sums[cadt_item];
  for (cadt_u32 i = begin; i < end; ++i) {
    const cadt_u32 value = data[i];
    data[i] = sum;
    sum += value;
  }
}

#endif
