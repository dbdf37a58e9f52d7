/* SPDX-License-Identifier: Apache-2.0
 *
 * From the mesh to a grid of cells, by triangles: each writes the cells whose centres it contains. A centre on an edge
 * or on a vertex belongs to the lowest triangle there, as in cadt_locate_queries, so each cell is written by one
 * triangle and no two work-items meet. Centres are computed in one way everywhere, and all signs are exact.
 *
 *      +---+---+---+---+
 *      |   |   | /.|   |     A small triangle goes through the cells of its bounding box. A large one is listed, and a
 *      +---+---+/--\---+     work-item takes one row of it: the cells between the two edges that the row meets, and one
 *      |   | /.| . |\  |     more on either side, since those ends are rounded.
 *      +---/---+---+-\-+
 *      | / | . | . | .\|
 *      +---+---+---+---+
 */
#ifndef CADT_QUERIES_RASTERIZE_H
#define CADT_QUERIES_RASTERIZE_H

#include "common/portable/atomics.dev.h"
#include "common/queries/interpolate.dev.h"

/* Cell (column i, row j) has its centre at x0 + (first_x + i + 0.5) dx, y0 + (first_y + j + 0.5) dy; the sums in
 * parentheses are exact. Kernels that draw take a raster that is scaled like the points: powers of two change no
 * rounding, so the centres are those of cadt_cell_centers, scaled.
 */
typedef struct {
  cadt_real x0, y0, dx, dy, first_x, first_y;
  cadt_u32 columns, rows;
} cadt_raster;
#define CADT_RASTER_PARAMETERS                                                                           \
  cadt_real raster_x0, cadt_real raster_y0, cadt_real raster_dx, cadt_real raster_dy, cadt_real first_x, \
      cadt_real first_y, cadt_u32 columns, cadt_u32 rows
#define CADT_RASTER(raster) \
  const cadt_raster raster = {raster_x0, raster_y0, raster_dx, raster_dy, first_x, first_y, columns, rows}

enum { CADT_RASTER_SMALL = 64 /* cells of a bounding box that its triangle's work-item goes through by itself */ };

CADT_FN cadt_real cadt_cell_x(const cadt_raster* r, cadt_u32 i) {
  return r->x0 + (CADT_CAST(cadt_real, i) + r->first_x + 0.5) * r->dx;
}
CADT_FN cadt_real cadt_cell_y(const cadt_raster* r, cadt_u32 j) {
  return r->y0 + (CADT_CAST(cadt_real, j) + r->first_y + 0.5) * r->dy;
}

/* The cells of an axis whose centres may lie between `low` and `high`, `first` to one before `end`: cell i has its
 * centre at origin + (before + i + 0.5) step. Rounding moves an end by less than `slack`. */
typedef struct {
  cadt_u32 first, end;
} cadt_cells;
CADT_FN cadt_u32 cadt_clamped_cell(cadt_real x, cadt_u32 count) {
  return x > 0.0 ? (x < CADT_CAST(cadt_real, count) ? CADT_CAST(cadt_u32, x) : count) : 0u;
}
CADT_FN cadt_cells cadt_cells_between(cadt_real origin, cadt_real step, cadt_real before, cadt_u32 count, cadt_real low,
                                      cadt_real high) {
#if CADT_WIDE /* the inverse of a subnormal number may overflow */
  const cadt_real start = origin / step + before, a = low / step - start, b = high / step - start;
#else
  const cadt_real inverse = 1.0 / step, start = origin * inverse + before, a = low * inverse - start,
                  b = high * inverse - start;
#endif
  const cadt_cells all = {0u, count};
  if (a - a != 0.0 || b - b != 0.0) return all; /* has overflowed: anywhere */
  const cadt_real from = a < b ? a : b, to = a < b ? b : a;
  cadt_real slack = 1e-14 * (cadt_fabs(start) + before + CADT_CAST(cadt_real, count));
#if CADT_WIDE /* a centre that is a subnormal number is rounded by half a step at most */
  slack += 1.0;
#endif
  const cadt_cells cells = {cadt_clamped_cell(from + 0.5 - slack, count), cadt_clamped_cell(to + 0.5 + slack, count)};
  return cells;
}

typedef struct {
  cadt_point a, b, c;
  cadt_real value_a, value_b, value_c;
  cadt_u32 triangle;
} cadt_drawn;

/* Whether the triangle is the lowest one that contains p. */
CADT_FN cadt_u32 cadt_owns(const cadt_query_mesh* m, CADT_GLOBAL const cadt_u32* lowest, const cadt_drawn* d,
                           cadt_point p) {
  const cadt_i32 s0 = cadt_side(d->b, d->c, p);
  if (s0 < 0) return 0u;
  const cadt_i32 s1 = cadt_side(d->c, d->a, p);
  if (s1 < 0) return 0u;
  const cadt_i32 s2 = cadt_side(d->a, d->b, p);
  if (s2 < 0) return 0u;
  if (s0 > 0 && s1 > 0 && s2 > 0) return 1u;
  const cadt_query_place at = {d->triangle, (s0 == 0 ? 1u : 0u) | (s1 == 0 ? 2u : 0u) | (s2 == 0 ? 4u : 0u), CADT_NONE};
  return cadt_lowest_at(m, lowest, &at) == d->triangle ? 1u : 0u;
}

