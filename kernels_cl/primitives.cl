/* SPDX-License-Identifier: Apache-2.0
 *
 * Scan and stable sort for GPUs, in groups of 256 work-items that share local memory. A group works on a tile of 4096
 * elements; groups never wait for one another. Needs no more than OpenCL 1.2 (no sub-groups) and 22 KiB of local
 * memory.
 *
 * Which elements a work-item takes: in global memory neighbours take neighbours (element i * 256 + item, "striped"); in
 * local memory each takes 16 in a row ("blocked") where the order matters.
 */
#ifndef CADT_PRIMITIVES_CL
#define CADT_PRIMITIVES_CL

#include "common/portable/dialect.dev.h"

/* also in backends/opencl/primitives.cpp */
enum { CADT_GROUP = 256, CADT_EACH = 16, CADT_TILE = CADT_GROUP * CADT_EACH };

#define CADT_GROUP_KERNEL __kernel __attribute__((reqd_work_group_size(CADT_GROUP, 1, 1)))
/* PoCL 3.1 crashes when it decides by itself to inline one function with barriers into another. */
#define CADT_GROUP_FN static __attribute__((always_inline))
#define cadt_lane ((cadt_u32)get_local_id(0))
#define cadt_tile ((cadt_u32)get_group_id(0))

/* Words of a tile in local memory, with a gap after every 32, so that 16 in a row lie in different banks for each
 * work-item. */
#define CADT_GAP(i) ((i) + ((i) >> 5))
enum { CADT_TILE_WORDS = CADT_TILE + (CADT_TILE >> 5) };

/* ---- sums over a group ---- */

/* Two arrays of a word per work-item, each behind zeros, so that reading before the first adds nothing. */
enum { CADT_BEFORE = 192, CADT_SIDE = CADT_BEFORE + CADT_GROUP, CADT_SUM_WORDS = 2 * CADT_SIDE };

/* Once, before the first cadt_group_scan; its barrier is enough. */
CADT_GROUP_FN void cadt_group_scan_begin(__local cadt_u32* work) {
  if (cadt_lane < (cadt_u32)CADT_BEFORE) {
    work[cadt_lane] = 0u;
    work[CADT_SIDE + cadt_lane] = 0u;
  }
}

/* Sum of the values of the work-items before this one. Each step adds up four times as many. The first barrier also
 * separates what the work-items did in local memory before from what they do after. */
CADT_GROUP_FN cadt_u32 cadt_group_scan(__local cadt_u32* work, cadt_u32 value, cadt_u32* total) {
  __local cadt_u32* const a = work + CADT_BEFORE + cadt_lane;
  __local cadt_u32* const b = a + CADT_SIDE;
  cadt_u32 sum = value;
  *a = sum;
  barrier(CLK_LOCAL_MEM_FENCE);
  sum += a[-1] + a[-2] + a[-3];
  *b = sum;
  barrier(CLK_LOCAL_MEM_FENCE);
  sum += b[-4] + b[-8] + b[-12];
  *a = sum;
  barrier(CLK_LOCAL_MEM_FENCE);
  sum += a[-16] + a[-32] + a[-48];
  *b = sum;
  barrier(CLK_LOCAL_MEM_FENCE);
  sum += b[-64] + b[-128] + b[-192];
  {
    __local const cadt_u32* const last = work + CADT_SIDE + CADT_BEFORE + CADT_GROUP - 1;
    *total = last[0] + last[-64] + last[-128] + last[-192];
  }
  return sum - value;
}

/* ---- scan: sums of tiles, their scan (the same again), then each tile ---- */

/* data and sums may be the same memory; each has the word at which it begins */
CADT_GROUP_KERNEL void cadt_tile_sums(__global const cadt_u32* data, cadt_u32 data_at, __global cadt_u32* sums,
                                      cadt_u32 sums_at, cadt_u32 count) {
  __local cadt_u32 work[CADT_SUM_WORDS];
  const cadt_u32 first = cadt_tile * CADT_TILE + cadt_lane, left = count - cadt_tile * CADT_TILE;
  __global const cadt_u32* const from = data + data_at + first;
  cadt_u32 sum = 0u, total;
  cadt_group_scan_begin(work);
  if (left >= CADT_TILE) {
#pragma unroll
    for (cadt_u32 i = 0u; i < CADT_EACH; ++i) sum += from[i * CADT_GROUP];
  } else {
    for (cadt_u32 i = 0u; i < CADT_EACH; ++i)
      if (i * CADT_GROUP + cadt_lane < left) sum += from[i * CADT_GROUP];
  }
  cadt_group_scan(work, sum, &total);
  if (cadt_lane == 0u) sums[sums_at + cadt_tile] = total;
}

