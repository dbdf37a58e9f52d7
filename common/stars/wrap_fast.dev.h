/* SPDX-License-Identifier: Apache-2.0
 *
 * Gift wrapping in single precision, checked as a whole: the star of one vertex p by a team. It wraps the points around
 * p; then exact predicates show for each triangle that no other point is in its circle, which mostly is so small that
 * all of its points are known. Stars with larger circles, and those that single precision gets wrong, are left to
 * cadt_wrap_stars, which decides each step exactly but takes over the proven triangles (docs/stars.md, "Gift
 * wrapping").
 */
#ifndef CADT_STARS_WRAP_FAST_H
#define CADT_STARS_WRAP_FAST_H

#include "common/stars/wrapped_star.dev.h"

typedef struct {
  float x[CADT_NEAR_POINTS], y[CADT_NEAR_POINTS]; /* relative to p, scaled */
  cadt_u32 at[CADT_NEAR_POINTS];
  cadt_u32
      star[2 * CADT_WRAP_DEGREE];    /* places of the star vertices, counterclockwise; the first one is in the middle */
  cadt_disc disc[CADT_WRAP_DEGREE];  /* discs of the triangles */
  cadt_u32 proven[CADT_WRAP_DEGREE]; /* whether they are certainly Delaunay */
  cadt_u32 nodes[CADT_WRAP_NODES], leaves[CADT_NEAR_LEAVES];
  cadt_reduction reductions;
  cadt_u32 place;
} cadt_near_memory;

typedef struct {
  CADT_TEAM_PTR cadt_near_memory* m;
  cadt_aabb_tree in;
  cadt_counters* counters;
  cadt_reach_around reach;
  cadt_u32 p, reduction, known; /* number of points gathered */
  cadt_u32 low, size, closed;   /* the star in m->star; whether it goes all the way round p */
} cadt_near;

CADT_FN cadt_u32 cadt_near_count(const cadt_near* w) {
  return cadt_team_add(&w->m->reductions.count[w->reduction], 1u);
}
CADT_FN cadt_u32 cadt_near_reduce(cadt_near* w, cadt_u32 value, cadt_u32* count) {
  return cadt_end_reduction(&w->m->reductions, &w->reduction, value, count);
}

/* Gathers the points within reach; the reach changes if they are too many or too few. Returns 0 if that does not help.
 */
CADT_FN cadt_u32 cadt_near_gather(cadt_near* w) {
  const cadt_point p = w->in.points[w->p];
  const cadt_u32 most = CADT_NEAR_POINTS, few = CADT_NEAR_FEW;
  cadt_u32 nodes, leaves, many = 1u, going = 1u;
  for (cadt_u32 tries = 0u; tries < 3u && going; ++tries) {
    const cadt_disc disc = {0.0, 0.0, w->reach.square};
    CADT_TEAM_FOR(j, w->in.node_count) {
      if (cadt_aabb_matters(w->in.nodes[j], p, 0.0, 0.0, 0.0, &disc)) w->m->nodes[cadt_near_count(w)] = j;
    }
    cadt_near_reduce(w, CADT_NONE, &nodes);
    CADT_TEAM_FOR(j, nodes * CADT_AABB_FANOUT) {
      const cadt_u32 c = w->m->nodes[j / CADT_AABB_FANOUT] * CADT_AABB_FANOUT + j % CADT_AABB_FANOUT;
      if (c >= w->in.leaf_count || !cadt_aabb_matters(w->in.leaves[c], p, 0.0, 0.0, 0.0, &disc)) continue;
      const cadt_u32 slot = cadt_near_count(w);
      if (slot < CADT_CAST(cadt_u32, CADT_NEAR_LEAVES)) w->m->leaves[slot] = c;
    }
    cadt_near_reduce(w, CADT_NONE, &leaves);
    many = leaves > CADT_CAST(cadt_u32, CADT_NEAR_LEAVES) ? 1u : 0u;
    CADT_TEAM_FOR(j, many ? 0u : leaves * CADT_AABB_LEAF) {
      const cadt_u32 i = cadt_wrap_in_leaves(w->m->leaves, j);
      if (i >= w->in.n || i == w->p) continue;
      const cadt_point c = w->in.points[i];
      const double x = c.x - p.x, y = c.y - p.y;
      if (x * x + y * y > w->reach.square) continue;
      const cadt_u32 slot = cadt_near_count(w);
      if (slot >= most) continue;
      w->m->at[slot] = i;
      w->m->x[slot] = CADT_CAST(float, x * w->reach.unit);
      w->m->y[slot] = CADT_CAST(float, y * w->reach.unit);
    }
    cadt_near_reduce(w, CADT_NONE, &w->known);
    /* The points must have been within reach of the last search. */
    double change = many ? 0.1 : 4.0;
    if (w->known > most) many = 1u, change = 0.5 * CADT_CAST(double, most) / CADT_CAST(double, w->known);
    going = many || (w->known < few && w->in.n > 2u * few) ? 1u : 0u;
    if (going && tries < 2u) w->reach.square *= change;
  }
  return !many;
}

