/* SPDX-License-Identifier: Apache-2.0
 *
 * The stars of all tiles: where they are stored, in which order the tiles are processed, and when to stop early.
 */
#ifndef CADT_STARS_TILE_STARS_H
#define CADT_STARS_TILE_STARS_H

#include "common/stars/local_star.dev.h"

/* Where stars are stored: the star vertices of each vertex counterclockwise, and their number, 0 without a proven star.
 * With `begins`, the first word of each star, they are packed: the stars of a tile in a block of its own as far as they
 * fit, others from `overflow` on. Without `begins`, each vertex has CADT_STAR_DEGREE words. */
typedef struct {
  CADT_GLOBAL cadt_u32* star_vertices;
  CADT_GLOBAL cadt_u32* begins;
  CADT_GLOBAL cadt_u32* sizes;
  CADT_GLOBAL cadt_u32* overflowed; /* words used from `overflow` on */
  cadt_u32 overflow, room;
} cadt_star_pool;

/* First word of the block of tile t, whose first position is `begin`. */
CADT_FN cadt_u32 cadt_pool_of_tile(cadt_u32 t, cadt_u32 begin) {
  return CADT_STAR_LEAD + 6u * begin + begin / 8u + CADT_STAR_SPARE * t;
}

/* Returns the size, or 0 if there is no room. */
CADT_FN cadt_u32 cadt_store_star(const cadt_star_maker* m, cadt_u32 p, cadt_u32 size, const cadt_star_pool* pool) {
  const cadt_u32 vertex = m->w->at[p];
  cadt_u64 begin = CADT_STAR_DEGREE * CADT_CAST(cadt_u64, vertex);
  if (pool->begins) {
    const cadt_u32 place = cadt_team_add(&m->w->pool_used, size);
    cadt_u32 at = m->w->pool_begin + place;
    if (place + size > m->w->pool_size) {
      at = pool->overflow + cadt_add_relaxed(pool->overflowed, size);
      if (at + size > pool->room) return 0u;
    }
    pool->begins[vertex] = at;
    begin = at;
  }
  pool->sizes[vertex] = size;
  for (cadt_u32 k = 0u; k < size; ++k) pool->star_vertices[begin + k] = m->w->at[cadt_star_place(m, k)];
  return size;
}

/* The tile at `turn` in the order of processing: first a sample of `sample` tiles from everywhere, then the others. */
CADT_FN cadt_u32 cadt_tile_of_turn(cadt_u32 turn, cadt_u32 count, cadt_u32 sample) {
  if (!sample) return turn;
  const cadt_u32 step = count / sample, other = turn - sample; /* step: at least 2 */
  if (turn < sample) return turn * step;
  return other < sample * (step - 1u) ? other + other / (step - 1u) + 1u : turn;
}

/* The verdict of the sample on all tiles, available when nearly all of the sample is done. */
CADT_FN cadt_u32 cadt_verdict_of_sample(CADT_GLOBAL cadt_u32* counts, cadt_u32 sample) {
  if (!sample || 8u * cadt_load_relaxed(counts + CADT_STARS_SAMPLED_TILES) < 7u * sample) return 0u;
  const cadt_u32 points = cadt_load_relaxed(counts + CADT_STARS_SAMPLED_POINTS);
  const cadt_u32 unproven = cadt_load_relaxed(counts + CADT_STARS_SAMPLED_UNPROVEN);
  const cadt_u32 overfull = cadt_load_relaxed(counts + CADT_STARS_SAMPLED_OVERFULL);
  /* the host's limit (common/stars/mesh_from_stars.cpp) */
  return (3u * unproven > points ? CADT_CAST(cadt_u32, CADT_SAMPLE_FEW_PROVEN) : 0u) |
         (8u * overfull > points ? CADT_CAST(cadt_u32, CADT_SAMPLE_MANY) : 0u);
}

/* Whether to give up a tile: of its first `tried` points nearly all have failed. */
CADT_FN cadt_u32 cadt_tile_early_out(cadt_u32 tried, CADT_TEAM_PTR cadt_u32* failed) {
  return tried >= CADT_CAST(cadt_u32, CADT_STAR_LANES) && 16u * cadt_team_add(failed, 0u) > 15u * tried ? 1u : 0u;
}

/* Proves the stars of all tiles. With `sets`, the grid is that of the tile's set (batch.dev.h), and only batched sets
 * are processed. `sample`: so many tiles come first, 0 or at most half of all; what they need decides on room for
 * candidates, and, if `cautious`, on whether the other tiles are processed at all. A cautious team gives up a tile that
 * yields no stars. `counts`: CADT_STARS_... (layout.dev.h). \pre sizes are 0 */
