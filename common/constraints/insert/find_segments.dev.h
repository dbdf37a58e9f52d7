/* SPDX-License-Identifier: Apache-2.0
 *
 * Segments in the Delaunay mesh, before it changes. Most of them are edges already. A vertex on a segment divides it;
 * the pieces that are no edges are listed, as pairs of vertices with none between them.
 */
#ifndef CADT_CONSTRAINTS_FIND_SEGMENTS_H
#define CADT_CONSTRAINTS_FIND_SEGMENTS_H

#include "common/constraints/insert/segment_walk.dev.h"

/* Words that are counted for all segments. */
enum {
  CADT_SEGMENTS_OTHERS,      /* segments that are not found as edges at once */
  CADT_SEGMENTS_PIECES,      /* that are no edges */
  CADT_SEGMENTS_LEFT,        /* of these, pieces that wait for another launch */
  CADT_SEGMENTS_RETRIES,     /* how often one of them has waited (few_pieces.dev.h) */
  CADT_SEGMENTS_STRIDES,     /* of long pieces */
  CADT_SEGMENTS_BROKEN,      /* at which the mesh was found to be wrong */
  CADT_SEGMENTS_CROSSED,     /* pieces that cross a constrained edge */
  CADT_SEGMENTS_LONG_CHAINS, /* that are left to another launch, */
  CADT_SEGMENTS_CHAINS,      /* and others */
  CADT_SEGMENTS_BAD_INDEX,   /* the first segment with an end that is no point; CADT_NONE: none */
  CADT_SEGMENTS_MORE_LOW,    /* vertices of chains, but for two a segment, */
  CADT_SEGMENTS_MORE_HIGH,   /* in two words */
  CADT_SEGMENTS_WORDS
};

/* What is known of the pieces of a launch, an element each. */
typedef struct {
  CADT_GLOBAL cadt_u32* ends;    /* two: the vertices a and b, the piece entered from a */
  CADT_GLOBAL cadt_u32* entry;   /* the half-edge by which it leaves the first triangle */
  CADT_GLOBAL cadt_u32* sizes;   /* places of its ring (segment_rings.dev.h); CADT_NONE: unknown, or it waits */
  CADT_GLOBAL cadt_u32* begins;  /* the scan of the sizes: where its places begin */
  CADT_GLOBAL cadt_u32* upper;   /* vertices on its left */
  CADT_GLOBAL cadt_u32* strides; /* of a long piece: the first one; else CADT_NONE */
  cadt_u32 room;                 /* pieces that there is memory for */
} cadt_pieces;
#define CADT_PIECES_PARAMETERS                                                                                        \
  CADT_GLOBAL cadt_u32 *ends, CADT_GLOBAL cadt_u32 *entry, CADT_GLOBAL cadt_u32 *sizes, CADT_GLOBAL cadt_u32 *begins, \
      CADT_GLOBAL cadt_u32 *upper, CADT_GLOBAL cadt_u32 *piece_strides, cadt_u32 piece_room
#define CADT_PIECES(pieces) const cadt_pieces pieces = {ends, entry, sizes, begins, upper, piece_strides, piece_room}

/* A triangle of each vertex. */
CADT_KERNEL(cadt_vertex_triangles, CADT_GLOBAL const cadt_u32* vertices, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* vertex_triangle) {
  CADT_FOR(t, count, grain) {
    for (cadt_u32 k = 0u; k < 3u; ++k)
      if (vertices[3u * t + k] != CADT_GHOST) cadt_store_relaxed(vertex_triangle + vertices[3u * t + k], t);
  }
}

/* The vertex of each input point: of those that are vertices, and of duplicates, which have the vertex of another. */
CADT_KERNEL(cadt_vertices_of_points, CADT_GLOBAL const cadt_u32* input_ids, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* vertex_of) {
  CADT_FOR(v, count, grain) { vertex_of[input_ids ? input_ids[v] : v] = v; }
}
CADT_KERNEL(cadt_vertices_of_duplicates, CADT_GLOBAL const cadt_u32* duplicates,
            CADT_GLOBAL const cadt_u32* representatives, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* vertex_of) {
  CADT_FOR(i, count, grain) { vertex_of[duplicates[i]] = vertex_of[representatives[i]]; }
}

/* Vertices that lie together, and so do the triangles around them: each 2^16 of them. */
enum { CADT_PATCH_BITS = 16 };

/* Segments between vertices instead of points; both ends CADT_NONE for a segment of no length, or a bad one. `patches`:
 * null, or where the segments begin, for those of no length anything. */
CADT_KERNEL(cadt_vertices_of_segments, CADT_GLOBAL const cadt_u32* segments, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* vertex_of, cadt_u32 point_count, CADT_GLOBAL cadt_u32* ends,
            CADT_GLOBAL cadt_u32* patches, CADT_GLOBAL cadt_u32* words) {
  CADT_FOR(s, count, grain) {
    const cadt_u32 i = segments[2u * s], j = segments[2u * s + 1u];
    const cadt_u32 good = i < point_count && j < point_count ? 1u : 0u;
    if (!good) cadt_min_relaxed(words + CADT_SEGMENTS_BAD_INDEX, s);
    cadt_u32 a = good ? vertex_of[i] : CADT_NONE, b = good ? vertex_of[j] : CADT_NONE;
    if (a == b) a = b = CADT_NONE;
    ends[2u * s] = a;
    ends[2u * s + 1u] = b;
    if (patches) patches[s] = a >> CADT_PATCH_BITS;
  }
}

