/* SPDX-License-Identifier: Apache-2.0
 *
 * Stitching: the proven part of the mesh and the residual mesh become one. A triangle without a proven vertex belongs
 * to the Delaunay triangulation of the unproven (residual) vertices alone, since an empty circle stays empty in a
 * subset (docs/stars.md, "Stitching"). Gift wrapping builds that residual mesh, or insertion where it cannot; here
 * those of its triangles are found that fill the holes of the proven part, and both parts are connected.
 *
 *    proven part with a hole     residual mesh               whole mesh
 *
 *       p -- u === u -- p             u --- u.                  p -- u --- u -- p
 *       | \  |     |  / | \           | k / |  '.               | \  | k / |  / | \    p proven, u unproven
 *       |  p | hole| p  |  u          |  /  | h   u             |  p |  /  | p  |  u   = edges where both meet
 *       | /  |     |  \ | /           | / k |  .'               | /  | / k |  \ | /
 *       p -- u === u -- p             u --- u'                  p -- u --- u -- p
 *
 *                            k kept, h hidden: the proven part covers it
 *
 * An open triangle has one proven vertex; its edge 0 is opposite of that. The two parts meet in such edges: an open
 * triangle on one side, the residual mesh on the other. They cut the residual mesh into components; a component is
 * hidden if an open triangle lies on the same side of an edge as one of its triangles: there the proven part covers it.
 * Stitched meshes have no constrained edges.
 */
#ifndef CADT_STARS_STITCH_H
#define CADT_STARS_STITCH_H

#include "common/mesh/locked_mesh.dev.h"
#include "common/mesh/mesh_view.dev.h"
#include "common/portable/union_find.dev.h"

/* Gathers the residual vertices. `ranks` is the scan of 1 for each. */
CADT_KERNEL(cadt_pack_residual, CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL const cadt_point* points,
            CADT_GLOBAL cadt_point* subset, CADT_GLOBAL cadt_u32* positions, cadt_u32 n, cadt_u32 grain) {
  CADT_FOR(v, n, grain) {
    const cadt_u32 rank = ranks[v];
    if (ranks[v + 1u] == rank) continue;
    subset[rank] = points[v];
    positions[rank] = v;
  }
}

CADT_FN cadt_u32 cadt_edge_hash(cadt_u32 a, cadt_u32 b) {
  cadt_u32 x = a * 2654435761u ^ (b * 0x85EBCA6Bu + 0x9E3779B9u);
  x ^= x >> 15;
  x *= 0x2C1B3C6Du;
  return x ^ (x >> 13);
}

/* A hash table of the open triangles by the ends of their edge 0, from the first to the second; `mask` + 1 places, a
 * power of two. \pre the table is CADT_NONE */
CADT_KERNEL(cadt_stitch_enter, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* open, cadt_u32 count,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* table, cadt_u32 mask) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 t = open[i];
    CADT_GLOBAL const cadt_u32* v = vertices + 3u * t;
    cadt_u32 at = cadt_edge_hash(v[1], v[2]) & mask;
    while (!cadt_cas_relaxed(table + at, CADT_NONE, t)) at = (at + 1u) & mask;
  }
}

/* covers[3 r + k]: the open triangle on the same side of edge k as triangle r of the residual mesh, or CADT_NONE.
 * `mesh_vertices`: of the whole mesh, here and below. */
CADT_KERNEL(cadt_stitch_cover, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* mesh_vertices,
            CADT_GLOBAL const cadt_u32* positions, cadt_u32 grain, CADT_GLOBAL const cadt_u32* table, cadt_u32 mask,
            CADT_GLOBAL cadt_u32* covers, CADT_GLOBAL cadt_u32* roots) {
  CADT_MESH_VIEW(residual);
  CADT_FOR(r, residual.all, grain) {
    roots[r] = r;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      cadt_u32 cover = CADT_NONE;
      const cadt_u32 from = cadt_vertex_of(&residual, r, CADT_NEXT(k)), to = cadt_vertex_of(&residual, r, CADT_PREV(k));
      if (from != CADT_GHOST && to != CADT_GHOST) {
        const cadt_u32 a = positions[from], b = positions[to];
        cadt_u32 at = cadt_edge_hash(a, b) & mask;
        for (cover = table[at]; cover != CADT_NONE; cover = table[at]) {
          CADT_GLOBAL const cadt_u32* v = mesh_vertices + 3u * cover;
          if (v[1] == a && v[2] == b) break;
          at = (at + 1u) & mask;
        }
      }
      covers[3u * r + k] = cover;
    }
  }
}

