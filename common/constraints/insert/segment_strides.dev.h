/* SPDX-License-Identifier: Apache-2.0
 *
 * Long pieces, which one work-item would follow for too long, are walked along in strides, all at the same time:
 *
 *     a . . . . . o . . . . . . . o . . . . . . o . . . . . . . b      o: a triangle found by a probe: point location
 * of stride 0     stride 1        stride 2      stride 3               a place on the piece, in floating point
 *
 * Each stride walks until it enters the first triangle of the next one. A probe need not find what it looks for, only
 * some triangle that the piece crosses: that is decided exactly. Where strides do not fit together, which rounding may
 * cause, the first one goes all the way.
 */
#ifndef CADT_CONSTRAINTS_SEGMENT_STRIDES_H
#define CADT_CONSTRAINTS_SEGMENT_STRIDES_H

#include "common/constraints/insert/find_segments.dev.h"
#include "common/points/hilbert_keys.dev.h"

/* An element each. */
typedef struct {
  CADT_GLOBAL cadt_u32* piece;
  CADT_GLOBAL cadt_u32* start; /* the half-edge by which the piece leaves the first triangle; CADT_NONE: none */
  CADT_GLOBAL cadt_u32* steps; /* triangles that it enters; behind, those of the strides before */
  CADT_GLOBAL cadt_u32* left;  /* of their apexes, those on the left; the same */
} cadt_strides;
#define CADT_STRIDES_PARAMETERS                                                                               \
  CADT_GLOBAL cadt_u32 *stride_piece, CADT_GLOBAL cadt_u32 *stride_start, CADT_GLOBAL cadt_u32 *stride_steps, \
      CADT_GLOBAL cadt_u32 *stride_left
#define CADT_STRIDES(strides) const cadt_strides strides = {stride_piece, stride_start, stride_steps, stride_left}

/* Gives long pieces their strides. \pre the counter is 0 */
CADT_KERNEL(cadt_divide_pieces, CADT_PIECES_PARAMETERS, cadt_u32 count, cadt_u32 grain, CADT_STRIDES_PARAMETERS,
            CADT_GLOBAL cadt_u32* words) {
  CADT_PIECES(pieces);
  CADT_STRIDES(strides);
  CADT_FOR(s, count, grain) {
    const cadt_u32 of_piece = pieces.strides[s];
    if (of_piece == CADT_NONE) continue;
    const cadt_u32 begin = cadt_add_relaxed(words + CADT_SEGMENTS_STRIDES, of_piece);
    pieces.strides[s] = begin;
    for (cadt_u32 i = begin; i < begin + of_piece; ++i) strides.piece[i] = s;
  }
}

enum { CADT_PROBE_NEIGHBORS = 16, CADT_PROBE_STAR = 64, CADT_PROBE_STEPS = 1024 };

/* The vertex nearest to q among those beside its place along Hilbert's curve: vertices are in that order. */
CADT_FN cadt_u32 cadt_vertex_near(const cadt_segment_mesh* m, cadt_u32 vertex_count, const cadt_key_grid* grid,
                                  cadt_point q) {
  const cadt_u64 key = cadt_key_of_place(grid, q);
  cadt_u32 low = 0u, high = vertex_count;
  CADT_FIND_FIRST(low, high, middle, cadt_key_of_place(grid, cadt_load_point(m->points + middle)) < key)
  const cadt_u32 each = CADT_CAST(cadt_u32, CADT_PROBE_NEIGHBORS) / 2u;
  const cadt_u32 begin = low > each ? low - each : 0u, end = cadt_min_u32(low + each, vertex_count);
  cadt_u32 nearest = begin;
  cadt_real least = CADT_INFINITY;
  for (cadt_u32 v = begin; v < end; ++v) {
    const cadt_point p = cadt_load_point(m->points + v);
    const cadt_real away = cadt_fabs(p.x - q.x) + cadt_fabs(p.y - q.y);
    if (away < least) {
      least = away;
      nearest = v;
    }
  }
  return nearest;
}

/* A triangle that contains the place q as far as floating point can tell: straight on from a vertex near it. (A walk
 * that only turns towards q may take for ever where long edges have made long triangles.) CADT_NONE if it meets a
 * vertex or takes long. */
