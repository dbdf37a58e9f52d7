/* SPDX-License-Identifier: Apache-2.0
 *
 * One step of exact gift wrapping: among the points on one side of the line through p and its star vertex a, the one
 * whose circle with p and a is empty.
 *
 *               ____
 *            .-'    '-.
 *         c *          \     . d     One step on side 1, left of the line from p to a:
 *          |     b *    |            c is the best so far, the disc is its circle with p and a.
 *          |            |            b lies in the disc: it becomes the best, and the disc shrinks.
 *           \          /             d lies outside: it is not better.
 *          p *--------* a            e lies on the other side: it is no candidate.
 *             '-.__.-'
 *          . e                       No point is left in the disc of b: p a b is a Delaunay triangle,
 *                                    and the next step starts from b.
 *
 * A first guess comes from the points next to p in sorted order; then the nodes and leaves of the AABB tree that the
 * disc reaches are searched. Exact predicates decide, so ties are broken as everywhere else.
 */
#ifndef CADT_STARS_WRAP_STEP_H
#define CADT_STARS_WRAP_STEP_H

#include "common/stars/wrapped_star.dev.h"

typedef struct {
  cadt_u32 star[CADT_WRAP_DEGREE]; /* star vertices found, in the order of the search */
  cadt_u32 best[CADT_WRAP_LANES];
  cadt_u32 nodes[CADT_WRAP_NODES], leaves[CADT_WRAP_OPENED * CADT_AABB_FANOUT];
  cadt_u32 node_count, leaf_count; /* how many of each */
  cadt_u32 better[2];              /* lanes that have found a better point, in either round */
  cadt_u32 deferred_count;         /* lanes with a deferred exact test */
  cadt_u32 deferred_many;          /* lanes that would have needed more than one */
  cadt_u32 arc[CADT_WRAP_ROW];     /* the partial star of cadt_wrap_near */
  cadt_u32 key, guess, place;
} cadt_wrap_memory;

typedef struct {
  CADT_TEAM_PTR cadt_wrap_memory* m;
  cadt_aabb_tree in;
  cadt_counters* counters;
  cadt_u32 lanes;         /* lanes of the team that search: the first ones */
  cadt_u32 p;             /* the vertex */
  cadt_u32 leaves_tested; /* leaves whose points were tested */
} cadt_wrapper;

/* One step: the search for the star vertex after `a`, on one side of the line from p to a. */
typedef struct {
  cadt_u32 a;
  cadt_i32 side;
  cadt_u32 best;  /* best point so far, CADT_NONE if there is none */
  cadt_disc disc; /* contains its circle with p and a, on that side: what is outside is not better */
} cadt_wrap_step;

/* What to do with c where the floating-point filter does not decide between b and c: c is better or worse, its exact
 * test is deferred, or there is no room for another deferred test. */
enum { CADT_TEST_BETTER, CADT_TEST_WORSE, CADT_TEST_DEFERRED, CADT_TEST_DROPPED };
#define CADT_MANY_DEFERRED 0xFFFFFFFEu /* in place of the deferred point of a lane: more than one */

/* Each lane can defer one exact test, of the point `deferred`; another point replaces it once it is known to be worse
 * than b. A function of its own, so that its code is out of the way of what all lanes execute. */
CADT_FN_SLOW cadt_u32 cadt_wrap_unsure(CADT_GLOBAL const cadt_point* points, cadt_u32 p, cadt_u32 a, cadt_i32 side,
                                       cadt_u32 b, cadt_u32 c, cadt_u32 may_defer, cadt_u32 deferred,
                                       cadt_counters* counters) {
  const cadt_point first = points[side > 0 ? p : a], second = points[side > 0 ? a : p];
  double most;
  if (!may_defer)
    return cadt_incircle(first, second, points[b], points[c], counters) > 0 ? CADT_TEST_BETTER : CADT_TEST_WORSE;
  if (deferred == CADT_NONE) return CADT_TEST_DEFERRED;
  if (deferred == CADT_MANY_DEFERRED) return CADT_TEST_DROPPED;
  return cadt_incircle_filter(first, second, points[b], points[deferred], &most) < 0 ? CADT_TEST_DEFERRED
                                                                                     : CADT_TEST_DROPPED;
}

