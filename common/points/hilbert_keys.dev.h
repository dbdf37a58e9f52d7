/* SPDX-License-Identifier: Apache-2.0
 *
 * Sort keys: the place of a point's grid cell along Hilbert's curve. Each step of the curve divides a square into four;
 * a quadrant is entered where the one before is left:
 *
 *     one level: 0 1 2 3       two levels: the curve of 16 cells
 *
 *       1 ----> 2                5---6   9--10
 *       ^       |                |   |   |   |
 *       |       v                4   7---8  11
 *       0       3                |           |
 *                                3---2  13--12
 *                                    |   |
 *                                0---1  14--15
 *
 * The two bits of a level are the quadrant, so the keys of a square of any level are one interval, and begin with the
 * key of each larger square around it. Points in sorted order visit the squares of a quadtree depth first.
 *
 * Where one axis is longer, its surplus bits go on top: the grid is a row of squares, each entered where the one before
 * is left.
 */
#ifndef CADT_POINTS_HILBERT_KEYS_H
#define CADT_POINTS_HILBERT_KEYS_H

#include "common/portable/layout.dev.h"

/* Moves the 16 low bits of x to the even places. */
CADT_FN cadt_u32 cadt_spread_bits(cadt_u32 x) {
  x &= 0xFFFFu;
  x = (x | (x << 8)) & 0x00FF00FFu;
  x = (x | (x << 4)) & 0x0F0F0F0Fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}

/* Place of a cell along Hilbert's curve through 2^bits x 2^bits cells, from x = y = 0 to the other end of the x axis.
 * Unlike Morton's order it never jumps: neighbours on the curve are neighbours in the plane, so no walk from one to the
 * next is long. (One long walk on a GPU delays the whole launch.) The function returns a part of the place, that of the
 * bits below `from` and not below `to` of each coordinate, and transforms x and y as the rest of the place needs them.
 */
CADT_FN cadt_u32 cadt_hilbert_part(cadt_u32* x, cadt_u32* y, cadt_u32 from, cadt_u32 to) {
  cadt_u32 place = 0u;
  for (cadt_u32 b = from; b-- > to;) {
    const cadt_u32 qx = (*x >> b) & 1u, qy = (*y >> b) & 1u;
    place = (place << 2) | ((3u * qx) ^ qy);
    if (!qy) { /* the two lower quadrants are transposed, the last one is also rotated by half a turn */
      const cadt_u32 turn = 0u - qx, t = *x ^ turn;
      *x = *y ^ turn;
      *y = t;
    }
  }
  return place;
}
CADT_FN cadt_u32 cadt_hilbert(cadt_u32 x, cadt_u32 y, cadt_u32 bits) { return cadt_hilbert_part(&x, &y, bits, 0u); }

/* The grid of the sort keys: 2^bits_x x 2^bits_y square cells. Coordinates are halved first, because the width of the
 * bounding box may exceed the largest double. */
typedef struct {
  cadt_real half_min_x, half_min_y, scale;
  cadt_u32 bits_x, bits_y;
  cadt_u32 set; /* number of the set in a batch: the squares of its sets follow one another (batch.dev.h); else 0 */
} cadt_key_grid;

#define CADT_GRID_PARAMETERS \
  cadt_real half_min_x, cadt_real half_min_y, cadt_real grid_scale, cadt_u32 bits_x, cadt_u32 bits_y
#define CADT_GRID_VIEW(grid) cadt_key_grid grid = {half_min_x, half_min_y, grid_scale, bits_x, bits_y, 0u}

/* A point in units of cells. */
CADT_FN cadt_point cadt_to_grid(const cadt_key_grid* grid, cadt_point p) {
  const cadt_point f = {(0.5 * p.x - grid->half_min_x) * grid->scale, (0.5 * p.y - grid->half_min_y) * grid->scale};
  return f;
}
/* The last cell of an axis with `bits` bits, as a coordinate. A float may round it up, out of the grid: then the last
 * cell below that is exact in a float. */
