/* SPDX-License-Identifier: Apache-2.0
 *
 * The verifier on the device: kernels over a finished mesh (mesh_view.dev.h: vertices are indices of the input,
 * triangles stand across), independent of the builder. `points`: the coordinates of the input. The driver
 * (common/verify/device/verify_on_device.cpp) draws the conclusions.
 *
 * Signs are found in three stages. cadt_verify_filter tests all triangles and edges and lists those that it cannot
 * decide; cadt_verify_exact decides what it can of the lists and leaves the rest in them; cadt_verify_gather packs the
 * rest for the host. Each work-item has a list of its own, so no slot is allocated by atomics and no list can overflow.
 */
#ifndef CADT_VERIFY_DEVICE_VERIFY_H
#define CADT_VERIFY_DEVICE_VERIFY_H

#include "common/mesh/mesh_view.dev.h"
#include "common/portable/atomics.dev.h"
#include "common/verify/device/verify_layout.dev.h"
#include "common/verify/device/verify_predicates.dev.h"

/* Outcome of a check: how many elements were examined, how many failed, and the lowest that failed. */
typedef struct {
  cadt_u32 examined, failures, first;
} cadt_finding;

/* Where the list of a work-item has entry j. */
#if CADT_CONTIGUOUS
#define CADT_LIST_AT(j, items, capacity) (CADT_CAST(cadt_u64, cadt_item) * (capacity) + (j))
#else
#define CADT_LIST_AT(j, items, capacity) (CADT_CAST(cadt_u64, (j)) * (items) + cadt_item)
#endif

CADT_FN cadt_finding cadt_no_finding(void) {
  const cadt_finding none = {0u, 0u, CADT_NONE};
  return none;
}
CADT_FN void cadt_finding_fail(cadt_finding* finding, cadt_u32 where) {
  finding->failures++;
  finding->first = cadt_min_u32(finding->first, where);
}
CADT_FN CADT_GLOBAL cadt_u32* cadt_found_row(CADT_GLOBAL cadt_u32* results, cadt_u32 item) {
  return results + (item % CADT_FOUND_ROWS) * CADT_FOUND_WORDS;
}
CADT_FN void cadt_found_count(CADT_GLOBAL cadt_u32* word, cadt_u32 count) {
  if (count) cadt_add_relaxed(word, count);
}
CADT_FN void cadt_finding_flush(const cadt_finding* finding, CADT_GLOBAL cadt_u32* words) {
  cadt_found_count(words, finding->examined);
  cadt_found_count(words + 1, finding->failures);
  if (finding->failures) cadt_min_relaxed(words + 2, finding->first);
}

/* ---- structure ---------------------------------------------------------------------------------------------------
 */

/* Whether edge k of triangle t, from `from` to `to`, is an edge of triangle s from `to` to `from`, t is the neighbour
 * of s there, and both or neither say that the edge is constrained. \pre s is a triangle. The vertices of a triangle
 * differ, so at most one of its edges is this one reversed. */
CADT_FN cadt_u32 cadt_is_mutual(const cadt_mesh_view* mesh, cadt_u32 t, cadt_u32 k, cadt_u32 s, cadt_u32 from,
                                cadt_u32 to) {
  const cadt_u32 v0 = mesh->vertices[3u * s], v1 = mesh->vertices[3u * s + 1u], v2 = mesh->vertices[3u * s + 2u];
  const cadt_u32 j = v1 == to && v2 == from ? 0u : (v2 == to && v0 == from ? 1u : (v0 == to && v1 == from ? 2u : 3u));
  return s != t && j != 3u && mesh->across[3u * s + j] == t &&
                 cadt_is_constrained(mesh, s, j) == cadt_is_constrained(mesh, t, k)
             ? 1u
             : 0u;
}

