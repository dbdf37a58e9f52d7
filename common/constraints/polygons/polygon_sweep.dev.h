/* SPDX-License-Identifier: Apache-2.0
 *
 * The inside of one small polygon in triangles, by one work-item: a line sweeps over its vertices from left to right
 * and keeps the edges that it cuts in their order from bottom to top. Between two of them lies a gap. One inside the
 * polygon (an odd number of edges is below it) has a chain: the vertices on the border of what has triangles already,
 * from the left end of the edge below to that of the edge above.
 *
 *            _ 2 _______ edge          At the next vertex p of the gap all triangles are made that p sees beyond edges
 * of / done |                   the chain. What is left of a chain therefore bends towards the line at each 1 ______| 3
 * p         vertex, or is straight: it is seen from p as from an end of it inwards, or, where \ done | p lies on none
 * of the edges, from its rightmost vertex (3) both ways. ` 4 _______ edge
 *
 * Several edges may meet in a vertex, vertices may lie on edges, which they divide, and edges may cover one another;
 * the shorter one then stands for both. What must not be are crossings. There are none if and only if each vertex, when
 * the line comes to it, lies above the edge that is next below it in the order and below the next one above: two edges
 * that are neighbours in the order while the line passes are in this order where they become neighbours and where they
 * cease to be, and so between.
 *
 * Vertices are numbered by their rank from left to right, those of equal x from bottom to top.
 */
#ifndef CADT_CONSTRAINTS_POLYGON_SWEEP_H
#define CADT_CONSTRAINTS_POLYGON_SWEEP_H

#include "common/portable/layout.dev.h"
#include "common/predicates/filtered_predicates.dev.h"

/* An edge, from left to right, and the gap above it while it is cut. */
typedef struct {
  cadt_u32 low, high;           /* its ends */
  cadt_u32 next;                /* of the edges with this left end */
  cadt_u32 odd;                 /* 1: it parts the inside from the outside; 0: an even number of edges lies here */
  cadt_u32 inside;              /* the gap */
  cadt_u32 bottom, top, newest; /* of its chain: the ends, and the rightmost vertex */
} cadt_sweep_edge;

/* A vertex of a chain. `side`: what lies beyond the edge to the vertex above: a half-edge, a bridge, or CADT_NONE for
 * an edge of the polygon. */
typedef struct {
  cadt_u32 vertex, up, down, side;
} cadt_chain_node;

/* An edge inside that has no triangle on either side yet joins a vertex with its chain. The first triangle waits in
 * `bridges` for the second one. */
#define CADT_BRIDGE 0x80000000u

/* Memory for one polygon of n points; sizes in CADT_SWEEP_WORDS. */
typedef struct {
  CADT_GLOBAL cadt_point* points;     /* n: of the vertices, by rank */
  CADT_GLOBAL cadt_sweep_edge* edges; /* n, and one more for a part of a chain */
  CADT_GLOBAL cadt_chain_node* nodes; /* 6 n: three a vertex, and one for each edge between two of them */
  CADT_GLOBAL cadt_u32* vertices;     /* 8 n: by half-edge, the vertex opposite of it; below 2 n triangles */
  CADT_GLOBAL cadt_u32* across;       /* 8 n: the half-edge across */
  CADT_GLOBAL cadt_u32* first_edge;   /* n: of the edges with this left end */
  CADT_GLOBAL cadt_u32* cut_at;       /* n: an edge that ends here, while it is cut */
  CADT_GLOBAL cadt_u32* cut;          /* n: the edges that the line cuts, from bottom to top */
  CADT_GLOBAL cadt_u32* places;       /* n: of these edges */
  CADT_GLOBAL cadt_u32* bridges;      /* n */
  cadt_u32 spare;                     /* that edge */
  cadt_u32 room;                      /* n */
  cadt_u32 cut_count, node_count, bridge_count, triangle_count;
} cadt_sweep;

CADT_FN cadt_i32 cadt_turn(const cadt_sweep* s, cadt_u32 a, cadt_u32 b, cadt_u32 c) {
  const cadt_point p = cadt_load_point(s->points + a), q = cadt_load_point(s->points + b),
                   r = cadt_load_point(s->points + c);
  const cadt_i32 sign = cadt_orientation_filter(p, q, r);
  return sign != CADT_UNSURE ? sign : cadt_orientation_exact(p, q, r);
}

