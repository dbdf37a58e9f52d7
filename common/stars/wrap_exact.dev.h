/* SPDX-License-Identifier: Apache-2.0
 *
 * Stars of few points by gift wrapping: a team for each vertex, without locks and without levels. It finds one
 * neighbour after another: of the points on one side of p and the last neighbour, the one whose circle with both is
 * empty (docs/algorithm.md, "Gift wrapping"). A guess is made among the points next in sorted order; then all points
 * stand in boxes, and boxes in crates, so that those which the circle does not reach are passed over. What decides are
 * the exact predicates, so ties are decided as everywhere else.
 */
#ifndef CADT_STARS_WRAP_EXACT_H
#define CADT_STARS_WRAP_EXACT_H

#include "common/stars/wrapped_star.dev.h"

typedef struct {
  cadt_u32 star[CADT_WRAP_DEGREE]; /* the neighbours found, in the order of the search */
  cadt_u32 best[CADT_WRAP_LANES];
  cadt_u32 nodes[CADT_WRAP_NODES], leaves[CADT_WRAP_OPENED * CADT_AABB_FANOUT];
  cadt_u32 node_count, leaf_count; /* how many of each */
  cadt_u32 better[2];              /* lanes that have found a better neighbour, at first and then */
  cadt_u32 put_off, put_off_many;  /* lanes that have put off an exact test, that could not put off another */
  cadt_u32 arc[CADT_WRAP_ROW];     /* what cadt_wrap_near has found out */
  cadt_u32 key, guess, place;
} cadt_wrap_memory;

typedef struct {
  CADT_TEAM_PTR cadt_wrap_memory* m;
  cadt_aabb_tree in;
  cadt_counters* counters;
  cadt_u32 lanes;  /* of the team that search: the first ones */
  cadt_u32 p;      /* the vertex */
  cadt_u32 looked; /* boxes whose points were looked at */
} cadt_wrapper;

/* The search for the neighbour behind `a`, on one side of the line from p to a. */
typedef struct {
  cadt_u32 a;
  cadt_i32 side;
  cadt_u32 best;  /* the best so far, CADT_NONE if there is none */
  cadt_disc disc; /* what is not in it is not better: it contains its circle with p and a, on that side */
} cadt_wrap_turn;

/* What becomes of c, which rounded numbers do not tell from b: it is better or worse, put off, or one too many. */
enum { CADT_WRAP_BETTER, CADT_WRAP_WORSE, CADT_WRAP_LATER, CADT_WRAP_LOST };
#define CADT_WRAP_MANY 0xFFFFFFFEu /* instead of the point that a lane has put off: more than one */

/* Each lane can put off one exact test, of the point `later`, which another one replaces when that is known to be worse
 * than b. A function of its own: its code must not be in the way of what all lanes do. */
CADT_FN_SLOW cadt_u32 cadt_wrap_unsure(CADT_GLOBAL const cadt_point* points, cadt_u32 p, cadt_u32 a, cadt_i32 side,
                                       cadt_u32 b, cadt_u32 c, cadt_u32 put_off, cadt_u32 later,
                                       cadt_counters* counters) {
  const cadt_point first = points[side > 0 ? p : a], second = points[side > 0 ? a : p];
  double most;
  if (!put_off)
    return cadt_incircle(first, second, points[b], points[c], counters) > 0 ? CADT_WRAP_BETTER : CADT_WRAP_WORSE;
  if (later == CADT_NONE) return CADT_WRAP_LATER;
  if (later == CADT_WRAP_MANY) return CADT_WRAP_LOST;
  return cadt_incircle_filter(first, second, points[b], points[later], &most) < 0 ? CADT_WRAP_LATER : CADT_WRAP_LOST;
}

/* Each lane proposes a point and a key, or CADT_NONE for both: the point with the least key, or CADT_NONE if that is
 * not on that side for certain. All lanes call it. \pre key and guess in the memory of the team are CADT_NONE,
 * synchronised */
CADT_FN cadt_u32 cadt_wrap_agree(const cadt_wrapper* w, cadt_u32 a, cadt_i32 side, cadt_u32 key, cadt_u32 guess) {
  cadt_team_least(&w->m->key, key);
  CADT_TEAM_SYNC();
  /* What is asked before a barrier is asked in another way behind it: PoCL 3.1 takes the first lane's answer for that
   * of all lanes. */
  if (key == w->m->key && guess != CADT_NONE &&
      cadt_orientation(w->in.points[w->p], w->in.points[a], w->in.points[guess], w->counters) == side)
    cadt_team_min(&w->m->guess, guess);
  CADT_TEAM_SYNC();
  return w->m->guess;
}

