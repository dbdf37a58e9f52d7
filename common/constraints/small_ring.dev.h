/* SPDX-License-Identifier: Apache-2.0
 *
 * The inside of one small ring in triangles, by one work-item, without a mesh. First all vertices are compared with all
 * edges; a ring that crosses or touches itself is left to the sweep. Then the polygon is divided from a base, an edge
 * of the ring:
 *
 *             apex                  The apex is the vertex that sees both ends of the base and has no other such vertex
 *       .    /   \    .             in its circle through them: nothing that is visible from the triangle lies in its
 *     .     /     \     .           circle, so it is one of the constrained Delaunay triangulation. On both sides are
 *    .     /       \     .          edges of the ring, or bases of the vertices beyond.
 *    low =========== high
 *
 * Beyond the base such circles are nested. Candidates are tried from the smallest one on, until the triangle of one has
 * no vertex in it, which would be a candidate before it, and no edge passes through. An edge that does leaves the
 * triangle by two sides other than the base, or begins at an end of the base and leaves by the opposite side.
 *
 * Vertices are numbered along the ring, counterclockwise; edge e goes from vertex e to the next one.
 */
#ifndef CADT_CONSTRAINTS_SMALL_RING_H
#define CADT_CONSTRAINTS_SMALL_RING_H

#include "common/predicates/filtered_predicates.dev.h"

enum { CADT_SMALL_RING = 32 }; /* vertices at most: each is a bit of a word */
#define CADT_HIGHEST_BIT(word) (63u - cadt_clz64(word))

typedef struct {
  cadt_point points[CADT_SMALL_RING];
  cadt_u32 left[CADT_SMALL_RING]; /* of a vertex: the edges that have it on their left. Not those whose line it is on */
  cadt_u32 count;
  cadt_real extent; /* the largest difference of a coordinate from that of the first point */
} cadt_small_ring;

CADT_FN cadt_i32 cadt_turn_in_ring(const cadt_small_ring* r, cadt_u32 a, cadt_u32 b, cadt_u32 c) {
  const cadt_i32 sign = cadt_orientation_filter(r->points[a], r->points[b], r->points[c]);
  return sign != CADT_UNSURE ? sign : cadt_orientation_exact(r->points[a], r->points[b], r->points[c]);
}

/* The points in counterclockwise order. Whether this is the given order (1) or the reverse (2). 0: the area is so small
 * that rounding might decide. */
CADT_FN cadt_u32 cadt_load_ring(cadt_small_ring* r, CADT_GLOBAL const cadt_point* points, cadt_u32 count) {
  const cadt_point origin = cadt_load_point(points);
  cadt_real x = 0.0, y = 0.0, most_x = 0.0, most_y = 0.0, area = 0.0;
  for (cadt_u32 i = 1u; i < count; ++i) {
    const cadt_point p = cadt_load_point(points + i);
    const cadt_real next_x = p.x - origin.x, next_y = p.y - origin.y;
    most_x = cadt_fabs(next_x) > most_x ? cadt_fabs(next_x) : most_x;
    most_y = cadt_fabs(next_y) > most_y ? cadt_fabs(next_y) : most_y;
    area += x * next_y - y * next_x;
    x = next_x;
    y = next_y;
  }
  r->count = count;
  r->extent = most_x > most_y ? most_x : most_y;
  /* Of 30 terms below 2 extent^2, each rounded three times as often as u = 2^-53, their sum 30 times: below 2^12 u. */
  if (!(cadt_fabs(area) > 0x1p-40 * (r->extent * r->extent))) return 0u;
  const cadt_u32 reversed = area < 0.0 ? 1u : 0u;
  for (cadt_u32 i = 0u; i < count; ++i) r->points[i] = cadt_load_point(points + (reversed ? count - 1u - i : i));
  return 1u + reversed;
}

/* Compares all vertices with all edges. 0: a vertex lies on an edge that it is no end of, or at its end
 *
 * Nearly all by floats, coordinates from the first vertex on in units of the extent. With u = 2^-24: a coordinate is
 * below 1 and has an error of u / 2, a component of an edge is below 2 and has 2 u, a product of the two is below 2 and
 * has 4 u, the sum of four of them is below 8 and has 16 u + 10 u. */
