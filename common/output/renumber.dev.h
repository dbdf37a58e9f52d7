/* SPDX-License-Identifier: Apache-2.0
 *
 * The mesh as arrays of input ids: vertices become input ids, half-edges become numbers of triangles.
 */
#ifndef CADT_OUTPUT_RENUMBER_H
#define CADT_OUTPUT_RENUMBER_H

#include "common/mesh/finished_triangle.dev.h"
#include "common/mesh/mesh_view.dev.h"

/* So many triangles later a CPU writes to a place that it fetches now: 26 -> 15 ms for a million points in random
 * order. */
enum { CADT_TRIANGLES_AHEAD = 16 };

/* Writes triangle t to place first + numbers[t], or first + t if `numbers` is null. In the order of the mesh, so that
 * what is read (numbers of neighbours, input ids) is near. Results that are null are skipped. Without numbers they may
 * be the arrays of the mesh. */
CADT_KERNEL(cadt_write_triangles, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* input_ids,
            CADT_GLOBAL const cadt_u32* numbers, CADT_GLOBAL cadt_u32* triangles, CADT_GLOBAL cadt_u32* neighbors,
            CADT_GLOBAL cadt_u32* flags, cadt_u32 first, cadt_u32 grain) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    if (numbers && mesh.triangles - t > CADT_CAST(cadt_u32, CADT_TRIANGLES_AHEAD)) {
      const cadt_u32 soon = first + numbers[t + CADT_TRIANGLES_AHEAD];
      if (neighbors) cadt_prefetch_to_write(neighbors + 3u * soon);
      if (triangles) cadt_prefetch_to_write(triangles + 3u * soon);
    }
    const cadt_triangle r = cadt_in_input_ids(input_ids, cadt_vertex_of(&mesh, t, 0u), cadt_vertex_of(&mesh, t, 1u),
                                              cadt_vertex_of(&mesh, t, 2u));
    const cadt_u32 at = first + (numbers ? numbers[t] : t);
    if (neighbors) { /* else the words across may be gone already */
      cadt_u32 n[3];
      for (cadt_u32 k = 0u; k < 3u; ++k) {
        n[k] = cadt_neighbor_of(&mesh, t, k);
        if (numbers && n[k] != CADT_NONE) n[k] = numbers[n[k]];
      }
      cadt_write_finished_neighbors(neighbors, at, r.slot, n[0], n[1], n[2]);
    }
    if (triangles) cadt_write_finished_vertices(triangles, at, &r);
    if (flags) flags[at] = cadt_turned_flags(mesh.edge_flags[t], r.slot);
  }
}

/* Moves a finished array of `row` words a triangle to the places of the triangles in as many steps, one for each word
 * `k`, by way of `moved`. It takes more time than a second array and a third of its memory. `neighbors`: the words are
 * triangles. */
CADT_KERNEL(cadt_move_words, CADT_GLOBAL const cadt_u32* words, CADT_GLOBAL const cadt_u32* numbers, cadt_u32 row,
            cadt_u32 k, cadt_u32 neighbors, CADT_GLOBAL cadt_u32* moved, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
    const cadt_u32 value = words[row * t + k];
    moved[numbers[t]] = neighbors && value != CADT_NONE ? numbers[value] : value;
  }
}

CADT_KERNEL(cadt_put_words, CADT_GLOBAL const cadt_u32* moved, CADT_GLOBAL cadt_u32* words, cadt_u32 row, cadt_u32 k,
            cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(t, count, grain) { words[row * t + k] = moved[t]; }
}

#endif
