/* SPDX-License-Identifier: Apache-2.0
 *
 * Natural neighbour interpolation (R. Sibson, "A brief description of natural neighbour interpolation", 1981). If p
 * became a vertex, its Voronoi cell would take a piece of each neighbour's cell; the share of the piece is the
 * neighbour's weight. The triangles whose circles contain p are the cavity (conflict region) of p; its boundary, seen
 * from p, is a polygon of p's neighbours. No list is kept of them, so no cavity is too large: the boundary is followed,
 * and around each of its vertices v the triangles of the cavity are crossed one by one:
 *
 *            w                 piece of v: the polygon of the circumcentres of
 *           /|\                  (p, u, v), the cavity's triangles at v from edge uv to edge vw, (p, v, w)
 *          / | \
 *         /  |  \              uv and vw are edges of the boundary; what lies beyond them is not in the cavity
 *        /   p   \
 *       /  .   .  \
 *      v-----------u
 *
 * The sum of weight * (vertex - p) is 0; what rounding leaves of it is corrected with the slope of the triangle that
 * contains p, so linear functions are reproduced. On the hull, where a circumcentre is infinite, in thin triangles, of
 * which there are some along it, and where that correction is more than a little, as beside vertices 10^10 times as far
 * away as others, the function is linear.
 */
#ifndef CADT_QUERIES_NATURAL_NEIGHBOR_H
#define CADT_QUERIES_NATURAL_NEIGHBOR_H

#include "common/queries/circumcenter.dev.h"
#include "common/queries/interpolate.dev.h"

/* Whether p lies strictly inside the circle of triangle t. Ties need no decision: the piece that they add has no area.
 */
CADT_FN cadt_u32 cadt_in_circle(const cadt_query_mesh* m, cadt_u32 t, cadt_point p) {
  const cadt_point a = cadt_corner(m, t, 0u), b = cadt_corner(m, t, 1u), c = cadt_corner(m, t, 2u);
  cadt_real max_det;
  const cadt_i32 sign = cadt_incircle_filter(a, b, c, p, &max_det);
  return (sign != 0 ? sign : cadt_incircle_exact(a, b, c, p, max_det)) > 0 ? 1u : 0u;
}

/* An edge of the cavity's boundary: edge k of a triangle of the cavity. */
typedef struct {
  cadt_u32 triangle, k;
} cadt_cavity_edge;

/* From boundary edge e, u -> v, around v to the next one, v -> w. Returns twice the area of the piece of v. `center`:
 * of p, u, v; then of p, v, w. Centres are seen from p. */
CADT_FN cadt_real cadt_next_piece(const cadt_query_mesh* m, cadt_point p, cadt_cavity_edge* e, cadt_point v,
                                  cadt_point* w, cadt_point* center, cadt_u32* steps) {
  const cadt_point first = *center;
  cadt_point before = first;
  cadt_real area = 0.0;
  cadt_u32 t = e->triangle, k = e->k; /* v is the vertex after next of edge k: k + 2 */
  for (;; ++*steps) {
    const cadt_point next_center = cadt_center_seen_from(cadt_center_of_triangle(m, t), p);
    area += cadt_cross(before.x - first.x, before.y - first.y, next_center.x - first.x, next_center.y - first.y);
    before = next_center;
    const cadt_u32 across = CADT_NEXT(k), next = cadt_neighbor_of(&m->view, t, across); /* the edge that leaves v */
    if (next == CADT_NONE || !cadt_in_circle(m, next, p)) {
      e->triangle = t;
      e->k = across;
      *w = cadt_corner(m, t, k);
      break;
    }
    k = cadt_edge_towards(m, next, t);
    t = next;
  }
  *center = cadt_center_seen_from(cadt_center_of(p, v, *w), p);
  area += cadt_cross(before.x - first.x, before.y - first.y, center->x - first.x, center->y - first.y);
  return cadt_fabs(area);
}

/* The first boundary edge: from triangle t of the cavity, out through edge 0 as long as there is more of it. Edges seen
 * from p strictly inside lead away from it, so this ends. */
CADT_FN cadt_cavity_edge cadt_first_cavity_edge(const cadt_query_mesh* m, cadt_point p, cadt_u32 t) {
  cadt_cavity_edge e = {t, 0u};
  for (;;) {
    const cadt_u32 next = cadt_neighbor_of(&m->view, e.triangle, e.k);
    if (next == CADT_NONE || !cadt_in_circle(m, next, p)) return e;
    const cadt_u32 back = cadt_edge_towards(m, next, e.triangle);
    e.triangle = next;
    e.k = CADT_NEXT(back);
    /* the one of the two other edges that does not have p beyond it */
    if (cadt_side(cadt_corner(m, next, CADT_NEXT(e.k)), cadt_corner(m, next, CADT_PREV(e.k)), p) <= 0)
      e.k = CADT_PREV(back);
  }
}

/* How much the linear function of triangle t with values fa, fb, fc rises along `way`. */
CADT_FN cadt_real cadt_rise_along(const cadt_query_mesh* m, cadt_u32 t, cadt_real fa, cadt_real fb, cadt_real fc,
                                  cadt_point way) {
  const cadt_point a = cadt_corner(m, t, 0u), b = cadt_corner(m, t, 1u), c = cadt_corner(m, t, 2u);
  const cadt_point ab = cadt_seen_from(b, a), ac = cadt_seen_from(c, a);
  const cadt_real left = ab.x * ac.y, right = ab.y * ac.x;
  cadt_real area = left - right;
#if CADT_GRADUAL_UNDERFLOW && !CADT_WIDE
  if (area < CADT_ROUNDED * (cadt_fabs(left) + cadt_fabs(right))) area = cadt_area_of_arms(a, b, c);
#endif
  return ((fb - fa) * cadt_cross(way.x, way.y, ac.x, ac.y) - (fc - fa) * cadt_cross(way.x, way.y, ab.x, ab.y)) / area;
}

