/* SPDX-License-Identifier: Apache-2.0
 *
 * Spatial order of the points: box, Hilbert keys, gathering, short runs of equal keys, duplicates.
 */
#ifndef CADT_POINTS_SPATIAL_SORT_H
#define CADT_POINTS_SPATIAL_SORT_H

#include "common/portable/atomics.dev.h"
#include "common/portable/layout.dev.h"
#include "common/predicates/bigint.dev.h"
#include "common/predicates/filtered_predicates.dev.h"

enum {
  CADT_RUN =
      16 /* runs of equal keys up to this length are sorted in place, longer ones are refined (key_refinement.dev.h) */
};

/* A coordinate times two powers of two (one may not be enough to reach all of a double's exponents); -0.0 becomes 0.0.
 * Floats are left as they are: a product could lose bits, and -0.0 is equal to 0.0 wherever they are compared. */
CADT_FN cadt_real cadt_multiplied(cadt_real x, cadt_real scale, cadt_real scale_again) {
#if CADT_GRADUAL_UNDERFLOW
  return x * scale * scale_again + 0.0;
#else
  (void)scale, (void)scale_again;
  return x;
#endif
}

CADT_FN cadt_point cadt_multiplied_point(cadt_point p, cadt_real scale, cadt_real scale_again) {
  p.x = cadt_multiplied(p.x, scale, scale_again);
  p.y = cadt_multiplied(p.y, scale, scale_again);
  return p;
}

/* Points from the caller's memory: coordinate i of an axis is at first + i * stride. With `order`, those that it lists,
 * times both factors; null: all as they are. */
#if !CADT_FLOAT
CADT_KERNEL(cadt_import_doubles, CADT_GLOBAL const double* x, CADT_GLOBAL const double* y, cadt_u32 first_x,
            cadt_u32 first_y, cadt_u32 stride, CADT_GLOBAL const cadt_u32* order, cadt_real scale,
            cadt_real scale_again, CADT_GLOBAL cadt_point* points, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 at = order ? order[i] : i;
    cadt_point p;
    p.x = x[first_x + at * stride];
    p.y = y[first_y + at * stride];
    points[i] = order ? cadt_multiplied_point(p, scale, scale_again) : p;
  }
}
#endif

CADT_KERNEL(cadt_import_floats, CADT_GLOBAL const float* x, CADT_GLOBAL const float* y, cadt_u32 first_x,
            cadt_u32 first_y, cadt_u32 stride, CADT_GLOBAL const cadt_u32* order, cadt_real scale,
            cadt_real scale_again, CADT_GLOBAL cadt_point* points, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 at = order ? order[i] : i;
    cadt_point p;
    p.x = CADT_CAST(cadt_real, x[first_x + at * stride]);
    p.y = CADT_CAST(cadt_real, y[first_y + at * stride]);
    points[i] = order ? cadt_multiplied_point(p, scale, scale_again) : p;
  }
}

CADT_FN cadt_bounds_row cadt_bounds_of_nothing(void) {
  cadt_bounds_row row;
  row.min_x = row.min_y = CADT_CAST(cadt_real, CADT_INFINITY);
  row.max_x = row.max_y = -CADT_CAST(cadt_real, CADT_INFINITY);
  row.low = row.bad = CADT_NONE;
  row.high = row.rows = 0u;
  return row;
}

CADT_FN void cadt_bounds_add(cadt_bounds_row* row, const cadt_bounds_row other) {
  row->min_x = other.min_x < row->min_x ? other.min_x : row->min_x;
  row->max_x = other.max_x > row->max_x ? other.max_x : row->max_x;
  row->min_y = other.min_y < row->min_y ? other.min_y : row->min_y;
  row->max_y = other.max_y > row->max_y ? other.max_y : row->max_y;
  row->low = cadt_min_u32(row->low, other.low);
  row->high = other.high > row->high ? other.high : row->high;
  row->bad = cadt_min_u32(row->bad, other.bad);
}

