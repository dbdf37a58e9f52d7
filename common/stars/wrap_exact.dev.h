/* SPDX-License-Identifier: Apache-2.0
 *
 * Exact gift wrapping: the star of one vertex p by a team, without locks. It finds one star vertex after another
 * (wrap_step.dev.h; docs/stars.md, "Gift wrapping"), each by exact predicates, so ties are broken as everywhere
 * else.
 */
#ifndef CADT_STARS_WRAP_EXACT_H
#define CADT_STARS_WRAP_EXACT_H

#include "common/stars/wrap_step.dev.h"

/* The star vertex after `a` on that side by a proven triangle of the partial star, or CADT_NONE. */
CADT_FN cadt_u32 cadt_wrap_proven_next(const cadt_wrapper* w, cadt_u32 a, cadt_i32 side) {
  const cadt_u32 size = w->m->arc[0] >> 1, closed = w->m->arc[0] & 1u;
  cadt_u32 found = CADT_NONE;
  for (cadt_u32 k = 0u; k < size; ++k) {
    const cadt_u32 one = w->m->arc[1u + k], next = k + 1u < size ? k + 1u : 0u;
    if (!(one & CADT_WRAP_PROVEN) || (!next && !closed)) continue;
    const cadt_u32 from = one & ~CADT_WRAP_PROVEN, to = w->m->arc[1u + next] & ~CADT_WRAP_PROVEN;
    if ((side > 0 ? from : to) == a) found = side > 0 ? to : from;
  }
  return found;
}

/* A star vertex of a proven triangle, or CADT_NONE: from there on all points found are star vertices. */
CADT_FN cadt_u32 cadt_wrap_proven_neighbor(const cadt_wrapper* w) {
  const cadt_u32 size = w->m->arc[0] >> 1;
  for (cadt_u32 k = 0u; k < size; ++k)
    if (w->m->arc[1u + k] & CADT_WRAP_PROVEN) return w->m->arc[1u + k] & ~CADT_WRAP_PROVEN;
  return CADT_NONE;
}

/* Computes the star of w->p: *size star vertices in w->m->star from *begin on, counterclockwise if *side is 1, else
 * clockwise. Returns 0 if there is none: all points are collinear, or there are too many star vertices; 1 for an inner
 * vertex; 2 for a vertex of the hull, whose star goes from one hull edge to the other. */
CADT_FN cadt_u32 cadt_wrap_star(cadt_wrapper* w, cadt_u32* begin, cadt_u32* size, cadt_i32* side) {
  const cadt_u32 known = cadt_wrap_proven_neighbor(w), none = CADT_NONE;
  cadt_u32 at = known != none ? known : (w->p ? w->p - 1u : 1u), from_hull = 0u, pass = 0u, outcome = 0u, going = 1u;
  cadt_u32 asked = none; /* place in the list that is tested for whether all from there on are star vertices */
  *begin = *size = 0u;
  *side = 1;
  while (going) {
    if (asked == none) {
      if (cadt_team_lane == 0u) w->m->star[*size] = at;
      ++*size;
    } else {
      at = w->m->star[asked + 1u];
    }
    const cadt_i32 towards = asked == none ? *side : -*side;
    cadt_u32 next = cadt_wrap_proven_next(w, at, towards), certain = none;
    if (next == none) next = cadt_wrap_next(w, at, towards);
    CADT_TEAM_SYNC();
    cadt_u32 restart = 0u;
    if (asked != none) {
      /* It is a star vertex if it is found from the one behind it as well: their circle is empty on either side. */
      if (next == w->m->star[asked])
        certain = asked;
      else
        ++asked;
    } else if (next != none) {
      /* The first point need not have been a star vertex; from a star vertex on all are, and the search comes back to
       * it. */
      for (cadt_u32 k = *begin; k < *size && !outcome; ++k)
        if (w->m->star[k] == next) *begin = k, outcome = 1u;
      if (outcome || *size + 1u >= CADT_CAST(cadt_u32, CADT_WRAP_DEGREE)) going = 0u;
      at = next;
    } else if (from_hull) {
      /* Beyond the line p, at there is nothing: a hull edge. The star lies between it and the other hull edge. */
      outcome = 2u;
      going = 0u;
    } else {
      asked = 0u;
      if (known != none) certain = 0u;
    }
    if (certain == none && asked != none && (asked + 1u >= *size || asked == CADT_CAST(cadt_u32, CADT_WRAP_DOUBTFUL)))
      restart = 1u;
    if (certain != none || restart) at = w->m->star[restart ? *size - 1u : certain];
    /* All lanes have read what is written next. A single barrier for all branches: PoCL 3.1 compiles the code behind a
     * barrier in a branch anew for each branch. */
    CADT_TEAM_SYNC();
    if (certain != none) {
      /* All from that one on are star vertices: reversed, the search goes on from it, which is entered again. */
      CADT_TEAM_FOR(k, (*size - certain) / 2u) {
        const cadt_u32 other = w->m->star[*size - 1u - k];
        w->m->star[*size - 1u - k] = w->m->star[certain + k];
        w->m->star[certain + k] = other;
      }
      from_hull = 1u;
      *begin = certain;
      --*size;
    }
    if (restart) {
      /* Start again from the last point. If it was found from a star vertex, it is one itself, and the edge is a hull
       * edge. */
      from_hull = *size > 1u ? 1u : 0u;
      if (++pass > 2u) going = 0u;
      *size = 0u;
    }
    if (certain != none || restart) {
      asked = none;
      *side = -*side;
    }
  }
  *size -= *begin;
  return *size < 2u ? 0u : outcome;
}

