/* SPDX-License-Identifier: Apache-2.0
 *
 * Bounding box of the points, the range of their exponents, and the first coordinate that is NaN or infinite. Each team
 * of work-items reduces its points to one row; cadt_merge_bounds reduces the rows.
 */
#ifndef CADT_POINTS_BOUNDS_H
#define CADT_POINTS_BOUNDS_H

#include "common/portable/layout.dev.h"
#include "common/portable/teams.dev.h"
#include "common/predicates/bigint.dev.h"

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

/* Adds point i; returns 0 if a coordinate is NaN or infinite. The exponents stay in `span` until cadt_bounds_close. */
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

/* Reduces the rows of all lanes of a team to one, in lanes[0]. All lanes call it. */
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

#if CADT_BUILDS(POINTS)
/* Partial results: a row for each team of work-items, as far as there is room. */
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

/* Reduces all rows to the first, and sets the CADT_ORDER_WORDS of `totals` to 0. One team runs it. */
CADT_KERNEL(cadt_merge_bounds, CADT_GLOBAL cadt_bounds_row* rows, cadt_u32 room, CADT_GLOBAL cadt_u32* totals) {
  CADT_TEAM_MEMORY cadt_bounds_row lanes[CADT_BOUNDS_LANES];
  const cadt_u32 count = cadt_item < cadt_team_lanes ? rows[0].rows : 0u; /* launches are rounded up to whole groups */
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
#endif

#endif