/* Adds point i; 0 if a coordinate is no number. The exponents are in `span` until the end. */
CADT_FN cadt_u32 cadt_bounds_add_point(cadt_bounds_row* row, cadt_span* span, cadt_point p, cadt_u32 i) {
  /* an exponent of all ones is infinity or NaN */
  if (((cadt_bits_of_real(p.x) >> CADT_MANTISSA_BITS) & CADT_EXPONENTS) == CADT_EXPONENTS ||
      ((cadt_bits_of_real(p.y) >> CADT_MANTISSA_BITS) & CADT_EXPONENTS) == CADT_EXPONENTS) {
    row->bad = cadt_min_u32(row->bad, i);
    return 0u;
  }
  cadt_span_add_point(span, p);
  row->min_x = p.x < row->min_x ? p.x : row->min_x;
  row->max_x = p.x > row->max_x ? p.x : row->max_x;
  row->min_y = p.y < row->min_y ? p.y : row->min_y;
  row->max_y = p.y > row->max_y ? p.y : row->max_y;
  return 1u;
}
CADT_FN void cadt_bounds_close(cadt_bounds_row* row, const cadt_span* span) {
  row->low = CADT_CAST(cadt_u32, span->low + 4096);
  row->high = CADT_CAST(cadt_u32, span->high + 4096);
}

/* The rows of all lanes of a team as one, in lanes[0]. All lanes call it. */
CADT_FN void cadt_bounds_of_team(CADT_TEAM_PTR cadt_bounds_row* lanes, cadt_bounds_row own) {
  const cadt_u32 most = CADT_BOUNDS_LANES;
  for (cadt_u32 begin = 0u; begin < cadt_team_lanes; begin += most) {
    if (cadt_team_lane >= begin && cadt_team_lane - begin < most) {
      if (begin) cadt_bounds_add(&own, lanes[cadt_team_lane - begin]);
      lanes[cadt_team_lane - begin] = own;
    }
    CADT_TEAM_SYNC();
  }
  for (cadt_u32 width = cadt_min_u32(cadt_team_lanes, most); width > 1u;) {
    const cadt_u32 middle = (width + 1u) / 2u;
    if (cadt_team_lane + middle < width) {
      own = lanes[cadt_team_lane];
      cadt_bounds_add(&own, lanes[cadt_team_lane + middle]);
      lanes[cadt_team_lane] = own;
    }
    width = middle;
    CADT_TEAM_SYNC();
  }
}

/* Partial results: a row of each team of work-items, as far as there is room. */
CADT_KERNEL(cadt_bounds, CADT_GLOBAL const cadt_point* points, cadt_u32 count, cadt_u32 chunk, cadt_u32 parts,
            cadt_u32 room, CADT_GLOBAL cadt_bounds_row* rows) {
  CADT_TEAM_MEMORY cadt_bounds_row lanes[CADT_BOUNDS_LANES];
  cadt_bounds_row row = cadt_bounds_of_nothing();
  cadt_span span;
  cadt_span_clear(&span);
  CADT_FOR_PART(i, cadt_item, parts, cadt_item < parts ? count : 0u, chunk) {
    if (!cadt_bounds_add_point(&row, &span, points[i], i)) break;
  }
  cadt_bounds_close(&row, &span);
  cadt_bounds_of_team(lanes, row);
  const cadt_u32 team = cadt_item / cadt_team_lanes, teams = (parts - 1u) / cadt_team_lanes + 1u;
  if (cadt_team_lane == 0u && team < cadt_min_u32(teams, room)) {
    row = lanes[0];
    row.rows = teams;
    rows[team] = row;
  }
}

/* The first row becomes that of all, and the CADT_ORDER_WORDS of `totals` become 0. By one team. */
CADT_KERNEL(cadt_merge_bounds, CADT_GLOBAL cadt_bounds_row* rows, cadt_u32 room, CADT_GLOBAL cadt_u32* totals) {
  CADT_TEAM_MEMORY cadt_bounds_row lanes[CADT_BOUNDS_LANES];
  const cadt_u32 count = cadt_item < cadt_team_lanes ? rows[0].rows : 0u; /* launches are rounded up */
  cadt_bounds_row row = cadt_bounds_of_nothing();
  CADT_TEAM_FOR(i, cadt_min_u32(count, room)) { cadt_bounds_add(&row, rows[i]); }
  if (cadt_item < cadt_team_lanes) CADT_TEAM_FOR(i, CADT_CAST(cadt_u32, CADT_ORDER_WORDS)) totals[i] = 0u;
  CADT_TEAM_SYNC();
  cadt_bounds_of_team(lanes, row);
  if (cadt_item == 0u) {
    row = lanes[0];
    row.rows = count;
    rows[0] = row;
  }
}