CADT_FN cadt_u32 cadt_triangle_near(const cadt_segment_mesh* m, cadt_u32 vertex_count, const cadt_key_grid* grid,
                                    cadt_point q) {
  const cadt_u32 nearest = cadt_vertex_near(m, vertex_count, grid, q);
  const cadt_point p = cadt_load_point(m->points + nearest);
  cadt_u32 t = m->vertex_triangle[nearest];
  cadt_u32 k = cadt_corner_of(m, t, 0u) == nearest ? 0u : (cadt_corner_of(m, t, 1u) == nearest ? 1u : 2u), found = 0u;
  for (cadt_u32 i = 0u; i < CADT_CAST(cadt_u32, CADT_PROBE_STAR) && !found; ++i) { /* the triangle towards q */
    const cadt_u32 v = cadt_corner_of(m, t, CADT_NEXT(k)), w = cadt_corner_of(m, t, CADT_PREV(k));
    found = v != CADT_GHOST && w != CADT_GHOST && cadt_orientation_filter(p, q, cadt_load_point(m->points + v)) == -1 &&
                    cadt_orientation_filter(p, q, cadt_load_point(m->points + w)) == 1
                ? 1u
                : 0u;
    if (found) break;
    const cadt_u32 next = cadt_across_of(m, CADT_HALF_EDGE(t, CADT_NEXT(k)));
    t = CADT_TRIANGLE_OF(next);
    k = CADT_NEXT(CADT_EDGE_OF(next));
  }
  for (cadt_u32 i = 0u; i < CADT_CAST(cadt_u32, CADT_PROBE_STEPS) && found; ++i) { /* it is left by edge k */
    const cadt_u32 v = cadt_corner_of(m, t, CADT_NEXT(k)), w = cadt_corner_of(m, t, CADT_PREV(k));
    if (cadt_orientation_filter(cadt_load_point(m->points + v), cadt_load_point(m->points + w), q) != -1) return t;
    const cadt_u32 entry = cadt_across_of(m, CADT_HALF_EDGE(t, k)), j = CADT_EDGE_OF(entry);
    t = CADT_TRIANGLE_OF(entry);
    const cadt_u32 apex = cadt_corner_of(m, t, j);
    if (apex == CADT_GHOST) return CADT_NONE;
    k = cadt_orientation_filter(p, q, cadt_load_point(m->points + apex)) == 1 ? CADT_NEXT(j) : CADT_PREV(j);
  }
  return CADT_NONE;
}

/* Where strides start. */
CADT_KERNEL(cadt_probe_pieces, CADT_SEGMENT_MESH_PARAMETERS, CADT_PIECES_PARAMETERS, CADT_STRIDES_PARAMETERS,
            CADT_GRID_PARAMETERS, cadt_u32 count, cadt_u32 grain, cadt_u32 vertex_count) {
  CADT_SEGMENT_MESH(mesh);
  CADT_GRID_VIEW(grid);
  CADT_PIECES(pieces);
  CADT_STRIDES(strides);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(i, count, grain) {
    const cadt_u32 s = strides.piece[i], number = i - pieces.strides[s];
    strides.start[i] = CADT_NONE;
    if (number == 0u) {
      strides.start[i] = pieces.entry[s];
      continue;
    }
    cadt_u32 end = i + 1u; /* of the strides of this piece */
    while (end < count && strides.piece[end] == s) ++end;
    const cadt_point p = cadt_load_point(mesh.points + pieces.ends[2u * s]),
                     q = cadt_load_point(mesh.points + pieces.ends[2u * s + 1u]);
    const cadt_real part = CADT_CAST(cadt_real, number) / CADT_CAST(cadt_real, end - pieces.strides[s]);
    const cadt_point place = {p.x + part * (q.x - p.x), p.y + part * (q.y - p.y)};
    const cadt_u32 t = cadt_triangle_near(&mesh, vertex_count, &grid, place);
    if (t == CADT_NONE) continue;
    cadt_i32 side[3];
    for (cadt_u32 k = 0u; k < 3u; ++k) side[k] = cadt_side_of(&mesh, p, q, cadt_corner_of(&mesh, t, k), &counters);
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      if (side[CADT_NEXT(k)] >= 0 || side[CADT_PREV(k)] <= 0) continue;
      /* The line leaves by this edge; so does the piece if its ends are on both sides. A walk from beyond an end would
       * leave the mesh. */
      const cadt_point v = cadt_load_point(mesh.points + cadt_corner_of(&mesh, t, CADT_NEXT(k))),
                       w = cadt_load_point(mesh.points + cadt_corner_of(&mesh, t, CADT_PREV(k)));
      if (cadt_orientation(v, w, p, &counters) > 0 && cadt_orientation(v, w, q, &counters) < 0)
        strides.start[i] = CADT_HALF_EDGE(t, k);
    }
  }
}

/* The first triangle of the next stride of the same piece that has another one than stride i; CADT_NONE: none has. */
CADT_FN cadt_u32 cadt_next_start(const cadt_strides* strides, cadt_u32 i, cadt_u32 count) {
  for (cadt_u32 j = i + 1u; j < count && strides->piece[j] == strides->piece[i]; ++j)
    if (strides->start[j] != CADT_NONE && strides->start[j] != strides->start[i])
      return CADT_TRIANGLE_OF(strides->start[j]);
  return CADT_NONE;
}
/* Whether stride i has the same first triangle as one before it. */
CADT_FN cadt_u32 cadt_is_repeated(const cadt_strides* strides, cadt_u32 i, cadt_u32 first) {
  for (cadt_u32 j = i; j > first; --j)
    if (strides->start[j - 1u] != CADT_NONE) return strides->start[j - 1u] == strides->start[i] ? 1u : 0u;
  return 0u;
}

