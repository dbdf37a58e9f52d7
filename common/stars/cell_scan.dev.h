/* SPDX-License-Identifier: Apache-2.0
 *
 * Scan of the points in a rectangle of cells of a neighbourhood grid.
 */
#ifndef CADT_STARS_CELL_SCAN_H
#define CADT_STARS_CELL_SCAN_H

#include "common/stars/neighborhood_grid.dev.h"

/* The points of a rectangle of cells, row by row, in a single loop: lanes whose rows are short do not wait for the
 * others. A step has CADT_SCAN_POINTS places; those from `end` on are not in the row, and in a row without points none
 * is. */
typedef struct {
  cadt_u32 place, end; /* first place of the step; end of the row */
  cadt_u32 cell, last, width, side;
} cadt_cell_scan;

CADT_FN cadt_cell_scan cadt_cell_scan_of(CADT_TEAM_PTR const cadt_neighborhood* w, cadt_u32 left, cadt_u32 bottom,
                                         cadt_u32 right, cadt_u32 top) {
  cadt_cell_scan s;
  s.side = *CADT_CAST(volatile CADT_TEAM_PTR const cadt_u32*, &w->shape.side);
  s.cell = bottom * s.side + left;
  s.last = top * s.side + left;
  s.width = right - left + 1u;
  s.place = w->cells[s.cell];
  s.end = w->cells[s.cell + s.width];
  return s;
}

CADT_FN cadt_cell_scan cadt_scan_around(CADT_TEAM_PTR const cadt_neighborhood* w, cadt_u32 x, cadt_u32 y,
                                        cadt_u32 reach) {
  return cadt_cell_scan_of(w, x - reach, y - reach, x + reach, y + reach);
}

/* Advances to the next step; returns 0 if there is none. */
CADT_FN cadt_u32 cadt_cell_scan_next(CADT_TEAM_PTR const cadt_neighborhood* w, cadt_cell_scan* s) {
  s->place += CADT_CAST(cadt_u32, CADT_SCAN_POINTS);
  const cadt_u32 over = s->place >= s->end ? 1u : 0u, more = !over || s->cell != s->last ? 1u : 0u;
  if (over && more) {
    s->cell += s->side;
    s->place = w->cells[s->cell];
    s->end = w->cells[s->cell + s->width];
  }
  return more;
}

#endif