/* The gathered point after the one at place `a` on one side, or the nearest to p; CADT_NONE if there is none. */
CADT_FN cadt_u32 cadt_near_next(cadt_near* w, cadt_u32 a, cadt_i32 side) {
  const float ax = a == CADT_NONE ? 0.0f : w->m->x[a], ay = a == CADT_NONE ? 0.0f : w->m->y[a];
  const cadt_u32 mask = CADT_NEAR_PLACE;
  cadt_u32 key = CADT_NONE, count;
  CADT_TEAM_FOR(j, w->known) {
    const cadt_u32 order = cadt_wrap_key(ax, ay, w->m->x[j], w->m->y[j], side, a == CADT_NONE ? 1u : 0u);
    if (order != CADT_NONE) key = cadt_min_u32(key, (order & ~mask) | j);
  }
  key = cadt_near_reduce(w, key, &count);
  return key == CADT_NONE ? CADT_NONE : key & mask;
}

/* The exact test of two gathered points, at places b and c. A function of its own, for the reason given below. */
CADT_FN_SLOW cadt_u32 cadt_near_better(CADT_GLOBAL const cadt_point* points, CADT_TEAM_PTR const cadt_u32* at,
                                       cadt_u32 p, cadt_u32 a, cadt_i32 side, cadt_u32 b, cadt_u32 c,
                                       cadt_counters* counters) {
  return cadt_wrap_better_of(points, p, at[a], side, at[b], at[c], counters) == at[c] ? c : b;
}

/* The gathered point after the one at place `a`: `next`, or one that rounded arithmetic does not distinguish from it,
 * whichever the exact test prefers. */
CADT_FN cadt_u32 cadt_near_decide(cadt_near* w, cadt_u32 a, cadt_i32 side, cadt_u32 next) {
  const float ax = w->m->x[a], ay = w->m->y[a];
  const float value = cadt_wrap_key_value(cadt_wrap_key(ax, ay, w->m->x[next], w->m->y[next], side, 0u));
  const float most = value + 3e-5f * (1.0f + value * value);
  cadt_u32 count;
  CADT_TEAM_FOR(j, w->known) {
    const cadt_u32 key = cadt_wrap_key(ax, ay, w->m->x[j], w->m->y[j], side, 0u);
    if (key != CADT_NONE && cadt_wrap_key_value(key) <= most) w->m->leaves[cadt_near_count(w)] = j;
  }
  cadt_near_reduce(w, CADT_NONE, &count);
  if (count < 2u) return next;
  const cadt_u32 lanes = cadt_min_u32(cadt_team_lanes, CADT_WRAP_NODES);
  cadt_u32 width = cadt_min_u32(lanes, count);
  if (cadt_team_lane < width) {
    cadt_u32 best = w->m->leaves[cadt_team_lane];
    for (cadt_u32 j = cadt_team_lane + lanes; j < count; j += lanes)
      best = cadt_near_better(w->in.points, w->m->at, w->p, a, side, best, w->m->leaves[j], w->counters);
    w->m->nodes[cadt_team_lane] = best;
  }
  CADT_TEAM_SYNC();
  while (width > 1u) {
    const cadt_u32 middle = (width + 1u) / 2u;
    if (cadt_team_lane + middle < width)
      w->m->nodes[cadt_team_lane] = cadt_near_better(w->in.points, w->m->at, w->p, a, side, w->m->nodes[cadt_team_lane],
                                                     w->m->nodes[cadt_team_lane + middle], w->counters);
    width = middle;
    CADT_TEAM_SYNC();
  }
  return w->m->nodes[0];
}

