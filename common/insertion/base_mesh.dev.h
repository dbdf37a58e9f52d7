/* SPDX-License-Identifier: Apache-2.0
 *
 * The mesh of the first points as another stage has made it. Levels of few points take as long as those of many: each
 * waits for its longest chain of walks, locks and flips. So where points that can be wrapped are inserted on a graphics
 * card, those that represent the blocks of some level (insert.dev.h) are wrapped, and the levels below are inserted:
 *
 *     level 3    [    .    5     .    ]    wrapped: the vertices 5, ... in sorted order, in arrays;
 *     level 2    [ 1  .  ][  .   5  ]      from here on inserted into the same triangles with locks
 *
 * A vertex of the arrays is the number of its block, one of the mesh its place in the order of insertion.
 */
#ifndef CADT_INSERTION_BASE_MESH_H
#define CADT_INSERTION_BASE_MESH_H

#include "common/insertion/insert.dev.h"

#if CADT_BUILDS(INSERTION)
/* The points, in sorted order, that represent the `count` blocks of `level`. */
CADT_KERNEL(cadt_pick_base, CADT_GLOBAL const cadt_point* points, cadt_u32 n, cadt_u32 level, cadt_u32 count,
            cadt_u32 grain, CADT_GLOBAL cadt_point* picked) {
  CADT_FOR(b, count, grain) { picked[b] = points[cadt_representative(level, b, n)]; }
}

/* Their mesh, of `count` triangles, becomes locked triangles, all free. \pre all locked triangles are zero */
CADT_KERNEL(cadt_lock_base, CADT_LOCKED_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* vertices,
            CADT_GLOBAL const cadt_u32* across, cadt_u32 n, cadt_u32 level, cadt_u32 count, cadt_u32 grain) {
  CADT_LOCKED_MESH(mesh);
  CADT_FOR(t, count, grain) {
    cadt_u32 v[3];
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 block = vertices[3u * t + k];
      v[k] = block == CADT_GHOST ? CADT_GHOST : cadt_representing_vertex(level, block, n);
      cadt_set_vertex_triangle(&mesh, v[k], t);
    }
    cadt_new_triangle(&mesh, t, v[0], v[1], v[2], across[3u * t], across[3u * t + 1u], across[3u * t + 2u], 0u);
    cadt_publish_triangle(&mesh, t);
  }
}
#endif

#endif
