/* SPDX-License-Identifier: Apache-2.0
 *
 * The mesh for kernels that only read: certification, stitching, output, the verifier. Three vertices a triangle,
 * counterclockwise, and three words for what lies across the edges opposite of them, as in locked_mesh.dev.h, but
 * without lock words and flip counters. One view fits both forms:
 *
 *   within a run        vertices are indices of `points`; across stand half-edges (4 * triangle + edge); ghost
 * triangles come last of a finished mesh  vertices are indices of the input; across stand triangles, CADT_NONE outside
 * of the hull
 *
 * A vertex is an index of `points` and nothing more: what comes after the sort may add points behind the others.
 */
#ifndef CADT_MESH_MESH_VIEW_H
#define CADT_MESH_MESH_VIEW_H

#include "common/portable/layout.dev.h"

typedef struct {
  CADT_GLOBAL const cadt_point* points;
  CADT_GLOBAL const cadt_u32* vertices;   /* three words a triangle */
  CADT_GLOBAL const cadt_u32* across;     /* the same */
  CADT_GLOBAL const cadt_u32* edge_flags; /* a word a triangle, bit k: its edge k is constrained; null: none is */
  cadt_u32 triangles;                     /* without those of the ghost */
  cadt_u32 all;                           /* with them */
  cadt_u32 edge_bits;                     /* of the words of `across`: 2 for half-edges, 0 for triangles */
} cadt_mesh_view;

#define CADT_MESH_VIEW_PARAMETERS                                                                                 \
  CADT_GLOBAL const cadt_point *points, CADT_GLOBAL const cadt_u32 *vertices, CADT_GLOBAL const cadt_u32 *across, \
      CADT_GLOBAL const cadt_u32 *edge_flags, cadt_u32 triangle_count, cadt_u32 all_count, cadt_u32 edge_bits
#define CADT_MESH_VIEW(view) \
  const cadt_mesh_view view = {points, vertices, across, edge_flags, triangle_count, all_count, edge_bits}

/* Vertex k of triangle t. One vertex of a ghost triangle is CADT_GHOST. */
CADT_FN cadt_u32 cadt_vertex_of(const cadt_mesh_view* m, cadt_u32 t, cadt_u32 k) { return m->vertices[3u * t + k]; }

/* The triangle across edge k of triangle t, CADT_NONE outside of the hull. */
CADT_FN cadt_u32 cadt_neighbor_of(const cadt_mesh_view* m, cadt_u32 t, cadt_u32 k) {
  const cadt_u32 n = m->across[3u * t + k] >> m->edge_bits;
  return n < m->triangles ? n : CADT_NONE;
}

/* Whether edge k of triangle t is constrained. */
CADT_FN cadt_u32 cadt_is_constrained(const cadt_mesh_view* m, cadt_u32 t, cadt_u32 k) {
  return m->edge_flags ? m->edge_flags[t] >> k & 1u : 0u;
}

#endif