/* A likely neighbour among `count` points from `first` on, each `stride` further: that with the least cotangent of the
 * angle at which it sees p and a. CADT_NONE if there is none on that side. */
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

/* Lists crates from `first` on that matter; returns how many. */
CADT_FN cadt_u32 cadt_wrap_list(const cadt_wrapper* w, cadt_u32 first, cadt_point p, double ax, double ay, double side,
                                const cadt_disc* disc) {
  CADT_TEAM_SYNC(); /* all have read what the last call returned */
  if (cadt_team_lane == 0u) w->m->node_count = 0u;
  CADT_TEAM_SYNC();
  CADT_TEAM_FOR(j, cadt_min_u32(CADT_WRAP_NODES, w->in.node_count - first)) {
    if (cadt_aabb_matters(w->in.nodes[first + j], p, ax, ay, side, disc))
      w->m->nodes[cadt_team_add(&w->m->node_count, 1u)] = first + j;
  }
  CADT_TEAM_SYNC();
  return w->m->node_count;
}

/* Nothing has been found yet, so every point is in the disc. */
CADT_FN cadt_wrap_turn cadt_wrap_turn_behind(cadt_u32 a, cadt_i32 side) {
  cadt_wrap_turn t;
  t.a = a;
  t.side = side;
  t.best = CADT_NONE;
  t.disc.x = t.disc.y = 0.0;
  t.disc.square = CADT_CAST(double, CADT_INFINITY);
  return t;
}

CADT_FN void cadt_wrap_take(const cadt_wrapper* w, cadt_wrap_turn* t, cadt_u32 best) {
  t->best = best;
  t->disc = cadt_disc_beside(w->in.points[w->p], w->in.points[t->a], w->in.points[best], t->side);
}

/* Whether point i, on that side, may be better than the best. */
CADT_FN cadt_u32 cadt_wrap_reaches(const cadt_wrapper* w, const cadt_wrap_turn* t, cadt_u32 i) {
  if (i >= w->in.n || i == w->p || i == t->a || i == t->best) return 0u;
  const cadt_point p = w->in.points[w->p], c = w->in.points[i];
  const double x = c.x - p.x - t->disc.x, y = c.y - p.y - t->disc.y;
  if (x * x + y * y > t->disc.square) return 0u; /* what is not a number is not */
  return cadt_orientation(p, w->in.points[t->a], c, w->counters) == t->side ? 1u : 0u;
}

/* Which of two points is better. If rounded numbers cannot tell and `put_off`, it may be b: then c is *later, or that
 * is CADT_WRAP_MANY. */
CADT_FN cadt_u32 cadt_wrap_compare(const cadt_wrapper* w, const cadt_wrap_turn* t, cadt_u32 b, cadt_u32 c,
                                   cadt_u32 put_off, cadt_u32* later) {
  if (c == CADT_NONE || b == c) return b;
  if (b == CADT_NONE) return c;
  CADT_GLOBAL const cadt_point* points = w->in.points;
  double most;
  const cadt_i32 sign = cadt_incircle_filter(points[t->side > 0 ? w->p : t->a], points[t->side > 0 ? t->a : w->p],
                                             points[b], points[c], &most);
  if (sign != 0) return sign > 0 ? c : b;
  const cadt_u32 so = cadt_wrap_unsure(points, w->p, t->a, t->side, b, c, put_off, *later, w->counters);
  if (so == CADT_CAST(cadt_u32, CADT_WRAP_LATER)) *later = c;
  if (so == CADT_CAST(cadt_u32, CADT_WRAP_LOST)) *later = CADT_WRAP_MANY;
  return so == CADT_CAST(cadt_u32, CADT_WRAP_BETTER) ? c : b;
}