/* The star of p among the gathered points in rounded arithmetic; `careful`: exactly where that does not decide. Returns
 * 0 if the result is no star. */
CADT_FN cadt_u32 cadt_near_wrap(cadt_near* w, cadt_u32 careful) {
  cadt_u32 low = CADT_WRAP_DEGREE, high = low, start = CADT_NONE, now = CADT_NONE, sense = 1u, going = 1u;
  cadt_i32 side = 1;
  w->closed = 0u;
  while (going) {
    cadt_u32 next = cadt_near_next(w, now, side);
    if (careful && now != CADT_NONE && next != CADT_NONE) next = cadt_near_decide(w, now, side, next);
    if (start == CADT_NONE) { /* from the nearest point counterclockwise, */
      start = now = next;
      if (start == CADT_NONE) going = sense = 0u;
      if (cadt_team_lane == 0u && sense) w->m->star[low] = start;
    } else if (next == CADT_NONE) { /* then from a hull edge back, clockwise to the other one */
      if (side < 0) going = 0u;
      side = -1;
      now = start;
    } else if (next == start) {
      w->closed = 1u;
      going = 0u;
      if (side < 0) sense = 0u;
    } else if (high - low + 2u >= CADT_CAST(cadt_u32, CADT_WRAP_DEGREE)) {
      going = sense = 0u;
    } else {
      const cadt_u32 at = side > 0 ? ++high : --low;
      if (cadt_team_lane == 0u) w->m->star[at] = next;
      now = next;
    }
  }
  w->low = low;
  w->size = high - low + 1u;
  return sense && w->size >= 2u + w->closed ? 1u : 0u;
}

/* Number of triangles of the star. On the hull it is one less than the number of star vertices, and last come the two
 * hull edges, behind the last star vertex and before the first. */
CADT_FN cadt_u32 cadt_near_triangles(const cadt_near* w) { return w->closed ? w->size : w->size - 1u; }
/* Star vertex `k`, or the first one behind the last. */
CADT_FN cadt_u32 cadt_near_neighbor(const cadt_near* w, cadt_u32 k) {
  return w->m->at[w->m->star[w->low + (k < w->size ? k : 0u)]];
}

/* Computes the triangles' discs. A triangle becomes a candidate for a proof if it is certainly counterclockwise and
 * only gathered points can be in its disc; returns how many are. The disc of the others is empty: what is in it does
 * not matter. */
CADT_FN cadt_u32 cadt_near_candidates(cadt_near* w) {
  const cadt_point p = w->in.points[w->p];
  cadt_u32 count;
  CADT_TEAM_FOR(i, cadt_near_triangles(w)) {
    const cadt_point a = w->in.points[cadt_near_neighbor(w, i)], b = w->in.points[cadt_near_neighbor(w, i + 1u)];
    cadt_disc disc = cadt_disc_around(p, a, b);
    /* The circle goes through p, so nothing in it is further away than its diameter. */
    const cadt_u32 candidate = cadt_orientation_filter(p, a, b) == 1 && 4.0 * disc.square <= w->reach.square ? 1u : 0u;
    if (!candidate) disc.square = -1.0;
    w->m->disc[i] = disc;
    w->m->proven[i] = candidate;
    if (candidate) cadt_near_count(w);
  }
  cadt_near_reduce(w, CADT_NONE, &count);
  return count;
}