/* Every second bit. */
CADT_FN cadt_u32 cadt_spread_bits(cadt_u32 x) {
  x &= 0xFFFFu;
  x = (x | (x << 8)) & 0x00FF00FFu;
  x = (x | (x << 4)) & 0x0F0F0F0Fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}

/* Place of a cell along Hilbert's curve through 2^bits x 2^bits cells, from x = y = 0 to the other end of the x axis.
 * Unlike Morton's order it never jumps: neighbours on the curve are neighbours in the plane, so no walk from one to the
 * other is long. (One long walk in a launch on a GPU is waited for by everything.) A part: the bits of the place below
 * `from` and not below `to` of each coordinate, which afterwards are as the rest of the place needs them. */
CADT_FN cadt_u32 cadt_hilbert_part(cadt_u32* x, cadt_u32* y, cadt_u32 from, cadt_u32 to) {
  cadt_u32 place = 0u;
  for (cadt_u32 b = from; b-- > to;) {
    const cadt_u32 qx = (*x >> b) & 1u, qy = (*y >> b) & 1u;
    place = (place << 2) | ((3u * qx) ^ qy);
    if (!qy) { /* the two lower quadrants are transposed, the last one is also turned round */
      const cadt_u32 turn = 0u - qx, t = *x ^ turn;
      *x = *y ^ turn;
      *y = t;
    }
  }
  return place;
}
CADT_FN cadt_u32 cadt_hilbert(cadt_u32 x, cadt_u32 y, cadt_u32 bits) { return cadt_hilbert_part(&x, &y, bits, 0u); }

/* The grid of the sort keys: 2^bits_x x 2^bits_y square cells. Coordinates are halved first: the width of the box may
 * exceed the largest double. */
typedef struct {
  cadt_real half_min_x, half_min_y, scale;
  cadt_u32 bits_x, bits_y;
  cadt_u32 set; /* squares of sets one after another (batch.dev.h); else 0 */
} cadt_key_grid;

#define CADT_GRID_PARAMETERS \
  cadt_real half_min_x, cadt_real half_min_y, cadt_real grid_scale, cadt_u32 bits_x, cadt_u32 bits_y
#define CADT_GRID_VIEW(grid)    \
  cadt_key_grid grid;           \
  grid.half_min_x = half_min_x; \
  grid.half_min_y = half_min_y; \
  grid.scale = grid_scale;      \
  grid.bits_x = bits_x;         \
  grid.bits_y = bits_y;         \
  grid.set = 0u

/* A point in units of cells, and with the last cell of each axis closed to the right. */
CADT_FN cadt_point cadt_to_grid(const cadt_key_grid* grid, cadt_point p) {
  cadt_point f;
  f.x = (0.5 * p.x - grid->half_min_x) * grid->scale;
  f.y = (0.5 * p.y - grid->half_min_y) * grid->scale;
  return f;
}
/* The last cell of an axis with so many bits. A float may round it up, out of the grid: then the last below that is
 * one.
 */
CADT_FN cadt_real cadt_last_cell(cadt_u32 bits) {
  cadt_u32 cell = (1u << bits) - 1u;
#if CADT_FLOAT
  cell &= ~(cell >> (CADT_MANTISSA_BITS + 1));
#endif
  return CADT_CAST(cadt_real, cell);
}
CADT_FN cadt_point cadt_clamp_to_grid(const cadt_key_grid* grid, cadt_point f) {
  const cadt_real limit_x = cadt_last_cell(grid->bits_x), limit_y = cadt_last_cell(grid->bits_y);
  /* half of the least coordinate may have been rounded up */
  f.x = f.x < 0.0 ? 0.0 : (f.x < limit_x ? f.x : limit_x);
  f.y = f.y < 0.0 ? 0.0 : (f.y < limit_y ? f.y : limit_y);
  return f;
}