/* The best of what the lanes have found. All lanes call it. \pre *better is 0 */
CADT_FN void cadt_wrap_settle(const cadt_wrapper* w, cadt_wrap_turn* t, CADT_TEAM_PTR cadt_u32* better, cadt_u32 mine,
                              cadt_u32 put_off, cadt_u32* later) {
  /* the best so far has been compared already */
  if (cadt_team_lane < w->lanes) w->m->best[cadt_team_lane] = mine != t->best ? mine : CADT_NONE;
  if (mine != t->best) cadt_team_add(better, 1u);
  CADT_TEAM_SYNC();
  if (!*better) return;
  for (cadt_u32 width = w->lanes; width > 1u;) {
    const cadt_u32 middle = (width + 1u) / 2u;
    if (cadt_team_lane + middle < width)
      w->m->best[cadt_team_lane] =
          cadt_wrap_compare(w, t, w->m->best[cadt_team_lane], w->m->best[cadt_team_lane + middle], put_off, later);
    width = middle;
    CADT_TEAM_SYNC();
  }
  cadt_wrap_take(w, t, w->m->best[0]);
}

/* The best of the points in `boxes` boxes. For an exact test of one lane all others wait. So where boxes are many,
 * exact tests are put off until there is a best one by rounded numbers: in its disc is next to nothing of what they
 * could not tell. That is what the lanes have put off, or, where that was too much for one, what is there of all
 * points. Other points are worse than some point. \pre the counts in the memory are 0 */
CADT_FN void cadt_wrap_search(const cadt_wrapper* w, cadt_wrap_turn* t, cadt_u32 leaves) {
  cadt_u32 put_off = leaves > CADT_CAST(cadt_u32, CADT_WRAP_WIDE) ? 1u : 0u;
  cadt_u32 count = leaves * CADT_AABB_LEAF, all = 1u, later = CADT_NONE;
  for (cadt_u32 round = 0u; round < 2u && count; ++round) {
    const cadt_u32 own = later;
    cadt_u32 mine = t->best;
    later = CADT_NONE;
    for (cadt_u32 j = cadt_team_lane; cadt_team_lane < w->lanes && j < count; j += w->lanes) {
      const cadt_u32 i = all ? cadt_wrap_in_leaves(w->m->leaves, j) : own;
      if (cadt_wrap_reaches(w, t, i)) mine = cadt_wrap_compare(w, t, mine, i, put_off, &later);
    }
    cadt_wrap_settle(w, t, &w->m->better[round], mine, put_off, &later);
    count = 0u;
    if (put_off) {
      if (later == CADT_WRAP_MANY)
        cadt_team_add(&w->m->put_off_many, 1u);
      else if (cadt_wrap_reaches(w, t, later))
        cadt_team_add(&w->m->put_off, 1u);
      CADT_TEAM_SYNC();
      all = w->m->put_off_many ? 1u : 0u;
      if (w->m->put_off_many || w->m->put_off) count = all ? leaves * CADT_AABB_LEAF : w->lanes;
      put_off = 0u;
    }
  }
}

/* The neighbour of p behind its neighbour a, counterclockwise (side 1) or clockwise (-1); CADT_NONE if no point is on
 * that side. a may be any other point: then the neighbour behind it among the points on that side and a. */
