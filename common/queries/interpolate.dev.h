/* SPDX-License-Identifier: Apache-2.0
 *
 * Barycentric coordinates and linear interpolation in the triangle that contains a point, and values of nearest
 * vertices.
 */
#ifndef CADT_QUERIES_INTERPOLATE_H
#define CADT_QUERIES_INTERPOLATE_H

#include "common/queries/query_mesh.dev.h"

typedef struct {
  cadt_real at[3];
} cadt_weights;

CADT_FN cadt_real cadt_cross(cadt_real ax, cadt_real ay, cadt_real bx, cadt_real by) { return ax * by - ay * bx; }
CADT_FN cadt_real cadt_positive(cadt_real x) { return x > 0.0 ? x : 0.0; }

/* The area of the parallelogram of two arms from p, where rounding would leave too little of it. */
#if CADT_GRADUAL_UNDERFLOW && !CADT_WIDE
CADT_FN_SLOW cadt_real cadt_area_of_arms(cadt_point p, cadt_point a, cadt_point b) {
  cadt_pair right = cadt_pair_product(cadt_pair_difference(a.y, p.y), cadt_pair_difference(b.x, p.x));
  right.high = -right.high;
  right.low = -right.low;
  return cadt_pair_sum(cadt_pair_product(cadt_pair_difference(a.x, p.x), cadt_pair_difference(b.y, p.y)), right).high;
}
#endif

/* A triangle is thin if rounding may change its area by more than 2^-26 of it. */
#define CADT_THIN 1.4901161193847656e-08

/* Along the longest of the three edges, seen from p: for triangles that have no area left. */
CADT_FN cadt_weights cadt_along_longest(const cadt_real* x, const cadt_real* y) {
  cadt_u32 longest = 0u;
  cadt_real square = -1.0;
  for (cadt_u32 k = 0u; k < 3u; ++k) {
    const cadt_real dx = x[CADT_NEXT(k)] - x[k], dy = y[CADT_NEXT(k)] - y[k];
    if (dx * dx + dy * dy > square) square = dx * dx + dy * dy, longest = k;
  }
  const cadt_u32 end = CADT_NEXT(longest);
  const cadt_real dx = x[end] - x[longest], dy = y[end] - y[longest];
  cadt_real share = square > 0.0 ? -(x[longest] * dx + y[longest] * dy) / square : 0.0;
  share = share > 0.0 ? (share < 1.0 ? share : 1.0) : 0.0;
  cadt_weights w = {{0.0, 0.0, 0.0}};
  w.at[longest] = 1.0 - share;
  w.at[end] = share;
  return w;
}

/* Barycentric coordinates of p in the triangle a, b, c that contains it: not negative, their sum is 1 but for rounding.
 * At a vertex they are exactly 0 and 1. `thin`: whether the triangle is. */
CADT_FN cadt_weights cadt_barycentric(cadt_point a, cadt_point b, cadt_point c, cadt_point p, cadt_u32* thin) {
  cadt_real x[3], y[3];
  x[0] = a.x - p.x, x[1] = b.x - p.x, x[2] = c.x - p.x;
  y[0] = a.y - p.y, y[1] = b.y - p.y, y[2] = c.y - p.y;
#if CADT_WIDE
  /* x and y apart, as in cadt_orientation_filter: a common factor of all areas. A difference may overflow: halve first.
   */
  cadt_i32 ex = cadt_exponent_of_largest(x[0], x[1], x[2], 0.0), ey = cadt_exponent_of_largest(y[0], y[1], y[2], 0.0);
  if (ex == 5000) x[0] = 0.5 * a.x - 0.5 * p.x, x[1] = 0.5 * b.x - 0.5 * p.x, x[2] = 0.5 * c.x - 0.5 * p.x, ex = 1023;
  if (ey == 5000) y[0] = 0.5 * a.y - 0.5 * p.y, y[1] = 0.5 * b.y - 0.5 * p.y, y[2] = 0.5 * c.y - 0.5 * p.y, ey = 1023;
  for (cadt_u32 k = 0u; k < 3u; ++k) x[k] = cadt_ldexp(x[k], -ex), y[k] = cadt_ldexp(y[k], -ey);
#endif
  cadt_weights w;
  cadt_real all = 0.0, terms = 0.0;
  for (cadt_u32 k = 0u; k < 3u; ++k) {
    const cadt_u32 i = CADT_NEXT(k), j = CADT_PREV(k);
    const cadt_real left = x[i] * y[j], right = y[i] * x[j];
    w.at[k] = cadt_positive(left - right);
    all += w.at[k];
    terms += cadt_fabs(left) + cadt_fabs(right);
  }
  *thin = all < CADT_THIN * terms ? 1u : 0u;
  if (*thin) {
#if CADT_GRADUAL_UNDERFLOW && !CADT_WIDE
    w.at[0] = cadt_positive(cadt_area_of_arms(p, b, c));
    w.at[1] = cadt_positive(cadt_area_of_arms(p, c, a));
    w.at[2] = cadt_positive(cadt_area_of_arms(p, a, b));
    all = w.at[0] + w.at[1] + w.at[2];
    if (!(all > 0.0)) return cadt_along_longest(x, y);
#else
    return cadt_along_longest(x, y);
#endif
  }
  for (cadt_u32 k = 0u; k < 3u; ++k) w.at[k] /= all;
  return w;
}