/* How far strides go. A stride that comes to the end of the piece although another one follows has 0 steps; so has the
 * first one of a piece with a vertex on it, whose place in `pieces.upper` gets that vertex. \pre pieces.upper of long
 * pieces is CADT_NONE */
CADT_KERNEL(cadt_walk_strides, CADT_SEGMENT_MESH_PARAMETERS, CADT_PIECES_PARAMETERS, CADT_STRIDES_PARAMETERS,
            cadt_u32 count, cadt_u32 grain) {
  CADT_SEGMENT_MESH(mesh);
  CADT_PIECES(pieces);
  CADT_STRIDES(strides);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(i, count, grain) {
    const cadt_u32 s = strides.piece[i], to = pieces.ends[2u * s + 1u];
    cadt_u32 steps = 0u, left = 0u;
    strides.steps[i] = strides.left[i] = 0u;
    if (strides.start[i] == CADT_NONE || cadt_is_repeated(&strides, i, pieces.strides[s])) continue;
    const cadt_u32 next = cadt_next_start(&strides, i, count);
    const cadt_point p = cadt_load_point(mesh.points + pieces.ends[2u * s]), q = cadt_load_point(mesh.points + to);
    cadt_crossed at = {strides.start[i], CADT_NONE, CADT_NONE, 1};
    do {
      cadt_cross(&mesh, &at, p, to, q, &counters);
      ++steps;
      if (at.side > 0) ++left;
    } while (at.side != 0 && CADT_TRIANGLE_OF(at.entry) != next);
    if (at.side == 0 && at.apex != to) cadt_min_relaxed(pieces.upper + s, at.apex);
    if ((at.side == 0 ? 1u : 0u) != (next == CADT_NONE ? 1u : 0u)) steps = 0u;
    strides.steps[i] = steps;
    strides.left[i] = left;
  }
}

/* Sums of the strides of each long piece. A piece with a vertex on it goes to `pairs` as two, those of which do not fit
 * together is walked along once more. */
CADT_KERNEL(cadt_sum_strides, CADT_SEGMENT_MESH_PARAMETERS, CADT_PIECES_PARAMETERS, cadt_u32 count, cadt_u32 grain,
            CADT_STRIDES_PARAMETERS, cadt_u32 stride_count, CADT_GLOBAL cadt_u32* pairs, CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_PIECES(pieces);
  CADT_STRIDES(strides);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(s, count, grain) {
    const cadt_u32 begin = pieces.strides[s], a = pieces.ends[2u * s], b = pieces.ends[2u * s + 1u];
    if (begin == CADT_NONE) continue;
    const cadt_u32 vertex = pieces.upper[s];
    if (vertex != CADT_NONE) {
      const cadt_u32 place = cadt_add_relaxed(words + CADT_SEGMENTS_LEFT, 2u);
      pairs[2u * place] = a;
      pairs[2u * place + 1u] = pairs[2u * place + 2u] = vertex;
      pairs[2u * place + 3u] = b;
      pieces.sizes[s] = 0u;
      continue;
    }
    cadt_u32 steps = 0u, left = 1u, fits = 1u;
    for (cadt_u32 i = begin; i < stride_count && strides.piece[i] == s; ++i) {
      const cadt_u32 repeated = strides.start[i] == CADT_NONE || cadt_is_repeated(&strides, i, begin) ? 1u : 0u;
      const cadt_u32 own = strides.steps[i], own_left = strides.left[i];
      if (repeated) strides.start[i] = CADT_NONE;
      if (!repeated && !own) fits = 0u;
      strides.steps[i] = steps;
      strides.left[i] = left;
      steps += own;
      left += own_left;
    }
    if (!fits) {
      const cadt_point p = cadt_load_point(mesh.points + a), q = cadt_load_point(mesh.points + b);
      cadt_crossed at = {pieces.entry[s], CADT_NONE, CADT_NONE, 1};
      steps = 0u;
      left = 1u;
      do {
        cadt_cross(&mesh, &at, p, b, q, &counters);
        ++steps;
        if (at.side > 0) ++left;
      } while (at.side != 0);
      if (at.apex != b) cadt_add_relaxed(words + CADT_SEGMENTS_BROKEN, 1u);
      for (cadt_u32 i = begin + 1u; i < stride_count && strides.piece[i] == s; ++i) strides.start[i] = CADT_NONE;
    }
    pieces.upper[s] = left;
    pieces.sizes[s] = steps + 4u; /* the first triangle, a, b and a again */
  }
}

#endif
