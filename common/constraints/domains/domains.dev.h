/* SPDX-License-Identifier: Apache-2.0
 *
 * Regions: triangles that no constrained edge separates. What lies outside of the hull is one more triangle here,
 * behind the last. Union-find joins triangles across edges that are not constrained, and its roots, the lowest
 * triangles, number the regions. Across constrained edges, links between regions form a graph, of which the driver
 * knows how much each link counts:
 *
 *     +-----------------+
 *     |  a    +-----+   |      links: a - outside, b - a
 *     |       |  b  |   |      the dangling edge is no link: a is on both sides
 *     |   --  +-----+   |
 *     +-----------------+
 */
#ifndef CADT_CONSTRAINTS_DOMAINS_H
#define CADT_CONSTRAINTS_DOMAINS_H

#include "common/portable/atomics.dev.h"
#include "common/portable/layout.dev.h"
#include "common/portable/union_find.dev.h"

/* Three vertices a triangle, counterclockwise; the three triangles across, CADT_NONE outside of the hull; a word with
 * bit k set if edge k is constrained. */
typedef struct {
  CADT_GLOBAL const cadt_u32* vertices;
  CADT_GLOBAL const cadt_u32* neighbors;
  CADT_GLOBAL const cadt_u32* edge_flags;
} cadt_domain_mesh;
#define CADT_DOMAIN_MESH_PARAMETERS \
  CADT_GLOBAL const cadt_u32 *vertices, CADT_GLOBAL const cadt_u32 *neighbors, CADT_GLOBAL const cadt_u32 *edge_flags
#define CADT_DOMAIN_MESH(mesh) const cadt_domain_mesh mesh = {vertices, neighbors, edge_flags}

/* Words for the driver. */
enum {
  CADT_DOMAIN_REGIONS, /* regions of triangles */
  CADT_DOMAIN_OUTSIDE, /* the region of the outside */
  CADT_DOMAIN_EDGES,   /* constrained edges */
  CADT_DOMAIN_CHAINS,  /* chains that are not empty */
  CADT_DOMAIN_OPEN,    /* the lowest vertex at which segments do not close; CADT_NONE: they do */
  CADT_DOMAIN_WORDS
};

/* Counts constrained edges as well. \pre roots[t] = t, up to the one outside, which is `count` */
CADT_KERNEL(cadt_domain_unite, CADT_DOMAIN_MESH_PARAMETERS, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* roots,
            CADT_GLOBAL cadt_u32* words) {
  CADT_DOMAIN_MESH(mesh);
  cadt_u32 edges = 0u;
  CADT_FOR(t, count, grain) {
    const cadt_u32 flags = mesh.edge_flags[t];
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 n = mesh.neighbors[3u * t + k];
      if (n != CADT_NONE && n > t) continue;
      if (flags >> k & 1u)
        ++edges;
      else
        cadt_unite(roots, t, n == CADT_NONE ? count : n);
    }
  }
  if (edges) cadt_add_relaxed(words + CADT_DOMAIN_EDGES, edges);
}

/* 1 for each root; their scan numbers the regions. That of the outside is a region only if it has a triangle. */
CADT_KERNEL(cadt_domain_roots, CADT_GLOBAL cadt_u32* roots, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* flags) {
  if (cadt_item == 0u) flags[count] = 0u;
  CADT_FOR(t, count, grain) { flags[t] = cadt_load_relaxed(roots + t) == t ? 1u : 0u; }
}

/* The region of each triangle, and behind them that of the outside, which is the number of regions if no triangle has
 * it. `numbers`: the scan of the flags */
CADT_KERNEL(cadt_domain_regions, CADT_GLOBAL cadt_u32* roots, CADT_GLOBAL const cadt_u32* numbers, cadt_u32 count,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* region, CADT_GLOBAL cadt_u32* words) {
  if (cadt_item == 0u) {
    region[count] = numbers[cadt_find_root(roots, count)];
    words[CADT_DOMAIN_REGIONS] = numbers[count];
    words[CADT_DOMAIN_OUTSIDE] = region[count];
  }
  CADT_FOR(t, count, grain) { region[t] = numbers[cadt_find_root(roots, t)]; }
}

/* How much constrained edges count, by their lower vertex, then by their upper one. */
typedef struct {
  CADT_GLOBAL const cadt_u32* begins; /* of the edges with this lower vertex */
  CADT_GLOBAL const cadt_u32* uppers;
  CADT_GLOBAL const cadt_u32* weights; /* signed, from the lower to the upper vertex; null: 1 in both directions */
} cadt_edge_weights;

/* Of the edge between two vertices, in this direction. */
CADT_FN cadt_u32 cadt_weight_of_edge(const cadt_edge_weights* w, cadt_u32 from, cadt_u32 to) {
  const cadt_u32 lower = from < to ? from : to, upper = from < to ? to : from;
  if (!w->weights) return 1u;
  cadt_u32 low = w->begins[lower], high = w->begins[lower + 1u];
  CADT_FIND_FIRST(low, high, middle, w->uppers[middle] < upper)
  return from < to ? w->weights[low] : 0u - w->weights[low];
}