CADT_FN cadt_real cadt_last_cell(cadt_u32 bits) {
  cadt_u32 cell = (1u << bits) - 1u;
#if CADT_FLOAT
  cell &= ~(cell >> (CADT_MANTISSA_BITS + 1));
#endif
  return CADT_CAST(cadt_real, cell);
}
CADT_FN cadt_point cadt_clamp_to_grid(const cadt_key_grid* grid, cadt_point f) {
  const cadt_real limit_x = cadt_last_cell(grid->bits_x), limit_y = cadt_last_cell(grid->bits_y);
  /* halving may have rounded the least coordinate up */
  f.x = f.x < 0.0 ? 0.0 : (f.x < limit_x ? f.x : limit_x);
  f.y = f.y < 0.0 ? 0.0 : (f.y < limit_y ? f.y : limit_y);
  return f;
}

/* Bits of the shorter axis: levels of squares below the top ones. */
CADT_FN cadt_u32 cadt_grid_levels(const cadt_key_grid* grid) {
  return grid->bits_x < grid->bits_y ? grid->bits_x : grid->bits_y;
}

/* Hilbert key of a square cell of a level: level 0 has the largest squares, level cadt_grid_levels the cells of the
 * grid. The surplus bits of the longer axis go on top, so a long box is a row of squares, each entered where the one
 * before is left. The squares of the sets of a batch form such a row too. The key of a cell begins with the key of each
 * larger cell around it. */
CADT_FN cadt_u32 cadt_cell_key(const cadt_key_grid* grid, cadt_u32 x, cadt_u32 y, cadt_u32 level) {
  const cadt_u32 mask = (1u << level) - 1u;
  const cadt_u32 along = grid->bits_x >= grid->bits_y ? x : y, across = grid->bits_x >= grid->bits_y ? y : x;
  const cadt_u32 low = cadt_hilbert(along & mask, across & mask, level);
  return level == 16u ? low : ((((along >> level) + grid->set) << (2u * level)) | low);
}

/* The same with up to 31 bits an axis, computed in two parts of at most 32 bits. */
CADT_FN cadt_u64 cadt_fine_key(const cadt_key_grid* grid, cadt_u32 x, cadt_u32 y, cadt_u32 level) {
  const cadt_u32 mask = (1u << level) - 1u, fine = level > 16u ? level - 16u : 0u;
  const cadt_u32 longer = grid->bits_x >= grid->bits_y ? 1u : 0u, along = longer ? x : y;
  cadt_u32 a = along & mask, b = (longer ? y : x) & mask;
  const cadt_u64 high = cadt_hilbert_part(&a, &b, level, fine), low = cadt_hilbert_part(&a, &b, fine, 0u);
  return (CADT_CAST(cadt_u64, (along >> level) + grid->set) << (2u * level)) | (high << (2u * fine)) | low;
}

/* The key of the cell of the grid that has a point, or of the nearest one. */
CADT_FN cadt_u64 cadt_key_of_place(const cadt_key_grid* grid, cadt_point p) {
  const cadt_point f = cadt_clamp_to_grid(grid, cadt_to_grid(grid, p));
  return cadt_fine_key(grid, CADT_CAST(cadt_u32, f.x), CADT_CAST(cadt_u32, f.y), cadt_grid_levels(grid));
}

/* Sort keys of one word, or of two where one-word cells would be over-full: `low_bits` of each key are in the low word.
 */
typedef struct {
  CADT_GLOBAL const cadt_u32* high;
  CADT_GLOBAL const cadt_u32* low; /* null for keys of one word */
  cadt_u32 low_bits;
} cadt_keys;

CADT_FN cadt_keys cadt_keys_of(CADT_GLOBAL const cadt_u32* high, CADT_GLOBAL const cadt_u32* low, cadt_u32 low_bits) {
  const cadt_keys keys = {high, low, low_bits};
  return keys;
}
CADT_FN cadt_u64 cadt_key_at(const cadt_keys* keys, cadt_u32 i) {
  const cadt_u64 high = keys->high[i];
  return keys->low ? (high << keys->low_bits) | keys->low[i] : high;
}

