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

#include "common/portable/lanes.dev.h"
#include "common/predicates/filtered_predicates.dev.h"

#define CADT_SMALL_RING 32u /* vertices at most: each is a bit of a word */
#define CADT_RING_ROOM (CADT_SMALL_RING + CADT_LANES)
#define CADT_HIGHEST_BIT(word) (63u - cadt_clz64(word))
/* All bits if the condition, 0 or 1, holds: a branch would be mispredicted half of the time. */
#define CADT_MASK_IF(condition) (0u - CADT_CAST(cadt_u32, condition))

typedef struct {
  CADT_GLOBAL const cadt_point* points;
  cadt_u32 count, clockwise, wide; /* wide: an exact comparison has met coordinates for the wide arithmetic */
  float x[CADT_RING_ROOM], y[CADT_RING_ROOM]; /* from the first point on; the extent is 1; if clockwise, -x */
  cadt_u32 left[CADT_RING_ROOM];              /* of a vertex: the edges that have it on their left or end there */
} cadt_small_ring;

CADT_FN cadt_u32 cadt_is_narrow(cadt_point p) {
  return (p.x == 0.0 || cadt_fabs(p.x) >= 0x1p-127) && (p.y == 0.0 || cadt_fabs(p.y) >= 0x1p-127) ? 1u : 0u;
}

/* 1: c lies on the left of the line from a to b, seen along a counterclockwise ring; 0: on it, or the ring is wide; -1:
 * on the right */
CADT_FN_SLOW cadt_i32 cadt_turn_in_ring(cadt_small_ring* r, cadt_u32 a, cadt_u32 b, cadt_u32 c) {
  const cadt_point p = cadt_load_point(r->points + a), q = cadt_load_point(r->points + b),
                   s = cadt_load_point(r->points + c);
  if (!cadt_is_narrow(p) || !cadt_is_narrow(q) || !cadt_is_narrow(s)) r->wide = 1u;
  if (r->wide) return 0;
  const cadt_i32 rounded = cadt_orientation_filter(p, q, s),
                 sign = rounded != CADT_UNSURE ? rounded : cadt_orientation_exact(p, q, s);
  return r->clockwise ? -sign : sign;
}

/* 0: the area is so small that rounding might decide its sign, or a coordinate is not finite or too large for the
 * narrow arithmetic. \pre r has points and count */
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
  if (!(cadt_fabs(area) > 0x1p-40 * (extent * extent)) || extent < 0x1p-126) return 0u;
  if (!(cadt_fabs(origin.x) + extent < 0x1p60) || !(cadt_fabs(origin.y) + extent < 0x1p60)) return 0u;
  r->clockwise = area < 0.0 ? 1u : 0u;
  r->wide = 0u;
  const cadt_real unit_y = 1.0 / extent, unit_x = r->clockwise ? -unit_y : unit_y;
  for (cadt_u32 i = 0u; i < n; ++i) {
    const cadt_point p = cadt_load_point(r->points + i);
    r->x[i] = CADT_CAST(float, (p.x - origin.x) * unit_x);
    r->y[i] = CADT_CAST(float, (p.y - origin.y) * unit_y);
  }
  for (cadt_u32 i = 0u; i < CADT_LANES; ++i) r->x[n + i] = r->y[n + i] = 0.0f; /* as vertex 0 */
  return 1u;
}

/* Compares all vertices with all edges. 0: a vertex lies on an edge that it is no end of, or at its end
 *
 * Nearly all by floats. With u = 2^-24: a coordinate is at most 1 and has an error of u / 2, a component of an edge is
 * at most 2 and has 2 u, a product of the two 4 u, and the sum of four of them, at most 8, has 16 u + 10 u. */
