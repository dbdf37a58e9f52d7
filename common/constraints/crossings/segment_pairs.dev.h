/* SPDX-License-Identifier: Apache-2.0
 *
 * Which segments cross, found in any triangulation of their ends and of all other points: two pieces that cross do so
 * in a triangle that both run through, or on an edge.
 *
 *          /\             Vertices divide each segment into pieces. A piece is listed in each triangle that it runs
 *      s  /  \  t         through, or, if it is an edge, in the lower of the two at that edge: whatever crosses the
 *       ./.  .\.          edge runs through both. The pairs in each triangle are tested with exact predicates; those
 *       /  .x.  \         that share several triangles are found several times.
 *      /_________\
 *
 * Segments, pieces and triangles are numbered from 0. Lists are in CSR: where each begins, and where the last one ends.
 */
#ifndef CADT_CONSTRAINTS_SEGMENT_PAIRS_H
#define CADT_CONSTRAINTS_SEGMENT_PAIRS_H

#include "common/constraints/insert/segment_walk.dev.h"

/* Words that are counted for all segments. */
enum {
  CADT_PAIRS_FOUND,       /* pairs of segments that cross, some of them several times */
  CADT_PAIRS_TESTS_LOW,   /* pairs of pieces in the same triangle, */
  CADT_PAIRS_TESTS_HIGH,  /* in two words */
  CADT_PAIRS_LISTED_LOW,  /* places of pieces in triangles, */
  CADT_PAIRS_LISTED_HIGH, /* in two words */
  CADT_PAIRS_BROKEN,      /* segments at which the mesh was found to be wrong */
  CADT_PAIRS_TIED,     /* segments with the same rounded place at two vertices of their chains (exact_places.dev.h) */
  CADT_PAIRS_UNSURE,   /* crossings whose rounded coordinates are not known */
  CADT_PAIRS_SUSPECTS, /* triangles and edges that are not certainly right */
  CADT_PAIRS_WORDS
};

CADT_FN void cadt_add_wide(CADT_GLOBAL cadt_u32* low_high, cadt_u64 value) {
  const cadt_u32 low = CADT_CAST(cadt_u32, value);
  cadt_u32 high = CADT_CAST(cadt_u32, value >> 32);
  if (low != 0u && cadt_add_relaxed(low_high, low) > 0u - low - 1u) ++high;
  if (high != 0u) cadt_add_relaxed(low_high + 1, high);
}

/* Pieces of segments, in the order of their segments and along each of them. */
typedef struct {
  CADT_GLOBAL cadt_u32* begins;   /* of each segment */
  CADT_GLOBAL cadt_u32* ends;     /* two vertices a piece, in the direction of the segment */
  CADT_GLOBAL cadt_u32* segments; /* whose each is */
} cadt_divided;
/* Where pieces are listed: the list of triangle t ends at ends[t] and begins where that of the triangle before ends. */
typedef struct {
  CADT_GLOBAL cadt_u32* ends;
  CADT_GLOBAL cadt_u32* pieces;
  CADT_GLOBAL cadt_u32* triangles; /* of each place of a list, whose it is */
} cadt_listed;
#define CADT_DIVIDED_PARAMETERS \
  CADT_GLOBAL cadt_u32 *piece_begins, CADT_GLOBAL cadt_u32 *piece_ends, CADT_GLOBAL cadt_u32 *piece_segments
#define CADT_LISTED_PARAMETERS \
  CADT_GLOBAL cadt_u32 *list_ends, CADT_GLOBAL cadt_u32 *list_pieces, CADT_GLOBAL cadt_u32 *list_triangles
#define CADT_DIVIDED(divided) const cadt_divided divided = {piece_begins, piece_ends, piece_segments}
#define CADT_LISTED(listed) const cadt_listed listed = {list_ends, list_pieces, list_triangles}

/* Counts a piece in the list of a triangle, or puts it there if there are lists. */
CADT_FN void cadt_list_piece(const cadt_listed* lists, cadt_u32 t, cadt_u32 piece) {
  const cadt_u32 place = cadt_add_relaxed(lists->ends + t, 1u);
  if (!lists->pieces) return;
  lists->pieces[place] = piece;
  lists->triangles[place] = t;
}

/* Without arrays of pieces it counts: begins[s] is how many segment s has, list_ends[t] how many run through t.
 * With arrays, and both scanned, it writes them. \pre begins has a word more than there are segments */
