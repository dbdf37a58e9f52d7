/* SPDX-License-Identifier: Apache-2.0
 *
 * Many small polygons with holes, each by one work-item: sort, sweep, legalise; single rings of few points without.
 * Rings may be given in either direction; what is inside is decided by the even-odd rule.
 */
#ifndef CADT_CONSTRAINTS_POLYGONS_H
#define CADT_CONSTRAINTS_POLYGONS_H

#include "common/constraints/polygons/polygon_sweep.dev.h"
#include "common/constraints/polygons/small_ring.dev.h"

/* What becomes of a polygon. */
enum {
  CADT_POLYGON_OK,
  CADT_POLYGON_TOO_FEW_POINTS, /* a ring has fewer than three different points, or there is no ring (the host asks
                                  whether it is the first one) */
  CADT_POLYGON_NOT_FINITE,
  CADT_POLYGON_SELF_CROSSING, /* two edges of one ring */
  CADT_POLYGON_RING_CROSSING, /* edges of two rings */
  CADT_POLYGON_ZERO_AREA,
  CADT_POLYGON_WIDE,  /* for the wide arithmetic: it is left to others */
  CADT_POLYGON_BROKEN /* edges cross and do not: the text is wrong */
};

/* Words of memory for n points, and beside them. */
enum { CADT_POLYGON_WORDS = 60, CADT_POLYGON_SPARE = 8, CADT_SORT_RUN = 16 };
/* A result: what becomes of it, and two points that show why, or CADT_NONE. */
enum { CADT_POLYGON_STATE, CADT_POLYGON_FIRST, CADT_POLYGON_SECOND, CADT_POLYGON_RESULT_WORDS };

typedef struct {
  CADT_GLOBAL const cadt_point* points;
  CADT_GLOBAL const cadt_u32* ring_begins; /* among all points; one more than rings */
  cadt_u32 first, count;                   /* of the points */
  cadt_u32 first_ring, end_ring;
  CADT_GLOBAL cadt_u32* ids;   /* of the vertices: the lowest point there */
  CADT_GLOBAL cadt_u32* ranks; /* the vertex of each point */
} cadt_polygon;

CADT_FN cadt_sweep cadt_sweep_in(CADT_GLOBAL cadt_u32* memory, cadt_polygon* polygon) {
  const cadt_u32 n = polygon->count;
  cadt_sweep s;
  s.points = (CADT_GLOBAL cadt_point*)memory;
  s.edges = (CADT_GLOBAL cadt_sweep_edge*)(memory + 4u * n);
  s.nodes = (CADT_GLOBAL cadt_chain_node*)(memory + 12u * n + 8u);
  s.vertices = memory + 36u * n + 8u;
  s.across = s.vertices + 8u * n;
  s.first_edge = s.across + 8u * n;
  s.cut_at = s.first_edge + n;
  s.cut = s.cut_at + n;
  s.places = s.cut + n;
  s.bridges = s.places + n;
  polygon->ids = s.bridges + n;
  polygon->ranks = polygon->ids + n;
  s.spare = s.room = n;
  s.cut_count = s.node_count = s.bridge_count = s.triangle_count = 0u;
  return s;
}

/* ---- points ---- */
/* Whether the narrow arithmetic serves: it takes multiples of 2^-180 below 2^60. They are so with 2^*shift times the
 * coordinates, unless the smallest is too far from the largest. */
CADT_FN cadt_u32 cadt_check_points(const cadt_polygon* polygon, cadt_i32* shift, cadt_u32* at) {
  cadt_real most = 0.0, least = CADT_INFINITY;
  for (cadt_u32 i = 0u; i < polygon->count; ++i) {
    const cadt_point p = cadt_load_point(polygon->points + polygon->first + i);
    const cadt_real x = cadt_fabs(p.x), y = cadt_fabs(p.y);
    if (x > most) most = x;
    if (y > most) most = y;
    if (x < least && x != 0.0) least = x;
    if (y < least && y != 0.0) least = y;
    if (x < CADT_INFINITY && y < CADT_INFINITY) continue;
    *at = i;
    return CADT_POLYGON_NOT_FINITE;
  }
  *shift = 0;
  if (most < 0x1p60 && least >= 0x1p-127) return CADT_POLYGON_OK;
  *shift = 59 + CADT_EXPONENT_BIAS - CADT_CAST(cadt_i32, cadt_bits_of_real(most) >> CADT_MANTISSA_BITS);
  return cadt_ldexp(least, *shift) >= 0x1p-127 ? CADT_POLYGON_OK : CADT_POLYGON_WIDE;
}

