/* SPDX-License-Identifier: Apache-2.0
 *
 * Point location: a walk without locks by orientation tests (paper, section 4.2, Algorithm 1; the visibility walk of
 * Guibas and Stolfi, 1985). What it reads may be torn or stale; the lock taken afterwards validates the last triangle.
 *
 * Outside the hull, rays from the centre of the seed triangle through the hull's vertices divide the plane into wedges;
 * a ghost triangle owns the part of its wedge beyond its hull edge:
 *
 *               .           .
 *                . ghost   .           x, y: hull vertices
 *                 y ----- x            the hull edge runs y -> x counterclockwise
 *                  .     .
 *                   .   .
 *                  center
 *
 * While threads work the hull need not be convex, but it stays star-shaped around the centre (docs/insertion.md,
 * "Outside the hull"). So at every moment each point of the plane lies in exactly one real triangle or wedge, and
 * inserting it there is always right.
 */
#ifndef CADT_INSERTION_LOCATE_H
#define CADT_INSERTION_LOCATE_H

#include "common/insertion/lock.dev.h"

enum { CADT_IN_FACE, CADT_ON_EDGE, CADT_LOST };
enum {
  CADT_WALK_LIMIT = 1 << 14, /* steps in one launch; a later one goes on */
  CADT_WALK_STRAIGHT =
      64 /* steps before edges are tried in random order: while others flip, the mesh is not Delaunay */
};

typedef struct {
  cadt_u32 kind, triangle, edge;
  cadt_snapshot at;
} cadt_place;

/* Orientation of the centre, a and b. */
CADT_FN cadt_i32 cadt_around_center(const cadt_locked_mesh* m, cadt_point a, cadt_point b, cadt_counters* counters) {
  counters->count[CADT_COUNT_ORIENTATION_TESTS]++;
#if !CADT_WIDE
  cadt_real ux = a.x - m->center.x, uy = a.y - m->center.y, vx = b.x - m->center.x, vy = b.y - m->center.y;
  cadt_real left = ux * vy, right = uy * vx, det = left - right;
  /* coordinates are below 1, so the rounded centre is off by less than 2^-50 in each */
  cadt_real bound = CADT_ORIENTATION_BOUND * (cadt_fabs(left) + cadt_fabs(right)) +
                    9e-16 * (cadt_fabs(b.x - a.x) + cadt_fabs(b.y - a.y));
  if (det > bound) return 1;
  if (-det > bound) return -1;
#endif
  counters->count[CADT_COUNT_EXACT_ORIENTATIONS]++;
  return cadt_orientation_centroid_exact(cadt_point_of(m, m->first), cadt_point_of(m, m->second),
                                         cadt_point_of(m, m->third), a, b);
}

/* The edge by which to leave a ghost triangle whose vertex g is the ghost, or 3 if p is in its wedge and strictly
 * outside the hull. */
CADT_FN cadt_u32 cadt_leave_ghost(const cadt_locked_mesh* m, const cadt_snapshot* s, cadt_u32 g, cadt_point p,
                                  cadt_counters* counters) {
  cadt_u32 gx = CADT_NEXT(g), gy = CADT_PREV(g);
  /* the hull edge runs y -> x counterclockwise */
  cadt_point x = cadt_point_of(m, CADT_VERTEX(*s, gx)), y = cadt_point_of(m, CADT_VERTEX(*s, gy));
  if (cadt_around_center(m, y, p, counters) < 0) return gx;
  if (cadt_around_center(m, x, p, counters) >= 0) return gy;
  return cadt_orientation(x, y, p, counters) > 0 ? 3u : g;
}

/* The edge by which to leave a real triangle towards p, or 3 if p is outside of no edge; then the bits of `on` name the
 * edges on whose lines p lies. `entry` is an edge known to have p on its inner side, or 3. Edges are tried from 0 to 2,
 * or from 2 to 0 if `reverse`: where two edges lead towards p, either will do. */
