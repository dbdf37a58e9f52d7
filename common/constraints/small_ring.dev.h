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
 * no vertex in it, which would be a candidate before it, and no edge passes through. An edge that does crosses both
 * sides, or begins at an end of the base and crosses the side opposite of it.
 *
 * Vertices are numbered along the ring, counterclockwise; edge e goes from vertex e to the next one.
 */
#ifndef CADT_CONSTRAINTS_SMALL_RING_H
#define CADT_CONSTRAINTS_SMALL_RING_H

#include "common/predicates/filtered_predicates.dev.h"

enum {
  CADT_SMALL_RING = 32, /* vertices at most: each is a bit of a word */
  CADT_RING_LANES = 4,  /* loops go on to a multiple, for compilers that vectorise them */
  CADT_RING_ROOM = CADT_SMALL_RING + CADT_RING_LANES
};
#define CADT_HIGHEST_BIT(word) (63u - cadt_clz64(word))
/* All bits if the condition, 0 or 1, holds: a branch would be mispredicted half of the time. */
#define CADT_MASK_IF(condition) (0u - CADT_CAST(cadt_u32, condition))

typedef struct {
  CADT_GLOBAL const cadt_point* points;
  cadt_u32 count, clockwise;
  float x[CADT_RING_ROOM], y[CADT_RING_ROOM]; /* from the first point on; the extent is 1; if clockwise, -x */
  cadt_u32 bit[CADT_RING_ROOM];               /* 1 << i, or 0 behind the last vertex */
  cadt_u32 left[CADT_RING_ROOM];              /* of a vertex: the edges that have it on their left or end there */
} cadt_small_ring;

CADT_FN cadt_u32 cadt_whole_lanes(cadt_u32 count) {
  return (count + CADT_CAST(cadt_u32, CADT_RING_LANES) - 1u) & ~(CADT_CAST(cadt_u32, CADT_RING_LANES) - 1u);
}

/* 1: c lies on the left of the line from a to b, seen along a counterclockwise ring; 0: on it; -1: on the right */
CADT_FN_SLOW cadt_i32 cadt_turn_in_ring(const cadt_small_ring* r, cadt_u32 a, cadt_u32 b, cadt_u32 c) {
  const cadt_point p = cadt_load_point(r->points + a), q = cadt_load_point(r->points + b),
                   s = cadt_load_point(r->points + c);
  const cadt_i32 rounded = cadt_orientation_filter(p, q, s),
                 sign = rounded != CADT_UNSURE ? rounded : cadt_orientation_exact(p, q, s);
  return r->clockwise ? -sign : sign;
}

/* 0: the area is so small that rounding might decide its sign. \pre r has points and count */
CADT_FN cadt_u32 cadt_measure_ring(cadt_small_ring* r) {
  const cadt_u32 n = r->count;
  const cadt_point origin = cadt_load_point(r->points);
  cadt_real x = 0.0, y = 0.0, most_x = 0.0, most_y = 0.0, area = 0.0;
  for (cadt_u32 i = 1u; i < n; ++i) {
    const cadt_point p = cadt_load_point(r->points + i);
    const cadt_real next_x = p.x - origin.x, next_y = p.y - origin.y;
    most_x = cadt_fabs(next_x) > most_x ? cadt_fabs(next_x) : most_x;
    most_y = cadt_fabs(next_y) > most_y ? cadt_fabs(next_y) : most_y;
    area += x * next_y - y * next_x;
    x = next_x;
    y = next_y;
  }
  const cadt_real extent = most_x > most_y ? most_x : most_y;
  /* Of 30 terms below 2 extent^2, each rounded three times as often as u = 2^-53, their sum 30 times: below 2^12 u. */
  if (!(cadt_fabs(area) > 0x1p-40 * (extent * extent))) return 0u;
  r->clockwise = area < 0.0 ? 1u : 0u;
  const cadt_real unit_y = 1.0 / extent, unit_x = r->clockwise ? -unit_y : unit_y;
  for (cadt_u32 i = 0u; i < n; ++i) {
    const cadt_point p = cadt_load_point(r->points + i);
    r->x[i] = CADT_CAST(float, (p.x - origin.x) * unit_x);
    r->y[i] = CADT_CAST(float, (p.y - origin.y) * unit_y);
    r->bit[i] = 1u << i;
  }
  for (cadt_u32 i = n; i < n + CADT_CAST(cadt_u32, CADT_RING_LANES); ++i) {
    r->x[i] = r->y[i] = 0.0f; /* as vertex 0 */
    r->bit[i] = 0u;
  }
  return 1u;
}