#if CADT_CONTIGUOUS
/* cadt_cell_key for several cells at once, for compilers that vectorise loops. The steps of cadt_hilbert are done with
 * masks: a branch would be mispredicted half of the time. */
enum { CADT_KEYS_AT_ONCE = 16 };
CADT_FN void cadt_cell_keys(const cadt_key_grid* grid, const cadt_u32* along, const cadt_u32* across, cadt_u32* keys) {
  const cadt_u32 level = cadt_grid_levels(grid), mask = (1u << level) - 1u;
  cadt_u32 x[CADT_KEYS_AT_ONCE], y[CADT_KEYS_AT_ONCE];
  for (cadt_u32 l = 0u; l < CADT_CAST(cadt_u32, CADT_KEYS_AT_ONCE); ++l) {
    x[l] = along[l] & mask;
    y[l] = across[l] & mask;
    keys[l] = level == 16u ? 0u : along[l] >> level;
  }
  for (cadt_u32 b = level; b-- > 0u;) {
    for (cadt_u32 l = 0u; l < CADT_CAST(cadt_u32, CADT_KEYS_AT_ONCE); ++l) {
      const cadt_u32 qx = (x[l] >> b) & 1u, qy = (y[l] >> b) & 1u;
      const cadt_u32 change = ((x[l] ^ y[l]) ^ (0u - qx)) & (qy - 1u);
      keys[l] = (keys[l] << 2) | ((3u * qx) ^ qy);
      x[l] ^= change;
      y[l] ^= change;
    }
  }
}
#endif

#if CADT_BUILDS(POINTS)
CADT_KERNEL(cadt_hilbert_keys, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL cadt_u32* keys, cadt_u32 count,
            cadt_u32 grain, CADT_GRID_PARAMETERS) {
  CADT_GRID_VIEW(grid);
#if CADT_CONTIGUOUS
  const cadt_u32 wide = grid.bits_x >= grid.bits_y ? 1u : 0u, most = CADT_KEYS_AT_ONCE;
  cadt_u32 along[CADT_KEYS_AT_ONCE], across[CADT_KEYS_AT_ONCE], some[CADT_KEYS_AT_ONCE];
  for (cadt_u32 l = 0u; l < most; ++l) along[l] = across[l] = 0u;
  const cadt_u32 begin = cadt_begin_of(cadt_item, grain, count), end = cadt_min_u32(begin + grain, count);
  for (cadt_u32 i = begin; i < end; i += most) {
    const cadt_u32 size = cadt_min_u32(most, end - i);
    for (cadt_u32 l = 0u; l < size; ++l) {
      const cadt_point f = cadt_clamp_to_grid(&grid, cadt_to_grid(&grid, points[i + l]));
      along[l] = CADT_CAST(cadt_u32, wide ? f.x : f.y);
      across[l] = CADT_CAST(cadt_u32, wide ? f.y : f.x);
    }
    cadt_cell_keys(&grid, along, across, some);
    for (cadt_u32 l = 0u; l < size; ++l) keys[i + l] = some[l];
  }
#else
  const cadt_u32 levels = cadt_grid_levels(&grid);
  CADT_FOR(i, count, grain) {
    const cadt_point f = cadt_clamp_to_grid(&grid, cadt_to_grid(&grid, points[i]));
    keys[i] = cadt_cell_key(&grid, CADT_CAST(cadt_u32, f.x), CADT_CAST(cadt_u32, f.y), levels);
  }
#endif
}

/* Two-word keys. */
CADT_KERNEL(cadt_fine_hilbert_keys, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL cadt_u32* high,
            CADT_GLOBAL cadt_u32* low, cadt_u32 low_bits, cadt_u32 count, cadt_u32 grain, CADT_GRID_PARAMETERS) {
  CADT_GRID_VIEW(grid);
  CADT_FOR(i, count, grain) {
    const cadt_u64 key = cadt_key_of_place(&grid, points[i]);
    high[i] = CADT_CAST(cadt_u32, key >> low_bits);
    low[i] = CADT_CAST(cadt_u32, key) & ((1u << low_bits) - 1u);
  }
}
#endif

#endif