#define CADT_RING_UNSURE 0x1p-19f /* 32 u */
CADT_FN cadt_u32 cadt_find_sides(cadt_small_ring* r) {
  const cadt_u32 n = r->count, all = 0xFFFFFFFFu >> (32u - n);
  const cadt_lanes unsure_side = cadt_all_lanes(CADT_RING_UNSURE);
  cadt_lanes edge_x[CADT_SMALL_RING / CADT_LANES], edge_y[CADT_SMALL_RING / CADT_LANES],
      offset[CADT_SMALL_RING / CADT_LANES];
  cadt_u32 sides[CADT_SMALL_RING]; /* of an edge: the vertices on its left, without its ends */
  for (cadt_u32 e = 0u, i = 0u; e < n; e += CADT_LANES, ++i) {
    const cadt_lanes ax = cadt_load_lanes(r->x + e), ay = cadt_load_lanes(r->y + e);
    edge_x[i] = cadt_load_lanes(r->x + e + 1u) - ax;
    edge_y[i] = cadt_load_lanes(r->y + e + 1u) - ay;
    offset[i] = edge_y[i] * ax - edge_x[i] * ay;
    cadt_store_words(sides + e, cadt_all_words(0u));
  }
  cadt_u32 own = 1u | 1u << (n - 1u); /* the edges that end at v */
  for (cadt_u32 v = 0u; v < n; ++v) {
    const cadt_lanes x = cadt_all_lanes(r->x[v]), y = cadt_all_lanes(r->y[v]);
    const cadt_words bit = cadt_all_words(1u << v);
    cadt_u32 left = own, right = 0u;
    for (cadt_u32 e = 0u, i = 0u; e < n; e += CADT_LANES, ++i) {
      const cadt_lanes side = offset[i] + edge_x[i] * y - edge_y[i] * x;
      const cadt_words is_left = cadt_mask(side > unsure_side);
      left |= cadt_bits_of_lanes(is_left) << e;
      right |= cadt_bits_of_lanes(cadt_mask(side < -unsure_side)) << e;
      cadt_store_words(sides + e, cadt_load_words(sides + e) | (is_left & bit));
    }
    for (cadt_u32 unsure = all & ~(left | right); unsure;) {
      const cadt_u32 e = CADT_HIGHEST_BIT(unsure), next = e + 1u == n ? 0u : e + 1u;
      const cadt_i32 side = cadt_turn_in_ring(r, e, next, v);
      const cadt_point p = cadt_load_point(r->points + v), a = cadt_load_point(r->points + e),
                       b = cadt_load_point(r->points + next);
      if (side > 0) {
        left |= 1u << e;
        sides[e] |= 1u << v;
      }
      if (side == 0 && !(cadt_before(p, a) && cadt_before(p, b)) && !(cadt_before(a, p) && cadt_before(b, p)))
        return 0u;
      unsure ^= 1u << e;
    }
    r->left[v] = left;
    own = 3u << v;
  }
  for (cadt_u32 i = 0u; i < CADT_LANES; ++i) r->left[n + i] = r->left[0];
  /* Edges cross if the line of each parts the ends of the other. A vertex on the line of an edge, but not on the edge,
   * may count for either side. Neighbours seem not to: their common end is on the left of both in `left`, and on the
   * right in `sides`. */
  cadt_words crossing = cadt_all_words(0u);
  for (cadt_u32 e = 0u; e < n; e += CADT_LANES) {
    const cadt_words side = cadt_load_words(sides + e);
    crossing |=
        (cadt_load_words(r->left + e) ^ cadt_load_words(r->left + e + 1u)) & (side ^ (side >> 1 | side << (n - 1u)));
  }
  return cadt_any_word(crossing) ? 0u : 1u;
}