CADT_KERNEL(cadt_divide_segments, CADT_SEGMENT_MESH_PARAMETERS, CADT_GLOBAL const cadt_u32* segment_ends,
            cadt_u32 count, cadt_u32 grain, CADT_DIVIDED_PARAMETERS, CADT_LISTED_PARAMETERS,
            CADT_GLOBAL cadt_u32* words) {
  CADT_SEGMENT_MESH(mesh);
  CADT_DIVIDED(divided);
  CADT_LISTED(lists);
  CADT_DECLARE_COUNTERS(counters);
  cadt_u64 listed = 0u;
  if (cadt_item == 0u && !divided.ends) divided.begins[count] = 0u;
  CADT_FOR(s, count, grain) {
    cadt_u32 a = segment_ends[2u * s], b = segment_ends[2u * s + 1u];
    cadt_u32 low = divided.ends ? divided.begins[s] : 0u, high = divided.ends ? divided.begins[s + 1u] : 0u;
    cadt_u32 pieces = 0u;
    while (a != b) {
      const cadt_segment_step step = cadt_next_step(&mesh, a, b, &counters);
      if (step.kind == CADT_STEP_NOWHERE) {
        cadt_add_relaxed(words + CADT_PAIRS_BROKEN, 1u);
        break;
      }
      const cadt_u32 from = step.from_b ? b : a, to = step.from_b ? a : b;
      const cadt_u32 piece = step.from_b ? --high : low++;
      const cadt_u32 t = CADT_TRIANGLE_OF(step.half_edge);
      cadt_u32 reached = step.vertex;
      if (step.kind == CADT_STEP_EDGE) { /* the lower one: where it is counted it is also written */
        cadt_list_piece(&lists, cadt_min_u32(t, CADT_TRIANGLE_OF(cadt_across_of(&mesh, step.half_edge))), piece);
      } else {
        const cadt_point p = cadt_load_point(mesh.points + from), q = cadt_load_point(mesh.points + to);
        cadt_crossed at = {step.half_edge, CADT_NONE, CADT_NONE, 1};
        cadt_list_piece(&lists, t, piece);
        while (at.side != 0) {
          cadt_cross(&mesh, &at, p, to, q, &counters);
          cadt_list_piece(&lists, CADT_TRIANGLE_OF(at.entry), piece);
          ++listed;
        }
        reached = at.apex;
      }
      if (divided.ends) {
        divided.ends[2u * piece] = step.from_b ? reached : from;
        divided.ends[2u * piece + 1u] = step.from_b ? from : reached;
        divided.segments[piece] = s;
      }
      if (step.from_b)
        b = reached;
      else
        a = reached;
      ++listed;
      ++pieces;
    }
    if (!divided.ends) divided.begins[s] = pieces;
  }
  if (!divided.ends && listed != 0u) cadt_add_wide(words + CADT_PAIRS_LISTED_LOW, listed);
}

/* Counts the pairs in all lists. `list_counts`: how long each is */
CADT_KERNEL(cadt_count_pairs, CADT_GLOBAL const cadt_u32* list_counts, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* words) {
  cadt_u64 pairs = 0u;
  CADT_FOR(t, count, grain) {
    const cadt_u64 n = list_counts[t];
    if (n > 1u) pairs += n * (n - 1u) / 2u;
  }
  if (pairs != 0u) cadt_add_wide(words + CADT_PAIRS_TESTS_LOW, pairs);
}

/* Whether the pieces between a and b and between c and d have a common point inside of both. No vertex lies there. */
CADT_FN cadt_u32 cadt_pieces_cross(CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_u32* ab,
                                   CADT_GLOBAL const cadt_u32* cd, cadt_counters* counters) {
  if (ab[0] == cd[0] || ab[0] == cd[1] || ab[1] == cd[0] || ab[1] == cd[1]) return 0u;
  const cadt_point a = cadt_load_point(points + ab[0]), b = cadt_load_point(points + ab[1]);
  const cadt_point c = cadt_load_point(points + cd[0]), d = cadt_load_point(points + cd[1]);
  const cadt_i32 side = cadt_orientation(a, b, c, counters);
  if (side == 0 || cadt_orientation(a, b, d, counters) != -side) return 0u;
  const cadt_i32 other = cadt_orientation(c, d, a, counters);
  return other != 0 && cadt_orientation(c, d, b, counters) == -other ? 1u : 0u;
}

/* Tests each place of a list with those behind it. Lists pairs of segments as far as there is room; counts all. */
CADT_KERNEL(cadt_find_pairs, CADT_GLOBAL const cadt_point* points, CADT_DIVIDED_PARAMETERS, CADT_LISTED_PARAMETERS,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* pairs, cadt_u32 room, CADT_GLOBAL cadt_u32* words) {
  CADT_DIVIDED(divided);
  CADT_LISTED(lists);
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR(i, count, grain) {
    const cadt_u32 piece = lists.pieces[i], end = lists.ends[lists.triangles[i]];
    for (cadt_u32 j = i + 1u; j < end; ++j) {
      const cadt_u32 other = lists.pieces[j];
      if (!cadt_pieces_cross(points, divided.ends + 2u * piece, divided.ends + 2u * other, &counters)) continue;
      const cadt_u32 place = cadt_add_relaxed(words + CADT_PAIRS_FOUND, 1u);
      if (place >= room) continue;
      pairs[2u * place] = divided.segments[piece];
      pairs[2u * place + 1u] = divided.segments[other];
    }
  }
}