/* Each lane proposes a point and its key, or CADT_NONE for both. Returns the point with the least key, or CADT_NONE if
 * that is not certainly on that side. All lanes call it. \pre key and guess in the team's memory are CADT_NONE,
 * synchronised */
CADT_FN cadt_u32 cadt_wrap_agree(const cadt_wrapper* w, cadt_u32 a, cadt_i32 side, cadt_u32 key, cadt_u32 guess) {
  cadt_team_least(&w->m->key, key);
  CADT_TEAM_SYNC();
  /* The comparison must differ from the one before the barrier: PoCL 3.1 takes the first lane's answer to a repeated
   * one for that of all lanes. */
  if (key == w->m->key && guess != CADT_NONE &&
      cadt_orientation(w->in.points[w->p], w->in.points[a], w->in.points[guess], w->counters) == side)
    cadt_team_min(&w->m->guess, guess);
  CADT_TEAM_SYNC();
  return w->m->guess;
}

/* A likely star vertex among `count` points from `first` on, `stride` apart: the one with the least cotangent of the
 * angle at which it sees p and a. CADT_NONE if none is on that side. */
CADT_FN cadt_u32 cadt_wrap_guess(const cadt_wrapper* w, cadt_u32 a, cadt_i32 side, cadt_u32 first, cadt_u32 count,
                                 cadt_u32 stride) {
  const cadt_point p = w->in.points[w->p], q = w->in.points[a];
  const double ax = q.x - p.x, ay = q.y - p.y, unit = 1.0 / (ax * ax + ay * ay);
  cadt_u32 key = CADT_NONE, guess = CADT_NONE;
  if (cadt_team_lane == 0u) w->m->key = w->m->guess = CADT_NONE;
  CADT_TEAM_SYNC();
  CADT_TEAM_FOR(j, count) {
    const cadt_u32 i = first + j * stride;
    const cadt_point c = w->in.points[i];
    const double cx = c.x - p.x, cy = c.y - p.y, cross = side > 0 ? ax * cy - ay * cx : ay * cx - ax * cy;
    const float cotangent =
        CADT_CAST(float, (cx * (cx - ax) + cy * (cy - ay)) * unit) * cadt_about_inverse(CADT_CAST(float, cross* unit));
    if (!(cross > 0.0 && cadt_fabsf(cotangent) < 3e38f)) continue; /* p and a as well */
    const cadt_u32 order = cadt_wrap_order(cotangent);
    if (order < key) key = order, guess = i;
  }
  return cadt_wrap_agree(w, a, side, key, guess);
}

/* Lists the nodes from `first` on that the disc reaches; returns how many. */
CADT_FN cadt_u32 cadt_wrap_list(const cadt_wrapper* w, cadt_u32 first, cadt_point p, double ax, double ay, double side,
                                const cadt_disc* disc) {
  CADT_TEAM_SYNC(); /* all lanes have read the last result */
  if (cadt_team_lane == 0u) w->m->node_count = 0u;
  CADT_TEAM_SYNC();
  CADT_TEAM_FOR(j, cadt_min_u32(CADT_WRAP_NODES, w->in.node_count - first)) {
    if (cadt_aabb_matters(w->in.nodes[first + j], p, ax, ay, side, disc))
      w->m->nodes[cadt_team_add(&w->m->node_count, 1u)] = first + j;
  }
  CADT_TEAM_SYNC();
  return w->m->node_count;
}

CADT_FN void cadt_wrap_set_best(const cadt_wrapper* w, cadt_wrap_step* t, cadt_u32 best) {
  t->best = best;
  t->disc = cadt_disc_beside(w->in.points[w->p], w->in.points[t->a], w->in.points[best], t->side);
}

