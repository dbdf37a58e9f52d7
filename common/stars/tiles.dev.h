/* SPDX-License-Identifier: Apache-2.0
 *
 * Tiles: the leaves of a quadtree over the sort keys, the largest squares with at most CADT_TILE_POINTS points, or
 * CADT_TILE_FEW where most of a square would be empty. The points of a square are neighbours in sorted order, so a tile
 * is an interval of positions, and the tiles follow one another in that order.
 */
#ifndef CADT_STARS_TILES_H
#define CADT_STARS_TILES_H

#include "common/points/hilbert_keys.dev.h"
#include "common/portable/atomics.dev.h"

/* Level of the smallest square that holds the cells of both keys; -1 if no square does. */
CADT_FN cadt_i32 cadt_shared_level(cadt_u64 a, cadt_u64 b, cadt_u32 levels) {
  if (a == b) return CADT_CAST(cadt_i32, levels);
  const cadt_u32 highest = 63u - cadt_clz64(a ^ b); /* the highest bit that differs */
  return highest / 2u < levels ? CADT_CAST(cadt_i32, levels - 1u - highest / 2u) : -1;
}

/* Whether the square of position i, of keys shifted by `shift`, has more than `most` points. */
CADT_FN cadt_u32 cadt_square_exceeds(const cadt_keys* keys, cadt_u32 n, cadt_u32 i, cadt_u32 shift, cadt_u32 most) {
  const cadt_u64 square = cadt_key_at(keys, i) >> shift;
  cadt_u32 low = i > most ? i - most : 0u, high = i; /* its begin is in [low, high], or before low */
  if (i >= most && cadt_key_at(keys, low) >> shift == square) return 1u;
  CADT_FIND_FIRST(low, high, middle, cadt_key_at(keys, middle) >> shift < square);
  return n - low > most && cadt_key_at(keys, low + most) >> shift == square ? 1u : 0u;
}

/* Level of the tile with at most `most` points that begins at position i, -1 if none begins there. A square of the
 * smallest cells is a tile however many points it has. */
CADT_FN cadt_i32 cadt_tile_level(const cadt_keys* keys, cadt_u32 n, cadt_u32 i, cadt_u32 levels, cadt_u32 most) {
  const cadt_u64 key = cadt_key_at(keys, i);
  /* squares at levels above `before` begin at i; squares at levels above `after` have few points from i on */
  const cadt_i32 before = i ? cadt_shared_level(cadt_key_at(keys, i - 1u), key, levels) : -1;
  const cadt_i32 after = n - i > most ? cadt_shared_level(key, cadt_key_at(keys, i + most), levels) : -1;
  if (before == CADT_CAST(cadt_i32, levels)) return -1;
  if (after == CADT_CAST(cadt_i32, levels)) return after;
  if (after >= before) return after + 1; /* the next larger square has more than `most` points from i on */
  /* The next larger square begins before i. Has it more than `most` points? */
  return cadt_square_exceeds(keys, n, i, 2u * (levels - CADT_CAST(cadt_u32, before)), most) ? before + 1 : -1;
}

/* How many points the tile of point i may have. `ranks` and `overfull` are those of the tiles before the division, or
 * null. */
CADT_FN cadt_u32 cadt_most_of_tile(CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL const cadt_u32* overfull,
                                   cadt_u32 i) {
  return overfull && overfull[ranks[i + 1u] - 1u] ? CADT_CAST(cadt_u32, CADT_TILE_FEW)
                                                  : CADT_CAST(cadt_u32, CADT_TILE_POINTS);
}

/* Whether the points from position i on make their tile an over-full one. */
CADT_FN cadt_u32 cadt_overfills_tile(const cadt_keys* keys, cadt_u32 n, cadt_u32 i, cadt_u32 levels) {
  const cadt_u32 last = i + CADT_TILE_OVERFULL - 1u;
  if (last >= n) return 0u;
  const cadt_i32 level = cadt_shared_level(cadt_key_at(keys, i), cadt_key_at(keys, last), levels) -
                         CADT_CAST(cadt_i32, CADT_OVERFULL_LEVELS);
  return level >= 0 && !cadt_square_exceeds(keys, n, i, 2u * (levels - CADT_CAST(cadt_u32, level)),
                                            CADT_CAST(cadt_u32, CADT_TILE_POINTS))
             ? 1u
             : 0u;
}