#define CADT_RING_UNSURE 0x1p-19f /* 32 u */
CADT_FN cadt_u32 cadt_find_sides(cadt_small_ring* r) {
  const cadt_u32 n = r->count, padded = (n + 3u) & ~3u;
  const cadt_real unit = 1.0 / r->extent;
  const cadt_point origin = r->points[0];
  float x[CADT_SMALL_RING], y[CADT_SMALL_RING], edge_x[CADT_SMALL_RING], edge_y[CADT_SMALL_RING],
      offset[CADT_SMALL_RING];
  cadt_u32 bit[CADT_SMALL_RING];
  for (cadt_u32 v = 0u; v < n; ++v) {
    x[v] = CADT_CAST(float, (r->points[v].x - origin.x) * unit);
    y[v] = CADT_CAST(float, (r->points[v].y - origin.y) * unit);
  }
  for (cadt_u32 e = 0u; e < n; ++e) {
    const cadt_u32 next = e + 1u == n ? 0u : e + 1u;
    edge_x[e] = x[next] - x[e];
    edge_y[e] = y[next] - y[e];
    offset[e] = edge_y[e] * x[e] - edge_x[e] * y[e];
    bit[e] = 1u << e;
  }
  for (cadt_u32 e = n; e < padded; ++e) {
    edge_x[e] = edge_y[e] = offset[e] = 0.0f;
    bit[e] = 0u;
  }
  for (cadt_u32 v = 0u; v < n; ++v) {
    cadt_u32 left = 0u, right = 0u;
    for (cadt_u32 e = 0u; e < padded; ++e) {
      const float side = offset[e] + edge_x[e] * y[v] - edge_y[e] * x[v];
      left |= side > CADT_RING_UNSURE ? bit[e] : 0u;
      right |= side < -CADT_RING_UNSURE ? bit[e] : 0u;
    }
    const cadt_u32 own = bit[v] | bit[v ? v - 1u : n - 1u];
    cadt_u32 unsure = 0xFFFFFFFFu >> (32u - n) & ~(left | right | own);
    left &= ~own;
    while (unsure) {
      const cadt_u32 e = CADT_HIGHEST_BIT(unsure), next = e + 1u == n ? 0u : e + 1u;
      const cadt_i32 side = cadt_turn_in_ring(r, e, next, v);
      const cadt_point p = r->points[v], a = r->points[e], b = r->points[next];
      if (side > 0) left |= bit[e];
      if (side == 0 && !(cadt_before(p, a) && cadt_before(p, b)) && !(cadt_before(a, p) && cadt_before(b, p)))
        return 0u;
      unsure ^= bit[e];
    }
    r->left[v] = left;
  }
  return 1u;
}

/* Whether two edges cross. A vertex on the line of an edge, but not on the edge, may count for either side. */
CADT_FN cadt_u32 cadt_ring_crosses(const cadt_small_ring* r) {
  const cadt_u32 n = r->count;
  cadt_u32 parted[CADT_SMALL_RING]; /* of an edge: the others whose lines part its ends */
  for (cadt_u32 e = 0u; e < n; ++e) {
    const cadt_u32 next = e + 1u == n ? 0u : e + 1u, before = e ? e - 1u : n - 1u;
    parted[e] = (r->left[e] ^ r->left[next]) & ~(1u << e | 1u << next | 1u << before);
  }
  cadt_u32 crossing = 0u;
  for (cadt_u32 e = 0u; e < n; ++e) {
    cadt_u32 parts = 0u; /* those whose ends the line of e parts */
    for (cadt_u32 f = 0u; f < n; ++f) parts |= (parted[f] >> e & 1u) << f;
    crossing |= parts & parted[e];
  }
  return crossing;
}

/* The apex over a base among the vertices beyond it, but for those in `tried`: an exact comparison each. */
CADT_FN cadt_u32 cadt_ring_apex_exact(const cadt_small_ring* r, cadt_u32 low, cadt_u32 high, cadt_u32 tried) {
  CADT_DECLARE_COUNTERS(counters);
  cadt_u32 apex = CADT_NONE;
  for (cadt_u32 v = low + 1u; v < high; ++v) {
    if ((tried >> v & 1u) || cadt_turn_in_ring(r, low, v, high) <= 0) continue;
    if (apex == CADT_NONE ||
        cadt_incircle(r->points[low], r->points[apex], r->points[high], r->points[v], &counters) > 0)
      apex = v;
  }
  return apex;
}

/* The same. The cotangent of the angle at the apex is the smallest one; numerator and denominator of each are below
 * 8 extent^2 and have an error of 32 u extent^2, with u = 2^-53; the difference of two products 1280 u extent^4. */
