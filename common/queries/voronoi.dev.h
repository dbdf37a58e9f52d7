/* SPDX-License-Identifier: Apache-2.0
 *
 * The Voronoi diagram, dual to the mesh: a vertex for each triangle (its circumcentre), a cell for each vertex (the
 * triangles around it), and an edge for each edge; and what circumcircles tell: holes between the points.
 */
#ifndef CADT_QUERIES_VORONOI_H
#define CADT_QUERIES_VORONOI_H

#include "common/queries/natural_neighbor.dev.h"

typedef struct {
  cadt_real x, y, radius, inside; /* inside: 1 if the centre is in the triangle, or within rounding of it; else 0 */
} cadt_circle;

CADT_FN cadt_real cadt_length(cadt_point d) {
#if CADT_WIDE
  const cadt_i32 e = cadt_exponent_of_largest(d.x, d.y, 0.0, 0.0);
  if (e == CADT_OVERFLOWED) return CADT_INFINITY;
  d.x = cadt_ldexp(d.x, -e);
  d.y = cadt_ldexp(d.y, -e);
  return cadt_ldexp(cadt_sqrt(cadt_dot(d, d)), e);
#else
  return cadt_sqrt(cadt_dot(d, d));
#endif
}

/* The circumcircle of triangle t, in the caller's units; infinite if rounding leaves the triangle no area. */
CADT_FN cadt_circle cadt_circumcircle(const cadt_query_mesh* m, cadt_u32 t) {
  const cadt_center center = cadt_center_of_triangle(m, t);
  cadt_circle circle = {(center.corner.x + center.arm.x) / m->scale / m->scale_again,
                        (center.corner.y + center.arm.y) / m->scale / m->scale_again,
                        cadt_length(center.arm) / m->scale / m->scale_again, center.inside ? 1.0 : 0.0};
  if (circle.x != circle.x || circle.y != circle.y) circle.x = circle.y = circle.radius = CADT_INFINITY;
  return circle;
}

CADT_KERNEL(cadt_circumcenters, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL cadt_point* centers, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_FOR(t, mesh.view.triangles, grain) {
    const cadt_circle circle = cadt_circumcircle(&mesh, t);
    centers[t].x = circle.x;
    centers[t].y = circle.y;
  }
}

/* The number of triangles of each vertex. sizes[count] is 0. */
CADT_KERNEL(cadt_cell_sizes, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL cadt_u32* sizes, cadt_u32 grain) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    for (cadt_u32 k = 0u; k < 3u; ++k) cadt_add_relaxed(sizes + cadt_vertex_of(&mesh, t, k), 1u);
  }
}

/* The triangles around each point, counterclockwise: from the lowest on, and around a
 * hull vertex from hull edge to hull edge. `begin`: the sizes, scanned. */
CADT_KERNEL(cadt_cell_triangles, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* lowest,
            CADT_GLOBAL const cadt_u32* begin, CADT_GLOBAL cadt_u32* cells, cadt_u32 count, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_FOR(v, count, grain) {
    const cadt_u32 size = begin[v + 1u] - begin[v], t = lowest[v];
    if (size == 0u) continue;
    cadt_spoke s = {t, cadt_index_in(&mesh, t, v)};
    cadt_u32 placed = 0u;
    for (; placed < size; ++placed) {
      cells[begin[v] + placed] = s.triangle;
      const cadt_spoke next = cadt_turn(&mesh, s, 0u);
      if (next.triangle == CADT_NONE) break;
      s = next;
    }
    if (placed == size) continue; /* all around */
    /* A hull vertex: from the other hull edge on. */
    const cadt_spoke from = {t, cadt_index_in(&mesh, t, v)};
    s = cadt_first_spoke(&mesh, from);
    for (placed = 0u; placed < size && s.triangle != CADT_NONE; ++placed) {
      cells[begin[v] + placed] = s.triangle;
      s = cadt_turn(&mesh, s, 0u);
    }
  }
}

/* Whether edge k is listed with triangle t: each edge is, with the lower of its two triangles. */
CADT_FN cadt_u32 cadt_lists_edge(const cadt_mesh_view* m, cadt_u32 t, cadt_u32 k) {
  const cadt_u32 n = cadt_neighbor_of(m, t, k);
  return n == CADT_NONE || n > t ? 1u : 0u;
}
/* The number of edges listed with each triangle. sizes[count] is 0. */
CADT_KERNEL(cadt_edge_counts, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL cadt_u32* sizes, cadt_u32 grain) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    sizes[t] = cadt_lists_edge(&mesh, t, 0u) + cadt_lists_edge(&mesh, t, 1u) + cadt_lists_edge(&mesh, t, 2u);
    if (t == 0u) sizes[mesh.triangles] = 0u;
  }
}
/* Both vertices of each edge, and both triangles; CADT_NONE outside. Null arrays are left out. The first triangle is on
 * the left of the edge from the first vertex to the second. */