/* ---- triangles ---- */
CADT_FN void cadt_sweep_link(cadt_sweep* s, cadt_u32 half_edge, cadt_u32 side) {
  cadt_u32 other = side;
  if (side != CADT_NONE && side >= CADT_BRIDGE) {
    CADT_GLOBAL cadt_u32* bridge = s->bridges + (side - CADT_BRIDGE);
    other = *bridge;
    if (other == CADT_NONE) *bridge = half_edge;
  }
  s->across[half_edge] = other;
  if (other != CADT_NONE) s->across[other] = half_edge;
}

/* The counterclockwise triangle a b c with what lies across the edges opposite of a and b. The half-edge opposite of c
 */
CADT_FN cadt_u32 cadt_sweep_triangle(cadt_sweep* s, cadt_u32 a, cadt_u32 b, cadt_u32 c, cadt_u32 side_a,
                                     cadt_u32 side_b) {
  /* More than there can be: edges cross, and it has not come out yet. */
  if (s->triangle_count == 2u * s->room) return CADT_NONE;
  const cadt_u32 first = CADT_HALF_EDGE(s->triangle_count++, 0u);
  s->vertices[first] = a;
  s->vertices[first + 1u] = b;
  s->vertices[first + 2u] = c;
  cadt_sweep_link(s, first, side_a);
  cadt_sweep_link(s, first + 1u, side_b);
  s->across[first + 2u] = CADT_NONE;
  return first + 2u;
}

CADT_FN cadt_u32 cadt_new_node(cadt_sweep* s, cadt_u32 vertex, cadt_u32 up, cadt_u32 down, cadt_u32 side) {
  const cadt_u32 node = s->node_count++;
  const cadt_chain_node value = {vertex, up, down, side};
  s->nodes[node] = value;
  return node;
}

/* Vertex p becomes the upper end of a chain, after the triangles that it sees. `side`: of the edge to the end before.
 */
CADT_FN cadt_u32 cadt_add_on_top(cadt_sweep* s, CADT_GLOBAL cadt_sweep_edge* gap, cadt_u32 p, cadt_u32 side) {
  cadt_u32 at = gap->top;
  for (;;) {
    const cadt_u32 below = s->nodes[at].down;
    if (below == CADT_NONE || cadt_turn(s, s->nodes[below].vertex, s->nodes[at].vertex, p) >= 0) break;
    side = cadt_sweep_triangle(s, s->nodes[below].vertex, p, s->nodes[at].vertex, side, s->nodes[below].side);
    at = below;
  }
  const cadt_u32 node = cadt_new_node(s, p, CADT_NONE, at, CADT_NONE);
  s->nodes[at].up = node;
  s->nodes[at].side = side;
  gap->top = node;
  return node;
}

/* The same for the lower end. */
CADT_FN cadt_u32 cadt_add_below(cadt_sweep* s, CADT_GLOBAL cadt_sweep_edge* gap, cadt_u32 p, cadt_u32 side) {
  cadt_u32 at = gap->bottom;
  for (;;) {
    const cadt_u32 above = s->nodes[at].up;
    if (above == CADT_NONE || cadt_turn(s, p, s->nodes[at].vertex, s->nodes[above].vertex) >= 0) break;
    side = cadt_sweep_triangle(s, p, s->nodes[above].vertex, s->nodes[at].vertex, s->nodes[at].side, side);
    at = above;
  }
  const cadt_u32 node = cadt_new_node(s, p, at, CADT_NONE, side);
  s->nodes[at].down = node;
  gap->bottom = node;
  return node;
}

/* Both edges of the gap end at p, which sees all of the chain. */
CADT_FN void cadt_close_gap(cadt_sweep* s, CADT_GLOBAL const cadt_sweep_edge* gap, cadt_u32 p) {
  cadt_u32 side = CADT_NONE;
  for (cadt_u32 at = gap->top, below = s->nodes[at].down; below != CADT_NONE; at = below, below = s->nodes[at].down)
    side = cadt_sweep_triangle(s, s->nodes[below].vertex, p, s->nodes[at].vertex, side, s->nodes[below].side);
}

