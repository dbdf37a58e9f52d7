/* SPDX-License-Identifier: Apache-2.0
 *
 * Retriangulates the conflict region of a vertex in one step. Threads that change the same triangles may give edges of
 * one vertex to another. That vertex then gets them back flip by flip, each of which makes the next edge illegal: a
 * flip cascade that no other thread can shorten. Here all triangles are tested at once for whether the vertex lies in
 * their circles, and those where it does, together with triangles of the vertex that border on them, become a fan
 * around it (Bowyer-Watson for a vertex that is already in the mesh; docs/insertion.md). Connected parts of the region
 * that the vertex does not see stay as they are.
 *
 * The kernels run one after the other, and no others besides: a plain store locks a triangle, and the lock marks it as
 * part of the region.
 */
#ifndef CADT_INSERTION_CAVITY_H
#define CADT_INSERTION_CAVITY_H

#include "common/insertion/insert.dev.h"
#include "common/portable/union_find.dev.h"

/* In place of a side: a spoke begins at this vertex. */
#define CADT_SPOKE_BEGINS 0x80000000u

/* quads[4 e] and on: the two vertices opposite edge list[e] and its two ends if it is illegal and no hull edge; else
 * CADT_NONE. */
CADT_KERNEL(cadt_cavity_candidates, CADT_LOCKED_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* list, cadt_u32 count,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* quads) {
  CADT_LOCKED_MESH(mesh);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(e, count, grain) {
    const cadt_u32 half_edge = list[e];
    const cadt_snapshot s = cadt_snapshot_from(&mesh, CADT_TRIANGLE_OF(half_edge), CADT_EDGE_OF(half_edge));
    const cadt_snapshot u = cadt_snapshot_from(&mesh, CADT_TRIANGLE_OF(s.n0), CADT_EDGE_OF(s.n0));
    const cadt_u32 hull = s.v1 == CADT_GHOST || s.v2 == CADT_GHOST ? 1u : 0u;
    const cadt_u32 illegal = !hull && cadt_is_illegal(&mesh, s.v0, s.v1, s.v2, u.v0, &counters) ? 1u : 0u;
    quads[4u * e] = illegal ? s.v0 : CADT_NONE;
    quads[4u * e + 1u] = illegal ? u.v0 : CADT_NONE;
    quads[4u * e + 2u] = illegal ? s.v1 : CADT_NONE;
    quads[4u * e + 3u] = illegal ? s.v2 : CADT_NONE;
  }
}

/* A set of vertices as a bit each, by a hash: it may seem to contain a few others. */
CADT_FN cadt_u32 cadt_is_in_set(CADT_GLOBAL const cadt_u32* set, cadt_u32 vertex) {
  const cadt_u32 bit = CADT_CAVITY_BIT(vertex);
  return set[bit >> 5] >> (bit & 31u) & 1u;
}

/* Triangles that may be in a region: a flip cascade turns around a vertex that holds the edges wrongly, an end of all
 * edges of the cascade. So most triangles need no test, which for distant vertices would often be an exact one; what
 * the region lacks by this is flipped later. */
CADT_FN cadt_u32 cadt_may_be_of_cascade(const cadt_snapshot* s, CADT_GLOBAL const cadt_u32* ends) {
  if (s->lock == 0u || s->v0 == CADT_GHOST || s->v1 == CADT_GHOST || s->v2 == CADT_GHOST) return 0u;
  return cadt_is_in_set(ends, s->v0) | cadt_is_in_set(ends, s->v1) | cadt_is_in_set(ends, s->v2);
}

/* Whether vertex w, at p, is certain to lie in the circle of triangle `s`, of which it is no vertex. What the
 * floating-point filter does not decide is left to flips: one lane with an exact test would keep all others waiting. */
CADT_FN cadt_u32 cadt_is_in_conflict(const cadt_locked_mesh* m, const cadt_snapshot* s, cadt_u32 w, cadt_point p) {
  cadt_real most;
  if (s->v0 == w || s->v1 == w || s->v2 == w) return 0u;
  return cadt_incircle_filter(cadt_point_of(m, s->v0), cadt_point_of(m, s->v1), cadt_point_of(m, s->v2), p, &most) > 0
             ? 1u
             : 0u;
}

/* sums[v]: how many of the `count` triangles are in conflict with vertices[v]; at most CADT_CAVITY_CANDIDATES vertices.
 * `ends`: the ends of the illegal edges. \pre sums are 0 */