CADT_KERNEL(cadt_list_edges, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* begin, CADT_GLOBAL cadt_u32* ends,
            CADT_GLOBAL cadt_u32* sides, cadt_u32 grain) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    cadt_u32 at = begin[t];
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      if (!cadt_lists_edge(&mesh, t, k)) continue;
      if (ends) {
        ends[2u * at] = cadt_vertex_of(&mesh, t, CADT_NEXT(k));
        ends[2u * at + 1u] = cadt_vertex_of(&mesh, t, CADT_PREV(k));
      }
      if (sides) {
        sides[2u * at] = t;
        sides[2u * at + 1u] = cadt_neighbor_of(&mesh, t, k);
      }
      ++at;
    }
  }
}

/* ---- cells within a box ---- */

/* Cuts the convex polygon in row[0] to row[size - 1] (counterclockwise, seen from a generator) to the points nearer to
 * the generator than to its neighbour at `arm`. Returns its new size. In place: two points are read ahead of what is
 * written.
 */
CADT_FN cadt_u32 cadt_cut_cell(CADT_GLOBAL cadt_point* row, cadt_u32 size, cadt_point arm) {
#if CADT_WIDE
  const cadt_i32 e = cadt_exponent_of_largest(arm.x, arm.y, 0.0, 0.0);
  arm.x = cadt_ldexp(arm.x, -e);
  arm.y = cadt_ldexp(arm.y, -e);
  const cadt_real limit = cadt_ldexp(0.5 * cadt_dot(arm, arm), e);
#else
  const cadt_real limit = 0.5 * cadt_dot(arm, arm);
#endif
  cadt_u32 written = 0u, entered = 0u;
  if (size == 0u) return 0u;
  cadt_point before = row[size - 1u], at = row[0];
  const cadt_point first = at;
  cadt_real side_before = before.x * arm.x + before.y * arm.y - limit;
  for (cadt_u32 i = 0u; i < size; ++i) {
    const cadt_point next = i + 1u < size ? row[i + 1u] : first;
    const cadt_real side = at.x * arm.x + at.y * arm.y - limit;
    /* A convex polygon comes back once; if rounding says otherwise, the others are within it of each other. */
    if (side <= 0.0 ? side_before > 0.0 && !entered : side_before <= 0.0) {
      if (side <= 0.0) entered = 1u;
      const cadt_real along = side_before / (side_before - side);
      row[written].x = before.x + along * (at.x - before.x);
      row[written].y = before.y + along * (at.y - before.y);
      ++written;
    }
    if (side <= 0.0) row[written++] = at;
    before = at;
    side_before = side;
    at = next;
  }
  return written;
}

/* The cell of each vertex within the box (scaled like the points), in a row of its triangles + 5 points from
 * begin[v] + 5 v on; `sizes`: the points of each, and sizes[count] is 0. A point that is no vertex has none. */
CADT_KERNEL(cadt_clip_cells, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* lowest,
            CADT_GLOBAL const cadt_u32* begin, cadt_real min_x, cadt_real min_y, cadt_real max_x, cadt_real max_y,
            CADT_GLOBAL cadt_point* rows, CADT_GLOBAL cadt_u32* sizes, cadt_u32 count, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_FOR(v, count, grain) {
    if (v == 0u) sizes[count] = 0u;
    sizes[v] = 0u;
    const cadt_u32 t = lowest[v];
    if (t == CADT_NONE) continue;
    const cadt_point center = cadt_mesh_point(&mesh, v);
    CADT_GLOBAL cadt_point* row = rows + CADT_CAST(cadt_u64, begin[v]) + 5u * CADT_CAST(cadt_u64, v);
    const cadt_real left = min_x - center.x, right = max_x - center.x, low = min_y - center.y, high = max_y - center.y;
    row[0].x = row[3].x = left;
    row[1].x = row[2].x = right;
    row[0].y = row[1].y = low;
    row[2].y = row[3].y = high;
    cadt_u32 size = 4u, turns = begin[v + 1u] - begin[v];
    cadt_spoke s = {t, cadt_index_in(&mesh, t, v)};
    s = cadt_first_spoke(&mesh, s);
    for (; turns > 0u; --turns) {
      size = cadt_cut_cell(row, size, cadt_seen_from(cadt_corner(&mesh, s.triangle, CADT_NEXT(s.k)), center));
      const cadt_spoke next = cadt_turn(&mesh, s, 0u);
      if (next.triangle == CADT_NONE) {
        size = cadt_cut_cell(row, size, cadt_seen_from(cadt_corner(&mesh, s.triangle, CADT_PREV(s.k)), center));
        break;
      }
      s = next;
    }
    for (cadt_u32 i = 0u; i < size; ++i) {
      row[i].x = (row[i].x + center.x) / mesh.scale / mesh.scale_again;
      row[i].y = (row[i].y + center.y) / mesh.scale / mesh.scale_again;
    }
    sizes[v] = size;
  }
}
/* The rows without gaps. `to`: the sizes, scanned. */
CADT_KERNEL(cadt_pack_cells, CADT_GLOBAL const cadt_point* rows, CADT_GLOBAL const cadt_u32* begin,
            CADT_GLOBAL const cadt_u32* to, CADT_GLOBAL cadt_point* polygons, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(v, count, grain) {
    for (cadt_u32 i = to[v]; i < to[v + 1u]; ++i)
      polygons[i] = rows[CADT_CAST(cadt_u64, begin[v]) + 5u * CADT_CAST(cadt_u64, v) + (i - to[v])];
  }
}

