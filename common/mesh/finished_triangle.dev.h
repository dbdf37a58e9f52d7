/* SPDX-License-Identifier: Apache-2.0
 *
 * A triangle of the result: indices of the input, counterclockwise from the smallest on, and triangles across.
 */
#ifndef CADT_MESH_FINISHED_TRIANGLE_H
#define CADT_MESH_FINISHED_TRIANGLE_H

#include "common/portable/layout.dev.h"

/* A triangle in input ids, rotated so that the smallest comes first; `slot` is where that vertex was. */
typedef struct {
  cadt_u32 a, b, c, slot;
} cadt_triangle;

/* Null `input_ids`: the vertices are input ids already. */
CADT_FN cadt_triangle cadt_in_input_ids(CADT_GLOBAL const cadt_u32* input_ids, cadt_u32 v0, cadt_u32 v1, cadt_u32 v2) {
  const cadt_u32 x = input_ids ? input_ids[v0] : v0, y = input_ids ? input_ids[v1] : v1,
                 z = input_ids ? input_ids[v2] : v2;
  const cadt_u32 slot = x < y ? (x < z ? 0u : 2u) : (y < z ? 1u : 2u);
  const cadt_triangle t = {CADT_PICK(slot, x, y, z), CADT_PICK(slot, y, z, x), CADT_PICK(slot, z, x, y), slot};
  return t;
}

/* Edge k of the result is edge slot + k of the mesh. */
CADT_FN cadt_u32 cadt_turned_flags(cadt_u32 flags, cadt_u32 slot) {
  return (flags >> slot | flags << (3u - slot)) & 7u;
}

CADT_FN void cadt_write_finished_vertices(CADT_GLOBAL cadt_u32* triangles, cadt_u32 at, const cadt_triangle* t) {
  triangles[3u * at] = t->a;
  triangles[3u * at + 1u] = t->b;
  triangles[3u * at + 2u] = t->c;
}

/* n0, n1, n2: the triangles across the edges of the mesh. */
CADT_FN void cadt_write_finished_neighbors(CADT_GLOBAL cadt_u32* neighbors, cadt_u32 at, cadt_u32 slot, cadt_u32 n0,
                                           cadt_u32 n1, cadt_u32 n2) {
  neighbors[3u * at] = CADT_PICK(slot, n0, n1, n2);
  neighbors[3u * at + 1u] = CADT_PICK(slot, n1, n2, n0);
  neighbors[3u * at + 2u] = CADT_PICK(slot, n2, n0, n1);
}

#endif
