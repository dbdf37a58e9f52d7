/* SPDX-License-Identifier: Apache-2.0
 *
 * The seed triangle and its three ghost triangles: the mesh that all points are inserted into, without a base
 * (base_mesh.dev.h). (The paper's super triangle, section 4.1, would spoil the hull.)
 *
 *              c
 *       g1    / \    g0         face = (a, b, c)      g0.0,   g1.0, g2.0
 *            /   \              g0   = (G, c, b)      face.0, g2.2, g1.1
 *           /face \             g1   = (G, a, c)      face.1, g0.2, g2.1
 *          a ----- b            g2   = (G, b, a)      face.2, g1.2, g0.1
 *              g2
 *
 * G is the ghost, at infinity; beside each triangle stand the half-edges across its edges 0, 1 and 2.
 */
#ifndef CADT_INSERTION_SEED_TRIANGLE_H
#define CADT_INSERTION_SEED_TRIANGLE_H

#include "common/insertion/split.dev.h"

#if CADT_BUILDS(INSERTION)
/* Lowers *third to the first position that is not on the line through points `first` and `second`. */
CADT_KERNEL(cadt_find_seed_triangle, CADT_GLOBAL const cadt_point* points, cadt_u32 first, cadt_u32 second,
            cadt_u32 begin, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* third) {
  CADT_DECLARE_COUNTERS(counters);
  const cadt_point a = points[first], b = points[second];
  CADT_FOR(i, count, grain) {
    if (cadt_orientation(a, b, points[begin + i], &counters) != 0) {
      cadt_min_relaxed(third, begin + i);
      break;
    }
  }
}
#endif

/* \pre all locked triangles are zero */
CADT_FN void cadt_make_seed_mesh(const cadt_locked_mesh* m, cadt_counters* counters) {
  cadt_u32 a = m->first, b = m->second, c = m->third;
  if (cadt_orientation(m->points[a], m->points[b], m->points[c], counters) < 0) {
    b = m->third;
    c = m->second;
  }
  const cadt_u32 face = 2u * a, g0 = face + 1u; /* ghosts opposite a, b, c */
  const cadt_u32 g1 = 2u * m->second, g2 = g1 + 1u;
  cadt_new_triangle(m, face, a, b, c, CADT_HALF_EDGE(g0, 0u), CADT_HALF_EDGE(g1, 0u), CADT_HALF_EDGE(g2, 0u), 0u);
  cadt_new_triangle(m, g0, CADT_GHOST, c, b, CADT_HALF_EDGE(face, 0u), CADT_HALF_EDGE(g2, 2u), CADT_HALF_EDGE(g1, 1u),
                    0u);
  cadt_new_triangle(m, g1, CADT_GHOST, a, c, CADT_HALF_EDGE(face, 1u), CADT_HALF_EDGE(g0, 2u), CADT_HALF_EDGE(g2, 1u),
                    0u);
  cadt_new_triangle(m, g2, CADT_GHOST, b, a, CADT_HALF_EDGE(face, 2u), CADT_HALF_EDGE(g1, 2u), CADT_HALF_EDGE(g0, 1u),
                    0u);
  cadt_publish_triangle(m, face);
  cadt_publish_triangle(m, g0);
  cadt_publish_triangle(m, g1);
  cadt_publish_triangle(m, g2);
  cadt_store_relaxed(m->vertex_to_triangle + m->first, face);
  cadt_store_relaxed(m->vertex_to_triangle + m->second, face);
  cadt_store_relaxed(m->vertex_to_triangle + m->third, face);
}

#if CADT_BUILDS(INSERTION)
CADT_KERNEL(cadt_seed_mesh, CADT_LOCKED_MESH_PARAMETERS) {
  if (cadt_item != 0u) return;
  CADT_LOCKED_MESH(mesh);
  CADT_DECLARE_COUNTERS(counters);
  cadt_make_seed_mesh(&mesh, &counters);
}
#endif

#endif