/* Sorts the points; `ids` and `spare` have room for all of them, the result is in either. Insertion, then merging. */
CADT_FN CADT_GLOBAL cadt_u32* cadt_sort_polygon(const cadt_polygon* polygon, CADT_GLOBAL cadt_u32* ids,
                                                CADT_GLOBAL cadt_u32* spare) {
  CADT_GLOBAL const cadt_point* points = polygon->points + polygon->first;
  const cadt_u32 n = polygon->count;
  for (cadt_u32 run = 0u; run < n; run += CADT_CAST(cadt_u32, CADT_SORT_RUN)) {
    const cadt_u32 end = cadt_min_u32(run + CADT_CAST(cadt_u32, CADT_SORT_RUN), n);
    for (cadt_u32 i = run; i < end; ++i) {
      const cadt_point p = cadt_load_point(points + i);
      cadt_u32 at = i;
      for (; at > run && cadt_before(p, cadt_load_point(points + ids[at - 1u])); --at) ids[at] = ids[at - 1u];
      ids[at] = i;
    }
  }
  for (cadt_u32 run = CADT_SORT_RUN; run < n; run *= 2u) {
    for (cadt_u32 begin = 0u; begin < n; begin += 2u * run) {
      const cadt_u32 middle = cadt_min_u32(begin + run, n), end = cadt_min_u32(middle + run, n);
      cadt_u32 left = begin, right = middle;
      for (cadt_u32 to = begin; to < end; ++to) {
        const cadt_u32 take_right = left == middle || (right < end && cadt_before(cadt_load_point(points + ids[right]),
                                                                                  cadt_load_point(points + ids[left])));
        spare[to] = ids[take_right ? right++ : left++];
      }
    }
    CADT_GLOBAL cadt_u32* other = ids;
    ids = spare;
    spare = other;
  }
  return ids;
}

/* Vertices: the different points by rank, 2^shift times as large. */
CADT_FN cadt_u32 cadt_rank_points(cadt_sweep* s, cadt_polygon* polygon, cadt_i32 shift) {
  CADT_GLOBAL const cadt_point* points = polygon->points + polygon->first;
  CADT_GLOBAL cadt_u32* order = cadt_sort_polygon(polygon, polygon->ids, s->cut);
  cadt_u32 vertices = 0u;
  for (cadt_u32 i = 0u; i < polygon->count; ++i) {
    const cadt_u32 id = order[i];
    cadt_point p = cadt_load_point(points + id);
    if (shift) {
      p.x = cadt_ldexp(p.x, shift);
      p.y = cadt_ldexp(p.y, shift);
    }
    if (i == 0u || cadt_before(s->points[vertices - 1u], p)) {
      s->points[vertices] = p;
      s->first_edge[vertices] = s->cut_at[vertices] = CADT_NONE;
      polygon->ids[vertices++] = id; /* not above i, so nothing is lost that is still to be read */
    }
    polygon->ranks[id] = vertices - 1u;
  }
  return vertices;
}

/* The edges of a ring. 0: it has fewer than three different points */
CADT_FN cadt_u32 cadt_add_ring(cadt_sweep* s, const cadt_polygon* polygon, cadt_u32 begin, cadt_u32 end) {
  cadt_u32 second = CADT_NONE, third = CADT_NONE;
  if (begin == end) return 0u;
  for (cadt_u32 i = begin; i < end; ++i) {
    const cadt_u32 a = polygon->ranks[i], b = polygon->ranks[i + 1u == end ? begin : i + 1u];
    if (a == b) continue;
    if (second == CADT_NONE) second = a;
    if (third == CADT_NONE && a != second) third = a;
    if (a != second && a != third) third = s->room; /* enough */
    s->edges[i].high = a > b ? a : b;
    s->edges[i].odd = 1u;
    cadt_add_edge(s, i, a > b ? b : a);
  }
  return third == s->room ? 1u : 0u;
}

/* ---- crossings ---- */
/* Whether the edges a b and c d cross: they have a point in common within both, and it is none of the
 * polygon's. */