CADT_FN cadt_u32 cadt_wrap_next(cadt_wrapper* w, cadt_u32 a, cadt_i32 side) {
  const cadt_u32 own = w->p / CADT_AABB_LEAF, near = (own ? own - 1u : 0u) * CADT_AABB_LEAF;
  const cadt_u32 first =
      cadt_wrap_guess(w, a, side, near, cadt_min_u32(CADT_WRAP_NEAR * CADT_AABB_LEAF, w->in.n - near), 1u);
  cadt_wrap_turn t = cadt_wrap_turn_behind(a, side);
  const cadt_point p = w->in.points[w->p], q = w->in.points[a];
  const double ax = q.x - p.x, ay = q.y - p.y, sign = side > 0 ? 1.0 : -1.0;
  if (first != CADT_NONE) cadt_wrap_take(w, &t, first);
  for (cadt_u32 node = 0u; node < w->in.node_count; node += CADT_WRAP_NODES) {
    cadt_u32 nodes = cadt_wrap_list(w, node, p, ax, ay, sign, &t.disc);
    if (node == 0u && nodes > (t.best == CADT_NONE ? 0u : CADT_CAST(cadt_u32, CADT_WRAP_OPENED))) {
      /* a large disc: a guess among all */
      const cadt_u32 guess = cadt_wrap_guess(w, a, side, 0u, w->in.leaf_count, CADT_AABB_LEAF);
      cadt_u32 later = CADT_NONE;
      if (guess != CADT_NONE && cadt_wrap_compare(w, &t, t.best, guess, 0u, &later) == guess) {
        cadt_wrap_take(w, &t, guess);
        nodes = cadt_wrap_list(w, node, p, ax, ay, sign, &t.disc);
      }
    }
    for (cadt_u32 opened = 0u; opened < nodes; opened += CADT_WRAP_OPENED) {
      if (cadt_team_lane == 0u)
        w->m->leaf_count = w->m->better[0] = w->m->better[1] = w->m->put_off = w->m->put_off_many = 0u;
      CADT_TEAM_SYNC();
      CADT_TEAM_FOR(j, cadt_min_u32(CADT_WRAP_OPENED, nodes - opened) * CADT_AABB_FANOUT) {
        const cadt_u32 c = w->m->nodes[opened + j / CADT_AABB_FANOUT] * CADT_AABB_FANOUT + j % CADT_AABB_FANOUT;
        if (c < w->in.leaf_count && cadt_aabb_matters(w->in.leaves[c], p, ax, ay, sign, &t.disc))
          w->m->leaves[cadt_team_add(&w->m->leaf_count, 1u)] = c;
      }
      CADT_TEAM_SYNC();
      const cadt_u32 leaves = w->m->leaf_count;
      cadt_wrap_search(w, &t, leaves);
      w->looked += leaves;
      CADT_TEAM_SYNC();
    }
  }
  CADT_TEAM_SYNC();
  return t.best;
}

