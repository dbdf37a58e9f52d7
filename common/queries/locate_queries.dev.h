/* SPDX-License-Identifier: Apache-2.0
 *
 * Point location in a finished mesh. The vertices are sorted along Hilbert's curve, and so are the queries. A query
 * finds its place among the vertices by binary search; from a triangle of that vertex, which is near, it walks:
 *
 *   vertices along the curve   ...  v7   v2   v9   v4  ...       keys ascend; each has its lowest triangle
 *                                        ^
 *   a query's key               found by search; walk from the lowest triangle of v2
 *
 * Neighbouring queries walk through the same triangles at about the same time, so caches hold them.
 */
#ifndef CADT_QUERIES_LOCATE_QUERIES_H
#define CADT_QUERIES_LOCATE_QUERIES_H

#include "common/points/hilbert_keys.dev.h"
#include "common/portable/atomics.dev.h"
#include "common/queries/query_mesh.dev.h"

/* Whether the arrays are a mesh: indices in range, and each edge the same from both sides. `first`: the first triangle
 * for which that is not so. */
CADT_KERNEL(cadt_check_mesh, CADT_MESH_VIEW_PARAMETERS, cadt_u32 point_count, CADT_GLOBAL cadt_u32* first,
            cadt_u32 grain) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    cadt_u32 good = 1u;
    for (cadt_u32 k = 0u; k < 3u; ++k)
      if (cadt_vertex_of(&mesh, t, k) >= point_count ||
          cadt_vertex_of(&mesh, t, k) == cadt_vertex_of(&mesh, t, CADT_NEXT(k)))
        good = 0u;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 n = mesh.across[3u * t + k];
      if (n == CADT_NONE) continue;
      if (n >= mesh.triangles || n == t) {
        good = 0u;
        continue;
      }
      cadt_u32 same = 0u;
      for (cadt_u32 j = 0u; j < 3u; ++j)
        if (mesh.across[3u * n + j] == t &&
            cadt_vertex_of(&mesh, n, CADT_NEXT(j)) == cadt_vertex_of(&mesh, t, CADT_PREV(k)) &&
            cadt_vertex_of(&mesh, n, CADT_PREV(j)) == cadt_vertex_of(&mesh, t, CADT_NEXT(k)))
          ++same;
      if (same != 1u) good = 0u;
    }
    if (!good) cadt_min_relaxed(first, t);
  }
}

/* lowest[v]: the lowest triangle of vertex v. It begins as CADT_NONE. */
CADT_KERNEL(cadt_lowest_triangles, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL cadt_u32* lowest, cadt_u32 count,
            cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 v = vertices[3u * t + k];
      if (cadt_load_relaxed(lowest + v) > t) cadt_min_relaxed(lowest + v, t);
    }
  }
}

/* Of the points along the curve, those that are vertices: duplicates are not. flags[count] is 0. */
CADT_KERNEL(cadt_curve_flags, CADT_GLOBAL const cadt_u32* order, CADT_GLOBAL const cadt_u32* lowest,
            CADT_GLOBAL cadt_u32* flags, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(i, count, grain) {
    flags[i] = lowest[order[i]] != CADT_NONE ? 1u : 0u;
    if (i == 0u) flags[count] = 0u;
  }
}
/* The lowest triangle and the key of each, in order; `places`: the flags, scanned. Null `low`: keys of one word.
 */
CADT_KERNEL(cadt_curve_pack, CADT_GLOBAL const cadt_u32* order, CADT_GLOBAL const cadt_u32* lowest,
            CADT_GLOBAL const cadt_u32* places, CADT_GLOBAL const cadt_u32* high, CADT_GLOBAL const cadt_u32* low,
            CADT_GLOBAL cadt_u32* start, CADT_GLOBAL cadt_u32* curve_high, CADT_GLOBAL cadt_u32* curve_low,
            cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 place = places[i];
    if (places[i + 1u] == place) continue;
    start[place] = lowest[order[i]];
    curve_high[place] = high[i];
    if (low) curve_low[place] = low[i];
  }
}

/* The vertices along the curve: their keys, and the lowest triangle of each. */
#define CADT_CURVE_PARAMETERS                                                                                       \
  CADT_GLOBAL const cadt_u32 *curve_high, CADT_GLOBAL const cadt_u32 *curve_low, CADT_GLOBAL const cadt_u32 *start, \
      cadt_u32 curve_size, cadt_u32 low_bits

/* The first place at or behind `from` with a key of at least `key`, or the last one. Steps double: the next query is
 * near the one before. */
CADT_FN cadt_u32 cadt_place_on_curve(const cadt_keys* curve, cadt_u32 size, cadt_u32 from, cadt_u64 key) {
  cadt_u32 low = from, step = 1u;
  while (low + step < size && cadt_key_at(curve, low + step) < key) {
    low += step;
    step *= 2u;
  }
  cadt_u32 high = cadt_min_u32(low + step, size - 1u);
  CADT_FIND_FIRST(low, high, middle, cadt_key_at(curve, middle) < key)
  return low;
}