/* ---- edges ---- */
CADT_FN void cadt_add_edge(cadt_sweep* s, cadt_u32 edge, cadt_u32 low) {
  s->edges[edge].low = low;
  s->edges[edge].next = s->first_edge[low];
  s->first_edge[low] = edge;
}

/* The side of p of the edge at this place of the order: 1 above, 0 on it, -1 below. */
CADT_FN cadt_i32 cadt_side_of_cut(const cadt_sweep* s, cadt_u32 place, cadt_u32 p) {
  CADT_GLOBAL const cadt_sweep_edge* e = s->edges + s->cut[place];
  return e->high == p ? 0 : cadt_turn(s, e->low, e->high, p);
}

/* The places of the edges that p lies on: from *begin to *end. 0: edges cross */
CADT_FN cadt_u32 cadt_locate_in_order(const cadt_sweep* s, cadt_u32 p, cadt_u32* begin, cadt_u32* end) {
  cadt_u32 low = 0u, high = s->cut_count;
  while (low < high) {
    const cadt_u32 known = s->cut_at[p], middle = known == CADT_NONE ? (low + high) / 2u : s->places[known];
    const cadt_i32 side = cadt_side_of_cut(s, middle, p);
    if (side == 0) {
      cadt_u32 first = middle, last = middle + 1u;
      cadt_i32 below = 1, above = -1;
      while (first > 0u && (below = cadt_side_of_cut(s, first - 1u, p)) == 0) --first;
      while (last < s->cut_count && (above = cadt_side_of_cut(s, last, p)) == 0) ++last;
      *begin = first;
      *end = last;
      return (first == 0u || below > 0) && (last == s->cut_count || above < 0) ? 1u : 0u;
    }
    if (side > 0)
      low = middle + 1u;
    else
      high = middle;
  }
  *begin = *end = low;
  return 1u;
}

CADT_FN void cadt_put_edge(cadt_sweep* s, cadt_u32 place, cadt_u32 edge) {
  s->cut[place] = edge;
  s->places[edge] = place;
}

/* Puts the edges that begin at p in their order, at `place` and after; how many there are. What follows moves up by as
 * many places as it takes more than the `room` there. Of edges in one direction the longer ones begin where the
 * shortest ends. */
CADT_FN cadt_u32 cadt_insert_edges(cadt_sweep* s, cadt_u32 p, cadt_u32 place, cadt_u32 room) {
  cadt_u32 count = 0u, edge = s->first_edge[p];
  while (edge != CADT_NONE) {
    const cadt_u32 next = s->edges[edge].next, high = s->edges[edge].high;
    cadt_u32 at = place + count, longer = CADT_NONE;
    for (; at > place; --at) {
      const cadt_u32 other = s->cut[at - 1u], other_high = s->edges[other].high;
      const cadt_i32 side = other_high == high ? 0 : cadt_turn(s, p, other_high, high);
      if (side > 0) break;
      if (side < 0) continue;
      longer = high >= other_high ? edge : other;
      if (longer == other) cadt_put_edge(s, at - 1u, edge);
      const cadt_u32 shorter = longer == edge ? other : edge, end = s->edges[shorter].high;
      s->edges[shorter].odd ^= s->edges[longer].odd;
      if (s->edges[longer].high != end) cadt_add_edge(s, longer, end);
      break;
    }
    if (longer == CADT_NONE) {
      if (room == count) { /* one more place */
        for (cadt_u32 i = s->cut_count++; i > place + count; --i) cadt_put_edge(s, i, s->cut[i - 1u]);
        ++room;
      }
      for (cadt_u32 i = place + count; i > at; --i) cadt_put_edge(s, i, s->cut[i - 1u]);
      cadt_put_edge(s, at, edge);
      ++count;
    }
    edge = next;
  }
  if (count < room) {
    s->cut_count -= room - count;
    for (cadt_u32 i = place + count; i < s->cut_count; ++i) cadt_put_edge(s, i, s->cut[i + room - count]);
  }
  return count;
}

/* ---- vertices ---- */
/* p lies within the gap: a bridge leads to it from the rightmost vertex of the chain, which is divided there. The spare
 * edge takes the upper part. */
