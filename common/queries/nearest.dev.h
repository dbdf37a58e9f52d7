/* SPDX-License-Identifier: Apache-2.0
 *
 * Nearest vertices. In a Delaunay mesh a vertex that is not the nearest to p has a neighbour that is nearer, so going
 * to the nearest neighbour again and again ends at the nearest vertex (F. Aurenhammer, "Voronoi diagrams: a survey of a
 * fundamental geometric data structure", 1991). Each further one is a neighbour of one found before: the circle around
 * p through it, shrunk towards it, becomes empty while another vertex, which is nearer, lies on it.
 */
#ifndef CADT_QUERIES_NEAREST_H
#define CADT_QUERIES_NEAREST_H

#include "common/queries/query_mesh.dev.h"

/* Three squares' and their sum's roundings, and some room: 2^-50. */
#define CADT_DISTANCE_BOUND 8.8817841970012523e-16

/* The sign of |a - p|^2 - |b - p|^2 by integers of any length, as that of
 * (a.x - b.x) (a.x + b.x - 2 p.x) + (a.y - b.y) (a.y + b.y - 2 p.y). */
CADT_FN_SLOW cadt_i32 cadt_compare_distances_exact(cadt_point p, cadt_point a, cadt_point b) {
  cadt_u32 d[4][CADT_LIMBS], term[CADT_LIMBS];
  const cadt_span s = cadt_span_of(p, a, b);
  const cadt_i32 n = (cadt_span_bits(&s) + 4 + 31) >> 5; /* |a + b - 2 p| < 4 * 2^bits */
  for (cadt_i32 i = 0; i < 4; ++i) { /* a.x - b.x, b.y - a.y, a.y + b.y - 2 p.y, a.x + b.x - 2 p.x */
    const cadt_u32 along_y = i == 1 || i == 2 ? 1u : 0u, sum = i > 1 ? 1u : 0u;
    cadt_limbs_load(d[i], n, along_y ? a.y : a.x, s.low);
    if (i == 1) cadt_limbs_load(d[i], n, b.y, s.low);
    cadt_limbs_load(term, n, i == 1 ? a.y : (along_y ? b.y : b.x), s.low);
    cadt_limbs_accumulate(d[i], n, term, n, sum ? 0u : 1u);
    if (!sum) continue;
    cadt_limbs_load(term, n, along_y ? p.y : p.x, s.low);
    cadt_limbs_accumulate(d[i], n, term, n, 1u);
    cadt_limbs_accumulate(d[i], n, term, n, 1u);
  }
  return cadt_sign_of_minor(d, n);
}

/* Whether a is nearer to p than b: -1, farther: 1, both equally near: 0. */
CADT_FN cadt_i32 cadt_compare_distances(cadt_point p, cadt_point a, cadt_point b) {
  cadt_real ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
#if CADT_WIDE
  const cadt_i32 e = cadt_exponent_of_largest(ax, ay, bx, by);
  if (!CADT_SCALES(e)) return cadt_compare_distances_exact(p, a, b);
  ax = cadt_ldexp(ax, -e);
  ay = cadt_ldexp(ay, -e);
  bx = cadt_ldexp(bx, -e);
  by = cadt_ldexp(by, -e);
#endif
  const cadt_real da = ax * ax + ay * ay, db = bx * bx + by * by, difference = da - db;
  const cadt_real bound = CADT_DISTANCE_BOUND * (da + db) + CADT_UNDERFLOW;
  if (difference > bound) return 1;
  if (-difference > bound) return -1;
  return cadt_compare_distances_exact(p, a, b);
}

/* Whether vertex v at `a` comes before vertex w at `b`: by the distance to p, then by index. `tied`: 1 if both are
 * equally near. */
CADT_FN cadt_u32 cadt_is_nearer(cadt_point p, cadt_u32 v, cadt_point a, cadt_u32 w, cadt_point b, cadt_u32* tied) {
  const cadt_i32 order = cadt_compare_distances(p, a, b);
  if (order == 0) *tied = 1u;
  return order < 0 || (order == 0 && v < w) ? 1u : 0u;
}

