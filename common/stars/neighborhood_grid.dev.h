/* SPDX-License-Identifier: Apache-2.0
 *
 * The neighbourhood grid: the points of a tile and of a halo around it in the memory of a team, sorted into a small
 * grid of cells with a few points each. It consists of squares of the key grid, so its points are a few intervals of
 * positions (spans), and no other point lies in it.
 *
 *   +-----+-----+-----+-----+-----+-----+
 *   |     .     .     .     .     .     |    1 square of the quadtree =
 *   +  .  +-----+-----+-----+-----+  .  +      1 x 1 to 8 x 8 cells
 *   |     |     .     .     .     |     |
 *   +  .  + . . + . . + . . + . . +  .  +    tile: 4 x 4 squares, one span
 *   |     |     .  t  .  i  .     |     |      of positions
 *   +  .  + . . + . . + . . + . . +  .  +
 *   |     |     .  l  .  e  .     |     |    halo: a rim of 1 or 2 squares on
 *   +  .  + . . + . . + . . + . . +  .  +      each side, a span each
 *   |     |     .     .     .     |     |
 *   +  .  +-----+-----+-----+-----+  .  +    a star of the tile is proven if its
 *   |     .     .  h  a  l  o     .     |      circles stay within the cells that
 *   +-----+-----+-----+-----+-----+-----+      were searched
 */
#ifndef CADT_STARS_NEIGHBORHOOD_GRID_H
#define CADT_STARS_NEIGHBORHOOD_GRID_H

#include "common/stars/tiles.dev.h"

enum {
  CADT_NEIGHBORHOOD_POINTS = 1600, /* below 2^11: stars keep places in eleven bits */
  CADT_NEIGHBORHOOD_CELLS = 24 * 24,
  CADT_NEIGHBORHOOD_SPANS = 64,
  CADT_NEIGHBORHOOD_PARTS = 32, /* parts in which the sizes of the cells are scanned */
  CADT_TILE_SIDE = 16,
  CADT_CANDIDATES = 16,
  CADT_SCAN_POINTS = 2, /* points of a step (cell_scan.dev.h): they share its overhead */
  CADT_FEW_CELLS =
      20, /* cells searched for candidates at first: few stars need more, and all lanes would wait for those */
  CADT_STAR_PLACES = 2 * 16 * 128 /* twice CADT_CANDIDATES for each of CADT_STAR_LANES */
};

/* The shape of a neighbourhood grid: the same for all lanes. */
typedef struct {
  cadt_u32 begin, end;         /* positions of the tile */
  cadt_u32 squares, rim;       /* squares along the grid; of these on each side of the tile */
  cadt_i32 square_x, square_y; /* the lower left square, in squares of its level */
  cadt_u32 square_level;
  cadt_u32 side, halo, tile_side;    /* cells along the grid, along the halo on one side, along the tile */
  cadt_i32 left, right, bottom, top; /* first cell that can have points, and behind the last */
  double origin_x, origin_y, cells;  /* in units of the key grid: lower left corner; cells per unit */
} cadt_neighborhood_shape;

typedef struct {
  /* In cells, from the centre of the grid. A scan reads beyond the last point (cell_scan.dev.h). */
  float x[CADT_NEIGHBORHOOD_POINTS + CADT_SCAN_POINTS], y[CADT_NEIGHBORHOOD_POINTS + CADT_SCAN_POINTS];
  cadt_u32 at[CADT_NEIGHBORHOOD_POINTS];       /* positions in sorted order */
  cadt_u32 cells[CADT_NEIGHBORHOOD_CELLS + 1]; /* first place of each cell, once sorted */
  cadt_u32 first[CADT_NEIGHBORHOOD_SPANS], offset[CADT_NEIGHBORHOOD_SPANS + 1], parts[CADT_NEIGHBORHOOD_PARTS];
  cadt_u32 rows[CADT_TILE_SIDE + 1]; /* points of the tile before each row of its cells */
  cadt_u16 star[CADT_STAR_PLACES];   /* the star that each lane works on (local_star.dev.h) */
  cadt_neighborhood_shape shape;
  cadt_u32 again_count, unproven, overfull;  /* overfull: stars with too many candidates */
  cadt_u32 verdict;                          /* of the sample (tile_stars.dev.h) */
  cadt_u32 pool_begin, pool_size, pool_used; /* of the words for the stars of the tile (tile_stars.dev.h) */
  cadt_u16 again[CADT_TILE_POINTS];          /* numbers in the tile of the points that are tried again */
} cadt_neighborhood;