/* The apex over a base among candidates, by an exact comparison each. */
CADT_FN_SLOW cadt_u32 cadt_ring_apex_exact(cadt_small_ring* r, cadt_u32 low, cadt_u32 high, cadt_u32 candidates) {
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
CADT_FN cadt_u32 cadt_ring_apex(cadt_small_ring* r, cadt_u32 low, cadt_u32 high) {
  const cadt_lanes unsure = cadt_all_lanes(4.0f * CADT_RING_UNSURE), none = cadt_all_lanes(2e38f);
  const cadt_lanes px = cadt_all_lanes(r->x[low]), py = cadt_all_lanes(r->y[low]), qx = cadt_all_lanes(r->x[high]),
                   qy = cadt_all_lanes(r->y[high]), base_x = qx - px, base_y = qy - py;
  cadt_lanes least[CADT_SMALL_RING / CADT_LANES], most = cadt_all_lanes(1e38f);
  cadt_u32 candidates = 0u;
  for (cadt_u32 v = low + 1u, i = 0u; v < high; v += CADT_LANES, ++i) {
    const cadt_lanes x = cadt_load_lanes(r->x + v), y = cadt_load_lanes(r->y + v);
    const cadt_lanes sine = (x - px) * base_y - (y - py) * base_x, cosine = (x - px) * (x - qx) + (y - py) * (y - qy);
    const cadt_lanes size = cadt_abs_lanes(sine), inverse = 1.0f / (size + 0x1p-60f);
    const cadt_lanes cotangent = cosine * inverse, error = unsure * inverse * (1.0f + cadt_abs_lanes(cotangent));
    least[i] = sine > unsure ? cotangent - error : none;
    most = cadt_min_lanes(most, (sine > unsure) & cadt_lanes_below(high - v) ? cotangent + error : none);
    candidates |= cadt_bits_of_lanes(cadt_mask(size <= unsure)) << v;
  }
  const float bound = cadt_least_lane(most);
  for (cadt_u32 v = low + 1u, i = 0u; v < high; v += CADT_LANES, ++i)
    candidates |= cadt_bits_of_lanes(cadt_mask(least[i] <= cadt_all_lanes(bound))) << v;
  candidates &= (1u << high) - 1u;
  if (!(candidates & (candidates - 1u)) && bound < 1e38f) return CADT_HIGHEST_BIT(candidates);
  return cadt_ring_apex_exact(r, low, high, candidates);
}

/* Whether the triangle over a base lies inside, after candidates before it do not. */
CADT_FN cadt_u32 cadt_triangle_is_inside(cadt_small_ring* r, cadt_u32 low, cadt_u32 apex, cadt_u32 high,
                                         cadt_u32 tried) {
  for (; tried; tried ^= 1u << CADT_HIGHEST_BIT(tried)) {
    const cadt_u32 v = CADT_HIGHEST_BIT(tried);
    if (cadt_turn_in_ring(r, low, apex, v) >= 0 && cadt_turn_in_ring(r, apex, high, v) >= 0) return 0u;
  }
  /* The first edge from the base to an apex that it hides has them on its left and on its right. */
  cadt_u32 edges = r->left[low] & r->left[high] & ~r->left[apex] & ((1u << high) - (1u << low));
  /* an edge that obstructs one with an edge of the ring would cross that edge */
  edges &= CADT_MASK_IF((low + 1u != apex) & (apex + 1u != high));
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
 * is left to others. Any doubles may be given. */
CADT_FN cadt_u32 cadt_triangulate_ring(CADT_GLOBAL const cadt_point* points, cadt_u32 count, cadt_u32 base,
                                       CADT_GLOBAL cadt_u32* out) {
  cadt_small_ring ring;
  if (count > 1u && points[0].x == points[count - 1u].x && points[0].y == points[count - 1u].y) --count;
  if (count < 3u || count > CADT_SMALL_RING) return 0u;
  ring.points = points;
  ring.count = count;
  if (!cadt_measure_ring(&ring) || !cadt_find_sides(&ring)) return 0u;
  cadt_u32 bases[CADT_SMALL_RING], waiting = 1u;
  bases[0] = 0u; /* the end */
  for (cadt_u32 next = CADT_RING_BASE(0u, count - 1u); next; out += 3) {
    const cadt_u32 low = next >> 8, high = next & 255u;
    cadt_u32 apex = low + 1u;
    if (low + 2u < high) {
      cadt_u32 tried = 0u;
      apex = cadt_ring_apex(&ring, low, high);
      while (apex != CADT_NONE && !cadt_triangle_is_inside(&ring, low, apex, high, tried)) {
        tried |= 1u << apex;
        apex = cadt_ring_apex_exact(&ring, low, high, ((1u << high) - (2u << low)) & ~tried);
      }
      if (apex == CADT_NONE) return 0u; /* there always is one */
    }
    cadt_write_ring_triangle(&ring, low, apex, high, base, out);
    bases[waiting] = CADT_RING_BASE(low, apex);
    waiting += low + 1u < apex ? 1u : 0u;
    bases[waiting] = CADT_RING_BASE(apex, high);
    waiting += apex + 1u < high ? 1u : 0u;
    next = bases[--waiting];
  }
  return ring.wide ? 0u : count - 2u;
}

#endif