/* ---- circumcircles ---- */

/* Keys that sort circumcircles from large to small; as floats, so equal keys may have radii that differ a little. */
CADT_KERNEL(cadt_radius_keys, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL cadt_u32* keys, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_FOR(t, mesh.view.triangles, grain) {
    const float radius = CADT_CAST(float, cadt_length(cadt_center_of_triangle(&mesh, t).arm));
    keys[t] = radius == radius ? ~cadt_bits_of_float(radius) : CADT_NONE;
  }
}
/* The circumcircles of the listed triangles. */
CADT_KERNEL(cadt_circles_of, CADT_QUERY_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* list,
            CADT_GLOBAL cadt_circle* circles, cadt_u32 count, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_FOR(i, count, grain) { circles[i] = cadt_circumcircle(&mesh, list[i]); }
}

/* 1 for triangles without an edge longer than `max_edge` (scaled) whose circumradius is at most `max_radius` (in the
 * caller's units); flags[count] is 0. */
CADT_KERNEL(cadt_flag_compact, CADT_QUERY_MESH_PARAMETERS, cadt_real max_edge, cadt_real max_radius,
            CADT_GLOBAL cadt_u32* flags, cadt_u32 grain) {
  CADT_QUERY_MESH(mesh);
  CADT_FOR(t, mesh.view.triangles, grain) {
    cadt_u32 kept = cadt_circumcircle(&mesh, t).radius <= max_radius ? 1u : 0u;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      if (cadt_is_longer(cadt_corner(&mesh, t, k), cadt_corner(&mesh, t, CADT_NEXT(k)), max_edge)) kept = 0u;
    }
    flags[t] = kept;
    if (t == 0u) flags[mesh.view.triangles] = 0u;
  }
}
/* The kept triangles; `places`: the flags, scanned. */
CADT_KERNEL(cadt_pack_kept, CADT_GLOBAL const cadt_u32* places, CADT_GLOBAL cadt_u32* kept, cadt_u32 count,
            cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
    if (places[t + 1u] != places[t]) kept[places[t]] = t;
  }
}
/* Whether edge k of triangle t is on the boundary of what is kept. */
CADT_FN cadt_u32 cadt_bounds_kept(const cadt_mesh_view* m, CADT_GLOBAL const cadt_u32* places, cadt_u32 t, cadt_u32 k) {
  const cadt_u32 n = cadt_neighbor_of(m, t, k);
  return places[t + 1u] != places[t] && (n == CADT_NONE || places[n + 1u] == places[n]) ? 1u : 0u;
}
/* How many edges of each triangle are; sizes[count] is 0. */
CADT_KERNEL(cadt_outline_counts, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* places,
            CADT_GLOBAL cadt_u32* sizes, cadt_u32 grain) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    sizes[t] = cadt_bounds_kept(&mesh, places, t, 0u) + cadt_bounds_kept(&mesh, places, t, 1u) +
               cadt_bounds_kept(&mesh, places, t, 2u);
    if (t == 0u) sizes[mesh.triangles] = 0u;
  }
}
/* They themselves, with what is kept on their left. `begin`: the counts, scanned. */
CADT_KERNEL(cadt_outline_edges, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* places,
            CADT_GLOBAL const cadt_u32* begin, CADT_GLOBAL cadt_u32* edges, cadt_u32 grain) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    cadt_u32 at = begin[t];
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      if (!cadt_bounds_kept(&mesh, places, t, k)) continue;
      edges[2u * at] = cadt_vertex_of(&mesh, t, CADT_NEXT(k));
      edges[2u * at + 1u] = cadt_vertex_of(&mesh, t, CADT_PREV(k));
      ++at;
    }
  }
}

#endif
