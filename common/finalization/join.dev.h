/* SPDX-License-Identifier: Apache-2.0
 *
 * A join: the mesh of the open vertices of the children, and the sides of their final triangles. A side runs from a to
 * b with its final triangle on the left. In the mesh of the open vertices the triangle on the left of a b is covered by
 * it, and so is each component that the sides cut off there (common/stars/stitch.dev.h has the kernels: a side is an
 * open triangle, of which two vertices are known).
 *
 *           b                   b
 *    final /|                  /|\ o
 *     (c) / |    is given     / | \          h is covered. n, across the side, is kept: it is the neighbour of the
 *        /__|                /h | n\         final triangle now, or becomes that at a later node
 *       x   a               y___a___z
 */
#ifndef CADT_FINALIZATION_JOIN_H
#define CADT_FINALIZATION_JOIN_H

#include "common/finalization/finish.dev.h"

/* Half-edges of a finished mesh, in which triangles stand across. Outside of the hull is one triangle more, behind the
 * others: its edge 0 is across all hull edges. */
CADT_KERNEL(cadt_half_edges_of, CADT_MESH_VIEW_PARAMETERS, cadt_u32 grain, CADT_GLOBAL cadt_u32* half_edges) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 n = cadt_neighbor_of(&mesh, t, k);
      cadt_u32 half_edge = CADT_HALF_EDGE(mesh.triangles, 0u);
      if (n != CADT_NONE) {
        const cadt_u32 to = cadt_vertex_of(&mesh, t, CADT_PREV(k));
        cadt_u32 j = 0u;
        while (j < 2u && cadt_vertex_of(&mesh, n, CADT_NEXT(j)) != to) ++j;
        half_edge = CADT_HALF_EDGE(n, j);
      }
      half_edges[3u * t + k] = half_edge;
    }
  }
}

/* What lies across each side: words of CADT_MATCH_* that begin as CADT_NONE. */
enum { CADT_MATCH_KIND, CADT_MATCH_FIRST, CADT_MATCH_SECOND, CADT_MATCH_WORDS };
enum {
  CADT_MATCHED_OUTSIDE, /* nothing: an edge of the hull of the open vertices */
  CADT_MATCHED_FINAL,   /* a final triangle of this node, which is the first word; the second is its vertex opposite, by
                           its number among those of the children */
  CADT_MATCHED_OPEN     /* a triangle that is not final yet */
};
/* `order`: of each vertex of the node, its number among those of the children. The two words of a side that is not
 * matched by a final triangle are the ranks of its ends. */
CADT_KERNEL(cadt_match_sides, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* half_edges,
            CADT_GLOBAL const cadt_u32* covers, CADT_GLOBAL const cadt_u32* places, CADT_GLOBAL const cadt_u32* ranks,
            CADT_GLOBAL const cadt_u32* order, cadt_u32 grain, CADT_GLOBAL cadt_u32* matches) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 side = covers[3u * t + k];
      if (side == CADT_NONE) continue;
      const cadt_u32 half_edge = half_edges[3u * t + k], n = CADT_TRIANGLE_OF(half_edge), j = CADT_EDGE_OF(half_edge);
      CADT_GLOBAL cadt_u32* match = matches + CADT_MATCH_WORDS * side;
      if (n != mesh.triangles) {
        /* no two sides meet: both ends of an edge are points of one child, and that would have matched them */
        if (covers[3u * n + j] != CADT_NONE) continue;
        if (cadt_is_final(places, n)) {
          match[CADT_MATCH_KIND] = CADT_MATCHED_FINAL;
          match[CADT_MATCH_FIRST] = places[n];
          match[CADT_MATCH_SECOND] = order[cadt_vertex_of(&mesh, n, j)];
          continue;
        }
      }
      match[CADT_MATCH_KIND] = n == mesh.triangles ? CADT_MATCHED_OUTSIDE : CADT_MATCHED_OPEN;
      match[CADT_MATCH_FIRST] = cadt_open_rank(ranks, cadt_vertex_of(&mesh, t, CADT_NEXT(k)));
      match[CADT_MATCH_SECOND] = cadt_open_rank(ranks, cadt_vertex_of(&mesh, t, CADT_PREV(k)));
    }
  }
}

#endif