/* Bits of the axis that has fewer: levels of squares below the top ones. */
CADT_FN cadt_u32 cadt_grid_levels(const cadt_key_grid* grid) {
  return grid->bits_x < grid->bits_y ? grid->bits_x : grid->bits_y;
}

/* Hilbert key of a square cell of a level: 0 the largest squares, cadt_grid_levels the cells of the grid. The longer
 * axis has more bits; its surplus goes on top, so a long box is a row of squares, each entered where the one before is
 * left. So are the boxes of sets, which are squares. The key of a cell begins with that of each larger cell around
 * it. */
CADT_FN cadt_u32 cadt_cell_key(const cadt_key_grid* grid, cadt_u32 x, cadt_u32 y, cadt_u32 level) {
  const cadt_u32 mask = (1u << level) - 1u;
  const cadt_u32 along = grid->bits_x >= grid->bits_y ? x : y, across = grid->bits_x >= grid->bits_y ? y : x;
  const cadt_u32 low = cadt_hilbert(along & mask, across & mask, level);
  return level == 16u ? low : ((((along >> level) + grid->set) << (2u * level)) | low);
}

/* The same with up to 31 bits an axis: in two parts, since a part has 32 bits. */
CADT_FN cadt_u64 cadt_fine_key(const cadt_key_grid* grid, cadt_u32 x, cadt_u32 y, cadt_u32 level) {
  const cadt_u32 mask = (1u << level) - 1u, fine = level > 16u ? level - 16u : 0u;
  const cadt_u32 longer = grid->bits_x >= grid->bits_y ? 1u : 0u, along = longer ? x : y;
  cadt_u32 a = along & mask, b = (longer ? y : x) & mask;
  const cadt_u64 high = cadt_hilbert_part(&a, &b, level, fine), low = cadt_hilbert_part(&a, &b, fine, 0u);
  return (CADT_CAST(cadt_u64, (along >> level) + grid->set) << (2u * level)) | (high << (2u * fine)) | low;
}

/* Sort keys of one word, or of two where cells would be crowded: `low_bits` of each are in the low one. */
typedef struct {
  CADT_GLOBAL const cadt_u32* high;
  CADT_GLOBAL const cadt_u32* low; /* or null */
  cadt_u32 low_bits;
} cadt_keys;

CADT_FN cadt_keys cadt_keys_of(CADT_GLOBAL const cadt_u32* high, CADT_GLOBAL const cadt_u32* low, cadt_u32 low_bits) {
  cadt_keys keys;
  keys.high = high;
  keys.low = low;
  keys.low_bits = low_bits;
  return keys;
}
CADT_FN cadt_u64 cadt_key_at(const cadt_keys* keys, cadt_u32 i) {
  const cadt_u64 high = keys->high[i];
  return keys->low ? (high << keys->low_bits) | keys->low[i] : high;
}

#if CADT_CONTIGUOUS
/* cadt_cell_key for some cells side by side, for compilers that make vector operations of the loops over them. The
 * steps are those of cadt_hilbert by masks: a branch would be wrong half of the time. */
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

/* Keys of two words. */
CADT_KERNEL(cadt_fine_hilbert_keys, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL cadt_u32* high,
            CADT_GLOBAL cadt_u32* low, cadt_u32 low_bits, cadt_u32 count, cadt_u32 grain, CADT_GRID_PARAMETERS) {
  CADT_GRID_VIEW(grid);
  const cadt_u32 levels = cadt_grid_levels(&grid);
  CADT_FOR(i, count, grain) {
    const cadt_point f = cadt_clamp_to_grid(&grid, cadt_to_grid(&grid, points[i]));
    const cadt_u64 key = cadt_fine_key(&grid, CADT_CAST(cadt_u32, f.x), CADT_CAST(cadt_u32, f.y), levels);
    high[i] = CADT_CAST(cadt_u32, key >> low_bits);
    low[i] = CADT_CAST(cadt_u32, key) & ((1u << low_bits) - 1u);
  }
}

/* Points in sorted order. */
CADT_KERNEL(cadt_gather_points, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* order,
            CADT_GLOBAL cadt_point* sorted, cadt_u32 count, cadt_u32 grain, cadt_real scale, cadt_real scale_again) {
  CADT_FOR(i, count, grain) { sorted[i] = cadt_multiplied_point(points[order[i]], scale, scale_again); }
}

