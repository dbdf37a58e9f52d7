/* SPDX-License-Identifier: Apache-2.0
 *
 * Certification of a mesh in arrays (mesh_view.dev.h): examines every edge and repairs nothing. The mesh of insertion
 * is certified by its last legality sweep, the one that found nothing to repair
 * (common/insertion/legality_sweep.dev.h).
 */
#ifndef CADT_CERTIFY_CERTIFY_H
#define CADT_CERTIFY_CERTIFY_H

#include "common/insertion/legality_sweep.dev.h"
#include "common/mesh/mesh_view.dev.h"

#if CADT_BUILDS(CERTIFY)
/* Examines the edges of `count` triangles from `begin` on, each edge once, from the triangle that comes first. Adds to
 *
 *   words[row]        edges examined
 *   words[row + 1]    illegal edges that are not constrained
 *   words[row + 2]    edges whose sides do not fit together, ghost triangles among the others, and, where edges are
 *                     constrained, triangles that are not counterclockwise: legal edges alone do not rule them out
 *   words[row + 3]    edges to the ghost at which the boundary turns back
 *
 * If `triangle_count` is CADT_NONE, the number of triangles without a ghost is words[row + CADT_CERTIFY_REAL]; 0: there
 * is no mesh. If `counted`, the rows behind are counters of work. */
CADT_KERNEL(cadt_certify, CADT_MESH_VIEW_PARAMETERS, cadt_u32 begin, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* words, cadt_u32 row, cadt_u32 counted) {
  CADT_GROUP_COUNTERS(counters, counted);
  CADT_MESH_VIEW(mesh);
  CADT_GLOBAL cadt_u32* found = words + row;
  const cadt_u32 real = mesh.triangles != CADT_NONE ? mesh.triangles : found[CADT_CERTIFY_REAL];
  if (!real) return;
  cadt_locked_mesh locked; /* the predicates read only its points */
  locked.points = mesh.points;
  cadt_u32 examined = 0u, illegal = 0u, wrong = 0u, broken = 0u;
  CADT_FOR(i, count, grain) {
    const cadt_u32 t = begin + i;
    cadt_u32 v[3], half_edge[3];
    for (cadt_u32 k = 0u; k < 3u; ++k) v[k] = cadt_vertex_of(&mesh, t, k);
    for (cadt_u32 k = 0u; k < 3u; ++k) half_edge[k] = mesh.across[3u * t + k];
    const cadt_u32 ghost = v[0] == CADT_GHOST || v[1] == CADT_GHOST || v[2] == CADT_GHOST ? 1u : 0u;
    if (ghost != (t >= real ? 1u : 0u)) ++wrong;
    if (mesh.edge_flags && !ghost &&
        cadt_orientation(cadt_point_of(&locked, v[0]), cadt_point_of(&locked, v[1]), cadt_point_of(&locked, v[2]),
                         &counters) <= 0)
      ++wrong;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 u = CADT_TRIANGLE_OF(half_edge[k]), j = CADT_EDGE_OF(half_edge[k]);
      if (u < t) continue; /* examined from the other side */
      ++examined;
      if (u >= mesh.all || j > 2u || mesh.across[3u * u + j] != CADT_HALF_EDGE(t, k)) {
        ++wrong;
        continue;
      }
      const cadt_u32 p = CADT_PICK(k, v[0], v[1], v[2]), a = CADT_PICK(k, v[1], v[2], v[0]),
                     b = CADT_PICK(k, v[2], v[0], v[1]), q = cadt_vertex_of(&mesh, u, j);
      const cadt_u32 constrained = cadt_is_constrained(&mesh, t, k);
      if (cadt_vertex_of(&mesh, u, CADT_NEXT(j)) != b || cadt_vertex_of(&mesh, u, CADT_PREV(j)) != a ||
          constrained != cadt_is_constrained(&mesh, u, j))
        ++wrong;
      else if (!constrained && cadt_is_illegal(&locked, p, a, b, q, &counters))
        ++illegal;
      else if (cadt_turns_back(&locked, p, a, b, q, &counters))
        ++broken;
    }
  }
  if (examined) cadt_add_relaxed(found, examined);
  if (illegal) cadt_add_relaxed(found + 1, illegal);
  if (wrong) cadt_add_relaxed(found + 2, wrong);
  if (broken) cadt_add_relaxed(found + 3, broken);
  CADT_SKIP_TIME(&counters);
  CADT_GLOBAL cadt_u32* counter_rows = counted ? found + CADT_COUNTER_STRIDE : 0;
  CADT_FLUSH_COUNTERS(&counters, counter_rows);
}
#endif

#endif