/* Flags the segments that are found to be edges without coordinates, as most are, and lists the others. `order`: null,
 * or in which order. `counts`: null, or how many vertices the chain of each of them has. */
CADT_KERNEL(cadt_flag_segments, CADT_SEGMENT_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* ends,
            CADT_GLOBAL const cadt_u32* order, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* counts,
            CADT_GLOBAL cadt_u32* others, CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_FOR(i, count, grain) {
    const cadt_u32 s = order ? order[i] : i;
    const cadt_u32 a = ends[2u * s], b = ends[2u * s + 1u];
    const cadt_u32 half_edge = a == b ? CADT_NONE : cadt_find_edge(&mesh, a, b);
    if (half_edge != CADT_NONE) cadt_flag_edge(&mesh, half_edge);
    if (a != b && half_edge == CADT_NONE)
      others[cadt_add_relaxed(words + CADT_SEGMENTS_OTHERS, 1u)] = s;
    else if (counts)
      counts[s] = a == b ? 0u : 2u;
  }
}

/* The triangles that one work-item walks through before a piece counts as long, on GPUs and in the first launch, and
 * those of a stride. */
enum { CADT_PIECE_LONG = 48, CADT_STRIDE = 24, CADT_MOST_STRIDES = 1024 };

/* Walks along a piece from `at->half_edge` on. Returns whether it has come to a vertex, within the limit. */
CADT_FN cadt_u32 cadt_walk_piece(const cadt_segment_mesh* m, cadt_crossed* at, cadt_point p, cadt_u32 to, cadt_point q,
                                 cadt_u32 limit, cadt_u32* triangles, cadt_u32* left, cadt_counters* counters) {
  for (;;) {
    cadt_cross(m, at, p, to, q, counters);
    ++*triangles;
    if (at->side > 0) ++*left;
    if (at->side == 0) return 1u;
    if (*triangles > limit) return 0u;
  }
}

/* Into how many strides a long piece is divided: by how far the first triangles have come. */
CADT_FN cadt_u32 cadt_strides_for(cadt_point p, cadt_point q, cadt_point reached) {
  const cadt_real all = cadt_fabs(q.x - p.x) + cadt_fabs(q.y - p.y);
  const cadt_real part = cadt_fabs(reached.x - p.x) + cadt_fabs(reached.y - p.y);
  const cadt_real most = CADT_CAST(cadt_real, CADT_MOST_STRIDES);
  cadt_real wanted = CADT_CAST(cadt_real, CADT_PIECE_LONG / CADT_STRIDE) * (all / part);
  if (!(wanted < most)) wanted = most;
  return 2u + CADT_CAST(cadt_u32, wanted);
}

/* Of pieces with the same first triangle and the same end, which many segments on one line have, whether this one is
 * not the first. No others have both in common: they would cross in that triangle. `seen`: null: it does not matter */
CADT_FN cadt_u32 cadt_is_seen(CADT_GLOBAL cadt_u32* seen, cadt_u32 entry, cadt_u32 end) {
  if (!seen || cadt_cas_relaxed(seen + CADT_TRIANGLE_OF(entry), CADT_NONE, end)) return 0u;
  return cadt_load_relaxed(seen + CADT_TRIANGLE_OF(entry)) == end ? 1u : 0u;
}
/* Counts a piece; its place, or CADT_NONE if there are too many to be counted. */
CADT_FN cadt_u32 cadt_place_of_piece(CADT_GLOBAL cadt_u32* words) {
  if (cadt_load_relaxed(words + CADT_SEGMENTS_PIECES) >= 0x80000000u) return CADT_NONE;
  return cadt_add_relaxed(words + CADT_SEGMENTS_PIECES, 1u);
}

CADT_FN void cadt_put_piece(const cadt_pieces* pieces, cadt_u32 place, cadt_u32 from, cadt_u32 to, cadt_u32 entry,
                            cadt_u32 whole, cadt_u32 triangles, cadt_u32 left) {
  pieces->ends[2u * place] = from;
  pieces->ends[2u * place + 1u] = to;
  pieces->entry[place] = entry;
  pieces->upper[place] = whole ? left : CADT_NONE;
  pieces->sizes[place] = whole ? triangles + 3u : CADT_NONE;
  pieces->strides[place] = CADT_NONE;
}

/* Flags the edges of segments between the vertices of pairs, those of `which` or all from `first` on, and lists their
 * other pieces, as far as there is room; counts all of them. Those of more triangles than `limit` have strides if
 * `divides`, else they wait. */