/* Compares all vertices with all edges. 0: a vertex lies on an edge that it is no end of, or at its end
 *
 * Nearly all by floats. With u = 2^-24: a coordinate is at most 1 and has an error of u / 2, a component of an edge is
 * at most 2 and has 2 u, a product of the two 4 u, and the sum of four of them, at most 8, has 16 u + 10 u. */
#define CADT_RING_UNSURE 0x1p-19f /* 32 u */
CADT_FN cadt_u32 cadt_find_sides(cadt_small_ring* r) {
  const cadt_u32 n = r->count, padded = cadt_whole_lanes(n), all = 0xFFFFFFFFu >> (32u - n);
  float edge_x[CADT_SMALL_RING], edge_y[CADT_SMALL_RING], offset[CADT_SMALL_RING];
  for (cadt_u32 e = 0u; e < padded; ++e) {
    const float x = r->x[e + 1u] - r->x[e], y = r->y[e + 1u] - r->y[e];
    edge_x[e] = x;
    edge_y[e] = y;
    offset[e] = y * r->x[e] - x * r->y[e];
  }
  cadt_u32 own = 1u | 1u << (n - 1u); /* the edges that end at v */
  for (cadt_u32 v = 0u; v < n; ++v) {
    const float x = r->x[v], y = r->y[v];
    cadt_u32 left = 0u, right = 0u;
    for (cadt_u32 e = 0u; e < padded; ++e) {
      const float side = offset[e] + edge_x[e] * y - edge_y[e] * x;
      left |= CADT_MASK_IF(side > CADT_RING_UNSURE) & r->bit[e];
      right |= CADT_MASK_IF(side < -CADT_RING_UNSURE) & r->bit[e];
    }
    left |= own;
    for (cadt_u32 unsure = all & ~(left | right); unsure;) {
      const cadt_u32 e = CADT_HIGHEST_BIT(unsure), next = e + 1u == n ? 0u : e + 1u;
      const cadt_i32 side = cadt_turn_in_ring(r, e, next, v);
      const cadt_point p = cadt_load_point(r->points + v), a = cadt_load_point(r->points + e),
                       b = cadt_load_point(r->points + next);
      if (side > 0) left |= 1u << e;
      if (side == 0 && !(cadt_before(p, a) && cadt_before(p, b)) && !(cadt_before(a, p) && cadt_before(b, p)))
        return 0u;
      unsure ^= 1u << e;
    }
    r->left[v] = left;
    own = 3u << v;
  }
  return 1u;
}

/* Whether two edges cross. A vertex on the line of an edge, but not on the edge, may count for either side. */
CADT_FN cadt_u32 cadt_ring_crosses(cadt_small_ring* r) {
  const cadt_u32 n = r->count, padded = cadt_whole_lanes(n);
  cadt_u32 parted[CADT_SMALL_RING]; /* of an edge: those whose lines part its ends, but for its neighbours */
  for (cadt_u32 i = n; i < n + CADT_CAST(cadt_u32, CADT_RING_LANES); ++i) r->left[i] = r->left[0];
  for (cadt_u32 e = 0u; e < padded; ++e)
    parted[e] = (r->left[e] ^ r->left[e + 1u]) & ~(r->bit[e] | r->bit[e] << 1u | r->bit[e] >> 1u);
  parted[n - 1u] &= ~1u;
  cadt_u32 crossing = 0u;
  for (cadt_u32 e = 1u; e < n; ++e) {
    const cadt_u32 some = cadt_whole_lanes(e);
    cadt_u32 parts = 0u; /* edges before it whose ends its line parts */
    for (cadt_u32 f = 0u; f < some; ++f) parts |= CADT_MASK_IF(parted[f] >> e & 1u) & r->bit[f];
    crossing |= parts & parted[e];
  }
  return crossing;
}