/* The exact test. A function of its own, so that its code is out of the way of what all lanes execute. */
CADT_FN_SLOW cadt_u32 cadt_near_in_circle(CADT_GLOBAL const cadt_point* points, cadt_u32 p, cadt_u32 a, cadt_u32 b,
                                          cadt_u32 c, cadt_counters* counters) {
  return cadt_incircle(points[p], points[a], points[b], points[c], counters) > 0 ? 1u : 0u;
}

/* Withdraws the proof of triangles with a gathered point in their circle: rounded arithmetic has erred, `erred` times.
 * Returns whether no gathered point is beyond a hull edge or on its line, which is not decided here. */
CADT_FN cadt_u32 cadt_near_refute(cadt_near* w, cadt_u32* erred) {
  const cadt_point p = w->in.points[w->p];
  const cadt_u32 triangles = cadt_near_triangles(w);
  cadt_u32 wrong = CADT_NONE;
  CADT_TEAM_FOR(j, triangles ? w->known : 0u) {
    const cadt_u32 i = w->m->at[j];
    const cadt_point c = w->in.points[i];
    /* Two loops, so that lanes reach exact tests at the same time, not one after the other. */
    for (cadt_u32 k = 0u; k < triangles; ++k) {
      cadt_u32 a = CADT_NONE, b = CADT_NONE;
      for (; k < triangles; ++k) {
        const double x = c.x - p.x - w->m->disc[k].x, y = c.y - p.y - w->m->disc[k].y, square = w->m->disc[k].square;
        if (square < 0.0 || x * x + y * y > square) continue;
        a = cadt_near_neighbor(w, k);
        b = cadt_near_neighbor(w, k + 1u);
        if (i != a && i != b) break;
      }
      if (k == triangles || !cadt_near_in_circle(w->in.points, w->p, a, b, i, w->counters)) continue;
      w->m->proven[k] = 0u;
      cadt_near_count(w);
    }
    if (w->closed) continue;
    const cadt_u32 first = cadt_near_neighbor(w, 0u), last = cadt_near_neighbor(w, triangles);
    if (i != first && cadt_orientation_filter(p, w->in.points[first], c) != 1) wrong = 0u;
    if (i != last && cadt_orientation_filter(p, w->in.points[last], c) != -1) wrong = 0u;
  }
  return cadt_near_reduce(w, wrong, erred) == CADT_NONE ? 1u : 0u;
}

/* Computes the star of w->p; returns its kind (wrapped_star.dev.h), 0 if this way does not find it: then its proven
 * triangles are right. */
CADT_FN cadt_u32 cadt_near_star(cadt_near* w) {
  const cadt_u32 all = w->reach.square == CADT_CAST(double, CADT_INFINITY) ? 1u : 0u;
  cadt_u32 right = 0u, erred = 1u;
  if (!cadt_near_gather(w)) w->known = 0u;
  for (cadt_u32 careful = 0u; careful < 2u && erred; ++careful) {
    if (!cadt_near_wrap(w, careful)) w->size = 0u, w->closed = 1u; /* no triangles */
    const cadt_u32 candidates = cadt_near_candidates(w);
    right = cadt_near_refute(w, &erred);
    if (!w->size && w->known) erred = 1u;
    if (w->size && !candidates) erred = 0u; /* none of its triangles would be proven */
  }
  if (!w->size || !(w->closed || all)) right = 0u;
  for (cadt_u32 k = 0u; k < cadt_near_triangles(w); ++k) right &= w->m->proven[k];
  return right ? (w->closed ? 1u : 2u) : 0u;
}

