/* SPDX-License-Identifier: Apache-2.0
 *
 * Batches: many small sets of points in one call. Each set has a square of the key grid of its own, one square after
 * another on the curve, so sorted points stand set by set, and no square of a tile holds points of two sets. From the
 * sort to the result the batch is one mesh with many components; positions and triangles of a set are contiguous, and
 * each set has two triangle slots a vertex, used or not.
 *
 * Several kernels find the set of an element among the first elements of all sets (`starts`, with the end of the last
 * one behind) by binary search: some dozen reads that the cache serves.
 */
#ifndef CADT_BATCH_BATCH_H
#define CADT_BATCH_BATCH_H

#include "common/mesh/locked_mesh.dev.h"
#include "common/mesh/mesh_view.dev.h"
#include "common/points/bounds.dev.h"
#include "common/points/hilbert_keys.dev.h"
#include "common/points/import.dev.h"

/* The set of element i: the last one that starts at i or before. */
CADT_FN cadt_u32 cadt_set_of(CADT_GLOBAL const cadt_u32* starts, cadt_u32 count, cadt_u32 i) {
  cadt_u32 low = 0u, high = count;
  CADT_FIND_LAST(low, high, middle, starts[middle] <= i);
  return low;
}

CADT_FN cadt_key_grid cadt_grid_of_set(CADT_GLOBAL const cadt_set* sets, cadt_u32 set, cadt_u32 levels) {
  const cadt_key_grid grid = {sets[set].half_min_x, sets[set].half_min_y, sets[set].scale, levels, levels, set};
  return grid;
}

CADT_FN cadt_point cadt_scale_point(CADT_GLOBAL const cadt_set* set, cadt_point p) {
  return cadt_multiplied_point(p, set->factor, set->factor_again);
}

CADT_FN double cadt_power_of_two(cadt_i32 exponent) {
  return cadt_double_of_bits(CADT_CAST(cadt_u64, exponent + 1023) << 52);
}

/* Grid and factors of a set from the bounds of its points: coordinates become multiples of 2^-240 below 1, if that is
 * exact. */
CADT_FN cadt_set cadt_set_from_bounds(const cadt_bounds_row* row, cadt_u32 levels, cadt_u32 wide) {
  cadt_set s;
  const cadt_i32 exponent = wide || row->high < row->low ? 0 : 4096 - CADT_CAST(cadt_i32, row->high);
  s.factor = cadt_power_of_two(exponent / 2);
  s.factor_again = cadt_power_of_two(exponent - exponent / 2);
  s.half_min_x = 0.5 * (row->min_x * s.factor * s.factor_again);
  s.half_min_y = 0.5 * (row->min_y * s.factor * s.factor_again);
  const double width = 0.5 * (row->max_x * s.factor * s.factor_again) - s.half_min_x;
  const double height = 0.5 * (row->max_y * s.factor * s.factor_again) - s.half_min_y;
  const double longer = width > height ? width : height, most = 1e300; /* if all points are equal, or nearly so */
  s.scale = CADT_CAST(double, 1u << levels) / longer;
  if (!(s.scale < most)) s.scale = most;
  s.most_x = width * s.scale;
  s.most_y = height * s.scale;
  return s;
}

#if CADT_BUILDS(BATCH)
/* Fills the table of the sets, a team for each. `bad`: the first point with a coordinate that is NaN or infinite. \pre
 * *bad is CADT_NONE */