/* The apex over a base among candidates, by an exact comparison each. */
CADT_FN_SLOW cadt_u32 cadt_ring_apex_exact(const cadt_small_ring* r, cadt_u32 low, cadt_u32 high, cadt_u32 candidates) {
  CADT_DECLARE_COUNTERS(counters);
  const cadt_point p = cadt_load_point(r->points + (r->clockwise ? high : low)),
                   q = cadt_load_point(r->points + (r->clockwise ? low : high));
  cadt_u32 apex = CADT_NONE;
  for (; candidates; candidates ^= 1u << CADT_HIGHEST_BIT(candidates)) {
    const cadt_u32 v = CADT_HIGHEST_BIT(candidates);
    if (cadt_turn_in_ring(r, low, v, high) <= 0) continue;
    if (apex == CADT_NONE ||
        cadt_incircle(p, cadt_load_point(r->points + apex), q, cadt_load_point(r->points + v), &counters) > 0)
      apex = v;
  }
  return apex;
}

/* The apex over a base among the vertices beyond it: the cotangent of its angle is the smallest one.
 *
 * By floats, its numerator and denominator have errors of d = CADT_RING_UNSURE each. Where the denominator s is above
 * 4 d, the cotangent c has one below 4 d (1 + |c|) / (3 s), and `error` has three times that, for all rounding. Several
 * candidates are left to exact comparisons. */
CADT_FN cadt_u32 cadt_ring_apex(const cadt_small_ring* r, cadt_u32 low, cadt_u32 high) {
  const cadt_u32 n = high - low - 1u, first = low + 1u, padded = cadt_whole_lanes(n);
  const float unsure = 4.0f * CADT_RING_UNSURE;
  const float px = r->x[low], py = r->y[low], qx = r->x[high], qy = r->y[high], base_x = qx - px, base_y = qy - py;
  float least[CADT_RING_ROOM], most[CADT_RING_ROOM];
  cadt_u32 candidates = 0u;
  for (cadt_u32 i = 0u; i < padded; ++i) {
    const float x = r->x[first + i], y = r->y[first + i];
    const float sine = (x - px) * base_y - (y - py) * base_x, cosine = (x - px) * (x - qx) + (y - py) * (y - qy);
    const float no = sine > unsure ? 0.0f : 2e38f, inverse = 1.0f / (cadt_fabsf(sine) + 0x1p-60f);
    const float cotangent = cosine * inverse, error = unsure * inverse * (1.0f + cadt_fabsf(cotangent));
    least[i] = cotangent - error + no;
    most[i] = cotangent + error + no;
    candidates |= CADT_MASK_IF(cadt_fabsf(sine) <= unsure) & r->bit[i];
  }
  float bound = 1e38f;
  for (cadt_u32 i = 0u; i < n; ++i) bound = cadt_minf(bound, most[i]);
  for (cadt_u32 i = 0u; i < padded; ++i) candidates |= CADT_MASK_IF(least[i] <= bound) & r->bit[i];
  candidates = candidates << first & (r->bit[high] - 1u);
  if (!(candidates & (candidates - 1u)) && bound < 1e38f) return CADT_HIGHEST_BIT(candidates);
  return cadt_ring_apex_exact(r, low, high, candidates);
}