/* Stride between the places of a lane's star. */
#define CADT_STAR_STRIDE (CADT_GROUP_SUMS ? CADT_CAST(cadt_u32, CADT_STAR_LANES) : 1u)

/* Behind the last cell that can have points along an axis of the key grid, `cells` per unit. `most`: the largest
 * coordinate. */
CADT_FN cadt_i32 cadt_edge_of_points(double most, double cells, cadt_u32 bits) {
  const double last = CADT_CAST(double, 1u << bits) * cells - 1.0, edge = most * cells;
  return CADT_CAST(cadt_i32, edge < last ? edge : last) + 1;
}

/* The shape for a tile. `most`: the largest coordinates of all points, in units of the key grid. */
CADT_FN cadt_neighborhood_shape cadt_shape_of_neighborhood(const cadt_key_grid* grid, const cadt_point most,
                                                           CADT_GLOBAL const cadt_point* points, const cadt_tile tile,
                                                           cadt_u32 end) {
  cadt_neighborhood_shape s;
  const cadt_u32 levels = cadt_grid_levels(grid), level = CADT_CAST(cadt_u32, tile.level);
  const cadt_u32 count = end - tile.begin, finer = cadt_min_u32(levels - level, 2u);
  const cadt_point f = cadt_clamp_to_grid(grid, cadt_to_grid(grid, points[tile.begin]));
  const cadt_u32 down = levels - level - finer; /* levels from the squares down to the cells of the key grid */
  s.begin = tile.begin;
  s.end = end;
  s.tile_side = finer < 2u ? 8u : (count > 256u ? 16u : (count > 60u ? 8u : 4u));
  s.rim = finer == 2u && s.tile_side < 16u ? 2u : 1u;
  s.squares = (1u << finer) + 2u * s.rim;
  s.square_level = level + finer;
  s.square_x =
      CADT_CAST(cadt_i32, (CADT_CAST(cadt_u32, f.x) >> (levels - level)) << finer) - CADT_CAST(cadt_i32, s.rim);
  s.square_y =
      CADT_CAST(cadt_i32, (CADT_CAST(cadt_u32, f.y) >> (levels - level)) << finer) - CADT_CAST(cadt_i32, s.rim);
  const cadt_i32 of_square = CADT_CAST(cadt_i32, s.tile_side >> finer);
  s.halo = s.rim * (s.tile_side >> finer);
  s.side = s.tile_side + 2u * s.halo;
  s.left = -s.square_x * of_square;
  s.bottom = -s.square_y * of_square;
  s.origin_x = CADT_CAST(double, s.square_x) * CADT_CAST(double, 1u << down);
  s.origin_y = CADT_CAST(double, s.square_y) * CADT_CAST(double, 1u << down);
  s.cells = CADT_CAST(double, of_square) / CADT_CAST(double, 1u << down);
  s.right = s.left + cadt_edge_of_points(most.x, s.cells, grid->bits_x);
  s.top = s.bottom + cadt_edge_of_points(most.y, s.cells, grid->bits_y);
  return s;
}

/* First position whose key, shifted by `shift`, is not less than `square`. */
CADT_FN cadt_u32 cadt_begin_of_square(const cadt_keys* keys, cadt_u32 n, cadt_u64 square, cadt_u32 shift) {
  cadt_u32 low = 0u, high = n;
  CADT_FIND_FIRST(low, high, middle, cadt_key_at(keys, middle) >> shift < square);
  return low;
}

