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
#if CADT_GRADUAL_UNDERFLOW
CADT_FN cadt_real cadt_cross_of_pairs(cadt_pair ax, cadt_pair ay, cadt_pair bx, cadt_pair by) {
  cadt_pair right = cadt_pair_product(ay, bx);
  right.high = -right.high;
  right.low = -right.low;
  return cadt_pair_sum(cadt_pair_product(ax, by), right).high;
}
#if !CADT_WIDE
CADT_FN_SLOW cadt_real cadt_area_of_arms(cadt_point p, cadt_point a, cadt_point b) {
  return cadt_cross_of_pairs(cadt_pair_difference(a.x, p.x), cadt_pair_difference(a.y, p.y),
                             cadt_pair_difference(b.x, p.x), cadt_pair_difference(b.y, p.y));
}
#endif
#endif

/* A triangle is thin if rounding may change its area by 2^-26 of it; from 2^-36 on, areas are sums of two doubles. */
#define CADT_THIN 1.4901161193847656e-08
#define CADT_ROUNDED 1.52587890625e-05

/* Along the longest of the three edges, seen from p: for triangles that have no area left. */
CADT_FN_SLOW cadt_weights cadt_along_longest(cadt_point a, cadt_point b, cadt_point c) {
  cadt_point q[3];
  cadt_weights w = {{0.0, 0.0, 0.0}};
  cadt_u32 longest = 0u;
  cadt_real square = -1.0;
  q[0] = a, q[1] = b, q[2] = c;
  for (cadt_u32 k = 0u; k < 3u; ++k) {
    if (q[k].x != 0.0 || q[k].y != 0.0) continue;
    w.at[k] = 1.0; /* at a vertex */
    return w;
  }
  for (cadt_u32 k = 0u; k < 3u; ++k) {
    const cadt_real dx = q[CADT_NEXT(k)].x - q[k].x, dy = q[CADT_NEXT(k)].y - q[k].y;
    if (dx * dx + dy * dy > square) square = dx * dx + dy * dy, longest = k;
  }
  const cadt_u32 end = CADT_NEXT(longest);
  const cadt_real dx = q[end].x - q[longest].x, dy = q[end].y - q[longest].y;
  cadt_real share = square > 0.0 ? -(q[longest].x * dx + q[longest].y * dy) / square : 0.0;
  share = share > 0.0 ? (share < 1.0 ? share : 1.0) : 0.0;
  w.at[longest] = 1.0 - share;
  w.at[end] = share;
  return w;
}

#if CADT_WIDE
/* The three arms from p with x and y scaled apart, as in cadt_orientation_filter: a common factor of all areas. */
CADT_FN void cadt_scale_axis(cadt_real a, cadt_real b, cadt_real c, cadt_real p, cadt_real* x) {
  cadt_i32 e = cadt_exponent_of_largest(x[0], x[1], x[2], 0.0);
  if (e == CADT_OVERFLOWED) { /* halve first */
    x[0] = 0.5 * a - 0.5 * p;
    x[1] = 0.5 * b - 0.5 * p;
    x[2] = 0.5 * c - 0.5 * p;
    e = 1023;
  }
  for (cadt_u32 k = 0u; k < 3u; ++k) x[k] = cadt_ldexp(x[k], -e);
}
#endif

#if CADT_GRADUAL_UNDERFLOW && CADT_WIDE
#define CADT_EXPONENT_OF_0 (-5000) /* less than of any other difference, once scaled */
/* Exponent of a - p, also of a subnormal one. */
CADT_FN cadt_i32 cadt_exponent_of_difference(cadt_real a, cadt_real p) {
  const cadt_i32 e = cadt_exponent_of_largest(a - p, 0.0, 0.0, 0.0);
  if (a == p) return CADT_EXPONENT_OF_0;
  if (e == CADT_OVERFLOWED) return 1025;
  return e > -1022 ? e : cadt_exponent_of_largest(0x1p60 * (a - p), 0.0, 0.0, 0.0) - 60;
}
/* a - p times 2^-e; what overflows is halved first. */
CADT_FN cadt_pair cadt_scaled_difference(cadt_real a, cadt_real p, cadt_i32 e) {
  const cadt_u32 halved = cadt_fabs(a - p) < CADT_INFINITY ? 0u : 1u;
  cadt_pair d = halved ? cadt_pair_difference(0.5 * a, 0.5 * p) : cadt_pair_difference(a, p);
  if (halved) --e;
  d.high = cadt_ldexp(d.high, -e);
  d.low = cadt_ldexp(d.low, -e);
  return d;
}
/* Areas that p = q[3] makes with two each of q[0] to q[2], but for a common factor, where rounding or underflow would
 * leave too little of them. x and y are scaled apart to at most 1, then each arm by 2^-e to about 1; as two of three
 * areas have a factor of an arm, the third one is divided by it instead. With a 1 on both axes, no area underflows that
 * counts. */