CADT_KERNEL(cadt_cavity_sizes, CADT_LOCKED_MESH_PARAMETERS, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* ends, CADT_GLOBAL const cadt_u32* vertices, cadt_u32 vertex_count,
            CADT_GLOBAL cadt_u32* sums) {
  CADT_LOCKED_MESH(mesh);
  CADT_FOR(t, count, grain) {
    const cadt_snapshot s = cadt_snapshot_of(&mesh, t);
    if (!cadt_may_be_of_cascade(&s, ends)) continue;
    for (cadt_u32 v = 0u; v < vertex_count; ++v)
      if (cadt_is_in_conflict(&mesh, &s, vertices[v], cadt_point_of(&mesh, vertices[v])))
        cadt_add_relaxed(sums + v, 1u);
  }
}

/* \pre no other kernel runs */
CADT_FN void cadt_add_to_region(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 lock, CADT_GLOBAL cadt_u32* list,
                                cadt_u32 capacity, CADT_GLOBAL cadt_u32* found) {
  const cadt_u32 at = cadt_add_relaxed(found + CADT_CAVITY_LISTED, 1u);
  if (at >= capacity) return;
  cadt_store_relaxed(m->locked[t].word + CADT_WORD_LOCK, lock | 1u);
  list[at] = t;
}

/* Locks and lists the triangles in conflict with vertex w. */
CADT_KERNEL(cadt_cavity_conflicts, CADT_LOCKED_MESH_PARAMETERS, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* ends, cadt_u32 w, CADT_GLOBAL cadt_u32* list, cadt_u32 capacity,
            CADT_GLOBAL cadt_u32* found) {
  CADT_LOCKED_MESH(mesh);
  const cadt_point p = cadt_point_of(&mesh, w);
  CADT_FOR(t, count, grain) {
    const cadt_snapshot s = cadt_snapshot_of(&mesh, t);
    if (cadt_may_be_of_cascade(&s, ends) && cadt_is_in_conflict(&mesh, &s, w, p))
      cadt_add_to_region(&mesh, t, s.lock, list, capacity, found);
  }
}

/* Adds the triangles of w that border on one of the first `count`, each on one only, by the edge opposite w. */
CADT_KERNEL(cadt_cavity_star, CADT_LOCKED_MESH_PARAMETERS, cadt_u32 count, cadt_u32 grain, cadt_u32 w,
            CADT_GLOBAL cadt_u32* list, cadt_u32 capacity, CADT_GLOBAL cadt_u32* found) {
  CADT_LOCKED_MESH(mesh);
  CADT_FOR(i, count, grain) {
    const cadt_snapshot s = cadt_snapshot_of(&mesh, list[i]);
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 across = CADT_NEIGHBOR(s, k), t = CADT_TRIANGLE_OF(across);
      const cadt_snapshot u = cadt_snapshot_from(&mesh, t, CADT_EDGE_OF(across));
      if (u.v0 == w) cadt_add_to_region(&mesh, t, u.lock, list, capacity, found);
    }
  }
}

/* Scratch memory for a region of `capacity` triangles, behind the union-find roots: per component, its triangles less
 * its sides, and whether a side is hidden from w; per triangle its flip counters, whose word meanwhile holds the
 * triangle's place in the list. */
#define CADT_CAVITY_BALANCE(scratch, capacity) ((scratch) + (capacity))
#define CADT_CAVITY_HIDDEN(scratch, capacity) ((scratch) + 2u * (capacity))
#define CADT_CAVITY_FLIPS(scratch, capacity) ((scratch) + 3u * (capacity))

CADT_KERNEL(cadt_cavity_roots, CADT_GLOBAL cadt_locked_triangle* locked, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* list, CADT_GLOBAL cadt_u32* scratch, cadt_u32 capacity) {
  CADT_FOR(i, count, grain) {
    CADT_GLOBAL cadt_u32* flips = locked[list[i]].word + CADT_WORD_FLIPS;
    scratch[i] = i;
    CADT_CAVITY_BALANCE(scratch, capacity)[i] = CADT_CAVITY_HIDDEN(scratch, capacity)[i] = 0u;
    CADT_CAVITY_FLIPS(scratch, capacity)[i] = cadt_load_relaxed(flips);
    cadt_store_relaxed(flips, i);
  }
}

CADT_FN cadt_u32 cadt_is_locked(CADT_GLOBAL cadt_locked_triangle* locked, cadt_u32 t) {
  return cadt_load_relaxed(locked[t].word + CADT_WORD_LOCK) & 1u;
}