/* Exclusive sums in place; sums[tile] is the sum before the tile if `scanned`, else the sum of the tile: then there are
 * at most CADT_GROUP tiles. Null sums: there is one tile. */
CADT_GROUP_KERNEL void cadt_tile_scan(__global cadt_u32* data, cadt_u32 data_at, __global const cadt_u32* sums,
                                      cadt_u32 sums_at, cadt_u32 scanned, cadt_u32 count) {
  __local cadt_u32 work[CADT_SUM_WORDS];
  __local cadt_u32 tile[CADT_TILE_WORDS];
  const cadt_u32 first = cadt_tile * CADT_TILE + cadt_lane, left = count - cadt_tile * CADT_TILE;
  __global cadt_u32* const at = data + data_at + first;
  cadt_u32 before = sums && scanned ? sums[sums_at + cadt_tile] : 0u;
  cadt_u32 mine[CADT_EACH], sum = 0u, total;
  cadt_group_scan_begin(work);
  if (sums && !scanned) cadt_group_scan(work, cadt_lane < cadt_tile ? sums[sums_at + cadt_lane] : 0u, &before);
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i) mine[i] = i * CADT_GROUP + cadt_lane < left ? at[i * CADT_GROUP] : 0u;
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i) tile[CADT_GAP(i * CADT_GROUP + cadt_lane)] = mine[i];
  barrier(CLK_LOCAL_MEM_FENCE);
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i) {
    mine[i] = tile[CADT_GAP(cadt_lane * CADT_EACH + i)];
    sum += mine[i];
  }
  sum = before + cadt_group_scan(work, sum, &total);
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i) {
    tile[CADT_GAP(cadt_lane * CADT_EACH + i)] = sum;
    sum += mine[i];
  }
  barrier(CLK_LOCAL_MEM_FENCE);
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i)
    if (i * CADT_GROUP + cadt_lane < left) at[i * CADT_GROUP] = tile[CADT_GAP(i * CADT_GROUP + cadt_lane)];
}

/* ---- sort: a pass for each digit of up to 8 bits, from the lowest: counts by tile, their scan, scatter ----
 * counts[digit * tiles + tile]; after the scan, where the first key of the tile with this digit goes. A few tiles are
 * not scanned: each group adds them up. */

/* Work-items with the same digit count in different words, of different banks. */
enum { CADT_COPIES = 8 };

CADT_GROUP_KERNEL void cadt_digit_counts(__global const cadt_u32* keys, __global cadt_u32* counts, cadt_u32 count,
                                         cadt_u32 tiles, cadt_u32 shift, cadt_u32 mask) {
  __local cadt_u32 copies[256 * CADT_COPIES];
  const cadt_u32 left = count - cadt_tile * CADT_TILE;
  __global const cadt_u32* const from = keys + cadt_tile * CADT_TILE + cadt_lane;
  cadt_u32 mine[CADT_EACH];
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i) mine[i] = i * CADT_GROUP + cadt_lane < left ? from[i * CADT_GROUP] : 0u;
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_COPIES; ++i) copies[i * CADT_GROUP + cadt_lane] = 0u;
  barrier(CLK_LOCAL_MEM_FENCE);
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i)
    if (i * CADT_GROUP + cadt_lane < left)
      atomic_inc(&copies[((mine[i] >> shift) & mask) * CADT_COPIES + (cadt_lane & (CADT_COPIES - 1u))]);
  barrier(CLK_LOCAL_MEM_FENCE);
  if (cadt_lane <= mask) {
    cadt_u32 sum = 0u;
#pragma unroll
    for (cadt_u32 i = 0u; i < CADT_COPIES; ++i)
      sum += copies[cadt_lane * CADT_COPIES + ((cadt_lane + i) & (CADT_COPIES - 1u))];
    counts[cadt_lane * tiles + cadt_tile] = sum;
  }
}

/* Counters of the ranking, 16 bits for each work-item and each value of half a digit. Values d and d + 8 share a word,
 * the words of a work-item lie in its own bank, and so do the 8 words in a row that it sums up. */
enum { CADT_ROW = CADT_GROUP + 32, CADT_COUNTER_WORDS = 8 * CADT_ROW };