/* Writes the cells `cells` of row j that belong to the triangle. */
CADT_FN void cadt_draw_row(const cadt_query_mesh* m, CADT_GLOBAL const cadt_u32* lowest, const cadt_raster* r,
                           const cadt_drawn* d, cadt_u32 j, cadt_cells cells, CADT_GLOBAL cadt_real* raster) {
  const cadt_real y = cadt_cell_y(r, j);
  for (cadt_u32 i = cells.first; i < cells.end; ++i) {
    const cadt_point p = {cadt_cell_x(r, i), y};
    if (!cadt_owns(m, lowest, d, p)) continue;
    cadt_u32 thin;
    const cadt_weights w = cadt_barycentric(d->a, d->b, d->c, p, &thin);
    raster[CADT_CAST(cadt_u64, j) * r->columns + i] = cadt_weighted_sum(&w, d->value_a, d->value_b, d->value_c);
  }
}

/* One after another, which compilers make without branches. */
CADT_FN cadt_real cadt_least(cadt_real a, cadt_real b, cadt_real c) {
  const cadt_real ab = a < b ? a : b;
  return ab < c ? ab : c;
}
CADT_FN cadt_real cadt_most(cadt_real a, cadt_real b, cadt_real c) {
  const cadt_real ab = a > b ? a : b;
  return ab > c ? ab : c;
}

/* `values`: of the points, or null if none are needed. */
CADT_FN cadt_drawn cadt_drawn_of(const cadt_query_mesh* m, cadt_u32 t, CADT_GLOBAL const cadt_real* values) {
  const cadt_u32 a = cadt_vertex_of(&m->view, t, 0u), b = cadt_vertex_of(&m->view, t, 1u),
                 c = cadt_vertex_of(&m->view, t, 2u);
  const cadt_drawn d = {cadt_mesh_point(m, a),
                        cadt_mesh_point(m, b),
                        cadt_mesh_point(m, c),
                        values ? values[a] : 0.0,
                        values ? values[b] : 0.0,
                        values ? values[c] : 0.0,
                        t};
  return d;
}
/* Whether one of the triangle's edges is longer than `most` (scaled). */
CADT_FN cadt_u32 cadt_longer_than(const cadt_drawn* d, cadt_real most) {
  return cadt_is_longer(d->a, d->b, most) || cadt_is_longer(d->b, d->c, most) || cadt_is_longer(d->c, d->a, most) ? 1u
                                                                                                                  : 0u;
}
CADT_FN cadt_cells cadt_rows_of(const cadt_raster* r, const cadt_drawn* d) {
  return cadt_cells_between(r->y0, r->dy, r->first_y, r->rows, cadt_least(d->a.y, d->b.y, d->c.y),
                            cadt_most(d->a.y, d->b.y, d->c.y));
}

/* Triangles whose bounding boxes are small write their cells; the others are listed in `large`, in any order. */
CADT_KERNEL(cadt_draw_small, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* lowest, CADT_RASTER_PARAMETERS,
            cadt_real max_edge, CADT_GLOBAL const cadt_real* values, CADT_GLOBAL cadt_real* cells,
            CADT_GLOBAL cadt_u32* large, CADT_GLOBAL cadt_u32* large_count, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_RASTER(raster);
  CADT_FOR(t, mesh.view.triangles, grain) {
    const cadt_drawn d = cadt_drawn_of(&mesh, t, values);
    if (max_edge < CADT_INFINITY && cadt_longer_than(&d, max_edge)) continue;
    const cadt_cells over = cadt_rows_of(&raster, &d);
    if (over.first >= over.end) continue;
    const cadt_cells along = cadt_cells_between(raster.x0, raster.dx, raster.first_x, raster.columns,
                                                cadt_least(d.a.x, d.b.x, d.c.x), cadt_most(d.a.x, d.b.x, d.c.x));
    if (along.first >= along.end) continue;
    if (CADT_CAST(cadt_u64, over.end - over.first) * (along.end - along.first) >
        CADT_CAST(cadt_u64, CADT_RASTER_SMALL)) {
      large[cadt_add_relaxed(large_count, 1u)] = t;
      continue;
    }
    for (cadt_u32 j = over.first; j < over.end; ++j) cadt_draw_row(&mesh, lowest, &raster, &d, j, along, cells);
  }
}