/* Components of the residual mesh without the edges that have an open triangle on either side. */
CADT_KERNEL(cadt_stitch_components, CADT_MESH_VIEW_PARAMETERS, cadt_u32 grain, CADT_GLOBAL const cadt_u32* covers,
            CADT_GLOBAL cadt_u32* roots) {
  CADT_MESH_VIEW(residual);
  CADT_FOR(r, residual.all, grain) {
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 half_edge = residual.across[3u * r + k], other = CADT_TRIANGLE_OF(half_edge);
      if (other < r || covers[3u * r + k] != CADT_NONE || covers[3u * other + CADT_EDGE_OF(half_edge)] != CADT_NONE)
        continue;
      cadt_unite(roots, r, other);
    }
  }
}

/* hidden[root] = 1 for components of `all` triangles that the proven part covers. \pre hidden is 0 */
CADT_KERNEL(cadt_stitch_hide, CADT_GLOBAL const cadt_u32* covers, CADT_GLOBAL cadt_u32* roots, cadt_u32 all,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* hidden) {
  CADT_FOR(r, all, grain) {
    if (covers[3u * r] != CADT_NONE || covers[3u * r + 1u] != CADT_NONE || covers[3u * r + 2u] != CADT_NONE)
      cadt_store_relaxed(hidden + cadt_find_root(roots, r), 1u);
  }
}

/* 1 for triangles that belong to the whole mesh; their scan, with a 0 at the end, numbers them, those of the ghost
 * behind the others. */
CADT_KERNEL(cadt_stitch_flags, CADT_GLOBAL cadt_u32* roots, CADT_GLOBAL const cadt_u32* hidden, cadt_u32 all,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* flags) {
  if (cadt_item == 0u) flags[all] = 0u;
  CADT_FOR(r, all, grain) { flags[r] = hidden[cadt_find_root(roots, r)] ? 0u : 1u; }
}

/* Copies the triangles behind the `before` triangles of the proven part, and connects both. */
CADT_KERNEL(cadt_stitch_residual, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* covers,
            CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL const cadt_u32* positions, cadt_u32 grain, cadt_u32 before,
            CADT_GLOBAL cadt_u32* mesh_vertices, CADT_GLOBAL cadt_u32* mesh_half_edges) {
  CADT_MESH_VIEW(residual);
  CADT_FOR(r, residual.all, grain) {
    const cadt_u32 t = before + ranks[r], taken = ranks[r + 1u] != ranks[r] ? 1u : 0u;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 half_edge = residual.across[3u * r + k], other = CADT_TRIANGLE_OF(half_edge);
      const cadt_u32 cover = covers[3u * r + k], beyond = covers[3u * other + CADT_EDGE_OF(half_edge)];
      if (taken) {
        const cadt_u32 v = cadt_vertex_of(&residual, r, k);
        cadt_u32 partner = CADT_HALF_EDGE(beyond, 0u);
        if (beyond != CADT_NONE)
          mesh_half_edges[3u * beyond] = CADT_HALF_EDGE(t, k);
        else
          partner = CADT_HALF_EDGE(before + ranks[other], CADT_EDGE_OF(half_edge));
        mesh_half_edges[3u * t + k] = partner;
        mesh_vertices[3u * t + k] = v == CADT_GHOST ? v : positions[v];
      } else if (cover != CADT_NONE && beyond != CADT_NONE) { /* proven on both sides */
        mesh_half_edges[3u * cover] = CADT_HALF_EDGE(beyond, 0u);
      }
    }
  }
}

#endif