CADT_FN cadt_weights cadt_weights_in(const cadt_query_mesh* m, cadt_u32 t, cadt_point p) {
  cadt_u32 thin;
  return cadt_barycentric(cadt_corner(m, t, 0u), cadt_corner(m, t, 1u), cadt_corner(m, t, 2u), p, &thin);
}

/* Value `of` of the triangle's vertices, weighted. A vertex without weight does not count, whatever its value. */
CADT_FN cadt_real cadt_weighted(const cadt_query_mesh* m, cadt_u32 t, const cadt_weights* w,
                                CADT_GLOBAL const cadt_real* values, cadt_u32 per_point, cadt_u32 of) {
  cadt_real sum = 0.0;
  for (cadt_u32 k = 0u; k < 3u; ++k)
    if (w->at[k] != 0.0) sum += w->at[k] * values[CADT_CAST(cadt_u64, cadt_vertex_of(&m->view, t, k)) * per_point + of];
  return sum;
}

/* Three barycentric coordinates a query; NaN outside. */
CADT_KERNEL(cadt_barycentric_of, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL const cadt_point* queries,
            CADT_GLOBAL const cadt_u32* order, CADT_GLOBAL const cadt_u32* located, CADT_GLOBAL cadt_real* coordinates,
            cadt_u32 count, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_FOR(i, count, grain) {
    const cadt_u32 q = order ? order[i] : i, t = located[q];
    cadt_weights w = {{CADT_NAN, CADT_NAN, CADT_NAN}};
    if (t != CADT_NONE) w = cadt_weights_in(&mesh, t, cadt_scaled_point(&mesh, queries + q));
    for (cadt_u32 k = 0u; k < 3u; ++k) coordinates[CADT_CAST(cadt_u64, q) * 3u + k] = w.at[k];
  }
}

/* `per_point` values a query, linear in its triangle. Outside: the value of the vertex in `nearest`, or NaN if that is
 * null. */
CADT_KERNEL(cadt_interpolate_linear, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL const cadt_point* queries,
            CADT_GLOBAL const cadt_u32* order, CADT_GLOBAL const cadt_u32* located, CADT_GLOBAL const cadt_u32* nearest,
            CADT_GLOBAL const cadt_real* values, cadt_u32 per_point, CADT_GLOBAL cadt_real* results, cadt_u32 count,
            cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_FOR(i, count, grain) {
    const cadt_u32 q = order ? order[i] : i, t = located[q];
    CADT_GLOBAL cadt_real* result = results + CADT_CAST(cadt_u64, q) * per_point;
    if (t == CADT_NONE) {
      for (cadt_u32 of = 0u; of < per_point; ++of)
        result[of] = nearest ? values[CADT_CAST(cadt_u64, nearest[q]) * per_point + of] : CADT_NAN;
      continue;
    }
    const cadt_weights w = cadt_weights_in(&mesh, t, cadt_scaled_point(&mesh, queries + q));
    for (cadt_u32 of = 0u; of < per_point; ++of) result[of] = cadt_weighted(&mesh, t, &w, values, per_point, of);
  }
}

/* The values of the nearest vertices; NaN outside of the hull if `located` is given. */
CADT_KERNEL(cadt_interpolate_nearest, CADT_GLOBAL const cadt_u32* located, CADT_GLOBAL const cadt_u32* nearest,
            CADT_GLOBAL const cadt_real* values, cadt_u32 per_point, CADT_GLOBAL cadt_real* results, cadt_u32 count,
            cadt_u32 grain) {
  CADT_FOR(q, count, grain) {
    const cadt_u32 outside = located && located[q] == CADT_NONE ? 1u : 0u;
    for (cadt_u32 of = 0u; of < per_point; ++of)
      results[CADT_CAST(cadt_u64, q) * per_point + of] =
          outside ? CADT_NAN : values[CADT_CAST(cadt_u64, nearest[q]) * per_point + of];
  }
}

#endif