/* Whether the triangle over a base lies inside, after candidates before it do not. */
CADT_FN cadt_u32 cadt_triangle_is_inside(const cadt_small_ring* r, cadt_u32 low, cadt_u32 apex, cadt_u32 high,
                                         cadt_u32 tried) {
  for (; tried; tried ^= 1u << CADT_HIGHEST_BIT(tried)) {
    const cadt_u32 v = CADT_HIGHEST_BIT(tried);
    if (cadt_turn_in_ring(r, low, apex, v) >= 0 && cadt_turn_in_ring(r, apex, high, v) >= 0) return 0u;
  }
  /* The first edge from the base to an apex that it hides has them on its left and on its right. */
  cadt_u32 edges = r->left[low] & r->left[high] & ~r->left[apex] & (r->bit[high] - r->bit[low]);
  if (low + 1u == apex || apex + 1u == high) edges = 0u; /* an edge that obstructs it would cross that edge */
  for (; edges; edges ^= 1u << CADT_HIGHEST_BIT(edges)) {
    const cadt_u32 e = CADT_HIGHEST_BIT(edges), end = e == low ? high : low;
    if (cadt_turn_in_ring(r, end, apex, e) * cadt_turn_in_ring(r, end, apex, e + 1u) < 0) return 0u;
  }
  return 1u;
}

CADT_FN void cadt_write_ring_triangle(const cadt_small_ring* r, cadt_u32 low, cadt_u32 apex, cadt_u32 high,
                                      cadt_u32 base, CADT_GLOBAL cadt_u32* out) {
  out[0] = base + (r->clockwise ? high : low);
  out[1] = base + apex;
  out[2] = base + (r->clockwise ? low : high);
}

#define CADT_RING_BASE(low, high) ((low) << 8 | (high))
/* The triangles inside a ring of `count` points, to `out`, as numbers of points from `base` on. How many; 0: the ring
 * is left to others. \pre no coordinate needs more than the narrow arithmetic */
CADT_FN cadt_u32 cadt_triangulate_ring(CADT_GLOBAL const cadt_point* points, cadt_u32 count, cadt_u32 base,
                                       CADT_GLOBAL cadt_u32* out) {
  cadt_small_ring ring;
  if (count > 1u && points[0].x == points[count - 1u].x && points[0].y == points[count - 1u].y) --count;
  if (count < 3u || count > CADT_CAST(cadt_u32, CADT_SMALL_RING)) return 0u;
  ring.points = points;
  ring.count = count;
  if (!cadt_measure_ring(&ring) || !cadt_find_sides(&ring) || cadt_ring_crosses(&ring)) return 0u;
  cadt_u32 bases[CADT_SMALL_RING], waiting = 1u, triangles = 0u;
  bases[0] = CADT_RING_BASE(0u, count - 1u);
  while (waiting) {
    const cadt_u32 low = bases[--waiting] >> 8, high = bases[waiting] & 255u;
    const cadt_u32 several = low + 2u < high ? 1u : 0u;
    cadt_u32 tried = 0u, apex = several ? cadt_ring_apex(&ring, low, high) : low + 1u;
    while (several && apex != CADT_NONE && !cadt_triangle_is_inside(&ring, low, apex, high, tried)) {
      tried |= 1u << apex;
      apex = cadt_ring_apex_exact(&ring, low, high, (ring.bit[high] - 2u * ring.bit[low]) & ~tried);
    }
    if (apex == CADT_NONE) return 0u; /* there always is one */
    cadt_write_ring_triangle(&ring, low, apex, high, base, out + 3u * triangles++);
    bases[waiting] = CADT_RING_BASE(low, apex);
    waiting += low + 1u < apex ? 1u : 0u;
    bases[waiting] = CADT_RING_BASE(apex, high);
    waiting += apex + 1u < high ? 1u : 0u;
  }
  return triangles;
}

#endif