/* Checks index ranges, distinct vertices and symmetry of neighbours; marks the vertices in `used`. \pre used is zero */
CADT_KERNEL(cadt_verify_structure, CADT_MESH_VIEW_PARAMETERS, cadt_u32 number_of_points, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* used, CADT_GLOBAL cadt_u32* results) {
  CADT_MESH_VIEW(mesh);
  cadt_finding range = cadt_no_finding(), mutual = cadt_no_finding();
  cadt_u32 boundary = 0u;
  CADT_FOR(t, mesh.triangles, grain) {
    cadt_u32 good = 1u;
    ++range.examined;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 v = mesh.vertices[3u * t + k], from = mesh.vertices[3u * t + CADT_NEXT(k)];
      const cadt_u32 s = mesh.across[3u * t + k];
      if (v < number_of_points && v != from) {
        if (cadt_load_relaxed(used + v) == 0u) cadt_store_relaxed(used + v, 1u);
      } else {
        good = 0u;
      }
      ++mutual.examined;
      if (s == CADT_NONE) {
        ++boundary;
      } else if (s >= mesh.triangles) {
        good = 0u;
      } else if (!cadt_is_mutual(&mesh, t, k, s, from, mesh.vertices[3u * t + CADT_PREV(k)])) {
        cadt_finding_fail(&mutual, 3u * t + k);
      }
    }
    if (!good) cadt_finding_fail(&range, t);
  }
  CADT_GLOBAL cadt_u32* row = cadt_found_row(results, cadt_item);
  cadt_finding_flush(&range, row + CADT_FOUND_RANGE);
  cadt_finding_flush(&mutual, row + CADT_FOUND_NEIGHBORS);
  cadt_found_count(row + CADT_FOUND_BOUNDARY, boundary);
}

CADT_FN cadt_u32 cadt_is_finite(double x) { return ((cadt_bits_of_double(x) >> 52) & 0x7FFul) != 0x7FFul ? 1u : 0u; }

/* Counts the points that are vertices, and looks for coordinates that are not finite. */
CADT_KERNEL(cadt_verify_points, CADT_GLOBAL const cadt_point* points, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* used, CADT_GLOBAL cadt_u32* results) {
  cadt_finding finite = cadt_no_finding();
  cadt_u32 vertices = 0u;
  CADT_FOR(i, count, grain) {
    const cadt_point p = points[i];
    ++finite.examined;
    if (!cadt_is_finite(p.x) || !cadt_is_finite(p.y)) cadt_finding_fail(&finite, i);
    vertices += used[i];
  }
  CADT_GLOBAL cadt_u32* row = cadt_found_row(results, cadt_item);
  cadt_finding_flush(&finite, row + CADT_FOUND_POINTS);
  cadt_found_count(row + CADT_FOUND_USED, vertices);
}

/* pairs: (point, representative), which must ascend; the point must be no vertex, the representative a vertex with a
 * lower index and equal coordinates. */
CADT_KERNEL(cadt_verify_duplicates, CADT_GLOBAL const cadt_point* points, cadt_u32 number_of_points,
            CADT_GLOBAL const cadt_u32* used, CADT_GLOBAL const cadt_u32* pairs, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* results) {
  cadt_finding finding = cadt_no_finding();
  CADT_FOR(i, count, grain) {
    const cadt_u32 p = pairs[2u * i], r = pairs[2u * i + 1u];
    const cadt_i32 before = i == 0u ? -1 : CADT_CAST(cadt_i32, pairs[2u * i - 2u]); /* may itself be negative */
    ++finding.examined;
    cadt_u32 good = p < number_of_points && r < p && before < CADT_CAST(cadt_i32, p) ? 1u : 0u;
    if (good) {
      const cadt_point a = points[p], b = points[r];
      good = a.x == b.x && a.y == b.y && used[p] == 0u && used[r] != 0u ? 1u : 0u;
    }
    if (!good) cadt_finding_fail(&finding, i);
  }
  cadt_finding_flush(&finding, cadt_found_row(results, cadt_item) + CADT_FOUND_DUPLICATES);
}

/* Lists the edges without a neighbour, in any order: 3 * triangle + k, from, to; and the point `from`. */
CADT_KERNEL(cadt_verify_boundary, CADT_MESH_VIEW_PARAMETERS, cadt_u32 grain, CADT_GLOBAL cadt_u32* edges,
            CADT_GLOBAL cadt_point* corners, CADT_GLOBAL cadt_u32* written, cadt_u32 capacity) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      if (mesh.across[3u * t + k] != CADT_NONE) continue;
      const cadt_u32 at = cadt_add_relaxed(written, 1u), from = mesh.vertices[3u * t + CADT_NEXT(k)];
      if (at >= capacity) continue;
      edges[3u * at] = 3u * t + k;
      edges[3u * at + 1u] = from;
      edges[3u * at + 2u] = mesh.vertices[3u * t + CADT_PREV(k)];
      corners[at] = mesh.points[from];
    }
  }
}