CADT_FN cadt_u32 cadt_lexicographic(cadt_point a, cadt_u32 i, cadt_point b, cadt_u32 j) {
  if (!cadt_same(a.x, b.x)) return cadt_less(a.x, b.x) ? 1u : 0u;
  if (!cadt_same(a.y, b.y)) return cadt_less(a.y, b.y) ? 1u : 0u;
  return i < j ? 1u : 0u;
}

/* Sorts each run of at most CADT_RUN equal keys lexicographically, equal points by index. Longer runs are left as they
 * are, and totals[CADT_OVERFULL] becomes 1; after refinement (key_refinement.dev.h) they are equal points in order of
 * their indices. */
CADT_KERNEL(cadt_sort_runs, CADT_GLOBAL const cadt_u32* keys, CADT_GLOBAL cadt_point* sorted,
            CADT_GLOBAL cadt_u32* order, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* totals) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 key = keys[i];
    if ((i > 0u && keys[i - 1u] == key) || i + 1u >= count || keys[i + 1u] != key) continue;
    cadt_u32 end = i + 2u;
    while (end < count && end <= i + CADT_RUN && keys[end] == key) ++end;
    if (end > i + CADT_RUN) {
      cadt_store_relaxed(totals + CADT_OVERFULL, 1u);
      continue;
    }
    for (cadt_u32 a = i + 1u; a < end; ++a) {
      const cadt_point p = sorted[a];
      const cadt_u32 id = order[a];
      cadt_u32 b = a;
      for (; b > i && cadt_lexicographic(p, id, sorted[b - 1u], order[b - 1u]); --b) {
        sorted[b] = sorted[b - 1u];
        order[b] = order[b - 1u];
      }
      sorted[b] = p;
      order[b] = id;
    }
  }
}

/* Whether points spread over all are on one side of the line from point i to the next, as far as rounded numbers tell:
 * few points that are not on the hull have that. */
CADT_FN cadt_u32 cadt_seems_on_hull(CADT_GLOBAL const cadt_point* sorted, cadt_u32 count, cadt_u32 i) {
  if (i + 1u >= count) return 0u;
  const cadt_point a = sorted[i], b = sorted[i + 1u];
  const cadt_real x = b.x - a.x, y = b.y - a.y;
  const cadt_u32 step = count / CADT_HULL_PROBES;
  cadt_u32 left = 0u, right = 0u, at = i + step / 2u;
  for (cadt_u32 k = 0u; k < CADT_CAST(cadt_u32, CADT_HULL_PROBES); ++k, at += step) {
    const cadt_point q = sorted[at % count];
    const cadt_real side = x * (q.y - a.y) - y * (q.x - a.x);
    left |= side > 0.0 ? 1u : 0u;
    right |= side < 0.0 ? 1u : 0u;
  }
  return left ^ right;
}

/* What four points one after the other are as far as rounded numbers can tell: CADT_SHAPE_LINE, on a line; on a circle,
 * CADT_SHAPE_MIRRORED if a cheap test does as along an axis, else CADT_SHAPE_CIRCLE; or CADT_NONE. */
CADT_FN cadt_u32 cadt_shape_of(CADT_GLOBAL const cadt_point* p) {
  cadt_real most;
  for (cadt_u32 k = 0u; k < 3u; ++k)
    if (cadt_same(p[k].x, p[k + 1u].x) && cadt_same(p[k].y, p[k + 1u].y)) return CADT_NONE;
  if (cadt_incircle_filter(p[0], p[1], p[2], p[3], &most) != 0) return CADT_NONE;
  if (cadt_orientation_filter(p[0], p[1], p[2]) == CADT_UNSURE &&
      cadt_orientation_filter(p[1], p[2], p[3]) == CADT_UNSURE)
    return CADT_SHAPE_LINE;
  return cadt_mirrored(p[0], p[1], p[2], p[3]) ? CADT_SHAPE_MIRRORED : CADT_SHAPE_CIRCLE;
}

/* Counts in `totals` what point i of a sample is (CADT_SHAPE_...): beside the line through two points for certain; on a
 * circle with three others far away, as far as rounded numbers can tell; on the hull; and with `neighbours`, what it is
 * with the next three. */