CADT_FN void cadt_split_chain(cadt_sweep* s, CADT_GLOBAL cadt_sweep_edge* gap, cadt_u32 p) {
  CADT_GLOBAL cadt_sweep_edge* upper = s->edges + s->spare;
  const cadt_u32 at = gap->newest, up = s->nodes[at].up, bridge = CADT_BRIDGE + s->bridge_count;
  const cadt_u32 again = cadt_new_node(s, s->nodes[at].vertex, up, CADT_NONE, s->nodes[at].side);
  s->bridges[s->bridge_count++] = CADT_NONE;
  upper->bottom = again;
  upper->top = again;
  if (up != CADT_NONE) {
    s->nodes[up].down = again;
    upper->top = gap->top;
  }
  s->nodes[at].up = CADT_NONE;
  gap->top = at;
  cadt_add_on_top(s, gap, p, bridge);
  cadt_add_below(s, upper, p, bridge);
}

/* No edge begins at p: the chains below and above it, if there are some, become one. */
CADT_FN void cadt_join_chains(cadt_sweep* s, CADT_GLOBAL cadt_sweep_edge* gap, cadt_u32 bottom, cadt_u32 top) {
  const cadt_u32 node = gap->top, up = s->nodes[bottom].up;
  s->nodes[node].up = up;
  s->nodes[node].side = s->nodes[bottom].side;
  s->nodes[up].down = node;
  gap->top = top;
  gap->newest = node;
}

/* The line comes to vertex p. 0: edges cross */
CADT_FN cadt_u32 cadt_sweep_vertex(cadt_sweep* s, cadt_u32 p) {
  cadt_u32 begin, end;
  if (!cadt_locate_in_order(s, p, &begin, &end)) return 0u;
  if (s->node_count + 3u > 6u * s->room) return 0u;
  CADT_GLOBAL cadt_sweep_edge* lower = s->edges + (begin ? s->cut[begin - 1u] : s->spare);
  const cadt_u32 inside_below = begin ? lower->inside : 0u;
  cadt_u32 inside_above = inside_below, bottom = CADT_NONE, top = CADT_NONE; /* of the chain above p */
  if (begin != end) {
    if (inside_below) cadt_add_on_top(s, lower, p, CADT_NONE);
    for (cadt_u32 i = begin; i < end; ++i) {
      const cadt_u32 edge = s->cut[i];
      CADT_GLOBAL cadt_sweep_edge* gap = s->edges + edge;
      if (i + 1u < end) {
        if (gap->inside) cadt_close_gap(s, gap, p);
      } else {
        inside_above = gap->inside;
        if (inside_above) {
          bottom = cadt_add_below(s, gap, p, CADT_NONE);
          top = gap->top;
        }
      }
      if (gap->high != p) cadt_add_edge(s, edge, p);
    }
  } else if (inside_below) {
    cadt_split_chain(s, lower, p);
    bottom = s->edges[s->spare].bottom;
    top = s->edges[s->spare].top;
  }
  const cadt_u32 count = cadt_insert_edges(s, p, begin, end - begin);
  cadt_u32 inside = inside_below;
  for (cadt_u32 i = 0u; i < count; ++i) inside ^= s->edges[s->cut[begin + i]].odd;
  if (inside != inside_above || s->node_count + count > 6u * s->room) return 0u; /* an edge to p is elsewhere */
  if (!count) {
    if (inside_below) cadt_join_chains(s, lower, bottom, top);
    return 1u;
  }
  if (inside_below) lower->newest = lower->top;
  inside = inside_below;
  for (cadt_u32 i = 0u; i < count; ++i) {
    CADT_GLOBAL cadt_sweep_edge* gap = s->edges + s->cut[begin + i];
    s->cut_at[gap->high] = s->cut[begin + i];
    inside ^= gap->odd;
    gap->inside = inside;
    if (!inside) continue;
    if (i + 1u == count) {
      gap->bottom = gap->newest = bottom;
      gap->top = top;
    } else {
      gap->bottom = gap->top = gap->newest = cadt_new_node(s, p, CADT_NONE, CADT_NONE, CADT_NONE);
    }
  }
  return 1u;
}

