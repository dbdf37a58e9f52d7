/* SPDX-License-Identifier: Apache-2.0
 *
 * What all queries share: a finished mesh whose points are scaled as they are read, signs, the walk to the triangle of
 * a point, and the way around a vertex.
 *
 * The narrow variant takes coordinates within 240 binades below 1. The caller's points stay as they are, so a query,
 * which has bounds of its own, chooses the two factors for both; in the wide variant they are 1.
 */
#ifndef CADT_QUERIES_QUERY_MESH_H
#define CADT_QUERIES_QUERY_MESH_H

#include "common/mesh/mesh_view.dev.h"
#include "common/points/import.dev.h"
#include "common/predicates/filtered_predicates.dev.h"

typedef struct {
  cadt_mesh_view view;
  cadt_real scale, scale_again;
} cadt_query_mesh;

#define CADT_QUERY_MESH_PARAMETERS CADT_MESH_VIEW_PARAMETERS, cadt_real scale, cadt_real scale_again
#define CADT_QUERY_MESH(mesh)  \
  CADT_MESH_VIEW(mesh##_view); \
  const cadt_query_mesh mesh = {mesh##_view, scale, scale_again}

/* A point of the caller's, scaled. */
CADT_FN cadt_point cadt_scaled_point(const cadt_query_mesh* m, CADT_GLOBAL const cadt_point* p) {
  return cadt_multiplied_point(cadt_load_point(p), m->scale, m->scale_again);
}
CADT_FN cadt_point cadt_mesh_point(const cadt_query_mesh* m, cadt_u32 vertex) {
  return cadt_scaled_point(m, m->view.points + vertex);
}
CADT_FN cadt_point cadt_corner(const cadt_query_mesh* m, cadt_u32 t, cadt_u32 k) {
  return cadt_mesh_point(m, cadt_vertex_of(&m->view, t, k));
}

/* Orientation of a, b, p. */
CADT_FN cadt_i32 cadt_side(cadt_point a, cadt_point b, cadt_point p) {
  const cadt_i32 sign = cadt_orientation_filter(a, b, p);
  return sign == CADT_UNSURE ? cadt_orientation_exact(a, b, p) : sign;
}

/* Whether a and b are further apart than `most` (scaled); exactly that far they are not. */
CADT_FN cadt_u32 cadt_is_longer(cadt_point a, cadt_point b, cadt_real most) {
  cadt_real x = a.x - b.x, y = a.y - b.y;
#if CADT_WIDE
  const cadt_i32 e = cadt_exponent_of_largest(x, y, most, 0.0);
  if (e == CADT_OVERFLOWED) return most < CADT_INFINITY ? 1u : 0u;
  x = cadt_ldexp(x, -e);
  y = cadt_ldexp(y, -e);
  most = cadt_ldexp(most, -e);
#endif
  return x * x + y * y > most * most ? 1u : 0u;
}

/* The edge of triangle n behind which triangle t lies. */
CADT_FN cadt_u32 cadt_edge_towards(const cadt_query_mesh* m, cadt_u32 n, cadt_u32 t) {
  return cadt_neighbor_of(&m->view, n, 0u) == t ? 0u : (cadt_neighbor_of(&m->view, n, 1u) == t ? 1u : 2u);
}

/* ---- the walk ---- */
enum {
  CADT_QUERY_STRAIGHT = 256 /* steps before the order of edges becomes random: for meshes that are not Delaunay */
};

/* Where a walk to a point ended. */
typedef struct {
  cadt_u32 triangle; /* the one that contains it; outside of the hull, the one behind whose edge it lies */
  cadt_u32 on;       /* inside: bit k: it lies on edge k */
  cadt_u32 edge;     /* CADT_NONE: inside; else the hull edge; CADT_LOST_WALK: the walk did not end */
} cadt_query_place;
#define CADT_LOST_WALK 3u

typedef struct {
  cadt_u32 triangle;
  cadt_u32 entry; /* the edge by which it was entered, or 3 */
  cadt_u32 steps, random;
} cadt_walker;

CADT_FN cadt_walker cadt_walker_from(cadt_u32 triangle) {
  const cadt_walker w = {triangle, 3u, 0u, triangle * 2654435761u + 12345u};
  return w;
}

/* One step of the visibility walk (L. Guibas, J. Stolfi, "Primitives for the manipulation of general subdivisions",
 * 1985): if p lies beyond an edge, cross it. 0 if the walk has come to its place. In a Delaunay mesh it comes to no
 * triangle twice (H. Edelsbrunner, "An acyclicity theorem for cell complexes in d dimensions", 1990). With other
 * meshes, edges that are tried in random order lead out of every cycle sooner or later (O. Devillers, S. Pion, M.
 * Teillaud, "Walking in a triangulation", 2001). The hull is convex: what lies beyond a hull edge is outside. */
CADT_FN cadt_u32 cadt_step(const cadt_query_mesh* m, cadt_point p, cadt_walker* walker, cadt_query_place* place) {
  const cadt_u32 t = walker->triangle, entry = walker->entry;
  const cadt_u32 limit = m->view.triangles < 0x20000000u ? 4u * m->view.triangles + 4096u : 0x80000000u;
  /* The entry edge comes last: p is on its inner side. */
  const cadt_u32 k0 = entry == 3u ? 0u : CADT_NEXT(entry), k1 = CADT_NEXT(k0), k2 = CADT_NEXT(k1);
  const cadt_point q0 = cadt_corner(m, t, k0), q1 = cadt_corner(m, t, k1), q2 = cadt_corner(m, t, k2);
  cadt_u32 second = 0u, leave = 3u;
  if (walker->steps >= CADT_CAST(cadt_u32, CADT_QUERY_STRAIGHT)) {
    walker->random = walker->random * 1664525u + 1013904223u;
    second = walker->random >> 31;
  }
  const cadt_i32 first_side = second ? cadt_side(q2, q0, p) : cadt_side(q1, q2, p);
  cadt_i32 other_side = 1, last_side = 1;
  if (first_side < 0) {
    leave = second ? k1 : k0;
  } else {
    other_side = second ? cadt_side(q1, q2, p) : cadt_side(q2, q0, p);
    if (other_side < 0) {
      leave = second ? k0 : k1;
    } else if (entry == 3u) {
      last_side = cadt_side(q0, q1, p);
      if (last_side < 0) leave = k2;
    }
  }
  place->triangle = t;
  place->on = 0u;
  place->edge = CADT_NONE;
  if (leave == 3u) {
    place->on = (first_side == 0 ? 1u << (second ? k1 : k0) : 0u) | (other_side == 0 ? 1u << (second ? k0 : k1) : 0u) |
                (last_side == 0 ? 1u << k2 : 0u);
    return 0u;
  }
  const cadt_u32 next = cadt_neighbor_of(&m->view, t, leave);
  if (next == CADT_NONE || ++walker->steps >= limit) {
    place->edge = next == CADT_NONE ? leave : CADT_LOST_WALK;
    return 0u;
  }
  walker->entry = cadt_edge_towards(m, next, t);
  walker->triangle = next;
  return 1u;
}

/* The walk from triangle `t`. */
CADT_FN cadt_query_place cadt_walk(const cadt_query_mesh* m, cadt_point p, cadt_u32 t) {
  cadt_walker walker = cadt_walker_from(t);
  cadt_query_place place;
  while (cadt_step(m, p, &walker, &place)) {
  }
  return place;
}

/* The lowest triangle that contains the point of a place; CADT_NONE outside. `lowest`: of each vertex. */
CADT_FN cadt_u32 cadt_lowest_at(const cadt_query_mesh* m, CADT_GLOBAL const cadt_u32* lowest,
                                const cadt_query_place* at) {
  if (at->edge != CADT_NONE) return CADT_NONE;
  if (at->on == 0u) return at->triangle;
  if (at->on == 1u || at->on == 2u || at->on == 4u)
    return cadt_min_u32(at->triangle, cadt_neighbor_of(&m->view, at->triangle, at->on >> 1));
  /* on two edges: at the vertex that both have, which is opposite of the third */
  return lowest[cadt_vertex_of(&m->view, at->triangle, at->on == 6u ? 0u : (at->on == 5u ? 1u : 2u))];
}

/* ---- around a vertex ---- */
/* A triangle and the number of the vertex in it. */
typedef struct {
  cadt_u32 triangle, k;
} cadt_spoke;

CADT_FN cadt_u32 cadt_index_in(const cadt_query_mesh* m, cadt_u32 t, cadt_u32 vertex) {
  return cadt_vertex_of(&m->view, t, 0u) == vertex ? 0u : (cadt_vertex_of(&m->view, t, 1u) == vertex ? 1u : 2u);
}
/* The next triangle around the vertex, counterclockwise or clockwise; beyond the hull its triangle is CADT_NONE. */
CADT_FN cadt_spoke cadt_turn(const cadt_query_mesh* m, cadt_spoke s, cadt_u32 clockwise) {
  const cadt_u32 next = cadt_neighbor_of(&m->view, s.triangle, clockwise ? CADT_PREV(s.k) : CADT_NEXT(s.k));
  cadt_spoke result = {next, 0u};
  if (next == CADT_NONE) return result;
  /* The vertex is at one end of the edge that is crossed. */
  const cadt_u32 entry = cadt_edge_towards(m, next, s.triangle);
  result.k = clockwise ? CADT_PREV(entry) : CADT_NEXT(entry);
  return result;
}

/* The first triangle of the vertex, counterclockwise: at a hull vertex the one that has no other before it, else the
 * one given. */
CADT_FN cadt_spoke cadt_first_spoke(const cadt_query_mesh* m, cadt_spoke s) {
  const cadt_u32 begin = s.triangle;
  for (;;) {
    const cadt_spoke before = cadt_turn(m, s, 1u);
    if (before.triangle == CADT_NONE) return s;
    s = before;
    if (s.triangle == begin) return s;
  }
}

#endif