/* What is known of query q when its walk has ended. Null arrays are left out. */
CADT_FN void cadt_write_place(const cadt_query_mesh* m, CADT_GLOBAL const cadt_u32* lowest, const cadt_query_place* at,
                              cadt_u32 q, CADT_GLOBAL cadt_u32* located, CADT_GLOBAL cadt_u32* reached,
                              CADT_GLOBAL cadt_u32* lost) {
  if (at->edge == CADT_LOST_WALK) cadt_add_relaxed(lost, 1u);
  if (located) located[q] = cadt_lowest_at(m, lowest, at);
  if (reached) reached[q] = 4u * at->triangle + (at->edge == CADT_NONE ? 3u : at->edge);
}

#if CADT_CONTIGUOUS
/* A processor takes so many walks at a time, a step of each in turn, and has fetched what one needs while it was busy
 * with the others: 1M queries in 1M points take half of the time. (A GPU has other threads for that.) */
enum { CADT_WALKS = 16 };
CADT_FN void cadt_fetch_triangle(const cadt_query_mesh* m, cadt_u32 t) {
  cadt_prefetch_to_read(m->view.vertices + 3u * t);
  cadt_prefetch_to_read(m->view.across + 3u * t);
}
CADT_FN void cadt_fetch_corners(const cadt_query_mesh* m, cadt_u32 t) {
  for (cadt_u32 k = 0u; k < 3u; ++k) cadt_prefetch_to_read(m->view.points + cadt_vertex_of(&m->view, t, k));
}
#endif

/* Query i of `order` (null: i): where it lies. `located`: the lowest triangle, CADT_NONE outside; `reached`: where the
 * walk ended, 4 * triangle + 3, or + the hull edge beyond which the query lies. `lost`: how many walks did not end. */
CADT_KERNEL(cadt_locate_queries, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* lowest, CADT_CURVE_PARAMETERS,
            CADT_GLOBAL const cadt_point* queries, CADT_GLOBAL const cadt_u32* keys_high,
            CADT_GLOBAL const cadt_u32* keys_low, CADT_GLOBAL const cadt_u32* order, CADT_GLOBAL cadt_u32* located,
            CADT_GLOBAL cadt_u32* reached, CADT_GLOBAL cadt_u32* lost, cadt_u32 count, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  const cadt_keys curve = cadt_keys_of(curve_high, curve_low, low_bits),
                  keys = cadt_keys_of(keys_high, keys_low, low_bits);
  cadt_u32 place = 0u;
#if CADT_CONTIGUOUS
  cadt_walker walkers[CADT_WALKS];
  cadt_point places[CADT_WALKS];
  cadt_u32 ids[CADT_WALKS];
  const cadt_u32 end = cadt_min_u32(cadt_begin_of(cadt_item, grain, count) + grain, count);
  for (cadt_u32 i = cadt_begin_of(cadt_item, grain, count); i < end;) {
    cadt_u32 walking = cadt_min_u32(CADT_CAST(cadt_u32, CADT_WALKS), end - i);
    for (cadt_u32 w = 0u; w < walking; ++w) {
      cadt_prefetch_to_read(queries + order[i + w]);
      place = cadt_place_on_curve(&curve, curve_size, place, cadt_key_at(&keys, i + w));
      walkers[w] = cadt_walker_from(start[place]);
      cadt_fetch_triangle(&mesh, start[place]);
    }
    for (cadt_u32 w = 0u; w < walking; ++w) {
      ids[w] = order[i + w];
      places[w] = cadt_scaled_point(&mesh, queries + ids[w]);
      cadt_fetch_corners(&mesh, walkers[w].triangle);
    }
    i += walking;
    while (walking > 0u) {
      for (cadt_u32 w = 0u; w < walking;) {
        cadt_query_place at;
        if (cadt_step(&mesh, places[w], &walkers[w], &at)) {
          cadt_fetch_triangle(&mesh, walkers[w].triangle);
          ++w;
          continue;
        }
        cadt_write_place(&mesh, lowest, &at, ids[w], located, reached, lost);
        --walking; /* the last one takes its place */
        walkers[w] = walkers[walking];
        places[w] = places[walking];
        ids[w] = ids[walking];
      }
      for (cadt_u32 w = 0u; w < walking; ++w) cadt_fetch_corners(&mesh, walkers[w].triangle);
    }
  }
#else
  CADT_FOR(i, count, grain) {
    const cadt_u32 q = order[i];
    place = cadt_place_on_curve(&curve, curve_size, place, cadt_key_at(&keys, i));
    const cadt_query_place at = cadt_walk(&mesh, cadt_scaled_point(&mesh, queries + q), start[place]);
    cadt_write_place(&mesh, lowest, &at, q, located, reached, lost);
  }
#endif
}

#endif
