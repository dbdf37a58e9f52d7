/* SPDX-License-Identifier: Apache-2.0
 *
 * The final triangles of a node are packed. An edge to what is not final yet, or to a final triangle of an earlier
 * node, has a row of links:
 *
 *     o === o        o open, c closed: triangles with a closed vertex are final
 *    / \ f / \
 *   /   \ /   \      === the edge of f between open vertices: what lies across belongs to another node, and its number
 *  o --- c --- o     becomes known there
 */
#ifndef CADT_FINALIZATION_FINISH_H
#define CADT_FINALIZATION_FINISH_H

#include "common/mesh/mesh_view.dev.h"
#include "common/portable/atomics.dev.h"
#include "common/portable/hash.dev.h"

/* 1 for final triangles; their scan, with a 0 at the end, numbers them. `kept` as for cadt_mark_open; `open` is null at
 * the root, where all that is kept is final. */
CADT_KERNEL(cadt_flag_final, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* kept,
            CADT_GLOBAL const cadt_u32* open, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* flags) {
  if (cadt_item == 0u) flags[count] = 0u;
  CADT_FOR(t, count, grain) {
    CADT_GLOBAL const cadt_u32* v = vertices + 3u * t;
    cadt_u32 final = !kept || kept[t] ? 1u : 0u;
    if (final && open && open[v[0]] && open[v[1]] && open[v[2]]) final = 0u;
    flags[t] = final;
  }
}

CADT_FN cadt_u32 cadt_is_final(CADT_GLOBAL const cadt_u32* places, cadt_u32 t) { return places[t + 1u] - places[t]; }

/* Whether edge k of the final triangle t has a row of links. */
CADT_FN cadt_u32 cadt_has_row(const cadt_mesh_view* m, CADT_GLOBAL const cadt_u32* places, cadt_u32 root, cadt_u32 t,
                              cadt_u32 k) {
  const cadt_u32 n = cadt_neighbor_of(m, t, k);
  if (n == CADT_NONE) return !root;
  return !cadt_is_final(places, n);
}

/* Lists 3 * triangle + edge of the edges with a row, in any order, as far as there is `room`; counts all of them. */
CADT_KERNEL(cadt_list_rows, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* places, cadt_u32 root,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* counter, CADT_GLOBAL cadt_u32* list, cadt_u32 room) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    if (!cadt_is_final(places, t)) continue;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      if (!cadt_has_row(&mesh, places, root, t, k)) continue;
      const cadt_u32 at = cadt_add_relaxed(counter, 1u);
      if (at < room) list[at] = 3u * t + k;
    }
  }
}

/* Writes the final triangles. `rows`: the sorted list of cadt_list_rows. */
CADT_KERNEL(cadt_pack_final, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* places, cadt_u32 root,
            cadt_u32 grain, CADT_GLOBAL const cadt_u32* rows, cadt_u32 row_count, CADT_GLOBAL cadt_u32* final_vertices,
            CADT_GLOBAL cadt_u32* final_neighbors) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    if (!cadt_is_final(places, t)) continue;
    const cadt_u32 to = 3u * places[t];
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      final_vertices[to + k] = cadt_vertex_of(&mesh, t, k);
      const cadt_u32 n = cadt_neighbor_of(&mesh, t, k);
      cadt_u32 other = CADT_NONE;
      if (cadt_has_row(&mesh, places, root, t, k)) {
        cadt_u32 row = 0u, end = row_count;
        CADT_FIND_FIRST(row, end, middle, rows[middle] < 3u * t + k)
        other = CADT_NONE - 1u - row; /* as a signed number: -2 - row */
      } else if (n != CADT_NONE) {
        other = places[n];
      }
      final_neighbors[to + k] = other;
    }
  }
}

/* The number of an open vertex among those that go up, which `ranks` is the scan of; else, and without ranks at the
 * root, CADT_NONE. */
CADT_FN cadt_u32 cadt_open_rank(CADT_GLOBAL const cadt_u32* ranks, cadt_u32 v) {
  return ranks && ranks[v + 1u] != ranks[v] ? ranks[v] : CADT_NONE;
}

/* What the host is told of a row: the words of CADT_ROW_*, and the apex of the triangle. `ranks`: the scan of `open`,
 * or null at the root. `half_edges` and `covers`: of a join (join.dev.h), else null. */