CADT_FN cadt_u32 cadt_edges_cross(const cadt_sweep* s, cadt_u32 vertices, cadt_u32 a, cadt_u32 b, cadt_u32 c,
                                  cadt_u32 d) {
  if ((a > b ? a : b) <= cadt_min_u32(c, d) || (c > d ? c : d) <= cadt_min_u32(a, b)) return 0u; /* side by side */
  if (cadt_turn(s, a, b, c) * cadt_turn(s, a, b, d) >= 0) return 0u;
  if (cadt_turn(s, c, d, a) * cadt_turn(s, c, d, b) >= 0) return 0u;
  for (cadt_u32 v = 0u; v < vertices; ++v)
    if (cadt_turn(s, a, b, v) == 0 && cadt_turn(s, c, d, v) == 0) return 0u;
  return 1u;
}

/* The lowest pair of edges that cross, and whether they are of one ring. */
CADT_FN cadt_u32 cadt_find_crossing(const cadt_sweep* s, const cadt_polygon* polygon, cadt_u32 vertices,
                                    cadt_u32* first, cadt_u32* second) {
  for (cadt_u32 r = polygon->first_ring; r < polygon->end_ring; ++r) {
    const cadt_u32 begin = polygon->ring_begins[r] - polygon->first,
                   end = polygon->ring_begins[r + 1u] - polygon->first;
    for (cadt_u32 i = begin; i < end; ++i) {
      const cadt_u32 a = polygon->ranks[i], b = polygon->ranks[i + 1u == end ? begin : i + 1u];
      for (cadt_u32 q = r; q < polygon->end_ring; ++q) {
        const cadt_u32 other = polygon->ring_begins[q] - polygon->first,
                       other_end = polygon->ring_begins[q + 1u] - polygon->first;
        for (cadt_u32 j = q == r ? i + 1u : other; j < other_end; ++j) {
          const cadt_u32 c = polygon->ranks[j], d = polygon->ranks[j + 1u == other_end ? other : j + 1u];
          if (!cadt_edges_cross(s, vertices, a, b, c, d)) continue;
          *first = i;
          *second = j;
          return q == r ? CADT_POLYGON_SELF_CROSSING : CADT_POLYGON_RING_CROSSING;
        }
      }
    }
  }
  return CADT_POLYGON_BROKEN;
}

/* Triangles of the polygon in `s`. What becomes of it, and two points that show why, or CADT_NONE if there are none. */
CADT_FN cadt_u32 cadt_sweep_polygon(cadt_sweep* s, cadt_polygon* polygon, cadt_i32 shift, cadt_u32* first,
                                    cadt_u32* second) {
  const cadt_u32 vertices = cadt_rank_points(s, polygon, shift);
  if (polygon->first_ring == polygon->end_ring) {
    *first = *second = CADT_NONE;
    return CADT_POLYGON_TOO_FEW_POINTS;
  }
  for (cadt_u32 r = polygon->first_ring; r < polygon->end_ring; ++r) {
    const cadt_u32 begin = polygon->ring_begins[r] - polygon->first,
                   end = polygon->ring_begins[r + 1u] - polygon->first;
    if (begin == end && r != polygon->first_ring) continue; /* a hole without points is nothing */
    if (cadt_add_ring(s, polygon, begin, end)) continue;
    *first = *second = begin == end ? CADT_NONE : begin;
    return CADT_POLYGON_TOO_FEW_POINTS;
  }
  for (cadt_u32 p = 0u; p < vertices; ++p)
    if (!cadt_sweep_vertex(s, p)) return cadt_find_crossing(s, polygon, vertices, first, second);
  if (s->cut_count) return cadt_find_crossing(s, polygon, vertices, first, second);
  if (!s->triangle_count) return CADT_POLYGON_ZERO_AREA;
  cadt_legalize_polygon(s, (CADT_GLOBAL cadt_u32*)s->nodes, 24u * s->room); /* nobody needs the nodes any more */
  return CADT_POLYGON_OK;
}

/* Writes the triangles of a polygon to `out`, as numbers of points, which are counted from `base`. How many; and what
 * becomes of the polygon, and two points that show why, as above. */