/* A factor for values, 1 unless those of triangle t are so small that their products with the areas of pieces, which
 * may be 2^-480 and less, would underflow. A function of its own: nothing of it stays in registers. */
CADT_FN_SLOW cadt_real cadt_factor_of_values(const cadt_query_mesh* m, cadt_u32 t, CADT_GLOBAL const cadt_real* values,
                                             cadt_u32 per_point, cadt_u32 of) {
  const cadt_u64 a = cadt_vertex_of(&m->view, t, 0u), b = cadt_vertex_of(&m->view, t, 1u),
                 c = cadt_vertex_of(&m->view, t, 2u);
  const cadt_real fa = values[a * per_point + of], fb = values[b * per_point + of], fc = values[c * per_point + of];
  return cadt_fabs(fa) + cadt_fabs(fb) + cadt_fabs(fc) < 0x1p-480 ? 0x1p540 : 1.0;
}

/* Value `of` at p in triangle t, strictly inside of the hull, by the boundary of its cavity from edge `begin` on.
 * Infinite or NaN where a circumcentre has overflowed, or rounding has changed the weights. */
CADT_FN cadt_real cadt_natural_value(const cadt_query_mesh* m, cadt_point p, cadt_u32 t, cadt_cavity_edge begin,
                                     CADT_GLOBAL const cadt_real* values, cadt_u32 per_point, cadt_u32 of,
                                     cadt_u32* open) {
  const cadt_real factor = cadt_factor_of_values(m, t, values, per_point, of);
  cadt_cavity_edge e = begin;
  cadt_point v = cadt_corner(m, e.triangle, CADT_PREV(e.k)), mean = {0.0, 0.0};
  cadt_point center = cadt_center_seen_from(cadt_center_of(p, cadt_corner(m, e.triangle, CADT_NEXT(e.k)), v), p);
  cadt_real all = 0.0, sum = 0.0;
  cadt_u32 steps = 0u;
  do {
    const cadt_u64 id = cadt_vertex_of(&m->view, e.triangle, CADT_PREV(e.k));
    cadt_point w = v;
    const cadt_real weight = cadt_next_piece(m, p, &e, v, &w, &center, &steps);
    if (weight != 0.0) {
      const cadt_point arm = cadt_seen_from(v, p);
      all += weight;
      sum += weight * (factor * values[id * per_point + of]);
      mean.x += weight * arm.x;
      mean.y += weight * arm.y;
    }
    v = w;
    if (++steps > 3u * m->view.triangles) {
      *open = 1u;
      break;
    }
  } while (e.triangle != begin.triangle || e.k != begin.k);
  mean.x /= all;
  mean.y /= all;
  const cadt_u64 a = cadt_vertex_of(&m->view, t, 0u), b = cadt_vertex_of(&m->view, t, 1u),
                 c = cadt_vertex_of(&m->view, t, 2u);
  const cadt_real fa = factor * values[a * per_point + of], fb = factor * values[b * per_point + of],
                  fc = factor * values[c * per_point + of];
  const cadt_real correction = cadt_rise_along(m, t, fa, fb, fc, mean), rise = cadt_fabs(fb - fa) + cadt_fabs(fc - fa);
  return cadt_fabs(correction) <= CADT_ROUNDED * rise ? (sum / all - correction) / factor : CADT_NAN;
}

/* `per_point` values a query, as in cadt_interpolate_linear. `failed`: how many boundaries did not close, which cannot
 * be in a Delaunay mesh. */
CADT_KERNEL(cadt_interpolate_natural, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL const cadt_point* queries,
            CADT_GLOBAL const cadt_u32* order, CADT_GLOBAL const cadt_u32* located, CADT_GLOBAL const cadt_u32* nearest,
            CADT_GLOBAL const cadt_real* values, cadt_u32 per_point, CADT_GLOBAL cadt_real* results,
            CADT_GLOBAL cadt_u32* failed, cadt_u32 count, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_FOR(i, count, grain) {
    const cadt_u32 q = order ? order[i] : i, t = located[q];
    const cadt_point p = cadt_scaled_point(&mesh, queries + q);
    CADT_GLOBAL cadt_real* result = results + CADT_CAST(cadt_u64, q) * per_point;
    if (t == CADT_NONE) {
      for (cadt_u32 of = 0u; of < per_point; ++of)
        result[of] = nearest ? values[CADT_CAST(cadt_u64, nearest[q]) * per_point + of] : CADT_NAN;
      continue;
    }
    cadt_u32 thin, open = 0u;
    const cadt_weights w =
        cadt_barycentric(cadt_corner(&mesh, t, 0u), cadt_corner(&mesh, t, 1u), cadt_corner(&mesh, t, 2u), p, &thin);
    const cadt_u32 linear = thin || w.at[0] == 1.0 || w.at[1] == 1.0 || w.at[2] == 1.0 ? 1u : 0u; /* or at a vertex */
    const cadt_cavity_edge none = {t, 0u}, begin = linear ? none : cadt_first_cavity_edge(&mesh, p, t);
    for (cadt_u32 of = 0u; of < per_point; ++of) {
      cadt_real value = CADT_NAN;
      if (!linear) value = cadt_natural_value(&mesh, p, t, begin, values, per_point, of, &open);
      /* not finite: a circumcentre has overflowed, or a value is not finite */
      result[of] = value - value == 0.0 ? value : cadt_weighted(&mesh, t, &w, values, per_point, of);
    }
    if (open) cadt_add_relaxed(failed, 1u);
  }
}

#endif
