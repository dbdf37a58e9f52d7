/* SPDX-License-Identifier: Apache-2.0
 *
 * From an end of a segment along it: which edge or triangle of the mesh comes next. Both ends are looked at in turn,
 * triangle by triangle around each, so that a vertex of many edges costs no more than the other end does:
 *
 *              v2                 the segment a b leaves the star of a
 *             /|                    along the edge to v1, if v1 = b, or if v1 lies on it: then it goes on from there;
 *            / | . . b              through the triangle a, v1, v2, if v1 lies right of it and v2 left.
 *           a  |                  Within the mesh it leaves each triangle by the edge between the last vertex on its
 *            \ |                  right and the last one on its left, until it comes to a vertex.
 *             v1
 *
 * A ghost triangle is never entered: the hull is convex.
 */
#ifndef CADT_CONSTRAINTS_SEGMENT_WALK_H
#define CADT_CONSTRAINTS_SEGMENT_WALK_H

#include "common/mesh/locked_mesh.dev.h"
#include "common/portable/atomics.dev.h"

/* The mesh in arrays while segments become edges (mesh_view.dev.h within a run). */
typedef struct {
  CADT_GLOBAL const cadt_point* points;
  CADT_GLOBAL cadt_u32* vertices; /* three words a triangle */
  CADT_GLOBAL cadt_u32* across;   /* half-edges */
  CADT_GLOBAL cadt_u32* edge_flags;
  CADT_GLOBAL cadt_u32* vertex_triangle; /* of each vertex, a triangle that has it */
} cadt_segment_mesh;

#define CADT_SEGMENT_MESH_PARAMETERS                                                                  \
  CADT_GLOBAL const cadt_point *points, CADT_GLOBAL cadt_u32 *vertices, CADT_GLOBAL cadt_u32 *across, \
      CADT_GLOBAL cadt_u32 *edge_flags, CADT_GLOBAL cadt_u32 *vertex_triangle
#define CADT_SEGMENT_MESH(mesh) const cadt_segment_mesh mesh = {points, vertices, across, edge_flags, vertex_triangle}

CADT_FN cadt_u32 cadt_corner_of(const cadt_segment_mesh* m, cadt_u32 t, cadt_u32 k) { return m->vertices[3u * t + k]; }
CADT_FN cadt_u32 cadt_across_of(const cadt_segment_mesh* m, cadt_u32 half_edge) {
  return m->across[3u * CADT_TRIANGLE_OF(half_edge) + CADT_EDGE_OF(half_edge)];
}
CADT_FN cadt_u32 cadt_is_flagged(const cadt_segment_mesh* m, cadt_u32 half_edge) {
  return m->edge_flags[CADT_TRIANGLE_OF(half_edge)] >> CADT_EDGE_OF(half_edge) & 1u;
}
CADT_FN cadt_i32 cadt_side_of(const cadt_segment_mesh* m, cadt_point a, cadt_point b, cadt_u32 v,
                              cadt_counters* counters) {
  return cadt_orientation(a, b, cadt_load_point(m->points + v), counters);
}

/* Both triangles of an edge say that it is constrained. */
CADT_FN void cadt_flag_edge(const cadt_segment_mesh* m, cadt_u32 half_edge) {
  const cadt_u32 other = cadt_across_of(m, half_edge);
  cadt_or_relaxed(m->edge_flags + CADT_TRIANGLE_OF(half_edge), 1u << CADT_EDGE_OF(half_edge));
  cadt_or_relaxed(m->edge_flags + CADT_TRIANGLE_OF(other), 1u << CADT_EDGE_OF(other));
}

/* ---- around an end ---- */
enum {
  CADT_STEP_EDGE,   /* to a vertex, along half_edge */
  CADT_STEP_ENTER,  /* through a triangle: half_edge is the one by which the segment leaves it */
  CADT_STEP_NOWHERE /* the mesh is wrong: it has neither */
};

typedef struct {
  cadt_u32 kind, from_b; /* seen from the second end */
  cadt_u32 half_edge, vertex;
} cadt_segment_step;

typedef struct {
  cadt_u32 vertex, first, half_edge; /* opposite of the vertex, in the triangle looked at */
  cadt_i32 side;                     /* of its next vertex */
} cadt_turning;

/* The side of v on the way from p to vertex `to`, at q; 2 for the ghost. */
CADT_FN cadt_i32 cadt_side_or_ghost(const cadt_segment_mesh* m, cadt_point p, cadt_u32 to, cadt_point q, cadt_u32 v,
                                    cadt_counters* counters) {
  if (v == to) return 0;
  return v == CADT_GHOST ? 2 : cadt_side_of(m, p, q, v, counters);
}

CADT_FN cadt_turning cadt_begin_turning(const cadt_segment_mesh* m, cadt_u32 from, cadt_point p, cadt_u32 to,
                                        cadt_point q, cadt_counters* counters) {
  cadt_turning turn;
  const cadt_u32 t = cadt_load_relaxed(m->vertex_triangle + from);
  const cadt_u32 k = cadt_corner_of(m, t, 0u) == from ? 0u : (cadt_corner_of(m, t, 1u) == from ? 1u : 2u);
  turn.vertex = from;
  turn.half_edge = turn.first = CADT_HALF_EDGE(t, k);
  turn.side = cadt_side_or_ghost(m, p, to, q, cadt_corner_of(m, t, CADT_NEXT(k)), counters);
  return turn;
}