/* Whether the floating-point filter takes p for a point of the circle through three points far away. */
CADT_FN cadt_u32 cadt_near_on_circle(CADT_GLOBAL const cadt_point* points, cadt_u32 n, cadt_u32 p) {
  const cadt_u32 step = n / 4u, a = (p + step) % n, b = (p + 2u * step) % n, c = (p + 3u * step) % n;
  double most;
  return cadt_incircle_filter(points[a], points[b], points[c], points[p], &most) == 0 ? 1u : 0u;
}

/* The head of the partial star (wrapped_star.dev.h) with the first `noted` star vertices. */
CADT_FN cadt_u32 cadt_near_head(const cadt_near* w, cadt_u32 noted) {
  cadt_u32 head = noted << 1 | w->closed;
  for (cadt_u32 k = 0u; k < noted; ++k)
    if (k < cadt_near_triangles(w) && w->m->proven[k]) head |= CADT_WRAP_HEAD_PROVEN(k);
  return head;
}

/* The stars of all n points. Those not found are listed in `todo` and counted (CADT_WRAP_TODO... of layout.dev.h);
 * their rows of `arcs` hold the star vertices of the partial star, and begins[v] its head. \pre sizes are 0,
 * 2 <= n <= CADT_WRAP_MOST */
CADT_TEAM_KERNEL(32, 24, cadt_wrap_near, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_aabb* leaves,
                 CADT_GLOBAL const cadt_aabb* nodes, cadt_u32 n, cadt_u32 grain, cadt_u32 row,
                 CADT_GLOBAL cadt_u32* star_vertices, cadt_u32 star_words, CADT_GLOBAL cadt_u32* begins,
                 CADT_GLOBAL cadt_u32* sizes, CADT_GLOBAL cadt_u32* counts, CADT_GLOBAL cadt_u32* todo,
                 CADT_GLOBAL cadt_u16* arcs) {
  CADT_TEAM_MEMORY cadt_near_memory memory;
  const cadt_wrap_sink sink = {n, row, star_words, star_vertices, begins, sizes, counts};
  CADT_DECLARE_COUNTERS(counters);
  CADT_FOR_TEAMS(v, n, grain) {
    const cadt_aabb_tree in = cadt_aabb_tree_of(cadt_wrap_span_of(0, 0u, n), points, leaves, nodes);
    cadt_near w = {&memory, in, &counters, cadt_wrap_reach(&in, v), v, 0u, 0u, 0u, 0u, 0u};
    cadt_begin_reductions(&memory.reductions);
    CADT_TEAM_SYNC();
    const cadt_u32 kind = cadt_near_star(&w);
    if (cadt_team_lane == 0u && !kind) {
      memory.place = cadt_add_relaxed(counts + CADT_WRAP_TODO, 1u);
      if (!w.closed) {
        cadt_add_relaxed(counts + CADT_WRAP_TODO_OPEN, 1u);
        if (cadt_near_on_circle(points, n, v)) cadt_add_relaxed(counts + CADT_WRAP_TODO_ON_CIRCLE, 1u);
      }
      todo[memory.place] = v;
    }
    CADT_TEAM_SYNC();
    const cadt_u32 noted = w.size < CADT_CAST(cadt_u32, CADT_WRAP_ROW) ? w.size : 0u;
    CADT_TEAM_FOR(k, w.size) {
      const cadt_u32 neighbor = cadt_near_neighbor(&w, k);
      memory.leaves[k] = neighbor;
      if (!kind && noted) arcs[memory.place * CADT_WRAP_ROW + k] = CADT_CAST(cadt_u16, neighbor);
    }
    if (cadt_team_lane == 0u && !kind) begins[v] = cadt_near_head(&w, noted);
    cadt_wrap_store(&sink, &memory.place, v, 0u, memory.leaves, w.size, 1u, kind);
  }
  cadt_flush_exact(&counters, counts + CADT_WRAP_EXACT_ORIENTATIONS);
}

#endif