enum { CADT_ROW_FROM, CADT_ROW_TO, CADT_ROW_TRIANGLE, CADT_ROW_COVER, CADT_ROW_WORDS };
CADT_KERNEL(cadt_pack_rows, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* places,
            CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL const cadt_u32* half_edges,
            CADT_GLOBAL const cadt_u32* covers, CADT_GLOBAL const cadt_u32* rows, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* words, CADT_GLOBAL cadt_point* apexes) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(i, count, grain) {
    const cadt_u32 t = rows[i] / 3u, k = rows[i] % 3u;
    const cadt_u32 from = cadt_vertex_of(&mesh, t, CADT_NEXT(k)), to = cadt_vertex_of(&mesh, t, CADT_PREV(k));
    CADT_GLOBAL cadt_u32* out = words + CADT_ROW_WORDS * i;
    out[CADT_ROW_FROM] = cadt_open_rank(ranks, from);
    out[CADT_ROW_TO] = cadt_open_rank(ranks, to);
    out[CADT_ROW_TRIANGLE] = places[t];
    out[CADT_ROW_COVER] = CADT_NONE;
    if (covers) {
      const cadt_u32 half_edge = half_edges[3u * t + k];
      out[CADT_ROW_COVER] = covers[3u * CADT_TRIANGLE_OF(half_edge) + CADT_EDGE_OF(half_edge)];
    }
    apexes[i] = mesh.points[cadt_vertex_of(&mesh, t, k)];
  }
}

/* Sums of the hash of triangles by ids of 64 bits: a row for each work-item. */
CADT_KERNEL(cadt_hash_triangles, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u64* ids, cadt_u32 count,
            cadt_u32 chunk, cadt_u32 parts, CADT_GLOBAL cadt_hash* sums) {
  cadt_hash sum = {0u, 0u};
  if (cadt_item >= parts) return;
  CADT_FOR_PART(t, cadt_item, parts, count, chunk) {
    cadt_hash_add_triangle(&sum, ids[vertices[3u * t]], ids[vertices[3u * t + 1u]], ids[vertices[3u * t + 2u]]);
  }
  sums[cadt_item] = sum;
}

/* Sums of rows of cadt_hash_triangles: a row for each work-item. */
CADT_KERNEL(cadt_merge_hashes, CADT_GLOBAL const cadt_hash* rows, cadt_u32 count, cadt_u32 chunk, cadt_u32 parts,
            CADT_GLOBAL cadt_hash* sums) {
  cadt_hash sum = {0u, 0u};
  if (cadt_item >= parts) return;
  CADT_FOR_PART(i, cadt_item, parts, count, chunk) {
    sum.high += rows[i].high;
    sum.low += rows[i].low;
  }
  sums[cadt_item] = sum;
}

/* ids[i] = first + i, in two words. */
CADT_KERNEL(cadt_number_ids, CADT_GLOBAL cadt_u64* ids, cadt_u32 first_low, cadt_u32 first_high, cadt_u32 count,
            cadt_u32 grain) {
  const cadt_u64 first = CADT_LONG(first_high, first_low);
  CADT_FOR(i, count, grain) { ids[i] = first + i; }
}

/* The lowest i for which ids[i] is not above the one before it. */
CADT_KERNEL(cadt_check_ids, CADT_GLOBAL const cadt_u64* ids, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* first) {
  CADT_FOR(i, count, grain) {
    if (i != 0u && ids[i] <= ids[i - 1u]) cadt_min_relaxed(first, i);
  }
}

/* Words of ids: out[i] is that of ids[order[i]], or of ids[i] without an order, from bit `shift` on. */
CADT_KERNEL(cadt_id_words, CADT_GLOBAL const cadt_u64* ids, CADT_GLOBAL const cadt_u32* order, cadt_u32 shift,
            CADT_GLOBAL cadt_u32* out, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(i, count, grain) { out[i] = CADT_CAST(cadt_u32, ids[order ? order[i] : i] >> shift); }
}

/* open_ids[rank] = ids[v] for open vertices. */
CADT_KERNEL(cadt_gather_ids, CADT_GLOBAL const cadt_u64* ids, CADT_GLOBAL const cadt_u32* vertices,
            CADT_GLOBAL cadt_u64* out, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(i, count, grain) { out[i] = ids[vertices[i]]; }
}

#endif