/* Position of point j of the grid before it is sorted into cells. */
CADT_FN cadt_u32 cadt_position_in_neighborhood(CADT_TEAM_PTR const cadt_neighborhood* w, cadt_u32 ranges, cadt_u32 j) {
  cadt_u32 low = 0u, high = ranges; /* the span is in [low, high) */
  CADT_FIND_LAST(low, high, middle, w->offset[middle] <= j);
  return w->first[low] + (j - w->offset[low]);
}

/* The cell of a coordinate, in units of the key grid, along one axis. Rounding must not carry it out of the
 * neighbourhood grid, nor beyond the edge of the key grid: stars rely on there being nothing. */
CADT_FN cadt_u32 cadt_cell_along(double f, double origin, double cells, cadt_u32 side, cadt_i32 edge) {
  const cadt_u32 last = edge < CADT_CAST(cadt_i32, side) ? CADT_CAST(cadt_u32, edge) - 1u : side - 1u;
  return cadt_min_u32(CADT_CAST(cadt_u32, ((f < 0.0 ? 0.0 : f) - origin) * cells), last);
}

CADT_FN cadt_u32 cadt_cell_in_neighborhood(const cadt_neighborhood_shape* s, cadt_point f) {
  return cadt_cell_along(f.y, s->origin_y, s->cells, s->side, s->top) * s->side +
         cadt_cell_along(f.x, s->origin_x, s->cells, s->side, s->right);
}

/* Whether the grid may hold points from outside of a clipped key grid: those are in the cells at its edge. */
CADT_FN cadt_u32 cadt_at_edge(const cadt_neighborhood_shape* s, cadt_i32 squares_x, cadt_i32 squares_y) {
  const cadt_i32 squares = CADT_CAST(cadt_i32, s->squares);
  return s->square_x < 1 || s->square_y < 1 || s->square_x + squares >= squares_x || s->square_y + squares >= squares_y
             ? 1u
             : 0u;
}

/* Loads the points. Returns 0 if there are too many, or if the key grid is clipped and this one lies at its edge; the
 * same for all lanes. */