/* A vertex, and the triangle from which cadt_next_neighbor goes around it, counterclockwise. Each neighbour comes once;
 * that of a hull vertex which is behind its last triangle comes last. */
typedef struct {
  cadt_u32 vertex;
  cadt_spoke spoke; /* its first triangle, cadt_first_spoke */
} cadt_star_of;

CADT_FN cadt_star_of cadt_star_at(const cadt_query_mesh* m, cadt_u32 t, cadt_u32 k) {
  const cadt_spoke s = {t, k};
  const cadt_star_of star = {cadt_vertex_of(&m->view, t, k), cadt_first_spoke(m, s)};
  return star;
}
/* The neighbour at `*s`, and the step to the next one; CADT_NONE when all have come. `*state` is 0 at first. */
CADT_FN cadt_u32 cadt_next_neighbor(const cadt_query_mesh* m, const cadt_star_of* star, cadt_spoke* s,
                                    cadt_u32* state) {
  if (*state == 2u) return CADT_NONE;
  if (*state == 1u) { /* behind the last triangle of a hull vertex */
    *state = 2u;
    return cadt_vertex_of(&m->view, s->triangle, CADT_PREV(s->k));
  }
  const cadt_u32 neighbor = cadt_vertex_of(&m->view, s->triangle, CADT_NEXT(s->k));
  const cadt_spoke next = cadt_turn(m, *s, 0u);
  if (next.triangle == CADT_NONE)
    *state = 1u;
  else if (next.triangle == star->spoke.triangle)
    *state = 2u;
  else
    *s = next;
  return neighbor;
}

/* The vertices at the same, smallest distance are on an empty circle: the edges of their convex polygon are in the
 * mesh. From `v` around it, to the lowest. */
CADT_FN_SLOW cadt_u32 cadt_lowest_of_nearest(const cadt_query_mesh* m, CADT_GLOBAL const cadt_u32* lowest, cadt_point p,
                                             cadt_u32 v, cadt_u32 points) {
  const cadt_point a = cadt_mesh_point(m, v);
  cadt_u32 best = v, at = v;
  for (cadt_u32 steps = 0u; steps < points; ++steps) {
    const cadt_u32 t = lowest[at];
    const cadt_star_of star = cadt_star_at(m, t, cadt_index_in(m, t, at));
    const cadt_point from = cadt_mesh_point(m, at);
    cadt_spoke s = star.spoke;
    cadt_u32 state = 0u, next = CADT_NONE;
    cadt_point to = from;
    for (;;) {
      const cadt_u32 w = cadt_next_neighbor(m, &star, &s, &state);
      if (w == CADT_NONE) break;
      const cadt_point b = cadt_mesh_point(m, w);
      if (cadt_compare_distances(p, a, b) != 0) continue;
      if (next == CADT_NONE || cadt_side(from, to, b) < 0) { /* all others are left of the polygon's edge */
        next = w;
        to = b;
      }
    }
    if (next == CADT_NONE || next == v) return best;
    if (next < best) best = next;
    at = next;
  }
  return best;
}

