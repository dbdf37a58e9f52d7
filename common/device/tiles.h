/* SPDX-License-Identifier: Apache-2.0
 *
 * Tiles: the leaves of the quadtree over the sort keys, the largest squares with at most CADT_TILE_POINTS points. The
 * points of a square are neighbours in sorted order, so a tile is a range of positions, and tiles come in that order.
 */
#ifndef CADT_DEVICE_TILES_H
#define CADT_DEVICE_TILES_H

#include "common/device/order.h"

/* The smallest square, by its level, that holds the cells of both keys; -1: no square does. */
CADT_FN cadt_i32 cadt_shared_level(cadt_u64 a, cadt_u64 b, cadt_u32 levels) {
  if (a == b) return CADT_CAST(cadt_i32, levels);
  const cadt_u32 highest = 63u - cadt_clz64(a ^ b); /* bit that differs */
  return highest / 2u < levels ? CADT_CAST(cadt_i32, levels - 1u - highest / 2u) : -1;
}

/* Level of the tile that begins at position i, -1 if none does. A square of the smallest cells is a tile however many
 * points it has. */
CADT_FN cadt_i32 cadt_tile_level(const cadt_keys* keys, cadt_u32 n, cadt_u32 i, cadt_u32 levels) {
  const cadt_u32 most = CADT_TILE_POINTS;
  const cadt_u64 key = cadt_key_at(keys, i);
  /* squares smaller than `before` begin at i, squares smaller than `after` have few points from i on */
  const cadt_i32 before = i ? cadt_shared_level(cadt_key_at(keys, i - 1u), key, levels) : -1;
  const cadt_i32 after = n - i > most ? cadt_shared_level(key, cadt_key_at(keys, i + most), levels) : -1;
  if (before == CADT_CAST(cadt_i32, levels)) return -1;
  if (after == CADT_CAST(cadt_i32, levels)) return after;
  if (after >= before) return after + 1; /* the square around it has more than `most` from i on */
  /* The square around it begins before i. Has it more than `most`? */
  const cadt_u32 shift = 2u * (levels - CADT_CAST(cadt_u32, before));
  const cadt_u64 square = key >> shift;
  cadt_u32 low = i > most ? i - most : 0u, high = i; /* its begin is in [low, high], or before */
  if (i >= most && cadt_key_at(keys, low) >> shift == square) return before + 1;
  while (low < high) {
    const cadt_u32 middle = (low + high) / 2u;
    if (cadt_key_at(keys, middle) >> shift < square)
      low = middle + 1u;
    else
      high = middle;
  }
  return n - low > most && cadt_key_at(keys, low + most) >> shift == square ? before + 1 : -1;
}

/* 1 where a tile begins; flags[n] = 0, so the scan ends with their number. `descents`: keys that are not in order,
 * which happens if coordinates have lost bits when they were scaled; then there are no tiles. */
CADT_KERNEL(cadt_tile_flags, CADT_GLOBAL const cadt_u32* high_keys, CADT_GLOBAL const cadt_u32* low_keys,
            cadt_u32 low_bits, CADT_GLOBAL cadt_u32* flags, cadt_u32 n, cadt_u32 levels, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* descents) {
  const cadt_keys keys = cadt_keys_of(high_keys, low_keys, low_bits);
  cadt_u32 wrong = 0u;
  if (cadt_item == 0u) flags[n] = 0u;
  CADT_FOR(i, n, grain) {
    if (i && cadt_key_at(&keys, i - 1u) > cadt_key_at(&keys, i)) ++wrong;
    flags[i] = cadt_tile_level(&keys, n, i, levels) >= 0 ? 1u : 0u;
  }
  if (wrong) cadt_add_relaxed(descents, wrong);
}

/* `ranks` is the scan of the flags. One more tile marks the end. */
CADT_KERNEL(cadt_tile_pack, CADT_GLOBAL const cadt_u32* high_keys, CADT_GLOBAL const cadt_u32* low_keys,
            cadt_u32 low_bits, CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL cadt_tile* tiles, cadt_u32 n,
            cadt_u32 levels, cadt_u32 grain) {
  const cadt_keys keys = cadt_keys_of(high_keys, low_keys, low_bits);
  cadt_tile tile;
  if (cadt_item == 0u) {
    tile.begin = n;
    tile.level = 0;
    tiles[ranks[n]] = tile;
  }
  CADT_FOR(i, n, grain) {
    if (ranks[i + 1u] == ranks[i]) continue;
    tile.begin = i;
    tile.level = cadt_tile_level(&keys, n, i, levels);
    tiles[ranks[i]] = tile;
  }
}

#endif