/* The stars of the vertices in `todo`: `count` of them in a batch; or, with `arcs`, those that cadt_wrap_near has left
 * to do. Nothing is done if these are nearly all points and on the hull as far as is known: each would have to look at
 * all points; nor if there are many points, and some of the hull take exact tests. A vertex is skipped if more than
 * CADT_MOST_HIGH_DEGREE have failed, or if the work exceeds the limit, `work_limit` a point and `spare_work_limit` in
 * addition; in a batch, if one vertex of its set has failed, which states[set] counts, or the work work_done[set]
 * exceeds it. */
CADT_TEAM_KERNEL(128, 5, cadt_wrap_stars, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_aabb* leaves,
                 CADT_GLOBAL const cadt_aabb* nodes, cadt_u32 n, CADT_GLOBAL const cadt_u32* todo, cadt_u32 count,
                 CADT_GLOBAL const cadt_u16* arcs, CADT_GLOBAL const cadt_u32* starts, cadt_u32 set_count,
                 CADT_GLOBAL cadt_u32* states, CADT_GLOBAL cadt_u32* work_done, cadt_u32 work_limit,
                 cadt_u32 spare_work_limit, cadt_u32 grain, cadt_u32 row, CADT_GLOBAL cadt_u32* star_vertices,
                 cadt_u32 star_words, CADT_GLOBAL cadt_u32* begins, CADT_GLOBAL cadt_u32* sizes,
                 CADT_GLOBAL cadt_u32* counts) {
  CADT_TEAM_MEMORY cadt_wrap_memory memory;
  const cadt_wrap_sink sink = {n, row, star_words, star_vertices, begins, sizes, counts};
  const cadt_u32 hull = 2u * counts[CADT_WRAP_TODO_ON_CIRCLE] > n ? CADT_CAST(cadt_u32, CADT_WRAP_HULL_EXACT)
                                                                  : CADT_CAST(cadt_u32, CADT_WRAP_HULL);
  /* from words that this kernel does not change, so the same for all lanes of a team */
  const cadt_u32 mostly_hull = n > hull && 10u * counts[CADT_WRAP_TODO_OPEN] > 9u * n ? 1u : 0u;
  const cadt_u32 many_exact = n > CADT_CAST(cadt_u32, CADT_WRAP_MANY) && counts[CADT_WRAP_TODO_ON_CIRCLE] ? 1u : 0u;
  const cadt_u32 refused = arcs && (mostly_hull || many_exact) ? 1u : 0u;
  const cadt_u32 stars = refused ? 0u : (arcs ? counts[CADT_WRAP_TODO] : count);
  if (refused && cadt_item == 0u)
    cadt_add_relaxed(counts + CADT_WRAP_FAILED, CADT_CAST(cadt_u32, CADT_MOST_HIGH_DEGREE) + 1u);
  CADT_DECLARE_COUNTERS(counters);
  cadt_u32 exact_before = 0u;
  CADT_FOR_TEAMS(item, stars, grain) {
    const cadt_u32 v = todo[item], set = starts ? cadt_set_of(starts, set_count, v) : 0u;
    const cadt_wrap_span span = cadt_wrap_span_of(starts, set, n);
    CADT_GLOBAL cadt_u32* failed = starts ? states + set : counts + CADT_WRAP_FAILED;
    CADT_GLOBAL cadt_u32* done = starts ? work_done + set : counts + CADT_WRAP_WORK;
    const cadt_aabb_tree in = cadt_aabb_tree_of(span, points, leaves, nodes);
    const cadt_u32 lanes = cadt_min_u32(cadt_team_lanes, CADT_WRAP_LANES);
    cadt_wrapper w = {&memory, in, &counters, lanes, v - span.begin, 0u};
    const cadt_u32 head = arcs ? begins[v] : 0u;
    if (cadt_team_lane == 0u) memory.arc[0] = head & CADT_WRAP_HEAD_SIZE;
    CADT_TEAM_FOR(k, (head & CADT_WRAP_HEAD_SIZE) >> 1) {
      memory.arc[1u + k] = arcs[item * CADT_WRAP_ROW + k] | (head & CADT_WRAP_HEAD_PROVEN(k) ? CADT_WRAP_PROVEN : 0u);
    }
    if (cadt_team_lane == 0u)
      memory.place = cadt_load_relaxed(failed) <= (starts ? 0u : CADT_CAST(cadt_u32, CADT_MOST_HIGH_DEGREE)) &&
                             cadt_load_relaxed(done) <= work_limit * span.count + spare_work_limit
                         ? 1u
                         : 0u;
    CADT_TEAM_SYNC();
    const cadt_u32 wanted = memory.place;
    CADT_TEAM_SYNC();
    cadt_u32 begin = 0u, size = 0u, kind = 0u;
    cadt_i32 side = 1;
    if (wanted) kind = cadt_wrap_star(&w, &begin, &size, &side);
    const cadt_u32 exact = counters.count[CADT_COUNT_EXACT_INCIRCLES] + counters.count[CADT_COUNT_EXACT_ORIENTATIONS];
    if (exact != exact_before) cadt_add_relaxed(done, exact - exact_before);
    exact_before = exact;
    if (cadt_team_lane == 0u) {
      cadt_add_relaxed(done, w.leaves_tested);
      if (!kind) cadt_add_relaxed(failed, starts ? CADT_CAST(cadt_u32, CADT_SET_FAILURE) : 1u);
    }
    cadt_wrap_store(&sink, &memory.place, v, span.begin, memory.star + begin, size, side > 0 ? 1u : 0u, kind);
  }
  cadt_flush_exact(&counters, counts + CADT_WRAP_EXACT_ORIENTATIONS);
}

#endif