CADT_FN cadt_u32 cadt_leave_face(const cadt_locked_mesh* m, const cadt_snapshot* s, cadt_u32 entry, cadt_u32 reverse,
                                 cadt_point p, cadt_u32* on, cadt_counters* counters) {
  cadt_point a = cadt_point_of(m, s->v0), b = cadt_point_of(m, s->v1), c = cadt_point_of(m, s->v2);
  cadt_i32 o0 = 1, o1 = 1, o2 = 1;
  if (reverse) {
    if (entry != 2u && (o2 = cadt_orientation(a, b, p, counters)) < 0) return 2u;
    if (entry != 1u && (o1 = cadt_orientation(c, a, p, counters)) < 0) return 1u;
    if (entry != 0u && (o0 = cadt_orientation(b, c, p, counters)) < 0) return 0u;
  } else {
    if (entry != 0u && (o0 = cadt_orientation(b, c, p, counters)) < 0) return 0u;
    if (entry != 1u && (o1 = cadt_orientation(c, a, p, counters)) < 0) return 1u;
    if (entry != 2u && (o2 = cadt_orientation(a, b, p, counters)) < 0) return 2u;
  }
  *on = (o0 == 0 ? 1u : 0u) | (o1 == 0 ? 2u : 0u) | (o2 == 0 ? 4u : 0u);
  return 3u;
}

/* Walks from triangle `start` to the place of p. place->kind is CADT_LOST if the walk was too long or met a torn read;
 * place->triangle is where to go on in any case. */
CADT_FN void cadt_locate(const cadt_locked_mesh* m, cadt_point p, cadt_u32 start, cadt_place* place,
                         cadt_counters* counters) {
  cadt_u32 t = start, entry = 3u, steps = 0u, random = start * 2654435761u + 12345u;
  place->kind = CADT_LOST;
  place->edge = 0u;
  for (; steps < CADT_CAST(cadt_u32, CADT_WALK_LIMIT); ++steps) {
    CADT_NOISE_AT(m, CADT_SITE_WALK);
    cadt_snapshot s = cadt_snapshot_of(m, t);
    cadt_u32 leave, on = 0u;
    if (s.lock == 0u) break;
    if (s.v0 == CADT_GHOST || s.v1 == CADT_GHOST || s.v2 == CADT_GHOST) {
      cadt_u32 g = s.v0 == CADT_GHOST ? 0u : (s.v1 == CADT_GHOST ? 1u : 2u);
      if (CADT_VERTEX(s, CADT_NEXT(g)) == CADT_GHOST || CADT_VERTEX(s, CADT_PREV(g)) == CADT_GHOST)
        break; /* torn read */
      leave = cadt_leave_ghost(m, &s, g, p, counters);
    } else {
      cadt_u32 reverse = 0u;
      if (steps > CADT_CAST(cadt_u32, CADT_WALK_STRAIGHT)) {
        random = random * 1664525u + 1013904223u;
        reverse = random >> 31;
      }
      leave = cadt_leave_face(m, &s, entry, reverse, p, &on, counters);
      /* The entry edge was tested from the other side, but either side may have changed since: test it before it
       * counts. */
      if (leave == 3u && entry != 3u) {
        const cadt_i32 o = cadt_orientation(cadt_point_of(m, CADT_VERTEX(s, CADT_NEXT(entry))),
                                            cadt_point_of(m, CADT_VERTEX(s, CADT_PREV(entry))), p, counters);
        if (o < 0) leave = entry;
        if (o == 0) on |= 1u << entry;
      }
    }
    if (leave == 3u) {
      if (on & (on - 1u)) break; /* on two lines: a torn read, since p is no vertex */
      place->kind = on ? CADT_ON_EDGE : CADT_IN_FACE;
      place->edge = on >> 1; /* bits 1, 2, 4 to edges 0, 1, 2 */
      place->at = s;
      break;
    }
    const cadt_u32 half_edge = CADT_NEIGHBOR(s, leave);
    t = CADT_TRIANGLE_OF(half_edge);
    /* wedges decide how a ghost triangle is entered and left: that tells nothing of the edge between the two */
    entry = s.v0 == CADT_GHOST || s.v1 == CADT_GHOST || s.v2 == CADT_GHOST ? 3u : CADT_EDGE_OF(half_edge);
  }
  place->triangle = t;
  counters->count[CADT_COUNT_WALK_STEPS] += steps;
}

#endif