/* 1 where a tile begins; flags[n] = 0, so the scan ends with the number of tiles. With `overfull`, over-full tiles are
 * divided again. Without, found[0] counts keys that are out of order, which happens if scaling has cost coordinates
 * some bits - then there are no tiles -, and found[1] a sample of the points that make their tile over-full. */
CADT_KERNEL(cadt_tile_flags, CADT_GLOBAL const cadt_u32* high_keys, CADT_GLOBAL const cadt_u32* low_keys,
            cadt_u32 low_bits, CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL const cadt_u32* overfull,
            CADT_GLOBAL cadt_u32* flags, cadt_u32 n, cadt_u32 levels, cadt_u32 grain, CADT_GLOBAL cadt_u32* found) {
  const cadt_keys keys = cadt_keys_of(high_keys, low_keys, low_bits);
  cadt_u32 wrong = 0u, crowded = 0u;
  if (cadt_item == 0u) flags[n] = 0u;
  CADT_FOR(i, n, grain) {
    if (i && cadt_key_at(&keys, i - 1u) > cadt_key_at(&keys, i)) ++wrong;
    if (!overfull && i % CADT_CAST(cadt_u32, CADT_TILE_OVERFULL) == 0u)
      crowded += cadt_overfills_tile(&keys, n, i, levels);
    flags[i] = cadt_tile_level(&keys, n, i, levels, cadt_most_of_tile(ranks, overfull, i)) >= 0 ? 1u : 0u;
  }
  if (wrong) cadt_add_relaxed(found, wrong);
  if (crowded) cadt_add_relaxed(found + 1, crowded);
}

/* Stores the tiles. `ranks` is the scan of the flags, `before` that of the tiles before the division, if some were
 * `overfull`. One more tile marks the end. */
CADT_KERNEL(cadt_tile_pack, CADT_GLOBAL const cadt_u32* high_keys, CADT_GLOBAL const cadt_u32* low_keys,
            cadt_u32 low_bits, CADT_GLOBAL const cadt_u32* before, CADT_GLOBAL const cadt_u32* overfull,
            CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL cadt_tile* tiles, cadt_u32 n, cadt_u32 levels,
            cadt_u32 grain) {
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
    tile.level = cadt_tile_level(&keys, n, i, levels, cadt_most_of_tile(before, overfull, i));
    tiles[ranks[i]] = tile;
  }
}

/* Finds the over-full tiles: those with so many points in a small part that the neighbourhood grids of the stars would
 * have nearly all of them in a few cells, and each star would have to look at all of these. Stores 1 in `overfull`.
 * \pre it is 0 */
CADT_KERNEL(cadt_tile_overfull, CADT_GLOBAL const cadt_u32* high_keys, CADT_GLOBAL const cadt_u32* low_keys,
            cadt_u32 low_bits, CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL const cadt_tile* tiles, cadt_u32 n,
            cadt_u32 levels, cadt_u32 grain, CADT_GLOBAL cadt_u32* overfull) {
  const cadt_keys keys = cadt_keys_of(high_keys, low_keys, low_bits);
  CADT_FOR(i, n, grain) {
    const cadt_u32 t = ranks[i + 1u] - 1u, last = i + CADT_TILE_OVERFULL - 1u;
    if (last >= tiles[t + 1u].begin) continue;
    const cadt_i32 shared = cadt_shared_level(cadt_key_at(&keys, i), cadt_key_at(&keys, last), levels);
    if (shared < tiles[t].level + CADT_CAST(cadt_i32, CADT_OVERFULL_LEVELS)) continue;
    cadt_store_relaxed(overfull + t, 1u);
  }
}

#endif