CADT_FN void cadt_count_shapes(CADT_GLOBAL const cadt_point* sorted, cadt_u32 count, cadt_u32 i, cadt_u32 neighbours,
                               CADT_GLOBAL cadt_u32* totals) {
  const cadt_u32 far = count / 4u;
  const cadt_i32 side = cadt_orientation_filter(sorted[0], sorted[count / 2u], sorted[i]);
  cadt_real most;
  if (side == 1 || side == -1) cadt_store_relaxed(totals + CADT_SHAPE_BESIDE, 1u);
  if (cadt_incircle_filter(sorted[(i + far) % count], sorted[(i + 2u * far) % count], sorted[(i + 3u * far) % count],
                           sorted[i], &most) == 0)
    cadt_add_relaxed(totals + CADT_SHAPE_ONE_CIRCLE, 1u);
  if (cadt_seems_on_hull(sorted, count, i)) cadt_add_relaxed(totals + CADT_SHAPE_HULL, 1u);
  if (neighbours && i + 3u < count) {
    const cadt_u32 shape = cadt_shape_of(sorted + i);
    if (shape != CADT_NONE) cadt_add_relaxed(totals + shape, 1u);
  }
}

/* 1 where a point differs from the one before; equal points of different sets have different keys. totals[CADT_EQUAL]
 * counts the others, and behind it is what a sample is like: CADT_SHAPE_BESIDE is positive if one is, the others are
 * counted. The sample needs many registers, but most work-items only compare: as many as fit run at the same time.
 * \pre totals are 0 */
CADT_TEAM_KERNEL(128, 12, cadt_unique_flags, CADT_GLOBAL const cadt_point* sorted, CADT_GLOBAL const cadt_u32* keys,
                 CADT_GLOBAL cadt_u32* flags, cadt_u32 count, cadt_u32 grain, cadt_u32 neighbours,
                 CADT_GLOBAL cadt_u32* totals) {
  const cadt_u32 samples = cadt_min_u32(count, CADT_POINT_SAMPLES);
  cadt_u32 sum = 0u;
  for (cadt_u32 s = cadt_item; s < samples; s += cadt_items)
    cadt_count_shapes(sorted, count, s * (count / samples), neighbours, totals);
  CADT_FOR(i, count, grain) {
    const cadt_u32 flag = i == 0u || keys[i] != keys[i - 1u] || !cadt_same(sorted[i].x, sorted[i - 1u].x) ||
                                  !cadt_same(sorted[i].y, sorted[i - 1u].y)
                              ? 1u
                              : 0u;
    flags[i] = flag;
    sum += 1u - flag;
  }
  if (sum) cadt_add_relaxed(totals + CADT_EQUAL, sum);
}

/* Distinct points closed up. `ranks` is the exclusive scan of the flags. */
CADT_KERNEL(cadt_unique_pack, CADT_GLOBAL const cadt_point* sorted, CADT_GLOBAL const cadt_u32* order,
            CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL cadt_point* points, CADT_GLOBAL cadt_u32* input_ids,
            cadt_u32 count, cadt_u32 distinct, cadt_u32 grain) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 rank = ranks[i], next = i + 1u < count ? ranks[i + 1u] : distinct;
    if (next == rank) continue;
    points[rank] = sorted[i];
    input_ids[rank] = order[i];
  }
}

/* Every point that is not the first of its kind, and the one that is. */
CADT_KERNEL(cadt_duplicate_pairs, CADT_GLOBAL const cadt_u32* order, CADT_GLOBAL const cadt_u32* ranks,
            CADT_GLOBAL const cadt_u32* input_ids, CADT_GLOBAL cadt_u32* duplicates,
            CADT_GLOBAL cadt_u32* representatives, cadt_u32 count, cadt_u32 distinct, cadt_u32 grain) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 rank = ranks[i], next = i + 1u < count ? ranks[i + 1u] : distinct;
    if (next != rank) continue;
    const cadt_u32 at = i - rank; /* so many duplicates come before */
    duplicates[at] = order[i];
    representatives[at] = input_ids[rank - 1u];
  }
}

#endif