CADT_KERNEL(cadt_cavity_join, CADT_GLOBAL cadt_locked_triangle* locked, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* list, CADT_GLOBAL cadt_u32* roots) {
  CADT_FOR(i, count, grain) {
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 t = CADT_TRIANGLE_OF(cadt_load_relaxed(locked[list[i]].word + CADT_WORD_HALF_EDGE + k));
      if (!cadt_is_locked(locked, t)) continue;
      const cadt_u32 j = cadt_load_relaxed(locked[t].word + CADT_WORD_FLIPS);
      if (j < i) cadt_unite(roots, i, j);
    }
  }
}

/* Whether w, at p, does not see the side of the region from `from` to `to` from within. */
CADT_FN cadt_u32 cadt_is_hidden(const cadt_locked_mesh* m, cadt_point p, cadt_u32 from, cadt_u32 to,
                                cadt_counters* counters) {
  return cadt_orientation(p, cadt_point_of(m, from), cadt_point_of(m, to), counters) <= 0 ? 1u : 0u;
}

/* Counts for each component its sides: edges to triangles outside that do not end in w. */
CADT_KERNEL(cadt_cavity_check, CADT_LOCKED_MESH_PARAMETERS, cadt_u32 count, cadt_u32 grain, cadt_u32 w,
            CADT_GLOBAL const cadt_u32* list, CADT_GLOBAL cadt_u32* scratch, cadt_u32 capacity) {
  CADT_LOCKED_MESH(mesh);
  CADT_DECLARE_COUNTERS(counters);
  const cadt_point p = cadt_point_of(&mesh, w);
  CADT_FOR(i, count, grain) {
    const cadt_u32 root = cadt_find_root(scratch, i);
    const cadt_snapshot s = cadt_snapshot_of(&mesh, list[i]);
    cadt_u32 balance = 1u;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 from = CADT_VERTEX(s, CADT_NEXT(k)), to = CADT_VERTEX(s, CADT_PREV(k));
      if (from == w || to == w || cadt_is_locked(locked, CADT_TRIANGLE_OF(CADT_NEIGHBOR(s, k)))) continue;
      --balance;
      if (cadt_is_hidden(&mesh, p, from, to, &counters))
        cadt_store_relaxed(CADT_CAVITY_HIDDEN(scratch, capacity) + root, 1u);
    }
    if (balance) cadt_add_relaxed(CADT_CAVITY_BALANCE(scratch, capacity) + root, balance);
  }
}

/* Lists the triangles of components that w sees whole and that have as many sides as triangles: those are discs with w
 * on the boundary or inside, and no other vertex inside. Unlocks the others unchanged. */
CADT_KERNEL(cadt_cavity_keep, CADT_GLOBAL cadt_locked_triangle* locked, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* list, CADT_GLOBAL cadt_u32* scratch, cadt_u32 capacity,
            CADT_GLOBAL cadt_u32* kept, CADT_GLOBAL cadt_u32* found) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 t = list[i], root = cadt_find_root(scratch, i);
    cadt_store_relaxed(locked[t].word + CADT_WORD_FLIPS, CADT_CAVITY_FLIPS(scratch, capacity)[i]);
    if (!CADT_CAVITY_BALANCE(scratch, capacity)[root] && !CADT_CAVITY_HIDDEN(scratch, capacity)[root])
      kept[cadt_add_relaxed(found + CADT_CAVITY_KEPT, 1u)] = t;
    else
      cadt_add_relaxed(locked[t].word + CADT_WORD_LOCK, 0xFFFFFFFFu);
  }
}

/* The boundary of the `count` kept triangles. Sides: the half-edge outwards, from, to, counterclockwise. Spokes, edges
 * with w at an end: the half-edge outwards and the other end, with CADT_SPOKE_BEGINS if the spoke begins there.
 * vertex_to_triangle[v] meanwhile is the side or spoke that begins at v. Both lists have room for `capacity`. */
CADT_KERNEL(cadt_cavity_boundary, CADT_LOCKED_MESH_PARAMETERS, cadt_u32 count, cadt_u32 grain, cadt_u32 w,
            CADT_GLOBAL const cadt_u32* kept, CADT_GLOBAL cadt_u32* sides, CADT_GLOBAL cadt_u32* spokes,
            cadt_u32 capacity, CADT_GLOBAL cadt_u32* found) {
  CADT_LOCKED_MESH(mesh);
  CADT_FOR(i, count, grain) {
    const cadt_snapshot s = cadt_snapshot_of(&mesh, kept[i]);
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 across = CADT_NEIGHBOR(s, k);
      if (cadt_is_locked(locked, CADT_TRIANGLE_OF(across))) continue;
      const cadt_u32 from = CADT_VERTEX(s, CADT_NEXT(k)), to = CADT_VERTEX(s, CADT_PREV(k));
      const cadt_u32 spoke = from == w || to == w ? 1u : 0u;
      const cadt_u32 at = cadt_add_relaxed(found + (spoke ? CADT_CAVITY_SPOKES : CADT_CAVITY_SIDES), 1u);
      if (at >= capacity) continue;
      if (spoke) {
        spokes[2u * at] = across;
        spokes[2u * at + 1u] = to == w ? from | CADT_SPOKE_BEGINS : to;
      } else {
        sides[3u * at] = across;
        sides[3u * at + 1u] = from;
        sides[3u * at + 2u] = to;
      }
      if (from != w) cadt_store_relaxed(vertex_to_triangle + from, spoke ? at | CADT_SPOKE_BEGINS : at);
    }
  }
}