/* Looks at one triangle of the star of `turn->vertex`, at p, on the way to vertex `to`, at q. 1: the step is known. */
CADT_FN cadt_u32 cadt_turn_once(const cadt_segment_mesh* m, cadt_turning* turn, cadt_point p, cadt_u32 to, cadt_point q,
                                cadt_segment_step* step, cadt_counters* counters) {
  const cadt_u32 t = CADT_TRIANGLE_OF(turn->half_edge), k = CADT_EDGE_OF(turn->half_edge);
  const cadt_u32 v1 = cadt_corner_of(m, t, CADT_NEXT(k)), v2 = cadt_corner_of(m, t, CADT_PREV(k));
  step->vertex = v1;
  step->half_edge = CADT_HALF_EDGE(t, CADT_PREV(k)); /* of the edge to v1 */
  step->kind = CADT_STEP_EDGE;
  if (v1 == to) return 1u;
  /* On the line, and on the same side of p as q: then between them, as no edge passes through the vertex q. */
  if (turn->side == 0) {
    const cadt_point at = cadt_load_point(m->points + v1);
    if (cadt_before(p, at) == cadt_before(p, q)) return 1u;
  }
  const cadt_i32 side = cadt_side_or_ghost(m, p, to, q, v2, counters);
  if (turn->side == -1 && side == 1) {
    step->kind = CADT_STEP_ENTER;
    step->half_edge = turn->half_edge;
    return 1u;
  }
  /* across the edge to v2 */
  const cadt_u32 next = cadt_across_of(m, CADT_HALF_EDGE(t, CADT_NEXT(k)));
  turn->half_edge = CADT_HALF_EDGE(CADT_TRIANGLE_OF(next), CADT_NEXT(CADT_EDGE_OF(next)));
  turn->side = side;
  return 0u;
}

enum { CADT_EDGE_SEARCH = 12 /* triangles around an end in which an edge is looked for without coordinates */ };

/* A half-edge of the edge between a and b, in a triangle at a; CADT_NONE if it is not among the first triangles around
 * a. The search begins where the last one from a has ended: most edges are looked for twice. */
CADT_FN cadt_u32 cadt_find_edge(const cadt_segment_mesh* m, cadt_u32 a, cadt_u32 b) {
  const cadt_u32 first = cadt_load_relaxed(m->vertex_triangle + a);
  cadt_u32 t = first, k = cadt_corner_of(m, t, 0u) == a ? 0u : (cadt_corner_of(m, t, 1u) == a ? 1u : 2u);
  for (cadt_u32 i = 0u; i < CADT_CAST(cadt_u32, CADT_EDGE_SEARCH); ++i) {
    const cadt_u32 before = cadt_corner_of(m, t, CADT_NEXT(k)) == b ? 1u : 0u;
    if (before || cadt_corner_of(m, t, CADT_PREV(k)) == b) {
      if (t != first) cadt_store_relaxed(m->vertex_triangle + a, t);
      return CADT_HALF_EDGE(t, before ? CADT_PREV(k) : CADT_NEXT(k));
    }
    const cadt_u32 next = cadt_across_of(m, CADT_HALF_EDGE(t, CADT_NEXT(k)));
    t = CADT_TRIANGLE_OF(next);
    k = CADT_NEXT(CADT_EDGE_OF(next));
    if (t == first) break;
  }
  return CADT_NONE;
}

/* The step is known. An edge that was looked for is where the next one begins to look: it may be asked for again. */
CADT_FN cadt_segment_step cadt_take_step(const cadt_segment_mesh* m, cadt_u32 from, cadt_segment_step step) {
  if (step.kind == CADT_STEP_EDGE) cadt_store_relaxed(m->vertex_triangle + from, CADT_TRIANGLE_OF(step.half_edge));
  return step;
}

/* The next step of the segment between vertices a and b, from one of them. */
CADT_FN cadt_segment_step cadt_next_step(const cadt_segment_mesh* m, cadt_u32 a, cadt_u32 b, cadt_counters* counters) {
  const cadt_point p = cadt_load_point(m->points + a), q = cadt_load_point(m->points + b);
  cadt_turning at_a = cadt_begin_turning(m, a, p, b, q, counters), at_b = cadt_begin_turning(m, b, q, a, p, counters);
  cadt_segment_step step;
  for (;;) {
    step.from_b = 0u;
    if (cadt_turn_once(m, &at_a, p, b, q, &step, counters)) return cadt_take_step(m, a, step);
    step.from_b = 1u;
    if (cadt_turn_once(m, &at_b, q, a, p, &step, counters)) return cadt_take_step(m, b, step);
    if (at_a.half_edge == at_a.first || at_b.half_edge == at_b.first) break;
  }
  step.kind = CADT_STEP_NOWHERE;
  return step;
}

/* ---- through triangles ---- */
typedef struct {
  cadt_u32 half_edge; /* by which the segment leaves the triangle, seen from it */
  cadt_u32 apex;      /* the vertex that the triangle behind has beyond that edge, */
  cadt_u32 entry;     /* the half-edge opposite of it, */
  cadt_i32 side;      /* and its side: 0 if the segment ends there */
} cadt_crossed;

/* Crosses `at->half_edge`. p and q: the ends of the segment, in its direction; `to`: the second one. */
CADT_FN void cadt_cross(const cadt_segment_mesh* m, cadt_crossed* at, cadt_point p, cadt_u32 to, cadt_point q,
                        cadt_counters* counters) {
  const cadt_u32 entry = cadt_across_of(m, at->half_edge);
  const cadt_u32 t = CADT_TRIANGLE_OF(entry), k = CADT_EDGE_OF(entry);
  at->entry = entry;
  at->apex = cadt_corner_of(m, t, k);
  at->side = at->apex == to ? 0 : cadt_side_of(m, p, q, at->apex, counters);
  /* The next vertex of the entry is the one on the left, the previous one that on the right. */
  at->half_edge = CADT_HALF_EDGE(t, at->side > 0 ? CADT_NEXT(k) : CADT_PREV(k));
}

#endif