CADT_FN cadt_u32 cadt_triangulate_polygon(cadt_polygon* polygon, CADT_GLOBAL cadt_u32* memory, cadt_u32 base,
                                          CADT_GLOBAL cadt_u32* out, cadt_u32* state, cadt_u32* first,
                                          cadt_u32* second) {
  *state = CADT_POLYGON_OK;
  if (polygon->first_ring + 1u == polygon->end_ring) {
    const cadt_u32 count = cadt_triangulate_ring(polygon->points + polygon->first, polygon->count, base, out);
    if (count) return count;
  }
  cadt_i32 shift;
  *state = cadt_check_points(polygon, &shift, first);
  *second = *first;
  if (*state != CADT_POLYGON_OK) return 0u;
  cadt_sweep sweep = cadt_sweep_in(memory, polygon);
  *state = cadt_sweep_polygon(&sweep, polygon, shift, first, second);
  if (*state != CADT_POLYGON_OK) return 0u;
  for (cadt_u32 t = 0u; t < sweep.triangle_count; ++t)
    for (cadt_u32 k = 0u; k < 3u; ++k) out[3u * t + k] = base + polygon->ids[sweep.vertices[CADT_HALF_EDGE(t, k)]];
  return sweep.triangle_count;
}

/* Triangulates polygons, whose points are those from polygon_begins[p] and rings from polygon_rings[p] on, to those of
 * the next one. Polygon p's triangles go to `triangles` from 6 polygon_begins[p] on, as numbers of points, counted from
 * `base`; how many to counts[p], with a 0 at the end, and what becomes of it to results. `memory`: on CPUs `item_words`
 * for each work-item, on GPUs CADT_POLYGON_WORDS a point and CADT_POLYGON_SPARE a polygon. */
CADT_KERNEL(cadt_triangulate_polygons, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* ring_begins,
            CADT_GLOBAL const cadt_u32* polygon_rings, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* memory,
            cadt_u32 item_words, cadt_u32 base, CADT_GLOBAL cadt_u32* triangles, CADT_GLOBAL cadt_u32* counts,
            CADT_GLOBAL cadt_u32* results) {
  if (cadt_item == 0u) counts[count] = 0u;
  CADT_FOR(i, count, grain) {
    cadt_polygon polygon;
    polygon.points = points;
    polygon.ring_begins = ring_begins;
    polygon.first_ring = polygon_rings[i];
    polygon.end_ring = polygon_rings[i + 1u];
    polygon.first = ring_begins[polygon.first_ring];
    polygon.count = ring_begins[polygon.end_ring] - polygon.first;
#if CADT_CONTIGUOUS
    CADT_GLOBAL cadt_u32* own = memory + CADT_CAST(cadt_u64, cadt_item) * item_words;
#else
    CADT_GLOBAL cadt_u32* own =
        memory + CADT_CAST(cadt_u32, CADT_POLYGON_WORDS) * polygon.first + CADT_CAST(cadt_u32, CADT_POLYGON_SPARE) * i;
    (void)item_words;
#endif
    cadt_u32 state, first = 0u, second = 0u;
    counts[i] = cadt_triangulate_polygon(&polygon, own, base + polygon.first, triangles + 6u * polygon.first, &state,
                                         &first, &second);
    CADT_GLOBAL cadt_u32* result = results + CADT_CAST(cadt_u32, CADT_POLYGON_RESULT_WORDS) * i;
    result[CADT_POLYGON_STATE] = state;
    result[CADT_POLYGON_FIRST] = first == CADT_NONE ? first : base + polygon.first + first;
    result[CADT_POLYGON_SECOND] = second == CADT_NONE ? second : base + polygon.first + second;
  }
}

/* The triangles of all polygons, one behind the other. `places`: the scan of the counts. */
CADT_KERNEL(cadt_pack_polygons, CADT_GLOBAL const cadt_u32* triangles, CADT_GLOBAL const cadt_u32* ring_begins,
            CADT_GLOBAL const cadt_u32* polygon_rings, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* places, CADT_GLOBAL cadt_u32* packed, cadt_u32 offset) {
  CADT_FOR(i, count, grain) {
    CADT_GLOBAL const cadt_u32* from = triangles + 6u * ring_begins[polygon_rings[i]];
    CADT_GLOBAL cadt_u32* to = packed + 3u * (offset + places[i]);
    const cadt_u32 words = 3u * (places[i + 1u] - places[i]);
    for (cadt_u32 k = 0u; k < words; ++k) to[k] = from[k];
  }
}

#endif