/* Whether point i is on that side and may be better than the best. */
CADT_FN cadt_u32 cadt_wrap_reaches(const cadt_wrapper* w, const cadt_wrap_step* t, cadt_u32 i) {
  if (i >= w->in.n || i == w->p || i == t->a || i == t->best) return 0u;
  const cadt_point p = w->in.points[w->p], c = w->in.points[i];
  const double x = c.x - p.x - t->disc.x, y = c.y - p.y - t->disc.y;
  if (x * x + y * y > t->disc.square) return 0u; /* false for NaN */
  return cadt_orientation(p, w->in.points[t->a], c, w->counters) == t->side ? 1u : 0u;
}

/* The better of two points. If the filter does not decide and tests may be deferred, the result may be b: then
 * *deferred is c, or CADT_MANY_DEFERRED. */
CADT_FN cadt_u32 cadt_wrap_compare(const cadt_wrapper* w, const cadt_wrap_step* t, cadt_u32 b, cadt_u32 c,
                                   cadt_u32 may_defer, cadt_u32* deferred) {
  if (c == CADT_NONE || b == c) return b;
  if (b == CADT_NONE) return c;
  CADT_GLOBAL const cadt_point* points = w->in.points;
  double most;
  const cadt_i32 sign = cadt_incircle_filter(points[t->side > 0 ? w->p : t->a], points[t->side > 0 ? t->a : w->p],
                                             points[b], points[c], &most);
  if (sign != 0) return sign > 0 ? c : b;
  const cadt_u32 so = cadt_wrap_unsure(points, w->p, t->a, t->side, b, c, may_defer, *deferred, w->counters);
  if (so == CADT_CAST(cadt_u32, CADT_TEST_DEFERRED)) *deferred = c;
  if (so == CADT_CAST(cadt_u32, CADT_TEST_DROPPED)) *deferred = CADT_MANY_DEFERRED;
  return so == CADT_CAST(cadt_u32, CADT_TEST_BETTER) ? c : b;
}

/* Reduces the points that the lanes have found to the best. All lanes call it. \pre *better is 0 */
CADT_FN void cadt_wrap_reduce(const cadt_wrapper* w, cadt_wrap_step* t, CADT_TEAM_PTR cadt_u32* better, cadt_u32 mine,
                              cadt_u32 may_defer, cadt_u32* deferred) {
  /* the best so far has been compared already */
  if (cadt_team_lane < w->lanes) w->m->best[cadt_team_lane] = mine != t->best ? mine : CADT_NONE;
  if (mine != t->best) cadt_team_add(better, 1u);
  CADT_TEAM_SYNC();
  if (!*better) return;
  for (cadt_u32 width = w->lanes; width > 1u;) {
    const cadt_u32 middle = (width + 1u) / 2u;
    if (cadt_team_lane + middle < width)
      w->m->best[cadt_team_lane] =
          cadt_wrap_compare(w, t, w->m->best[cadt_team_lane], w->m->best[cadt_team_lane + middle], may_defer, deferred);
    width = middle;
    CADT_TEAM_SYNC();
  }
  cadt_wrap_set_best(w, t, w->m->best[0]);
}

/* The best of the points in `leaves` leaves. All other lanes wait for the exact test of one lane. So where leaves are
 * many, exact tests are deferred until the best point by rounded arithmetic is known: its disc has next to none of the
 * undecided points. Then the deferred tests are done or, if a lane had more than one, all points in the disc are
 * tested. Every point skipped is worse than some other point. \pre the counts in the team's memory are 0 */
CADT_FN void cadt_wrap_search(const cadt_wrapper* w, cadt_wrap_step* t, cadt_u32 leaves) {
  cadt_u32 may_defer = leaves > CADT_CAST(cadt_u32, CADT_WRAP_WIDE) ? 1u : 0u;
  cadt_u32 count = leaves * CADT_AABB_LEAF, all = 1u, deferred = CADT_NONE;
  for (cadt_u32 round = 0u; round < 2u && count; ++round) {
    const cadt_u32 own = deferred;
    cadt_u32 mine = t->best;
    deferred = CADT_NONE;
    for (cadt_u32 j = cadt_team_lane; cadt_team_lane < w->lanes && j < count; j += w->lanes) {
      const cadt_u32 i = all ? cadt_wrap_in_leaves(w->m->leaves, j) : own;
      if (cadt_wrap_reaches(w, t, i)) mine = cadt_wrap_compare(w, t, mine, i, may_defer, &deferred);
    }
    cadt_wrap_reduce(w, t, &w->m->better[round], mine, may_defer, &deferred);
    count = 0u;
    if (may_defer) {
      if (deferred == CADT_MANY_DEFERRED)
        cadt_team_add(&w->m->deferred_many, 1u);
      else if (cadt_wrap_reaches(w, t, deferred))
        cadt_team_add(&w->m->deferred_count, 1u);
      CADT_TEAM_SYNC();
      all = w->m->deferred_many ? 1u : 0u;
      if (w->m->deferred_many || w->m->deferred_count) count = all ? leaves * CADT_AABB_LEAF : w->lanes;
      may_defer = 0u;
    }
  }
}