CADT_FN cadt_u32 cadt_ring_apex(const cadt_small_ring* r, cadt_u32 low, cadt_u32 high, cadt_u32 tried) {
  if (low + 2u == high) return tried ? CADT_NONE : low + 1u;
  const cadt_real square = r->extent * r->extent, bound = 0x1p-47 * square, bound_of_product = 0x1p-42 * square * square;
  const cadt_point p = r->points[low], q = r->points[high];
  const cadt_real base_x = q.x - p.x, base_y = q.y - p.y;
  cadt_u32 apex = CADT_NONE;
  cadt_real cosine = 32.0 * square, sine = 0.0; /* each times the sides */
  for (cadt_u32 v = low + 1u; v < high; ++v) {
    const cadt_point a = r->points[v];
    const cadt_real px = a.x - p.x, py = a.y - p.y;
    const cadt_real next_sine = px * base_y - py * base_x, next_cosine = px * (a.x - q.x) + py * (a.y - q.y);
    const cadt_real difference = next_cosine * sine - cosine * next_sine;
    if (next_sine < -bound) continue;
    if (!(next_sine > bound) || !(cadt_fabs(difference) > bound_of_product) || tried)
      return cadt_ring_apex_exact(r, low, high, tried);
    if (difference > 0.0) continue;
    apex = v;
    sine = next_sine;
    cosine = next_cosine;
  }
  return apex;
}

/* Whether an edge between low and high crosses the line from a to b within both. */
CADT_FN cadt_u32 cadt_ring_obstructs(const cadt_small_ring* r, cadt_u32 a, cadt_u32 b, cadt_u32 low, cadt_u32 high) {
  /* a and b are on different sides of it. From `low` to below `high`: */
  cadt_u32 edges = (r->left[a] ^ r->left[b]) & ((1u << high) - (1u << low));
  edges &= ~(1u << a | 1u << b | (1u << a | 1u << b) >> 1);
  for (; edges; edges ^= 1u << CADT_HIGHEST_BIT(edges)) {
    const cadt_u32 e = CADT_HIGHEST_BIT(edges);
    if (cadt_turn_in_ring(r, a, b, e) * cadt_turn_in_ring(r, a, b, e + 1u) < 0) return 1u;
  }
  return 0u;
}

/* Whether the triangle over a base lies inside, after candidates before it do not. */
CADT_FN cadt_u32 cadt_triangle_is_inside(const cadt_small_ring* r, cadt_u32 low, cadt_u32 apex, cadt_u32 high,
                                         cadt_u32 tried) {
  for (; tried; tried ^= 1u << CADT_HIGHEST_BIT(tried)) {
    const cadt_u32 v = CADT_HIGHEST_BIT(tried);
    if (cadt_turn_in_ring(r, low, apex, v) >= 0 && cadt_turn_in_ring(r, apex, high, v) >= 0) return 0u;
  }
  if (low + 1u == apex || apex + 1u == high) return 1u; /* what crosses two sides would cross an edge */
  return !cadt_ring_obstructs(r, low, apex, low, high) && !cadt_ring_obstructs(r, apex, high, low, high) ? 1u : 0u;
}

/* The triangles inside a ring of `count` points, to `out`, as numbers of points from `base` on. How many; 0: the ring
 * is left to others. \pre no coordinate needs more than the narrow arithmetic */
CADT_FN cadt_u32 cadt_triangulate_ring(CADT_GLOBAL const cadt_point* points, cadt_u32 count, cadt_u32 base,
                                       CADT_GLOBAL cadt_u32* out) {
  cadt_small_ring ring;
  if (count > 1u && points[0].x == points[count - 1u].x && points[0].y == points[count - 1u].y) --count;
  if (count < 3u || count > CADT_CAST(cadt_u32, CADT_SMALL_RING)) return 0u;
  const cadt_u32 loaded = cadt_load_ring(&ring, points, count);
  if (!loaded || !cadt_find_sides(&ring) || cadt_ring_crosses(&ring)) return 0u;
  cadt_u32 waiting[CADT_SMALL_RING], depth = 0u, triangles = 0u, low = 0u, high = count - 1u;
  for (;;) {
    cadt_u32 apex, tried = 0u;
    for (;;) {
      apex = cadt_ring_apex(&ring, low, high, tried);
      if (apex == CADT_NONE) return 0u;
      if (cadt_triangle_is_inside(&ring, low, apex, high, tried)) break;
      tried |= 1u << apex;
    }
    const cadt_u32 corners[3] = {low, apex, high};
    for (cadt_u32 k = 0u; k < 3u; ++k)
      out[3u * triangles + k] = base + (loaded == 2u ? count - 1u - corners[k] : corners[k]);
    ++triangles;
    if (apex + 1u < high) waiting[depth++] = apex << 8 | high;
    high = apex;
    if (low + 1u < apex) continue;
    if (!depth) return triangles;
    low = waiting[--depth] >> 8;
    high = waiting[depth] & 255u;
  }
}

#endif