CADT_TEAM_KERNEL(CADT_STAR_LANES, 7, cadt_prove_stars, CADT_GLOBAL const cadt_point* points,
                 CADT_GLOBAL const cadt_u32* high_keys, CADT_GLOBAL const cadt_u32* low_keys, cadt_u32 low_bits,
                 cadt_u32 n, CADT_GRID_PARAMETERS, double most_x, double most_y, cadt_u32 clipped,
                 CADT_GLOBAL const cadt_set* sets, CADT_GLOBAL const cadt_u32* states,
                 CADT_GLOBAL const cadt_tile* tiles, cadt_u32 tile_count, cadt_u32 sample, cadt_u32 cautious,
                 cadt_u32 grain, CADT_GLOBAL cadt_u32* star_vertices, CADT_GLOBAL cadt_u32* begins,
                 CADT_GLOBAL cadt_u32* sizes, cadt_u32 overflow, cadt_u32 room, CADT_GLOBAL cadt_u32* counts) {
  CADT_TEAM_MEMORY cadt_neighborhood near;
  CADT_GRID_VIEW(grid);
  const cadt_keys keys = cadt_keys_of(high_keys, low_keys, low_bits);
  cadt_point most = {most_x, most_y};
  CADT_DECLARE_COUNTERS(counters);
  const cadt_star_pool pool = {star_vertices, begins, sizes, counts + CADT_STARS_OVERFLOWED, overflow, room};
  CADT_FOR_TEAMS(turn, tile_count, grain) {
    const cadt_u32 t = cadt_tile_of_turn(turn, tile_count, sample);
    const cadt_tile tile = tiles[t];
    if (cadt_team_lane == 0u) near.verdict = turn < sample ? 0u : cadt_verdict_of_sample(counts, sample);
    CADT_TEAM_SYNC();
    const cadt_u32 many = near.verdict & CADT_SAMPLE_MANY;
    const cadt_u32 left = cautious ? near.verdict & CADT_SAMPLE_FEW_PROVEN : 0u;
    cadt_u32 wanted = left ? 0u : 1u;
    if (sets) {
      const cadt_u32 levels = cadt_grid_levels(&grid), set = high_keys[tile.begin] >> (2u * levels);
      grid = cadt_grid_of_set(sets, set, levels);
      most.x = sets[set].most_x;
      most.y = sets[set].most_y;
      if (states[set] != CADT_SET_BATCHED) wanted = 0u;
    }
    const cadt_neighborhood_shape shape = cadt_shape_of_neighborhood(&grid, most, points, tile, tiles[t + 1u].begin);
    cadt_star_maker maker = {&near, points, &counters, 0u};
    if (cadt_team_lane == 0u) {
      near.shape = shape; /* registers are scarce */
      near.pool_begin = cadt_pool_of_tile(t, shape.begin);
      near.pool_size = cadt_pool_of_tile(t + 1u, shape.end) - near.pool_begin;
      near.pool_used = 0u;
    }
    const cadt_u32 loaded = wanted ? cadt_load_neighborhood(&near, &shape, &grid, points, &keys, n, clipped) : 0u;
    const cadt_u32 own = loaded ? near.rows[shape.tile_side] : shape.end - shape.begin;
    if (loaded) {
      const cadt_u32 lanes = cadt_min_u32(cadt_team_lanes, CADT_STAR_LANES);
      for (cadt_u32 round = 0u; round < 2u; ++round) {
        const cadt_u32 count = round ? near.again_count : own;
        for (cadt_u32 i = cadt_team_lane; cadt_team_lane < lanes && i < count; i += lanes) {
          const cadt_u32 number = round ? near.again[i] : i;
          cadt_u32 row = 0u;
          while (number >= near.rows[row + 1u]) ++row;
          const cadt_u32 halo = near.shape.halo, tile_side = near.shape.tile_side, side = near.shape.side;
          const cadt_u32 y = halo + row, p = near.cells[y * side + halo] + (number - near.rows[row]);
          cadt_u32 x = CADT_CAST(cadt_u32, near.x[p] + 0.5f * CADT_CAST(float, side));
          x = x < halo ? halo : cadt_min_u32(x, halo + tile_side - 1u);
          /* a point of a neighbouring tile, rounded into this one's cells */
          if (near.at[p] < near.shape.begin || near.at[p] >= near.shape.end) continue;
          const cadt_u32 stalled = cautious && cadt_tile_early_out(i, round ? &near.unproven : &near.again_count);
          /* also if a quarter has too many for the smaller limit, as where many points are cocircular */
          const cadt_u32 large = round || many || 4u * cadt_team_add(&near.overfull, 0u) > number + 64u ? 1u : 0u;
          maker.candidates = (large ? 2u : 1u) * CADT_CANDIDATES;
          cadt_u32 size = stalled ? 0u
                                  : cadt_make_star(&maker, p, x, y, round ? 2u : 1u, halo,
                                                   large ? CADT_NONE : CADT_CAST(cadt_u32, CADT_FEW_CELLS));
          if (size) size = cadt_store_star(&maker, p, size, &pool);
          if (size)
            continue;
          else if (!round)
            near.again[cadt_team_add(&near.again_count, 1u)] = CADT_CAST(cadt_u16, number);
          else
            cadt_team_add(&near.unproven, 1u);
        }
        CADT_TEAM_SYNC();
      }
    }
    if (cadt_team_lane == 0u) {
      cadt_add_relaxed(counts + CADT_STARS_POINTS, own);
      const cadt_u32 unproven = loaded ? near.unproven : own;
      if (unproven) cadt_add_relaxed(counts + CADT_STARS_UNPROVEN, unproven);
      const cadt_u32 again = loaded ? near.again_count : 0u, overfull = loaded ? near.overfull : 0u;
      if (again) cadt_add_relaxed(counts + CADT_STARS_AGAIN, again);
      if (left) cadt_add_relaxed(counts + CADT_STARS_SKIPPED_TILES, 1u);
      if (turn < sample) {
        cadt_add_relaxed(counts + CADT_STARS_SAMPLED_POINTS, own);
        cadt_add_relaxed(counts + CADT_STARS_SAMPLED_UNPROVEN, unproven);
        cadt_add_relaxed(counts + CADT_STARS_SAMPLED_OVERFULL, overfull);
        cadt_add_relaxed(counts + CADT_STARS_SAMPLED_TILES, 1u);
      }
    }
    CADT_TEAM_SYNC();
  }
  cadt_flush_exact(&counters, counts + CADT_STARS_EXACT_ORIENTATIONS);
}

#endif