CADT_KERNEL(cadt_find_segments, CADT_SEGMENT_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* pairs,
            CADT_GLOBAL const cadt_u32* which, cadt_u32 first, cadt_u32 count, cadt_u32 grain, cadt_u32 limit,
            cadt_u32 divides, CADT_PIECES_PARAMETERS, CADT_GLOBAL cadt_u32* seen, CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_PIECES(pieces);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(s, count, grain) {
    const cadt_u32 pair = which ? which[s] : first + s;
    cadt_u32 a = pairs[2u * pair], b = pairs[2u * pair + 1u];
    while (a != b) {
      const cadt_segment_step step = cadt_next_step(&mesh, a, b, &counters);
      const cadt_u32 from = step.from_b ? b : a, to = step.from_b ? a : b;
      cadt_u32 reached = step.vertex;
      if (step.kind == CADT_STEP_NOWHERE) {
        cadt_add_relaxed(words + CADT_SEGMENTS_BROKEN, 1u);
        break;
      }
      if (step.kind == CADT_STEP_EDGE) {
        cadt_flag_edge(&mesh, step.half_edge);
      } else {
        const cadt_point p = cadt_load_point(mesh.points + from), q = cadt_load_point(mesh.points + to);
        cadt_crossed at = {step.half_edge, CADT_NONE, CADT_NONE, 1};
        cadt_u32 triangles = 1u, left = 1u;
        const cadt_u32 whole = cadt_walk_piece(&mesh, &at, p, to, q, limit, &triangles, &left, &counters);
        reached = whole ? at.apex : to;
        const cadt_u32 place = cadt_is_seen(seen, step.half_edge, reached) ? CADT_NONE : cadt_place_of_piece(words);
        if (place < pieces.room) {
          cadt_put_piece(&pieces, place, from, reached, step.half_edge, whole, triangles, left);
          if (!whole && divides) { /* their number for now */
            const cadt_u32 strides = cadt_strides_for(p, q, cadt_load_point(mesh.points + at.apex));
            cadt_add_relaxed(words + CADT_SEGMENTS_STRIDES, strides);
            pieces.strides[place] = strides;
          }
        }
      }
      if (step.from_b)
        b = reached;
      else
        a = reached;
    }
  }
}

/* Pairs at other places, at random: `bits` hold any place, by which each leads to another one, and that to the next one
 * until it is below `count`. */
CADT_FN cadt_u32 cadt_shuffled_place(cadt_u32 place, cadt_u32 bits, cadt_u32 count) {
  const cadt_u32 mask = (1u << bits) - 1u, shift = (bits + 1u) / 2u;
  do {
    place = (place + 0x1E3779B9u) * 0x7FEB352Du & mask;
    place = (place ^ place >> shift) * 0x846CA68Bu & mask;
    place ^= place >> shift;
  } while (place >= count);
  return place;
}
CADT_KERNEL(cadt_shuffle_pairs, CADT_GLOBAL const cadt_u32* pairs, cadt_u32 count, cadt_u32 grain, cadt_u32 bits,
            CADT_GLOBAL cadt_u32* shuffled) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 place = cadt_shuffled_place(i, bits, count);
    shuffled[2u * place] = pairs[2u * i];
    shuffled[2u * place + 1u] = pairs[2u * i + 1u];
  }
}
/* The chains of segments, those of `which` or all, in the mesh that has all their edges. Without `begins` flags the
 * edges and counts vertices, also in `counts` if it is not null; with `begins`, the scan of the counts, writes them, in
 * input ids. */
CADT_KERNEL(cadt_trace_segments, CADT_SEGMENT_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* ends,
            CADT_GLOBAL const cadt_u32* which, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* counts,
            CADT_GLOBAL const cadt_u32* begins, CADT_GLOBAL const cadt_u32* input_ids, CADT_GLOBAL cadt_u32* chains,
            CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(i, count, grain) {
    const cadt_u32 s = which ? which[i] : i;
    cadt_u32 a = ends[2u * s], b = ends[2u * s + 1u];
    cadt_u32 length = 0u, low = begins ? begins[s] : 0u, high = begins ? begins[s + 1u] : 0u;
    if (begins && high - low == 2u) { /* one edge, as most segments are */
      chains[low] = input_ids ? input_ids[a] : a;
      chains[low + 1u] = input_ids ? input_ids[b] : b;
      continue;
    }
    while (a != b) {
      const cadt_segment_step step = cadt_next_step(&mesh, a, b, &counters);
      if (step.kind != CADT_STEP_EDGE) {
        cadt_add_relaxed(words + CADT_SEGMENTS_BROKEN, 1u);
        break;
      }
      if (begins) {
        const cadt_u32 v = step.from_b ? b : a, place = step.from_b ? --high : low++;
        chains[place] = input_ids ? input_ids[v] : v;
      } else {
        cadt_flag_edge(&mesh, step.half_edge);
      }
      if (step.from_b)
        b = step.vertex;
      else
        a = step.vertex;
      ++length;
    }
    if (begins && low < high) chains[low] = input_ids ? input_ids[a] : a;
    if (counts && !begins) counts[s] = length + 1u;
    if (!begins && length > 1u && cadt_add_relaxed(words + CADT_SEGMENTS_MORE_LOW, length - 1u) > 0u - length)
      cadt_add_relaxed(words + CADT_SEGMENTS_MORE_HIGH, 1u);
  }
}

#endif