/* ---- geometry ----------------------------------------------------------------------------------------------------
 */

/* The vertex of triangle s that is neither end of an edge. */
CADT_FN cadt_u32 cadt_across(const cadt_mesh_view* mesh, cadt_u32 s, cadt_u32 from, cadt_u32 to) {
  const cadt_u32 v0 = mesh->vertices[3u * s], v1 = mesh->vertices[3u * s + 1u];
  if (v0 != from && v0 != to) return v0;
  return v1 != from && v1 != to ? v1 : mesh->vertices[3u * s + 2u];
}

/* Orientation of triangles begin to begin + count - 1 and, if `with_edges`, legality of the edges between each of them
 * and a higher one. Undecided signs go to the work-item's list. \pre indices are in range */
CADT_KERNEL(cadt_verify_filter, CADT_MESH_VIEW_PARAMETERS, cadt_u32 begin, cadt_u32 count, cadt_u32 with_edges,
            cadt_u32 grain, cadt_u32 items, CADT_GLOBAL cadt_u32* lists, CADT_GLOBAL cadt_u32* sizes, cadt_u32 capacity,
            CADT_GLOBAL cadt_u32* results) {
  CADT_MESH_VIEW(mesh);
  if (cadt_item >= items) return; /* the launch may start others, which have no list */
  cadt_finding turn = cadt_no_finding(), edge = cadt_no_finding();
  cadt_u32 open = 0u;
  CADT_FOR_PART(r, cadt_item, items, count, grain) {
    const cadt_u32 t = begin + r;
    const cadt_u32 v0 = mesh.vertices[3u * t], v1 = mesh.vertices[3u * t + 1u], v2 = mesh.vertices[3u * t + 2u];
    const cadt_point p0 = mesh.points[v0], p1 = mesh.points[v1], p2 = mesh.points[v2];
    const cadt_i32 side = cadt_verify_turn_filter(p0, p1, p2);
    ++turn.examined;
    if (side < 0) cadt_finding_fail(&turn, t);
    if (side == CADT_UNKNOWN)
      lists[CADT_LIST_AT(open++, items, capacity)] = CADT_OPEN_A_TRIANGLE * r + CADT_OPEN_ORIENTATION;
    for (cadt_u32 k = 0u; with_edges && k < 3u; ++k) {
      const cadt_u32 s = mesh.across[3u * t + k];
      if (s == CADT_NONE || s < t) continue; /* the lower triangle of the two examines the edge */
      const cadt_point d = mesh.points[cadt_across(&mesh, s, CADT_PICK(k, v1, v2, v0), CADT_PICK(k, v2, v0, v1))];
      const cadt_i32 legal =
          cadt_verify_edge_filter(CADT_PICK(k, p0, p1, p2), CADT_PICK(k, p1, p2, p0), CADT_PICK(k, p2, p0, p1), d);
      ++edge.examined;
      if (cadt_is_constrained(&mesh, t, k)) continue; /* need not be legal */
      if (legal < 0) cadt_finding_fail(&edge, 3u * t + k);
      if (legal == CADT_UNKNOWN) lists[CADT_LIST_AT(open++, items, capacity)] = CADT_OPEN_A_TRIANGLE * r + k;
    }
  }
  sizes[cadt_item] = open;
  CADT_GLOBAL cadt_u32* row = cadt_found_row(results, cadt_item);
  cadt_finding_flush(&turn, row + CADT_FOUND_ORIENTATION);
  cadt_finding_flush(&edge, row + CADT_FOUND_EDGES);
  cadt_found_count(row + CADT_FOUND_OPEN, open);
}