/* Makes two half-edges name each other. */
CADT_FN void cadt_pair_half_edges(const cadt_locked_mesh* m, cadt_u32 a, cadt_u32 b) {
  cadt_store_field(m->locked[CADT_TRIANGLE_OF(a)].word + CADT_WORD_HALF_EDGE + CADT_EDGE_OF(a), b);
  cadt_store_field(m->locked[CADT_TRIANGLE_OF(b)].word + CADT_WORD_HALF_EDGE + CADT_EDGE_OF(b), a);
}

/* Side i of the boundary and w become triangle kept[i], which is paired with its neighbour outwards and with the next
 * one around w; a spoke that begins at w has no triangle before it. \pre there are as many sides as kept triangles, all
 * seen from w */
CADT_KERNEL(cadt_cavity_fill, CADT_LOCKED_MESH_PARAMETERS, cadt_u32 side_count, cadt_u32 spoke_count, cadt_u32 grain,
            cadt_u32 w, CADT_GLOBAL const cadt_u32* kept, CADT_GLOBAL const cadt_u32* sides,
            CADT_GLOBAL const cadt_u32* spokes) {
  CADT_LOCKED_MESH(mesh);
  CADT_FOR(i, side_count + spoke_count, grain) {
    if (i < side_count) {
      const cadt_u32 t = kept[i], across = sides[3u * i], from = sides[3u * i + 1u], to = sides[3u * i + 2u];
      const cadt_u32 next = cadt_load_relaxed(vertex_to_triangle + to);
      const cadt_u32 flips = cadt_load_field(locked[CADT_TRIANGLE_OF(across)].word + CADT_WORD_FLIPS);
      cadt_store_vertices(&mesh, t, w, from, to);
      cadt_store_flips(&mesh, t, cadt_flips_set(0u, 0u, cadt_flips_get(flips, CADT_EDGE_OF(across))));
      cadt_pair_half_edges(&mesh, CADT_HALF_EDGE(t, 0u), across);
      cadt_pair_half_edges(
          &mesh, CADT_HALF_EDGE(t, 1u),
          next & CADT_SPOKE_BEGINS ? spokes[2u * (next & ~CADT_SPOKE_BEGINS)] : CADT_HALF_EDGE(kept[next], 2u));
    } else {
      const cadt_u32 j = i - side_count, end = spokes[2u * j + 1u];
      if (!(end & CADT_SPOKE_BEGINS))
        cadt_pair_half_edges(&mesh, CADT_HALF_EDGE(kept[cadt_load_relaxed(vertex_to_triangle + end)], 2u),
                             spokes[2u * j]);
    }
  }
}

/* Unlocks the kept triangles, and sets vertex_to_triangle of the vertices on the boundary again. */
CADT_KERNEL(cadt_cavity_release, CADT_LOCKED_MESH_PARAMETERS, cadt_u32 side_count, cadt_u32 spoke_count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* kept, CADT_GLOBAL const cadt_u32* sides, CADT_GLOBAL const cadt_u32* spokes) {
  CADT_LOCKED_MESH(mesh);
  CADT_FOR(i, 2u * side_count + spoke_count, grain) {
    if (i < side_count) {
      CADT_GLOBAL cadt_u32* lock = locked[kept[i]].word + CADT_WORD_LOCK;
      cadt_store_relaxed(lock, cadt_next_version(cadt_load_relaxed(lock) & ~1u));
    } else if (i < 2u * side_count) {
      const cadt_u32 side = i - side_count;
      cadt_set_vertex_triangle(&mesh, sides[3u * side + 1u], kept[side]);
    } else {
      const cadt_u32 spoke = i - 2u * side_count;
      cadt_set_vertex_triangle(&mesh, spokes[2u * spoke + 1u] & ~CADT_SPOKE_BEGINS,
                               CADT_TRIANGLE_OF(spokes[2u * spoke]));
    }
  }
}

#endif