CADT_FN cadt_u32 cadt_load_neighborhood(CADT_TEAM_PTR cadt_neighborhood* w, const cadt_neighborhood_shape* s,
                                        const cadt_key_grid* grid, CADT_GLOBAL const cadt_point* points,
                                        const cadt_keys* keys, cadt_u32 n, cadt_u32 clipped) {
  const cadt_u32 ranges = s->squares * s->squares, levels = cadt_grid_levels(grid);
  const cadt_u32 shift = 2u * (levels - s->square_level), cells = s->side * s->side;
  const cadt_i32 squares_x = CADT_CAST(cadt_i32, 1u << (grid->bits_x - (levels - s->square_level)));
  const cadt_i32 squares_y = CADT_CAST(cadt_i32, 1u << (grid->bits_y - (levels - s->square_level)));
  if (clipped && cadt_at_edge(s, squares_x, squares_y)) return 0u;
  CADT_TEAM_FOR(r, ranges) {
    const cadt_u32 column = r % s->squares, row = r / s->squares;
    const cadt_i32 x = s->square_x + CADT_CAST(cadt_i32, column), y = s->square_y + CADT_CAST(cadt_i32, row);
    cadt_u32 first = 0u, size = 0u;
    if (column >= s->rim && column + s->rim < s->squares && row >= s->rim && row + s->rim < s->squares) {
      if (column == s->rim && row == s->rim) first = s->begin, size = s->end - s->begin; /* the whole tile */
    } else if (x >= 0 && x < squares_x && y >= 0 && y < squares_y) {
      const cadt_u64 square = cadt_fine_key(grid, CADT_CAST(cadt_u32, x), CADT_CAST(cadt_u32, y), s->square_level);
      first = cadt_begin_of_square(keys, n, square, shift);
      size = cadt_begin_of_square(keys, n, square + 1u, shift) - first;
    }
    w->first[r] = first;
    w->offset[r] = size;
  }
  CADT_TEAM_FOR(c, cells + 1u) { w->cells[c] = 0u; }
  CADT_TEAM_SYNC();
  if (cadt_team_lane == 0u) {
    cadt_u64 sum = 0u;
    for (cadt_u32 r = 0u; r < ranges; ++r) {
      const cadt_u32 size = w->offset[r];
      w->offset[r] = CADT_CAST(cadt_u32, sum);
      sum += size;
      if (sum > CADT_NEIGHBORHOOD_POINTS) sum = CADT_NEIGHBORHOOD_POINTS + 1u;
    }
    w->offset[ranges] = CADT_CAST(cadt_u32, sum);
    w->again_count = w->unproven = w->overfull = 0u;
  }
  CADT_TEAM_SYNC();
  const cadt_u32 total = w->offset[ranges];
  if (total > CADT_CAST(cadt_u32, CADT_NEIGHBORHOOD_POINTS) ||
      s->end - s->begin > CADT_CAST(cadt_u32, CADT_TILE_POINTS))
    return 0u;
  CADT_TEAM_FOR(j, total) {
    const cadt_point f = cadt_to_grid(grid, points[cadt_position_in_neighborhood(w, ranges, j)]);
    cadt_team_add(&w->cells[1u + cadt_cell_in_neighborhood(s, f)], 1u);
  }
  CADT_TEAM_SYNC();
  /* cells[1 + c] turns from the size of cell c into its first place; as points are placed, it becomes the place behind
   * the last, which is the first of cell c + 1 */
  const cadt_u32 of_part = (cells - 1u) / CADT_NEIGHBORHOOD_PARTS + 1u;
  CADT_TEAM_FOR(part, CADT_CAST(cadt_u32, CADT_NEIGHBORHOOD_PARTS)) {
    cadt_u32 sum = 0u;
    for (cadt_u32 c = part * of_part; c < cadt_min_u32((part + 1u) * of_part, cells); ++c) sum += w->cells[1u + c];
    w->parts[part] = sum;
  }
  CADT_TEAM_SYNC();
  if (cadt_team_lane == 0u) {
    cadt_u32 sum = 0u;
    for (cadt_u32 part = 0u; part < CADT_CAST(cadt_u32, CADT_NEIGHBORHOOD_PARTS); ++part) {
      const cadt_u32 size = w->parts[part];
      w->parts[part] = sum;
      sum += size;
    }
  }
  CADT_TEAM_SYNC();
  CADT_TEAM_FOR(part, CADT_CAST(cadt_u32, CADT_NEIGHBORHOOD_PARTS)) {
    cadt_u32 sum = w->parts[part];
    for (cadt_u32 c = part * of_part; c < cadt_min_u32((part + 1u) * of_part, cells); ++c) {
      const cadt_u32 size = w->cells[1u + c];
      w->cells[1u + c] = sum;
      sum += size;
    }
  }
  CADT_TEAM_SYNC();
  const double middle = 0.5 * CADT_CAST(double, s->side);
  CADT_TEAM_FOR(j, total) {
    const cadt_u32 i = cadt_position_in_neighborhood(w, ranges, j);
    const cadt_point f = cadt_to_grid(grid, points[i]);
    const cadt_u32 place = cadt_team_add(&w->cells[1u + cadt_cell_in_neighborhood(s, f)], 1u);
    w->x[place] = CADT_CAST(float, (f.x - s->origin_x) * s->cells - middle);
    w->y[place] = CADT_CAST(float, (f.y - s->origin_y) * s->cells - middle);
    w->at[place] = i;
  }
  /* what the last step reads beyond the last point */
  CADT_TEAM_FOR(k, CADT_CAST(cadt_u32, CADT_SCAN_POINTS)) w->x[total + k] = w->y[total + k] = 0.0f;
  CADT_TEAM_SYNC();
  if (cadt_team_lane == 0u) {
    cadt_u32 sum = 0u;
    for (cadt_u32 row = 0u; row < s->tile_side; ++row) {
      const cadt_u32 c = (s->halo + row) * s->side + s->halo;
      w->rows[row] = sum;
      sum += w->cells[c + s->tile_side] - w->cells[c];
    }
    w->rows[s->tile_side] = sum;
  }
  CADT_TEAM_SYNC();
  return 1u;
}

#endif