CADT_KERNEL(cadt_batch_bounds, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* starts,
            cadt_u32 set_count, cadt_u32 levels, cadt_u32 narrow_span, cadt_u32 grain, CADT_GLOBAL cadt_set* sets,
            CADT_GLOBAL cadt_u32* states, CADT_GLOBAL cadt_u32* bad) {
  CADT_TEAM_MEMORY cadt_bounds_row lanes[CADT_BOUNDS_LANES];
  CADT_FOR_TEAMS(s, set_count, grain) {
    const cadt_u32 begin = starts[s];
    cadt_bounds_row row = cadt_bounds_of_nothing();
    cadt_span span;
    cadt_span_clear(&span);
    CADT_TEAM_FOR(j, starts[s + 1u] - begin) {
      if (!cadt_bounds_add_point(&row, &span, points[begin + j], begin + j)) break;
    }
    cadt_bounds_close(&row, &span);
    cadt_bounds_of_team(lanes, row);
    if (cadt_team_lane == 0u) {
      row = lanes[0];
      const cadt_u32 wide = row.high > row.low && row.high - row.low > narrow_span ? 1u : 0u;
      sets[s] = cadt_set_from_bounds(&row, levels, wide);
      states[s] = wide ? CADT_SET_WIDE : CADT_SET_BATCHED;
      if (row.bad != CADT_NONE) cadt_min_relaxed(bad, row.bad);
    }
    CADT_TEAM_SYNC();
  }
}

/* Sort keys. `scaled`: the points are scaled already. */
CADT_KERNEL(cadt_batch_keys, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* starts,
            cadt_u32 set_count, CADT_GLOBAL const cadt_set* sets, cadt_u32 levels, cadt_u32 scaled,
            CADT_GLOBAL cadt_u32* keys, cadt_u32 n, cadt_u32 grain) {
  CADT_FOR(i, n, grain) {
    const cadt_u32 set = cadt_set_of(starts, set_count, i);
    const cadt_key_grid grid = cadt_grid_of_set(sets, set, levels);
    const cadt_point p = scaled ? points[i] : cadt_scale_point(sets + set, points[i]);
    const cadt_point f = cadt_clamp_to_grid(&grid, cadt_to_grid(&grid, p));
    keys[i] = cadt_cell_key(&grid, CADT_CAST(cadt_u32, f.x), CADT_CAST(cadt_u32, f.y), levels);
  }
}

/* Points in sorted order, scaled. */
CADT_KERNEL(cadt_batch_gather, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* order,
            CADT_GLOBAL const cadt_u32* starts, cadt_u32 set_count, CADT_GLOBAL const cadt_set* sets,
            CADT_GLOBAL cadt_point* sorted, cadt_u32 n, cadt_u32 grain) {
  CADT_FOR(i, n, grain) {
    /* place i belongs to the set of point i */
    sorted[i] = cadt_scale_point(sets + cadt_set_of(starts, set_count, i), points[order[i]]);
  }
}

/* First positions of the sets among the distinct points. `ranks`: scan of 1 for each distinct point. */
CADT_KERNEL(cadt_batch_starts, CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL const cadt_u32* starts,
            cadt_u32 set_count, cadt_u32 n, cadt_u32 distinct, cadt_u32 grain, CADT_GLOBAL cadt_u32* first) {
  CADT_FOR(s, set_count + 1u, grain) { first[s] = starts[s] < n ? ranks[starts[s]] : distinct; }
}

/* Classifies the sets, a team for each: flat ones have fewer than three points or only collinear ones, those with more
 * than `most` points are processed individually. */
CADT_KERNEL(cadt_batch_classify, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* starts,
            cadt_u32 set_count, cadt_u32 most, cadt_u32 grain, CADT_GLOBAL cadt_u32* states) {
  CADT_TEAM_MEMORY cadt_u32 turns;
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR_TEAMS(s, set_count, grain) {
    const cadt_u32 begin = starts[s], count = starts[s + 1u] - begin, wide = states[s];
    if (cadt_team_lane == 0u) turns = 0u;
    CADT_TEAM_SYNC();
    for (cadt_u32 j = 2u; !wide && j < count; j += cadt_team_lanes) {
      const cadt_u32 k = j + cadt_team_lane;
      if (k < count && cadt_orientation(points[begin], points[begin + 1u], points[begin + k], &counters) != 0)
        cadt_team_add(&turns, 1u);
      CADT_TEAM_SYNC();
      const cadt_u32 found = turns;
      CADT_TEAM_SYNC();
      if (found) break;
    }
    if (cadt_team_lane == 0u && !wide)
      states[s] = turns == 0u ? CADT_SET_FLAT : (count > most ? CADT_SET_INDIVIDUAL : CADT_SET_BATCHED);
    CADT_TEAM_SYNC();
  }
}