/* The nearest vertex to p, of equally near ones the lowest; `t`: a triangle near it. */
CADT_FN cadt_u32 cadt_nearest_vertex(const cadt_query_mesh* m, CADT_GLOBAL const cadt_u32* lowest, cadt_point p,
                                     cadt_u32 t, cadt_u32 points) {
  cadt_u32 tied = 0u, k = 0u, best = cadt_vertex_of(&m->view, t, 0u);
  cadt_point at = cadt_mesh_point(m, best);
  for (cadt_u32 j = 1u; j < 3u; ++j) {
    const cadt_u32 v = cadt_vertex_of(&m->view, t, j);
    const cadt_point b = cadt_mesh_point(m, v);
    if (cadt_is_nearer(p, v, b, best, at, &tied)) best = v, at = b, k = j;
  }
  for (;;) {
    const cadt_star_of star = cadt_star_at(m, t, k);
    cadt_spoke s = star.spoke;
    cadt_u32 state = 0u;
    tied = 0u;
    for (;;) {
      const cadt_spoke here = s;
      const cadt_u32 last = state, w = cadt_next_neighbor(m, &star, &s, &state);
      if (w == CADT_NONE) break;
      const cadt_point b = cadt_mesh_point(m, w);
      cadt_u32 equal = 0u;
      if (cadt_is_nearer(p, w, b, best, at, &equal)) {
        best = w, at = b;
        t = here.triangle;
        k = last == 1u ? CADT_PREV(here.k) : CADT_NEXT(here.k);
        tied = equal;
      } else if (equal) {
        tied = 1u;
      }
    }
    if (best == star.vertex) break;
  }
  return tied ? cadt_lowest_of_nearest(m, lowest, p, best, points) : best;
}

/* The nearest vertex to p behind those of `row`, the `found` nearest: a neighbour of one of them. CADT_NONE if there is
 * none. */
CADT_FN_SLOW cadt_u32 cadt_next_nearest(const cadt_query_mesh* m, CADT_GLOBAL const cadt_u32* lowest, cadt_point p,
                                        CADT_GLOBAL const cadt_u32* row, cadt_u32 found) {
  const cadt_u32 last = row[found - 1u];
  const cadt_point from = cadt_mesh_point(m, last);
  cadt_u32 best = CADT_NONE;
  cadt_point at = p;
  for (cadt_u32 j = 0u; j < found; ++j) {
    const cadt_u32 t = lowest[row[j]];
    const cadt_star_of star = cadt_star_at(m, t, cadt_index_in(m, t, row[j]));
    cadt_spoke s = star.spoke;
    cadt_u32 state = 0u;
    for (;;) {
      const cadt_u32 w = cadt_next_neighbor(m, &star, &s, &state);
      if (w == CADT_NONE) break;
      if (w == best || w == last) continue;
      const cadt_point b = cadt_mesh_point(m, w);
      cadt_u32 tied = 0u;
      if (best != CADT_NONE && !cadt_is_nearer(p, w, b, best, at, &tied)) continue;
      const cadt_i32 order = cadt_compare_distances(p, from, b); /* what is nearer than the last is in the row */
      cadt_u32 known = order > 0 ? 1u : 0u;
      for (cadt_u32 l = 0u; l < found && order == 0 && !known; ++l) known = row[l] == w ? 1u : 0u;
      if (!known) best = w, at = b;
    }
  }
  return best;
}

/* The `wanted` nearest vertices of the queries `first` and on, nearest first, as rows of `nearest`; CADT_NONE where
 * there are no more. `reached`: a triangle near each query. */
CADT_KERNEL(cadt_nearest_vertices, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* lowest, cadt_u32 point_count,
            CADT_GLOBAL const cadt_point* queries, CADT_GLOBAL const cadt_u32* order,
            CADT_GLOBAL const cadt_u32* reached, cadt_u32 wanted, CADT_GLOBAL cadt_u32* nearest, cadt_u32 first,
            cadt_u32 count, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_FOR(i, count, grain) {
    const cadt_u32 q = order ? order[first + i] : first + i;
    const cadt_point p = cadt_scaled_point(&mesh, queries + q);
    CADT_GLOBAL cadt_u32* row = nearest + CADT_CAST(cadt_u64, q) * wanted;
    row[0] = cadt_nearest_vertex(&mesh, lowest, p, reached[q] >> 2, point_count);
    cadt_u32 found = 1u;
    for (; found < wanted; ++found) {
      row[found] = cadt_next_nearest(&mesh, lowest, p, row, found);
      if (row[found] == CADT_NONE) break;
    }
    for (; found < wanted; ++found) row[found] = CADT_NONE; /* there are no more */
  }
}

#endif
