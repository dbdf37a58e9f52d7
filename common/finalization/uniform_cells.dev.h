/* SPDX-License-Identifier: Apache-2.0
 *
 * Uniform points by counter, cell by cell: a range of indices is a part of the plane, so tiles of a set that is in no
 * memory are made where they are needed. The unit square has 4^level cells along the Z curve, and cell c has the
 * points i with floor(i 4^level / n) = c, uniform within it.
 *
 *      level 1        y
 *      +-----+-----+
 *      |  1  |  3  |      cells in the order of their points; halves of a range are halves of its box, first by x
 *      +-----+-----+
 *      |  0  |  2  |
 *      +-----+-----+ x
 */
#ifndef CADT_FINALIZATION_UNIFORM_CELLS_H
#define CADT_FINALIZATION_UNIFORM_CELLS_H

#include "common/portable/dialect.dev.h"
#include "common/portable/hash.dev.h"

enum { CADT_CELL_BITS = 40 /* of a coordinate within its cell; with the level's they fit in a double */ };

/* Every second bit, from the lowest on. */
CADT_FN cadt_u32 cadt_even_bits(cadt_u32 code) {
  code &= 0x55555555u;
  code = (code | code >> 1) & 0x33333333u;
  code = (code | code >> 2) & 0x0F0F0F0Fu;
  code = (code | code >> 4) & 0x00FF00FFu;
  return (code | code >> 8) & 0x0000FFFFu;
}

/* The coordinate of a cell and random bits: exact. `unit`: 2^-(CADT_CELL_BITS + level) */
CADT_FN cadt_real cadt_in_cell(cadt_u32 cell, cadt_u64 random, cadt_real unit) {
  return CADT_CAST(cadt_real, CADT_CAST(cadt_u64, cell) << CADT_CELL_BITS | random >> (64 - CADT_CELL_BITS)) * unit;
}

/* Point i of n. \pre n <= 2^40, level <= 12 */
CADT_FN cadt_point cadt_cell_point(cadt_u64 i, cadt_u64 n, cadt_u32 level, cadt_u64 seed, cadt_real unit) {
  const cadt_u32 cell = CADT_CAST(cadt_u32, (i << (2u * level)) / n);
  const cadt_u64 first = cadt_mix(cadt_mix(seed + i) + seed), second = cadt_mix(first + i + 1u);
  const cadt_point point = {cadt_in_cell(cadt_even_bits(cell >> 1), first, unit),
                            cadt_in_cell(cadt_even_bits(cell), second, unit)};
  return point;
}

/* Points first, first + 1, ...; numbers of 64 bits in two words. */
CADT_KERNEL(cadt_uniform_cells, CADT_GLOBAL cadt_point* points, cadt_u32 first_low, cadt_u32 first_high, cadt_u32 n_low,
            cadt_u32 n_high, cadt_u32 seed_low, cadt_u32 seed_high, cadt_u32 level, cadt_real unit, cadt_u32 count,
            cadt_u32 grain) {
  const cadt_u64 first = CADT_LONG(first_high, first_low), n = CADT_LONG(n_high, n_low),
                 seed = CADT_LONG(seed_high, seed_low);
  CADT_FOR(i, count, grain) { points[i] = cadt_cell_point(first + i, n, level, seed, unit); }
}

#endif