/* Flags the vertices without a star in batched sets, with a 0 at the end, and sets begins[v]: each star has `row`
 * words. */
CADT_KERNEL(cadt_batch_unproven, CADT_GLOBAL const cadt_u32* sizes, CADT_GLOBAL const cadt_u32* starts,
            cadt_u32 set_count, CADT_GLOBAL const cadt_u32* states, cadt_u32 n, cadt_u32 grain, cadt_u32 row,
            CADT_GLOBAL cadt_u32* unproven, CADT_GLOBAL cadt_u32* begins) {
  if (cadt_item == 0u) unproven[n] = 0u;
  CADT_FOR(v, n, grain) {
    unproven[v] = sizes[v] == 0u && states[cadt_set_of(starts, set_count, v)] == CADT_SET_BATCHED ? 1u : 0u;
    begins[v] = v * row;
  }
}

/* Places of the flagged vertices. `ranks` is the scan of the flags. */
CADT_KERNEL(cadt_batch_list, CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL cadt_u32* list, cadt_u32 n,
            cadt_u32 grain) {
  CADT_FOR(v, n, grain) {
    if (ranks[v + 1u] != ranks[v]) list[ranks[v]] = v;
  }
}

/* Counts in `wrong` the sets whose triangles do not begin where they should, at 2 a vertex: contradictory stars have
 * another number. */
CADT_KERNEL(cadt_batch_check, CADT_GLOBAL const cadt_u32* starts, cadt_u32 set_count, CADT_GLOBAL const cadt_u32* bases,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* wrong) {
  CADT_FOR(s, set_count + 1u, grain) {
    if (bases[starts[s]] != 2u * starts[s]) cadt_add_relaxed(wrong, 1u);
  }
}

/* The points of one set. */
CADT_KERNEL(cadt_batch_extract, CADT_GLOBAL const cadt_point* points, cadt_u32 begin, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_point* to) {
  CADT_FOR(i, count, grain) { to[i] = points[begin + i]; }
}
#endif

/* Converts positions and triangle numbers of a set to those of the batch. */
CADT_FN void cadt_move_triangle(CADT_GLOBAL cadt_u32* word, cadt_u32 begin) {
  for (cadt_u32 k = 0u; k < 3u; ++k) {
    if (word[k] != CADT_GHOST) word[k] += begin;
    word[CADT_WORD_HALF_EDGE + k] += CADT_HALF_EDGE(2u * begin, 0u);
  }
}

#if CADT_BUILDS(BATCH)
/* Stores the mesh of one set in its slots, as locked triangles. Its vertices are indices into `positions` of the set.
 */
CADT_KERNEL(cadt_batch_store, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* positions, cadt_u32 begin,
            cadt_u32 grain, CADT_GLOBAL cadt_locked_triangle* to) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.all, grain) {
    CADT_GLOBAL cadt_u32* word = to[2u * begin + t].word;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 v = cadt_vertex_of(&mesh, t, k);
      word[k] = v == CADT_GHOST ? v : positions[v];
      word[CADT_WORD_HALF_EDGE + k] = mesh.across[3u * t + k];
    }
    word[CADT_WORD_LOCK] = 2u;
    word[CADT_WORD_FLIPS] = 0u;
    cadt_move_triangle(word, begin);
  }
}

/* values[i] -= by[set of element i / row], except where values[i] is CADT_NONE. */
CADT_KERNEL(cadt_batch_shift, CADT_GLOBAL cadt_u32* values, cadt_u32 first, cadt_u32 count, cadt_u32 row,
            CADT_GLOBAL const cadt_u32* starts, cadt_u32 set_count, CADT_GLOBAL const cadt_u32* by, cadt_u32 grain) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 down = by[cadt_set_of(starts, set_count, i)];
    for (cadt_u32 k = 0u; k < row; ++k) {
      const cadt_u32 at = row * (first + i) + k, value = values[at];
      if (value != CADT_NONE) values[at] = value - down;
    }
  }
}
#endif

#endif