/* ---- the constrained Delaunay triangulation ---- */
/* Half-edge h of a b c and its other side become the other diagonal of the quadrilateral:
 *
 *         c                 c           h is opposite of a: edge b c, and d lies across. The triangles keep their
 *       / | \             /   \         places: the first becomes a b d, the second d c a.
 *      a  h  d    ->     a --- d
 *       \ | /             \   /
 *         b                 b                                                                                      */
CADT_FN void cadt_join_in_polygon(cadt_sweep* s, cadt_u32 h, cadt_u32 other) {
  s->across[h] = other;
  if (other != CADT_NONE) s->across[other] = h;
}
CADT_FN void cadt_flip_in_polygon(cadt_sweep* s, cadt_u32 h, cadt_u32 other) {
  const cadt_u32 t = h & ~3u, u = other & ~3u, k = CADT_EDGE_OF(h), j = CADT_EDGE_OF(other);
  const cadt_u32 a = s->vertices[h], b = s->vertices[t + CADT_NEXT(k)], c = s->vertices[t + CADT_PREV(k)],
                 d = s->vertices[other];
  const cadt_u32 across_b = s->across[t + CADT_NEXT(k)], across_c = s->across[t + CADT_PREV(k)];
  const cadt_u32 beyond_c = s->across[u + CADT_NEXT(j)], beyond_b = s->across[u + CADT_PREV(j)];
  s->vertices[t] = a;
  s->vertices[t + 1u] = b;
  s->vertices[t + 2u] = d;
  s->vertices[u] = d;
  s->vertices[u + 1u] = c;
  s->vertices[u + 2u] = a;
  s->across[t + 1u] = u + 1u;
  s->across[u + 1u] = t + 1u;
  cadt_join_in_polygon(s, t, beyond_c);
  cadt_join_in_polygon(s, t + 2u, across_c);
  cadt_join_in_polygon(s, u, across_b);
  cadt_join_in_polygon(s, u + 2u, beyond_b);
}

/* A half-edge may be illegal. Triangles from `end` on are not looked at yet, and there is none beyond an edge of the
 * polygon. */
CADT_FN cadt_u32 cadt_list_half_edge(const cadt_sweep* s, CADT_GLOBAL cadt_u32* list, cadt_u32 count, cadt_u32 h,
                                     cadt_u32 end) {
  list[count] = h;
  return s->across[h] < end ? count + 1u : count;
}

/* Flips edges until all that are not of the polygon are legal (C. L. Lawson, 1977). `list` has `room` for half-edges.
 */
CADT_FN void cadt_legalize_polygon(cadt_sweep* s, CADT_GLOBAL cadt_u32* list, cadt_u32 room) {
  CADT_DECLARE_COUNTERS(counters);
  cadt_u32 again = 1u;
  while (again) { /* once, if there is room enough */
    again = 0u;
    for (cadt_u32 t = 0u; t < s->triangle_count; ++t) {
      const cadt_u32 end = CADT_HALF_EDGE(t + 1u, 0u);
      cadt_u32 count = 0u;
      for (cadt_u32 k = 0u; k < 3u; ++k) count = cadt_list_half_edge(s, list, count, CADT_HALF_EDGE(t, k), end);
      while (count) {
        const cadt_u32 h = list[--count], other = s->across[h], first = h & ~3u, second = other & ~3u;
        const cadt_u32 k = CADT_EDGE_OF(h);
        if (other >= end) continue; /* another edge since then */
        const cadt_point a = cadt_load_point(s->points + s->vertices[h]),
                         b = cadt_load_point(s->points + s->vertices[first + CADT_NEXT(k)]),
                         c = cadt_load_point(s->points + s->vertices[first + CADT_PREV(k)]),
                         d = cadt_load_point(s->points + s->vertices[other]);
        if (cadt_incircle(a, b, c, d, &counters) <= 0) continue;
        cadt_flip_in_polygon(s, h, other);
        if (count + 4u > room) {
          again = 1u;
          continue;
        }
        count = cadt_list_half_edge(s, list, count, first, end);
        count = cadt_list_half_edge(s, list, count, first + 2u, end);
        count = cadt_list_half_edge(s, list, count, second, end);
        count = cadt_list_half_edge(s, list, count, second + 2u, end);
      }
    }
  }
}

#endif