/* `halves`: 16 half digits of 4 bits, of 16 elements in a row. Gives each its place in the stable order by half digits,
 * two places to a word. Afterwards the local memory that work-items read before may be written. */
CADT_GROUP_FN void cadt_rank_halves(__local cadt_u32* counter_rows, __local cadt_u32* work, cadt_u64 halves,
                                    cadt_u32* places) {
  __local cadt_u32* const mine = counter_rows + CADT_GAP(cadt_lane);
  cadt_u64 among_mine = 0u; /* how many earlier elements of this work-item have the same half digit */
#pragma unroll
  for (cadt_u32 row = 0u; row < 8u; ++row) mine[row * CADT_ROW] = 0u;
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i) {
    const cadt_u32 d = (cadt_u32)(halves >> (4u * i)) & 15u, row = d & 7u, side = (d & 8u) << 1;
    const cadt_u32 word = mine[row * CADT_ROW];
    mine[row * CADT_ROW] = word + (1u << side);
    among_mine |= (cadt_u64)((word >> side) & 15u) << (4u * i);
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  {
    /* 32 work-items sum a row of 256 counters, 8 words each; both halves of a word at once. */
    const cadt_u32 in_row = cadt_lane & 31u;
    __local cadt_u32* const part = counter_rows + (cadt_lane >> 5) * CADT_ROW + 8u * in_row + (in_row >> 2);
    cadt_u32 words[8], sum = 0u, total;
#pragma unroll
    for (cadt_u32 i = 0u; i < 8u; ++i) {
      words[i] = part[i];
      sum += words[i];
    }
    sum = cadt_group_scan(work, sum, &total);
    sum += total << 16; /* values 8 to 15 come after all of 0 to 7 */
#pragma unroll
    for (cadt_u32 i = 0u; i < 8u; ++i) {
      part[i] = sum;
      sum += words[i];
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE);
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i) {
    const cadt_u32 d = (cadt_u32)(halves >> (4u * i)) & 15u, row = d & 7u, side = (d & 8u) << 1;
    const cadt_u32 before = (mine[row * CADT_ROW] >> side) & 0xFFFFu;
    const cadt_u32 place = before + ((cadt_u32)(among_mine >> (4u * i)) & 15u);
    places[i >> 1] = (i & 1u) ? places[i >> 1] | (place << 16) : place;
  }
}
#define CADT_PLACE(places, i) (((places)[(i) >> 1] >> (((i)&1u) << 4)) & 0xFFFFu)

/* Local memory of the scatter, by what it holds at the time. */
typedef union {
  struct {
    cadt_u32 counter_rows[CADT_COUNTER_WORDS];
    union {
      uchar digits[CADT_TILE];   /* of the elements as they come */
      ushort handles[CADT_TILE]; /* in the order of the lower halves: element, upper half << 12 */
      ushort places[CADT_TILE];  /* of the elements as they come: where they go in the tile */
      cadt_u32 words[CADT_TILE / 2];
    } order;
  } rank;
  cadt_u32 sorted[CADT_TILE];
} cadt_scatter_memory;