/* Each chain begins at a vertex, which gains by it, and ends at another, which loses. Where the next chain begins at
 * the end of this one, as in outlines, neither is written. \pre balance is 0 */
CADT_KERNEL(cadt_domain_ends, CADT_GLOBAL const cadt_u32* chain_offsets, CADT_GLOBAL const cadt_u32* chains,
            cadt_u32 length, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* balance,
            CADT_GLOBAL cadt_u32* words) {
  cadt_u32 found = 0u;
  CADT_FOR(s, count, grain) {
    const cadt_u32 first = chain_offsets[s], end = chain_offsets[s + 1u];
    if (first == end) continue;
    ++found;
    const cadt_u32 from = chains[first], to = chains[end - 1u];
    if (first == 0u || chains[first - 1u] != from) cadt_add_relaxed(balance + from, 1u);
    if (end == length || chains[end] != to) cadt_add_relaxed(balance + to, 0u - 1u);
  }
  if (found) cadt_add_relaxed(words + CADT_DOMAIN_CHAINS, found);
}
/* Finds the lowest of `count` vertices with bits of `mask` in its balance. */
CADT_KERNEL(cadt_domain_open, CADT_GLOBAL const cadt_u32* balance, cadt_u32 mask, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* words) {
  cadt_u32 lowest = CADT_NONE;
  CADT_FOR(v, count, grain) {
    if ((balance[v] & mask) != 0u) lowest = cadt_min_u32(lowest, v);
  }
  if (lowest != CADT_NONE) cadt_min_relaxed(words + CADT_DOMAIN_OPEN, lowest);
}

/* A link: what lies left of the edge, what lies right of it, and the weight of the edge. */
enum { CADT_LINK_WORDS = 3 };

/* Lists links as far as there is `room`, in any order, and counts them: one for each constrained edge between two
 * regions, or, with `roots` (of the regions, each its own at first), those of a spanning tree alone. Of every `step`-th
 * triangle, `count` in all. */
CADT_KERNEL(cadt_domain_links, CADT_DOMAIN_MESH_PARAMETERS, cadt_u32 triangles, cadt_u32 step, cadt_u32 count,
            cadt_u32 grain, CADT_GLOBAL const cadt_u32* region, CADT_GLOBAL cadt_u32* roots,
            CADT_GLOBAL const cadt_u32* begins, CADT_GLOBAL const cadt_u32* uppers, CADT_GLOBAL const cadt_u32* weights,
            CADT_GLOBAL cadt_u32* counter, CADT_GLOBAL cadt_u32* links, cadt_u32 room) {
  CADT_DOMAIN_MESH(mesh);
  const cadt_edge_weights all = {begins, uppers, weights};
  CADT_FOR(i, count, grain) {
    const cadt_u32 t = i * step, flags = mesh.edge_flags[t];
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 n = mesh.neighbors[3u * t + k];
      if (!(flags >> k & 1u) || (n != CADT_NONE && n > t)) continue;
      const cadt_u32 left = region[t], right = region[n == CADT_NONE ? triangles : n];
      if (left == right || (roots && !cadt_unite(roots, left, right))) continue;
      const cadt_u32 place = cadt_add_relaxed(counter, 1u);
      if (place >= room) continue;
      CADT_GLOBAL cadt_u32* link = links + CADT_CAST(cadt_u64, CADT_LINK_WORDS) * place;
      link[0] = left;
      link[1] = right;
      link[2] = cadt_weight_of_edge(&all, mesh.vertices[3u * t + CADT_NEXT(k)], mesh.vertices[3u * t + CADT_PREV(k)]);
    }
  }
}

/* 1 for triangles inside; their scan, with a 0 at the end, numbers them. */
CADT_KERNEL(cadt_domain_flags, CADT_GLOBAL const cadt_u32* region, CADT_GLOBAL const cadt_u32* region_inside,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* flags) {
  if (cadt_item == 0u) flags[count] = 0u;
  CADT_FOR(t, count, grain) { flags[t] = region_inside[region[t]]; }
}

/* The triangles inside alone. Where a neighbour is not inside there is none. `places`: the scan of the flags. */
CADT_KERNEL(cadt_domain_pack, CADT_DOMAIN_MESH_PARAMETERS, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* places, CADT_GLOBAL cadt_u32* packed, CADT_GLOBAL cadt_u32* packed_neighbors,
            CADT_GLOBAL cadt_u32* packed_flags) {
  CADT_DOMAIN_MESH(mesh);
  CADT_FOR(t, count, grain) {
    const cadt_u32 to = places[t];
    if (places[t + 1u] == to) continue;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 n = mesh.neighbors[3u * t + k];
      packed[3u * to + k] = mesh.vertices[3u * t + k];
      packed_neighbors[3u * to + k] = n != CADT_NONE && places[n + 1u] != places[n] ? places[n] : CADT_NONE;
    }
    packed_flags[to] = mesh.edge_flags[t];
  }
}

#endif
