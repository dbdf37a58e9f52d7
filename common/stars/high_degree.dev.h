/* SPDX-License-Identifier: Apache-2.0
 *
 * Triangles of three vertices without stars, which appear in no star: of three high-degree vertices, or of two and the
 * ghost. They fill gaps whose edges are known from the other side. All three are Delaunay neighbours, so the triangle
 * beyond an edge is the one that the edge has in the Delaunay triangulation of the high-degree vertices alone: a step
 * of gift wrapping among few points (docs/stars.md, "Gift wrapping").
 */
#ifndef CADT_STARS_HIGH_DEGREE_H
#define CADT_STARS_HIGH_DEGREE_H

#include "common/stars/wrapped_star.dev.h"

/* Lists the vertices without a star, CADT_WRAP_FAILED of them, in any order. \pre listed[0] is 0 */
CADT_KERNEL(cadt_list_high_degree, CADT_GLOBAL const cadt_u32* sizes, cadt_u32 n, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* high_degree, CADT_GLOBAL cadt_u32* listed) {
  CADT_FOR(v, n, grain) {
    if (sizes[v] == 0u) high_degree[cadt_add_relaxed(listed, 1u)] = v;
  }
}

/* Finds the apex to the left of edges[0] to edges[count - 1]: the high-degree vertex whose circle with both ends
 * contains no other, or the ghost if none is on that side. */
CADT_KERNEL(cadt_apex_of_high_degree, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* high_degree,
            cadt_u32 high_degree_count, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_wrap_edge* edges,
            CADT_GLOBAL cadt_u32* counts) {
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(e, count, grain) {
    const cadt_u32 a = edges[e].from, b = edges[e].to;
    cadt_u32 best = CADT_GHOST;
    for (cadt_u32 k = 0u; k < high_degree_count; ++k) {
      const cadt_u32 c = high_degree[k];
      if (c == a || c == b || cadt_orientation(points[a], points[b], points[c], &counters) <= 0) continue;
      best = best == CADT_GHOST ? c : cadt_wrap_better_of(points, a, b, 1, best, c, &counters);
    }
    edges[e].left = best;
  }
  cadt_flush_exact(&counters, counts + CADT_WRAP_EXACT_ORIENTATIONS);
}

#endif