CADT_GROUP_KERNEL void cadt_digit_scatter(__global const cadt_u32* keys_in, __global const cadt_u32* values_in,
                                          __global cadt_u32* keys_out, __global cadt_u32* values_out,
                                          __global const cadt_u32* counts, cadt_u32 scanned, cadt_u32 count,
                                          cadt_u32 tiles, cadt_u32 shift, cadt_u32 mask) {
  __local cadt_u32 work[CADT_SUM_WORDS];
  __local cadt_u32
      goes_to[256]; /* for each digit: the first key's place in the output, later less its place in the tile */
  __local cadt_scatter_memory memory;
  const cadt_u32 first = cadt_tile * CADT_TILE + cadt_lane;
  const cadt_u32 left = cadt_min_u32(count - cadt_tile * CADT_TILE, CADT_TILE);
  cadt_u32 keys[CADT_EACH], values[CADT_EACH], places[CADT_EACH / 2];
  cadt_u64 halves = 0u;

  /* Beyond the end stand keys with the highest digit: the order is stable, so they stay behind all others. With null
   * values_in the values are the places of the keys. */
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i)
    keys[i] = i * CADT_GROUP + cadt_lane < left ? keys_in[first + i * CADT_GROUP] : 0xFFFFFFFFu;
  cadt_group_scan_begin(work);
  if (scanned) {
    if (cadt_lane <= mask) goes_to[cadt_lane] = counts[cadt_lane * tiles + cadt_tile];
  } else {
    cadt_u32 before = 0u, sum = 0u, total;
    for (cadt_u32 t = 0u; t < tiles && cadt_lane <= mask; ++t) {
      const cadt_u32 here = counts[cadt_lane * tiles + t];
      if (t < cadt_tile) before += here;
      sum += here;
    }
    goes_to[cadt_lane] = before + cadt_group_scan(work, sum, &total);
  }
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i)
    memory.rank.order.digits[i * CADT_GROUP + cadt_lane] = (uchar)((keys[i] >> shift) & mask);
  barrier(CLK_LOCAL_MEM_FENCE);

  /* Sorts the tile by the lower half of the digit, then by the upper one. What moves is a handle of 16 bits. */
  {
    cadt_u32 digits[CADT_EACH / 4];
#pragma unroll
    for (cadt_u32 i = 0u; i < CADT_EACH / 4u; ++i)
      digits[i] = memory.rank.order.words[cadt_lane * (CADT_EACH / 4u) + i];
#pragma unroll
    for (cadt_u32 i = 0u; i < CADT_EACH; ++i)
      halves |= (cadt_u64)((digits[i >> 2] >> ((i & 3u) << 3)) & 15u) << (4u * i);
    cadt_rank_halves(memory.rank.counter_rows, work, halves, places);
    if (mask < 16u) {
#pragma unroll
      for (cadt_u32 i = 0u; i < CADT_EACH; ++i)
        memory.rank.order.places[cadt_lane * CADT_EACH + i] = (ushort)CADT_PLACE(places, i);
    } else {
#pragma unroll
      for (cadt_u32 i = 0u; i < CADT_EACH; ++i) {
        const cadt_u32 upper = (digits[i >> 2] >> (((i & 3u) << 3) + 4u)) & 15u;
        memory.rank.order.handles[CADT_PLACE(places, i)] = (ushort)((cadt_lane * CADT_EACH + i) | (upper << 12));
      }
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (mask >= 16u) {
    cadt_u32 handles[CADT_EACH / 2];
    halves = 0u;
#pragma unroll
    for (cadt_u32 i = 0u; i < CADT_EACH / 2u; ++i)
      handles[i] = memory.rank.order.words[cadt_lane * (CADT_EACH / 2u) + i];
#pragma unroll
    for (cadt_u32 i = 0u; i < CADT_EACH; ++i) halves |= (cadt_u64)(CADT_PLACE(handles, i) >> 12) << (4u * i);
    cadt_rank_halves(memory.rank.counter_rows, work, halves, places);
#pragma unroll
    for (cadt_u32 i = 0u; i < CADT_EACH; ++i)
      memory.rank.order.places[CADT_PLACE(handles, i) & 0xFFFu] = (ushort)CADT_PLACE(places, i);
    barrier(CLK_LOCAL_MEM_FENCE);
  }

  /* Through local memory, so that the keys of a digit leave side by side. */
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i)
    values[i] =
        values_in && i * CADT_GROUP + cadt_lane < left ? values_in[first + i * CADT_GROUP] : first + i * CADT_GROUP;
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH / 2u; ++i)
    places[i] = memory.rank.order.places[2u * i * CADT_GROUP + cadt_lane] |
                (cadt_u32)memory.rank.order.places[(2u * i + 1u) * CADT_GROUP + cadt_lane] << 16;
  barrier(CLK_LOCAL_MEM_FENCE);
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i) memory.sorted[CADT_PLACE(places, i)] = keys[i];
  barrier(CLK_LOCAL_MEM_FENCE);
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i) {
    const cadt_u32 at = i * CADT_GROUP + cadt_lane;
    keys[i] = memory.sorted[at];
    {
      const cadt_u32 digit = (keys[i] >> shift) & mask;
      if (at != 0u && ((memory.sorted[at - 1u] >> shift) & mask) != digit) goes_to[digit] -= at;
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE);
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i) memory.sorted[CADT_PLACE(places, i)] = values[i];
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i) { /* from here on, where the key goes */
    const cadt_u32 at = i * CADT_GROUP + cadt_lane, to = at + goes_to[(keys[i] >> shift) & mask];
    if (at < left) keys_out[to] = keys[i];
    keys[i] = to;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
#pragma unroll
  for (cadt_u32 i = 0u; i < CADT_EACH; ++i) {
    const cadt_u32 at = i * CADT_GROUP + cadt_lane;
    if (at < left) values_out[keys[i]] = memory.sorted[at];
  }
}

#endif