/* The number of rows of each listed triangle. rows_of[count] is 0. */
CADT_KERNEL(cadt_large_rows, CADT_QUERY_MESH_PARAMETERS, CADT_RASTER_PARAMETERS, CADT_GLOBAL const cadt_u32* large,
            CADT_GLOBAL cadt_u32* rows_of, cadt_u32 count, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_RASTER(raster);
  CADT_FOR(i, count, grain) {
    const cadt_drawn d = cadt_drawn_of(&mesh, large[i], 0);
    const cadt_cells over = cadt_rows_of(&raster, &d);
    rows_of[i] = over.end - over.first;
    if (i == 0u) rows_of[count] = 0u;
  }
}

/* The columns in which row y of the triangle may have cells: between the points where the lines a row above and below
 * it meet the edges. */
CADT_FN void cadt_meet_edge(cadt_point a, cadt_point b, cadt_real low_y, cadt_real high_y, cadt_real* low,
                            cadt_real* high) {
  const cadt_real below = a.y < b.y ? a.y : b.y, above = a.y < b.y ? b.y : a.y;
  if (below > high_y || above < low_y) return;
#if CADT_WIDE
  if (above - below == CADT_INFINITY) { /* has overflowed: anywhere */
    *low = -CADT_INFINITY;
    *high = CADT_INFINITY;
    return;
  }
#endif
  for (cadt_u32 side = 0u; side < 2u; ++side) {
    cadt_real along = above > below ? ((side ? high_y : low_y) - a.y) / (b.y - a.y) : (side ? 1.0 : 0.0);
    along = along > 0.0 ? (along < 1.0 ? along : 1.0) : 0.0;
    const cadt_real x = along < 1.0 ? a.x + along * (b.x - a.x) : b.x;
    const cadt_real rounding = 1e-15 * (cadt_fabs(a.x) + cadt_fabs(b.x)); /* of it, where cells are as small */
    *low = x - rounding < *low ? x - rounding : *low;
    *high = x + rounding > *high ? x + rounding : *high;
  }
}
CADT_FN cadt_cells cadt_span_of_row(const cadt_raster* r, const cadt_drawn* d, cadt_u32 j) {
  const cadt_real y = cadt_cell_y(r, j), dy = cadt_fabs(r->dy);
  const cadt_cells none = {0u, 0u};
  cadt_real low = CADT_INFINITY, high = -CADT_INFINITY;
  cadt_meet_edge(d->a, d->b, y - dy, y + dy, &low, &high);
  cadt_meet_edge(d->b, d->c, y - dy, y + dy, &low, &high);
  cadt_meet_edge(d->c, d->a, y - dy, y + dy, &low, &high);
  return low <= high ? cadt_cells_between(r->x0, r->dx, r->first_x, r->columns, low, high) : none;
}

/* One row of a listed triangle a work-item; `first_row`: scanned. */
CADT_KERNEL(cadt_draw_large, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* lowest, CADT_RASTER_PARAMETERS,
            CADT_GLOBAL const cadt_u32* large, CADT_GLOBAL const cadt_u32* first_row, cadt_u32 listed,
            CADT_GLOBAL const cadt_real* values, CADT_GLOBAL cadt_real* cells, cadt_u32 count, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_RASTER(raster);
  CADT_FOR(i, count, grain) {
    cadt_u32 at = 0u, end = listed;
    CADT_FIND_LAST(at, end, middle, first_row[middle] <= i)
    const cadt_drawn d = cadt_drawn_of(&mesh, large[at], values);
    const cadt_u32 j = cadt_rows_of(&raster, &d).first + (i - first_row[at]);
    cadt_draw_row(&mesh, lowest, &raster, &d, j, cadt_span_of_row(&raster, &d, j), cells);
  }
}

/* Every cell becomes NaN. */
CADT_KERNEL(cadt_clear_raster, CADT_GLOBAL cadt_real* cells, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(i, count, grain) { cells[i] = CADT_NAN; }
}

/* The centres of the cells from `first` on, row by row. */
CADT_KERNEL(cadt_cell_centers, CADT_RASTER_PARAMETERS, cadt_u32 first, CADT_GLOBAL cadt_point* centers, cadt_u32 count,
            cadt_u32 grain) {
  CADT_RASTER(raster);
  CADT_FOR(i, count, grain) {
    centers[i].x = cadt_cell_x(&raster, (first + i) % columns);
    centers[i].y = cadt_cell_y(&raster, (first + i) / columns);
  }
}

/* Cells whose triangle has an edge longer than `max_edge` become NaN. */
CADT_KERNEL(cadt_drop_long_edges, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* located, cadt_real max_edge,
            CADT_GLOBAL cadt_real* cells, cadt_u32 count, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_FOR(i, count, grain) {
    if (located[i] == CADT_NONE) continue;
    const cadt_drawn d = cadt_drawn_of(&mesh, located[i], 0);
    if (cadt_longer_than(&d, max_edge)) cells[i] = CADT_NAN;
  }
}

#endif