CADT_FN_SLOW cadt_weights cadt_areas_of_arms(const cadt_point* q) {
  cadt_pair x[3], y[3];
  cadt_i32 e[3], least = 0, ex = CADT_EXPONENT_OF_0, ey = CADT_EXPONENT_OF_0;
  cadt_weights areas; /* an array, and loops that are not unrolled: the caller needs registers */
  CADT_ROLLED
  for (cadt_u32 k = 0u; k < 3u; ++k) {
    const cadt_i32 of_x = cadt_exponent_of_difference(q[k].x, q[3].x),
                   of_y = cadt_exponent_of_difference(q[k].y, q[3].y);
    ex = of_x > ex ? of_x : ex;
    ey = of_y > ey ? of_y : ey;
  }
  CADT_ROLLED
  for (cadt_u32 k = 0u; k < 3u; ++k) {
    const cadt_i32 of_x = cadt_exponent_of_difference(q[k].x, q[3].x) - ex,
                   of_y = cadt_exponent_of_difference(q[k].y, q[3].y) - ey;
    e[k] = of_x > of_y ? of_x : of_y;
    x[k] = cadt_scaled_difference(q[k].x, q[3].x, ex + e[k]);
    y[k] = cadt_scaled_difference(q[k].y, q[3].y, ey + e[k]);
    least = e[k] < least ? e[k] : least;
  }
  CADT_ROLLED
  for (cadt_u32 k = 0u; k < 3u; ++k) {
    const cadt_u32 i = CADT_NEXT(k), j = CADT_PREV(k);
    areas.at[k] = cadt_ldexp(cadt_positive(cadt_cross_of_pairs(x[i], y[i], x[j], y[j])), least - e[k]);
  }
  return areas;
}
#endif

/* Barycentric coordinates of p in the triangle a, b, c that contains it: not negative, their sum is 1 but for rounding.
 * At a vertex they are exactly 0 and 1. `thin`: whether the triangle is. */
CADT_FN cadt_weights cadt_barycentric(cadt_point a, cadt_point b, cadt_point c, cadt_point p, cadt_u32* thin) {
  cadt_point u = {a.x - p.x, a.y - p.y}, v = {b.x - p.x, b.y - p.y}, w = {c.x - p.x, c.y - p.y};
#if CADT_WIDE
  cadt_real x[3], y[3];
  x[0] = u.x, x[1] = v.x, x[2] = w.x, y[0] = u.y, y[1] = v.y, y[2] = w.y;
  cadt_scale_axis(a.x, b.x, c.x, p.x, x);
  cadt_scale_axis(a.y, b.y, c.y, p.y, y);
  u.x = x[0], v.x = x[1], w.x = x[2], u.y = y[0], v.y = y[1], w.y = y[2];
#endif
  const cadt_real vw = v.x * w.y, wv = v.y * w.x, wu = w.x * u.y, uw = w.y * u.x, uv = u.x * v.y, vu = u.y * v.x;
  cadt_weights result = {{cadt_positive(vw - wv), cadt_positive(wu - uw), cadt_positive(uv - vu)}};
  cadt_real all = result.at[0] + result.at[1] + result.at[2];
  const cadt_real terms = cadt_fabs(vw) + cadt_fabs(wv) + cadt_fabs(wu) + cadt_fabs(uw) + cadt_fabs(uv) + cadt_fabs(vu);
  *thin = all < CADT_THIN * terms ? 1u : 0u;
#if CADT_GRADUAL_UNDERFLOW && !CADT_WIDE
  if (all < CADT_ROUNDED * terms) {
    result.at[0] = cadt_positive(cadt_area_of_arms(p, b, c));
    result.at[1] = cadt_positive(cadt_area_of_arms(p, c, a));
    result.at[2] = cadt_positive(cadt_area_of_arms(p, a, b));
    all = result.at[0] + result.at[1] + result.at[2];
    if (!(all > 0.0)) return cadt_along_longest(u, v, w);
  }
#elif CADT_GRADUAL_UNDERFLOW
  if (all < CADT_ROUNDED * terms || all < CADT_UNDERFLOW) {
    cadt_point q[4];
    q[0] = a, q[1] = b, q[2] = c, q[3] = p;
    result = cadt_areas_of_arms(q);
    all = result.at[0] + result.at[1] + result.at[2];
    if (!(all > 0.0)) return cadt_along_longest(u, v, w);
  }
#else
  if (*thin) return cadt_along_longest(u, v, w);
#endif
  result.at[0] /= all;
  result.at[1] /= all;
  result.at[2] /= all;
  return result;
}

CADT_FN cadt_weights cadt_weights_in(const cadt_query_mesh* m, cadt_u32 t, cadt_point p) {
  cadt_u32 thin;
  return cadt_barycentric(cadt_corner(m, t, 0u), cadt_corner(m, t, 1u), cadt_corner(m, t, 2u), p, &thin);
}

/* A vertex without weight does not count, whatever its value. */
CADT_FN cadt_real cadt_weighted_sum(const cadt_weights* w, cadt_real a, cadt_real b, cadt_real c) {
  cadt_real sum = 0.0;
  if (w->at[0] != 0.0) sum += w->at[0] * a;
  if (w->at[1] != 0.0) sum += w->at[1] * b;
  if (w->at[2] != 0.0) sum += w->at[2] * c;
  return sum;
}
/* Value `of` of the triangle's vertices, weighted. */
CADT_FN cadt_real cadt_weighted(const cadt_query_mesh* m, cadt_u32 t, const cadt_weights* w,
                                CADT_GLOBAL const cadt_real* values, cadt_u32 per_point, cadt_u32 of) {
  const cadt_u64 a = cadt_vertex_of(&m->view, t, 0u), b = cadt_vertex_of(&m->view, t, 1u),
                 c = cadt_vertex_of(&m->view, t, 2u);
  return cadt_weighted_sum(w, values[a * per_point + of], values[b * per_point + of], values[c * per_point + of]);
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
