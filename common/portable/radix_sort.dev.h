/* SPDX-License-Identifier: Apache-2.0
 *
 * One pass of a stable least-significant-digit radix sort of 32-bit keys with 32-bit values: each work-item owns a
 * chunk, counts its digits, and after a scan of all counts (digit-major) scatters its chunk in order.
 */
#ifndef CADT_PORTABLE_RADIX_SORT_H
#define CADT_PORTABLE_RADIX_SORT_H

#include "common/portable/dialect.dev.h"

enum { CADT_DIGITS = 1 << CADT_RADIX_BITS };

CADT_KERNEL(cadt_radix_count, CADT_GLOBAL const cadt_u32* keys, CADT_GLOBAL cadt_u32* counts, cadt_u32 count,
            cadt_u32 chunk, cadt_u32 chunks, cadt_u32 shift) {
  if (cadt_item >= chunks) return;
  cadt_u32 digits[CADT_DIGITS];
  for (cadt_u32 d = 0u; d < CADT_CAST(cadt_u32, CADT_DIGITS); ++d) digits[d] = 0u;
  const cadt_u32 begin = cadt_begin_of(cadt_item, chunk, count), end = cadt_min_u32(begin + chunk, count);
  for (cadt_u32 i = begin; i < end; ++i) digits[(keys[i] >> shift) & (CADT_DIGITS - 1)]++;
  for (cadt_u32 d = 0u; d < CADT_CAST(cadt_u32, CADT_DIGITS); ++d) counts[d * chunks + cadt_item] = digits[d];
}

/* values_in may be null: then the values are 0, 1, 2, ... */
CADT_KERNEL(cadt_radix_scatter, CADT_GLOBAL const cadt_u32* keys_in, CADT_GLOBAL const cadt_u32* values_in,
            CADT_GLOBAL cadt_u32* keys_out, CADT_GLOBAL cadt_u32* values_out, CADT_GLOBAL const cadt_u32* counts,
            cadt_u32 count, cadt_u32 chunk, cadt_u32 chunks, cadt_u32 shift) {
  if (cadt_item >= chunks) return;
  cadt_u32 digits[CADT_DIGITS];
  for (cadt_u32 d = 0u; d < CADT_CAST(cadt_u32, CADT_DIGITS); ++d) digits[d] = counts[d * chunks + cadt_item];
  const cadt_u32 begin = cadt_begin_of(cadt_item, chunk, count), end = cadt_min_u32(begin + chunk, count);
  for (cadt_u32 i = begin; i < end; ++i) {
    const cadt_u32 key = keys_in[i], to = digits[(key >> shift) & (CADT_DIGITS - 1)]++;
    keys_out[to] = key;
    values_out[to] = values_in ? values_in[i] : i;
  }
}

#endif