/* Puts both segments of each pair in the list of the other. Without `partners` it counts the places of each list. */
CADT_KERNEL(cadt_list_partners, CADT_GLOBAL const cadt_u32* pairs, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* partner_ends, CADT_GLOBAL cadt_u32* partners) {
  CADT_FOR(i, count, grain) {
    for (cadt_u32 k = 0u; k < 2u; ++k) {
      const cadt_u32 place = cadt_add_relaxed(partner_ends + pairs[2u * i + k], 1u);
      if (partners) partners[place] = pairs[2u * i + 1u - k];
    }
  }
}

/* ---- sorted lists ---- */

/* Vertices along a segment, at rounded places: rounding keeps their order, but may make two the same. */
typedef struct {
  CADT_GLOBAL const cadt_point* places; /* null: numbers are sorted, not vertices */
  cadt_u32 right, up;                   /* the direction of the segment */
} cadt_sorting;

CADT_FN cadt_u32 cadt_comes_before(const cadt_sorting* by, cadt_u32 a, cadt_u32 b) {
  if (!by->places) return a < b ? 1u : 0u;
  const cadt_point p = cadt_load_point(by->places + a), q = cadt_load_point(by->places + b);
  if (p.x != q.x) return (p.x < q.x ? 1u : 0u) == by->right ? 1u : 0u;
  return p.y != q.y && (p.y < q.y ? 1u : 0u) == by->up ? 1u : 0u;
}

/* Heapsort (J. W. J. Williams, "Algorithm 232: Heapsort", 1964): in place, and never quadratic. */
CADT_FN void cadt_sort_list(CADT_GLOBAL cadt_u32* list, cadt_u32 size, const cadt_sorting* by) {
  for (cadt_u32 begin = size / 2u, end = size; end > 1u;) {
    cadt_u32 value;
    if (begin > 0u) {
      value = list[--begin];
    } else {
      value = list[--end];
      list[end] = list[0];
    }
    cadt_u32 hole = begin;
    for (cadt_u32 child = 2u * hole + 1u; child < end; child = 2u * hole + 1u) {
      if (child + 1u < end && cadt_comes_before(by, list[child], list[child + 1u])) ++child;
      if (!cadt_comes_before(by, value, list[child])) break;
      list[hole] = list[child];
      hole = child;
    }
    list[hole] = value;
  }
}

/* Sorts the list of each segment and drops what repeats. counts[s]: how long it is then; owned[s]: how many segments in
 * it come after s. The list begins where that of the segment before ended. */
CADT_KERNEL(cadt_sort_partners, CADT_GLOBAL const cadt_u32* partner_ends, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* partners, CADT_GLOBAL cadt_u32* counts, CADT_GLOBAL cadt_u32* owned) {
  const cadt_sorting by = {0, 0u, 0u};
  if (cadt_item == 0u) owned[count] = 0u;
  CADT_FOR(s, count, grain) {
    const cadt_u32 begin = s == 0u ? 0u : partner_ends[s - 1u], size = partner_ends[s] - begin;
    CADT_GLOBAL cadt_u32* list = partners + begin;
    cadt_sort_list(list, size, &by);
    cadt_u32 kept = 0u, after = 0u;
    for (cadt_u32 i = 0u; i < size; ++i) {
      if (i != 0u && list[i] == list[kept - 1u]) continue;
      if (list[i] > s) ++after;
      list[kept++] = list[i];
    }
    counts[s] = kept;
    owned[s] = after;
  }
}

/* The pairs in ascending order, the lower segment first: two words each. `owned` is scanned. */
CADT_KERNEL(cadt_order_pairs, CADT_GLOBAL const cadt_u32* partner_ends, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* partners, CADT_GLOBAL const cadt_u32* counts, CADT_GLOBAL const cadt_u32* owned,
            CADT_GLOBAL cadt_u32* ordered) {
  CADT_FOR(s, count, grain) {
    const cadt_u32 begin = s == 0u ? 0u : partner_ends[s - 1u], first = owned[s], size = owned[s + 1u] - first;
    for (cadt_u32 i = 0u; i < size; ++i) {
      ordered[2u * (first + i)] = s;
      ordered[2u * (first + i) + 1u] = partners[begin + counts[s] - size + i];
    }
  }
}

#endif