/* Of the triangles that are proven that behind the neighbour a on that side: its other neighbour of p, or CADT_NONE. */
CADT_FN cadt_u32 cadt_wrap_known(const cadt_wrapper* w, cadt_u32 a, cadt_i32 side) {
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

/* A neighbour of a proven triangle, from which all that are found are neighbours; CADT_NONE if there is none. */
CADT_FN cadt_u32 cadt_wrap_known_one(const cadt_wrapper* w) {
  const cadt_u32 size = w->m->arc[0] >> 1;
  for (cadt_u32 k = 0u; k < size; ++k)
    if (w->m->arc[1u + k] & CADT_WRAP_PROVEN) return w->m->arc[1u + k] & ~CADT_WRAP_PROVEN;
  return CADT_NONE;
}

/* Searches the star of w->p. Its neighbours stand in w->m->link from *begin on, *size of them, counterclockwise if
 * *side is 1, else clockwise. Returns 0 if there is none: all points are on a line, or there are too many neighbours; 1
 * inside of the hull; 2 for a vertex of the hull, from one of its hull edges to the other. */
CADT_FN cadt_u32 cadt_wrap_star(cadt_wrapper* w, cadt_u32* begin, cadt_u32* size, cadt_i32* side) {
  const cadt_u32 known = cadt_wrap_known_one(w), none = CADT_NONE;
  cadt_u32 at = known != none ? known : (w->p ? w->p - 1u : 1u), from_hull = 0u, pass = 0u, outcome = 0u, going = 1u;
  cadt_u32 asked = none; /* whether from this place of the list on all are neighbours */
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
    cadt_u32 next = cadt_wrap_known(w, at, towards), certain = none;
    if (next == none) next = cadt_wrap_next(w, at, towards);
    CADT_TEAM_SYNC();
    cadt_u32 restart = 0u;
    if (asked != none) {
      /* It is a neighbour if it is found from the one behind it as well: their circle is empty on either side. */
      if (next == w->m->star[asked])
        certain = asked;
      else
        ++asked;
    } else if (next != none) {
      /* The first one need not have been a neighbour; from a neighbour on all are, and come again. */
      for (cadt_u32 k = *begin; k < *size && !outcome; ++k)
        if (w->m->star[k] == next) *begin = k, outcome = 1u;
      if (outcome || *size + 1u >= CADT_CAST(cadt_u32, CADT_WRAP_DEGREE)) going = 0u;
      at = next;
    } else if (from_hull) {
      /* Beyond the line p, at there is nothing: an edge of the hull. The star is what lies between it and the other
       * one. */
      outcome = 2u;
      going = 0u;
    } else {
      asked = 0u;
      if (known != none) certain = 0u;
    }
    if (certain == none && asked != none && (asked + 1u >= *size || asked == CADT_CAST(cadt_u32, CADT_WRAP_DOUBTFUL)))
      restart = 1u;
    if (certain != none || restart) at = w->m->star[restart ? *size - 1u : certain];
    /* All have read what is written next. Once for all ways: PoCL 3.1 compiles what is behind a barrier of some ways
     * anew for each of them. */
    CADT_TEAM_SYNC();
    if (certain != none) {
      /* All from that one on are neighbours: turned round, the search goes on from it, which is entered again. */
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
      /* Once more from the last one. If it was found from a neighbour, it is one itself, and the edge one of the hull.
       */
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

/* The stars of the vertices in `todo`: of `count`, which are of sets, or, with `arcs`, those that cadt_wrap_near has
 * left, found[7] of them. Nothing is done where these are nearly all and on the hull, as far as is known: each would
 * have to look at all points. Nor when more than CADT_MOST_HIGH_DEGREE have failed, or the effort is above its bound,
 * `effort` a point and `spare_work_limit`; of sets when one has failed, which states[set] counts, as efforts[set] the
 * effort. */
CADT_TEAM_KERNEL(128, 5, cadt_wrap_stars, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_aabb* leaves,
                 CADT_GLOBAL const cadt_aabb* nodes, cadt_u32 n, CADT_GLOBAL const cadt_u32* todo, cadt_u32 count,
                 CADT_GLOBAL const cadt_u16* arcs, CADT_GLOBAL const cadt_u32* starts, cadt_u32 set_count,
                 CADT_GLOBAL cadt_u32* states, CADT_GLOBAL cadt_u32* work_limits, cadt_u32 work_limit,
                 cadt_u32 spare_work_limit, cadt_u32 grain, cadt_u32 row, CADT_GLOBAL cadt_u32* star_vertices,
                 cadt_u32 link_words, CADT_GLOBAL cadt_u32* begins, CADT_GLOBAL cadt_u32* sizes,
                 CADT_GLOBAL cadt_u32* found) {
  CADT_TEAM_MEMORY cadt_wrap_memory memory;
  const cadt_wrap_sink sink = cadt_wrap_sink_of(n, row, star_vertices, link_words, begins, sizes, found);
  const cadt_u32 hull =
      2u * found[9] > n ? CADT_CAST(cadt_u32, CADT_WRAP_HULL_EXACT) : CADT_CAST(cadt_u32, CADT_WRAP_HULL);
  /* from words that this kernel does not change, so it is the same for all lanes of a team */
  const cadt_u32 crowd = arcs && n > hull && 10u * found[8] > 9u * n ? 1u : 0u;
  const cadt_u32 stars = crowd ? 0u : (arcs ? found[7] : count);
  if (crowd && cadt_item == 0u) cadt_add_relaxed(found + 1, CADT_CAST(cadt_u32, CADT_MOST_HIGH_DEGREE) + 1u);
  cadt_counters counters;
  cadt_counters_clear(&counters);
  cadt_u32 exact_before = 0u;
  CADT_FOR_TEAMS(item, stars, grain) {
    const cadt_u32 v = todo[item], set = starts ? cadt_set_of(starts, set_count, v) : 0u;
    const cadt_wrap_span span = cadt_wrap_span_of(starts, set, n);
    CADT_GLOBAL cadt_u32* failed = starts ? states + set : found + 1;
    CADT_GLOBAL cadt_u32* done = starts ? work_limits + set : found + 2;
    cadt_wrapper w;
    w.m = &memory;
    w.in = cadt_aabb_tree_of(span, points, leaves, nodes);
    w.counters = &counters;
    w.lanes = cadt_min_u32(cadt_team_lanes, CADT_WRAP_LANES);
    w.p = v - span.begin;
    w.looked = 0u;
    const cadt_u32 known = arcs ? arcs[item * CADT_WRAP_ROW] : 0u;
    CADT_TEAM_FOR(k, 1u + (known >> 1)) { memory.arc[k] = k ? arcs[item * CADT_WRAP_ROW + k] : known; }
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
      cadt_add_relaxed(done, w.looked);
      if (!kind) cadt_add_relaxed(failed, starts ? CADT_CAST(cadt_u32, CADT_SET_FAILURE) : 1u);
    }
    cadt_wrap_store(&sink, &memory.place, v, span.begin, memory.star + begin, size, side > 0 ? 1u : 0u, kind);
  }
  cadt_wrap_pass_on(&counters, found);
}

#endif