/* Decides the entries of the lists whose coordinate differences are exact; the others stay. left: how many stay. */
CADT_KERNEL(cadt_verify_exact, CADT_MESH_VIEW_PARAMETERS, cadt_u32 begin, cadt_u32 items, CADT_GLOBAL cadt_u32* lists,
            CADT_GLOBAL cadt_u32* sizes, cadt_u32 capacity, CADT_GLOBAL cadt_u32* left, CADT_GLOBAL cadt_u32* results) {
  CADT_MESH_VIEW(mesh);
  if (cadt_item >= items) return;
  cadt_finding turn = cadt_no_finding(), edge = cadt_no_finding(), tie = cadt_no_finding();
  const cadt_u32 open = sizes[cadt_item];
  cadt_u32 kept = 0u;
  for (cadt_u32 i = 0u; i < open; ++i) {
    const cadt_u32 entry = lists[CADT_LIST_AT(i, items, capacity)];
    const cadt_u32 t = begin + entry / CADT_OPEN_A_TRIANGLE, k = entry % CADT_OPEN_A_TRIANGLE;
    const cadt_u32 first = k == CADT_OPEN_ORIENTATION ? 0u : k; /* the vertex to begin with */
    const cadt_u32 from = mesh.vertices[3u * t + CADT_NEXT(first)], to = mesh.vertices[3u * t + CADT_PREV(first)];
    const cadt_point a = mesh.points[mesh.vertices[3u * t + first]], b = mesh.points[from], c = mesh.points[to];
    cadt_i32 sign;
    if (k == CADT_OPEN_ORIENTATION) {
      sign = cadt_verify_turn_exact(a, b, c);
      if (sign <= 0) cadt_finding_fail(&turn, t);
    } else {
      const cadt_point d = mesh.points[cadt_across(&mesh, mesh.across[3u * t + k], from, to)];
      sign = cadt_verify_edge_exact(a, b, c, d);
      if (sign < 0) cadt_finding_fail(&edge, 3u * t + k);
      if (sign == 0) {
        ++tie.examined;
        if (!cadt_verify_tie_is_usual(a, b, c, d)) cadt_finding_fail(&tie, 3u * t + k);
      }
    }
    if (sign == CADT_UNKNOWN) lists[CADT_LIST_AT(kept++, items, capacity)] = entry;
  }
  sizes[cadt_item] = kept;
  cadt_found_count(left, kept);
  CADT_GLOBAL cadt_u32* row = cadt_found_row(results, cadt_item);
  cadt_finding_flush(&turn, row + CADT_FOUND_ORIENTATION);
  cadt_finding_flush(&edge, row + CADT_FOUND_EDGES);
  cadt_finding_flush(&tie, row + CADT_FOUND_TIES);
  cadt_found_count(row + CADT_FOUND_EXACT, open - kept);
}

/* Packs entries from_number to to_number - 1 of all lists: the entry, and the points a, b, c, d of its edge (a, b, c, a
 * for a triangle). \pre offsets: the scanned sizes, with the total behind the last */
CADT_KERNEL(cadt_verify_gather, CADT_MESH_VIEW_PARAMETERS, cadt_u32 begin, cadt_u32 items,
            CADT_GLOBAL const cadt_u32* lists, CADT_GLOBAL const cadt_u32* offsets, cadt_u32 capacity,
            cadt_u32 from_number, cadt_u32 to_number, CADT_GLOBAL cadt_u32* entries, CADT_GLOBAL cadt_point* corners) {
  CADT_MESH_VIEW(mesh);
  if (cadt_item >= items) return;
  const cadt_u32 first_number = offsets[cadt_item], end_number = offsets[cadt_item + 1u];
  for (cadt_u32 number = first_number; number < end_number; ++number) {
    if (number < from_number || number >= to_number) continue;
    const cadt_u32 entry = lists[CADT_LIST_AT(number - first_number, items, capacity)];
    const cadt_u32 t = begin + entry / CADT_OPEN_A_TRIANGLE, k = entry % CADT_OPEN_A_TRIANGLE;
    const cadt_u32 first = k == CADT_OPEN_ORIENTATION ? 0u : k;
    const cadt_u32 a = mesh.vertices[3u * t + first];
    const cadt_u32 from = mesh.vertices[3u * t + CADT_NEXT(first)], to = mesh.vertices[3u * t + CADT_PREV(first)];
    const cadt_u32 d = k == CADT_OPEN_ORIENTATION ? a : cadt_across(&mesh, mesh.across[3u * t + k], from, to);
    const cadt_u32 at = number - from_number;
    entries[at] = entry;
    corners[4u * at] = mesh.points[a];
    corners[4u * at + 1u] = mesh.points[from];
    corners[4u * at + 2u] = mesh.points[to];
    corners[4u * at + 3u] = mesh.points[d];
  }
}

#endif