/* The star vertex of p after its star vertex a, counterclockwise (side 1) or clockwise (-1); CADT_NONE if no point is
 * on that side. If a is any other point: the star vertex after a in the star of p among a and the points on that side.
 */
CADT_FN cadt_u32 cadt_wrap_next(cadt_wrapper* w, cadt_u32 a, cadt_i32 side) {
  const cadt_u32 own = w->p / CADT_AABB_LEAF, near = (own ? own - 1u : 0u) * CADT_AABB_LEAF;
  const cadt_u32 first =
      cadt_wrap_guess(w, a, side, near, cadt_min_u32(CADT_WRAP_NEAR * CADT_AABB_LEAF, w->in.n - near), 1u);
  cadt_wrap_step t = {a, side, CADT_NONE, {0.0, 0.0, CADT_CAST(double, CADT_INFINITY)}}; /* no point yet: the plane */
  const cadt_point p = w->in.points[w->p], q = w->in.points[a];
  const double ax = q.x - p.x, ay = q.y - p.y, sign = side > 0 ? 1.0 : -1.0;
  if (first != CADT_NONE) cadt_wrap_set_best(w, &t, first);
  for (cadt_u32 node = 0u; node < w->in.node_count; node += CADT_WRAP_NODES) {
    cadt_u32 nodes = cadt_wrap_list(w, node, p, ax, ay, sign, &t.disc);
    if (node == 0u && nodes > (t.best == CADT_NONE ? 0u : CADT_CAST(cadt_u32, CADT_WRAP_OPENED))) {
      /* a large disc: guess among all points */
      const cadt_u32 guess = cadt_wrap_guess(w, a, side, 0u, w->in.leaf_count, CADT_AABB_LEAF);
      cadt_u32 deferred = CADT_NONE;
      if (guess != CADT_NONE && cadt_wrap_compare(w, &t, t.best, guess, 0u, &deferred) == guess) {
        cadt_wrap_set_best(w, &t, guess);
        nodes = cadt_wrap_list(w, node, p, ax, ay, sign, &t.disc);
      }
    }
    for (cadt_u32 opened = 0u; opened < nodes; opened += CADT_WRAP_OPENED) {
      if (cadt_team_lane == 0u)
        w->m->leaf_count = w->m->better[0] = w->m->better[1] = w->m->deferred_count = w->m->deferred_many = 0u;
      CADT_TEAM_SYNC();
      CADT_TEAM_FOR(j, cadt_min_u32(CADT_WRAP_OPENED, nodes - opened) * CADT_AABB_FANOUT) {
        const cadt_u32 c = w->m->nodes[opened + j / CADT_AABB_FANOUT] * CADT_AABB_FANOUT + j % CADT_AABB_FANOUT;
        if (c < w->in.leaf_count && cadt_aabb_matters(w->in.leaves[c], p, ax, ay, sign, &t.disc))
          w->m->leaves[cadt_team_add(&w->m->leaf_count, 1u)] = c;
      }
      CADT_TEAM_SYNC();
      const cadt_u32 leaves = w->m->leaf_count;
      cadt_wrap_search(w, &t, leaves);
      w->leaves_tested += leaves;
      CADT_TEAM_SYNC();
    }
  }
  CADT_TEAM_SYNC();
  return t.best;
}

#endif
