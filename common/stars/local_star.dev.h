/* SPDX-License-Identifier: Apache-2.0
 *
 * Local stars: one lane computes the star of a vertex p from the points around it, without locks. A star is proven, or
 * its vertex is left to gift wrapping and insertion (docs/algorithm.md, "The star stage").
 *
 * In inverted space, u = (q - p) / |q - p|^2, the star vertices of p are the vertices of the convex hull of all u, and
 * incircle is orientation. Near points are far out:
 *
 *       plane                     inverted space
 *                                         n
 *         .     .                     *---*---*        p  at the origin
 *      .    a      .                 /  .      \       *  extreme point in one of eight directions: the octagon
 *             h                   w *     p  .  * e    .  inside of the octagon: not a star vertex
 *    .    p        .                 \   .     /          outside, or too near to the boundary to tell: a candidate
 *         b   g                       *---*---*
 *       .       .                         s
 *
 * 1. The octagon: the extreme points in four directions among the points of the nearest cells, and between two of them
 * the one furthest out. What lies inside of it is no star vertex, and that is most of the neighbourhood grid; what may
 * lie outside is a candidate.
 *
 * 2. The convex hull of the candidates: a Graham scan in the order of their angles.
 *
 * 3. The proof: all circles through p and two consecutive star vertices lie within the cells that were searched.
 *
 * All of this is computed in single precision with error bounds; where a bound does not decide, an exact predicate
 * does, so ties are broken as everywhere else.
 */
#ifndef CADT_STARS_LOCAL_STAR_H
#define CADT_STARS_LOCAL_STAR_H

#include "common/batch/batch.dev.h"
#include "common/portable/sorting_network.dev.h"
#include "common/predicates/filtered_predicates.dev.h"
#include "common/stars/cell_scan.dev.h"

/* Error of a difference of two points of a neighbourhood grid, in cells: coordinates are at most 12 cells from the
 * centre, so they are rounded by at most 2^-21. Before that they are exact to 2^-23: in units of a key grid of at most
 * 2^26 cells an axis, of which none is divided by more than 8. */
#define CADT_NEIGHBORHOOD_ERROR 2e-6f
#define CADT_PLACE_BITS 11u
#define CADT_PLACE_MASK 2047u

typedef struct {
  float x, y;
} cadt_vector;

/* Coordinates of a place, read from memory each time: the compiler would spill a value that lives as long as a star,
 * and reload it in each step of a loop. */
CADT_FN cadt_vector cadt_place_of(CADT_TEAM_PTR const cadt_neighborhood* w, cadt_u32 place) {
  cadt_vector v;
  v.x = *CADT_CAST(volatile CADT_TEAM_PTR const float*, w->x + place);
  v.y = *CADT_CAST(volatile CADT_TEAM_PTR const float*, w->y + place);
  return v;
}
CADT_FN cadt_vector cadt_vector_from(CADT_TEAM_PTR const cadt_neighborhood* w, cadt_vector from, cadt_u32 to) {
  cadt_vector d;
  d.x = w->x[to] - from.x;
  d.y = w->y[to] - from.y;
  return d;
}
CADT_FN cadt_vector cadt_vector_to(CADT_TEAM_PTR const cadt_neighborhood* w, cadt_u32 from, cadt_u32 to) {
  cadt_vector d;
  d.x = w->x[to] - w->x[from];
  d.y = w->y[to] - w->y[from];
  return d;
}
CADT_FN float cadt_square(cadt_vector d) { return d.x * d.x + d.y * d.y; }
CADT_FN float cadt_cross(cadt_vector a, cadt_vector b) { return a.x * b.y - a.y * b.x; }
CADT_FN float cadt_size(cadt_vector a) { return cadt_fabsf(a.x) + cadt_fabsf(a.y); }
CADT_FN float cadt_inverse_square(cadt_vector d) { return cadt_about_inverse(cadt_about_fma(d.x, d.x, d.y * d.y)); }
CADT_FN cadt_vector cadt_invert(cadt_vector d) {
  const float inverse = cadt_inverse_square(d);
  d.x *= inverse;
  d.y *= inverse;
  return d;
}

/* A value with a place in its lowest bits: the maximum of several tells whose it is. */
CADT_FN float cadt_mark(float value, cadt_u32 place) {
  return cadt_float_of_bits((cadt_bits_of_float(value) & ~CADT_PLACE_MASK) | place);
}
CADT_FN cadt_u32 cadt_marked(float value) { return cadt_bits_of_float(value) & CADT_PLACE_MASK; }

/* What a lane needs to compute stars. */
typedef struct {
  CADT_TEAM_PTR cadt_neighborhood* w;
  CADT_GLOBAL const cadt_point* points;
  cadt_counters* counters;
  cadt_u32 candidates; /* most candidates */
} cadt_star_maker;

CADT_FN cadt_u32 cadt_star_place(const cadt_star_maker* m, cadt_u32 k) {
  return m->w->star[k * CADT_STAR_STRIDE + cadt_team_lane];
}
CADT_FN void cadt_set_star_place(const cadt_star_maker* m, cadt_u32 k, cadt_u32 place) {
  m->w->star[k * CADT_STAR_STRIDE + cadt_team_lane] = CADT_CAST(cadt_u16, place);
}

/* Exact tests of points at these positions. Functions of their own, so that their long code is out of the way of what
 * all lanes execute. */
CADT_FN_SLOW cadt_i32 cadt_exact_orientation_in(CADT_GLOBAL const cadt_point* points, cadt_u32 p, cadt_u32 a,
                                                cadt_u32 b, cadt_counters* counters) {
  return cadt_orientation(points[p], points[a], points[b], counters);
}

/* Whether the angle from a to b is certainly between 0 and 180 degrees; the vectors are from p, inverted or not. */
CADT_FN cadt_u32 cadt_star_ordered(cadt_vector ua, cadt_vector ub, float sigma) {
  return cadt_cross(ua, ub) > 4.0f * sigma * cadt_size(ua) * cadt_size(ub) ? 1u : 0u;
}

/* Orientation of p, a, b: 1, 0 or -1. */
CADT_FN cadt_i32 cadt_star_orientation(const cadt_star_maker* m, cadt_u32 p, cadt_u32 a, cadt_u32 b, cadt_vector ua,
                                       cadt_vector ub, float sigma) {
  const float cross = cadt_cross(ua, ub), bound = 4.0f * sigma * cadt_size(ua) * cadt_size(ub);
  if (cross > bound) return 1;
  if (-cross > bound) return -1;
  return cadt_exact_orientation_in(m->points, m->w->at[p], m->w->at[a], m->w->at[b], m->counters);
}

/* Whether the hull keeps its last vertex b when c comes after it; a is the one before b. In rounded arithmetic:
 * CADT_STAR_UNSURE if the error bound does not decide. */
#define CADT_STAR_INVALID 2u
#define CADT_STAR_UNSURE 3u
CADT_FN cadt_u32 cadt_star_keeps(cadt_vector ua, cadt_vector ub, cadt_vector uc, float sigma) {
  cadt_vector e, f;
  e.x = ub.x - ua.x;
  e.y = ub.y - ua.y;
  f.x = uc.x - ub.x;
  f.y = uc.y - ub.y;
  const float largest = cadt_maxf(cadt_maxf(cadt_size(ua), cadt_size(ub)), cadt_size(uc));
  const float cross = cadt_cross(e, f), bound = 4.0f * sigma * largest * (cadt_size(e) + cadt_size(f));
  if (cross > bound) return 1u;
  return -cross > bound ? 0u : CADT_STAR_UNSURE;
}

/* The same exactly. CADT_STAR_INVALID: a and b are not in order around p; `ordered`: they are known to be. */
CADT_FN_SLOW cadt_u32 cadt_keeps_exactly(CADT_GLOBAL const cadt_point* points, cadt_u32 p, cadt_u32 a, cadt_u32 b,
                                         cadt_u32 c, cadt_u32 ordered, cadt_counters* counters) {
  const cadt_point P = points[p], A = points[a], B = points[b];
  if (!ordered && cadt_orientation(P, A, B, counters) <= 0) return CADT_STAR_INVALID;
  return cadt_incircle(P, A, B, points[c], counters) < 0 ? 1u : 0u;
}

/* For the last two of `size` hull vertices. */
CADT_FN cadt_u32 cadt_star_keeps_exactly(const cadt_star_maker* m, cadt_u32 p, cadt_u32 size, cadt_u32 c,
                                         cadt_vector ua, cadt_vector ub, float sigma) {
  CADT_TEAM_PTR const cadt_u32* at = m->w->at;
  return cadt_keeps_exactly(m->points, at[p], at[cadt_star_place(m, size - 2u)], at[cadt_star_place(m, size - 1u)],
                            at[c], cadt_star_ordered(ua, ub, sigma), m->counters);
}

/* Sort key of a candidate: its angle from that of `first` on, and its place. */
CADT_FN cadt_u32 cadt_angle_key(const cadt_star_maker* m, cadt_u32 p, cadt_u32 first, cadt_vector start,
                                cadt_u32 place) {
  const cadt_vector d = cadt_vector_to(m->w, p, place);
  const float cross = cadt_cross(start, d), dot = start.x * d.x + start.y * d.y;
  const float t = cross * cadt_about_inverse(cadt_fabsf(cross) + cadt_fabsf(dot));
  const float angle = dot >= 0.0f ? (cross >= 0.0f ? t : 4.0f + t) : 2.0f - t;
  return place == first ? place : (CADT_CAST(cadt_u32, angle * 524280.0f) << CADT_PLACE_BITS) | place;
}

/* Inverse square of the distance d of the point at `place` from p; NaN if the place is not in the row of the scan, or
 * is p itself: a maximum with NaN is the other value. */
CADT_FN float cadt_scanned_inverse(const cadt_cell_scan* s, cadt_u32 place, cadt_u32 p, cadt_vector d) {
  const float inverse = cadt_inverse_square(d);
  return place < s->end && place != p ? inverse : cadt_float_of_bits(0x7FFFFFFFu);
}

/* Computes the star of the point at place p in cell (x, y) from the cells up to `reach` away, which must be in the
 * grid; `near` cells are searched for the octagon, at most `most_cells` for the candidates. Returns the number of star
 * vertices, which stand counterclockwise in w->star, or 0 if there is no proof. */
CADT_FN cadt_u32 cadt_make_star(const cadt_star_maker* m, cadt_u32 p, cadt_u32 x, cadt_u32 y, cadt_u32 near,
                                cadt_u32 reach, cadt_u32 most_cells) {
  CADT_TEAM_PTR cadt_neighborhood* w = m->w;
  const float least = -3e38f;
  float best[8];        /* by angle: east, north-east, north, ... */
  float nearest = 0.0f; /* 1 / distance^2 */
  for (cadt_u32 k = 0u; k < 8u; ++k) best[k] = least;
  cadt_vector at_p = cadt_place_of(w, p);
  cadt_cell_scan cells = cadt_scan_around(w, x, y, near);
  cadt_u32 more = 1u;
  while (more) {
    for (cadt_u32 i = 0u; i < CADT_CAST(cadt_u32, CADT_SCAN_POINTS); ++i) {
      const cadt_u32 place = cells.place + i;
      const cadt_vector d = cadt_vector_from(w, at_p, place);
      const float inverse = cadt_scanned_inverse(&cells, place, p, d);
      const float ux = cadt_mark(d.x * inverse, place), uy = cadt_mark(d.y * inverse, place);
      nearest = cadt_maxf(nearest, inverse);
      best[0] = cadt_maxf(best[0], ux);
      best[2] = cadt_maxf(best[2], uy);
      best[4] = cadt_maxf(best[4], -ux);
      best[6] = cadt_maxf(best[6], -uy);
    }
    more = cadt_cell_scan_next(w, &cells);
  }
  if (!(nearest > 0.0f && nearest < 1e7f)) return 0u; /* no point, or too near for single precision */
  /* Relative error of a difference, and of its inverse. Points further away than a cell have smaller ones. */
  const float rho = CADT_NEIGHBORHOOD_ERROR * cadt_about_sqrt(cadt_maxf(nearest, 1.0f)), sigma = 3.0f * rho + 1e-6f;

  /* Between two of the four extreme points: the point furthest out from the line through them. */
  {
    float ex[4], ey[4];
    for (cadt_u32 k = 0u; k < 4u; ++k) {
      const cadt_u32 a = cadt_marked(best[2u * k]), b = cadt_marked(best[(2u * k + 2u) & 7u]);
      const cadt_vector ua = cadt_invert(cadt_vector_to(w, p, a)), ub = cadt_invert(cadt_vector_to(w, p, b));
      ex[k] = a == b ? ua.x : ub.y - ua.y;
      ey[k] = a == b ? ua.y : ua.x - ub.x;
    }
    at_p = cadt_place_of(w, p);
    cells = cadt_scan_around(w, x, y, near);
    more = 1u;
    while (more) {
      for (cadt_u32 i = 0u; i < CADT_CAST(cadt_u32, CADT_SCAN_POINTS); ++i) {
        const cadt_u32 place = cells.place + i;
        const cadt_vector d = cadt_vector_from(w, at_p, place);
        const float inverse = cadt_scanned_inverse(&cells, place, p, d), ux = d.x * inverse, uy = d.y * inverse;
        for (cadt_u32 k = 0u; k < 4u; ++k)
          best[2u * k + 1u] = cadt_maxf(best[2u * k + 1u], cadt_mark(cadt_about_fma(ex[k], ux, ey[k] * uy), place));
      }
      more = cadt_cell_scan_next(w, &cells);
    }
  }

  /* Half-planes n . u < 1, that is n . d < d . d, of a polygon through some of the eight points. */
  float nx[8], ny[8], error = 0.0f;
  float west = 0.0f, east = 0.0f, south = 0.0f, north = 0.0f; /* twice the extent of what is not inside */
  cadt_u32 first = p;
  {
    float largest = 0.0f;
    const cadt_u32 start = cadt_marked(best[0]);
    cadt_u32 place = start;
    cadt_vector u = cadt_invert(cadt_vector_to(w, p, place));
    float longest = cadt_square(u);
    first = place;
    for (cadt_u32 k = 0u; k < 8u; ++k) {
      const cadt_u32 next = cadt_marked(best[(k + 1u) & 7u]);
      const cadt_vector v = cadt_invert(cadt_vector_to(w, p, next));
      nx[k] = ny[k] = 0.0f;
      if (next == place) continue;
      const float cross = cadt_cross(u, v), lengths = cadt_square(u) * cadt_square(v);
      if (cadt_square(v) > longest) longest = cadt_square(v), first = next;
      if (!(cross > 0.0f && cross * cross > 0.0025f * lengths)) { /* not clearly to the left */
        /* Without this vertex the polygon is smaller, which is valid as well, but it must go round p. */
        if (u.x * v.x + u.y * v.y <= 0.0f || next == start) return 0u;
        continue;
      }
      const float inverse = cadt_about_inverse(cross);
      nx[k] = (v.y - u.y) * inverse;
      ny[k] = (u.x - v.x) * inverse;
      const float square = nx[k] * nx[k] + ny[k] * ny[k], length = cadt_about_sqrt(square) * 1.00001f;
      largest = cadt_maxf(largest, square * (lengths * inverse * inverse));
      west = cadt_maxf(west, length - nx[k]);
      east = cadt_maxf(east, length + nx[k]);
      south = cadt_maxf(south, length - ny[k]);
      north = cadt_maxf(north, length + ny[k]);
      place = next;
      u = v;
    }
    if (place != start) return 0u;
    error = 8.0f * sigma * cadt_about_sqrt(largest);
  }

  const float shrink = 1.0f - 4.0f * rho - 1e-6f;
  /* What is not inside a half-plane lies in the disc of diameter n, so all candidates are in these cells. A point that
   * is outside of all discs by 1e-5 of their radius plus 1e-4 fails the test below, whose rounding errors are smaller,
   * so the test is not needed for other cells. */
  const float middle = 0.5f * CADT_CAST(float, w->shape.side), stretch = 0.5f * cadt_about_inverse(shrink);
  at_p = cadt_place_of(w, p);
  const float at_x = at_p.x + middle, at_y = at_p.y + middle, margin = 1.25f * error + 2e-4f;
  const float low_x = CADT_CAST(float, x - reach), high_x = CADT_CAST(float, x + reach);
  const float low_y = CADT_CAST(float, y - reach), high_y = CADT_CAST(float, y + reach);
  const cadt_u32 from_x = CADT_CAST(cadt_u32, cadt_maxf(low_x, at_x - stretch * west - margin));
  const cadt_u32 from_y = CADT_CAST(cadt_u32, cadt_maxf(low_y, at_y - stretch * south - margin));
  const cadt_u32 to_x = CADT_CAST(cadt_u32, cadt_minf(high_x, at_x + stretch * east + margin));
  const cadt_u32 to_y = CADT_CAST(cadt_u32, cadt_minf(high_y, at_y + stretch * north + margin));
  if ((to_x - from_x + 1u) * (to_y - from_y + 1u) > most_cells) return 0u;
  cells = cadt_cell_scan_of(w, from_x, from_y, to_x, to_y);
  cadt_u32 count = 0u;
  more = 1u;
  while (more) {
    for (cadt_u32 i = 0u; i < CADT_CAST(cadt_u32, CADT_SCAN_POINTS); ++i) {
      const cadt_u32 j = cells.place + i, here = j < cells.end ? 1u : 0u;
      const float dx = w->x[j] - at_p.x, dy = w->y[j] - at_p.y;
      float t = cadt_about_fma(nx[0], dx, ny[0] * dy);
      for (cadt_u32 k = 1u; k < 8u; ++k) t = cadt_maxf(t, cadt_about_fma(nx[k], dx, ny[k] * dy));
      /* not p itself */
      if (cadt_about_fma(error, cadt_fabsf(dx) + cadt_fabsf(dy), t) > cadt_about_fma(dx, dx, dy * dy) * shrink &&
          here) {
        cadt_set_star_place(m, count & (2u * CADT_CANDIDATES - 1u), j); /* beyond the limit the star fails anyway */
        ++count;
      }
    }
    more = cadt_cell_scan_next(w, &cells);
  }
  if (count > m->candidates) cadt_team_add(&w->overfull, 1u);
  if (count < 3u || count > m->candidates) return 0u;

  /* Sort by the angle from `first` on: 21 bits of it, then the place. */
  const cadt_vector start = cadt_vector_to(w, p, first);
  {
    cadt_u32 key[CADT_CANDIDATES];
    for (cadt_u32 k = 0u; k < CADT_CAST(cadt_u32, CADT_CANDIDATES); ++k) { /* no branch: lanes stay converged */
      const cadt_u32 made = cadt_angle_key(m, p, first, start, cadt_star_place(m, cadt_min_u32(k, count - 1u)));
      key[k] = k < count ? made : CADT_NONE;
    }
    CADT_SORT_KEYS;
    for (cadt_u32 k = 0u; k < CADT_CAST(cadt_u32, CADT_CANDIDATES); ++k)
      if (k < count) cadt_set_star_place(m, k, key[k] & CADT_PLACE_MASK);
  }
  for (cadt_u32 k = CADT_CANDIDATES; k < count; ++k) { /* in the second attempt only */
    const cadt_u32 place = cadt_star_place(m, k), key = cadt_angle_key(m, p, first, start, place);
    cadt_u32 low = 0u, high = k;
    while (low < high) {
      const cadt_u32 centre = (low + high) / 2u;
      if (cadt_angle_key(m, p, first, start, cadt_star_place(m, centre)) < key)
        low = centre + 1u;
      else
        high = centre;
    }
    for (cadt_u32 at = k; at > low; --at) cadt_set_star_place(m, at, cadt_star_place(m, at - 1u));
    cadt_set_star_place(m, low, place);
  }
  if (cadt_star_place(m, 0u) != first) return 0u;

  /* The hull: Graham scan, begins and ends with `first`; a point that is no vertex is popped. One test and one load a
   * step, and no exit from the middle, so that the lanes of a warp stay converged. A lane that needs an exact test
   * waits until all lanes do or have finished: then many lanes test at a time. */
  cadt_u32 size = 1u, at = 0u, c = first, going = 1u, proven = 1u, answer = CADT_STAR_UNSURE;
  const cadt_vector us = cadt_invert(start);
  cadt_vector ua = us, ub = us, uc = us; /* of the last two hull vertices and of candidate `at` */
  while (going) {
    cadt_u32 stuck = 0u;
    while (going && !stuck) {
      cadt_u32 keeps = answer;
      if (keeps == CADT_STAR_UNSURE) keeps = size >= 2u ? cadt_star_keeps(ua, ub, uc, sigma) : 1u;
      answer = CADT_STAR_UNSURE;
      stuck = keeps == CADT_STAR_UNSURE ? 1u : 0u;
      if (!stuck) going = keeps != CADT_STAR_INVALID && !(keeps && at == count) ? 1u : 0u;
      if (keeps == CADT_STAR_INVALID) proven = 0u;
      if (going && !stuck) {
        cadt_u32 next;
        if (keeps) {
          if (at > 0u) {
            cadt_set_star_place(m, size, c);
            ++size;
            ua = ub;
            ub = uc;
          }
          ++at;
          next = at < count ? at : 0u;
        } else {
          --size;
          next = size >= 2u ? size - 2u : 0u;
        }
        const cadt_u32 place = cadt_star_place(m, next);
        const cadt_vector u = cadt_invert(cadt_vector_to(w, p, place));
        if (keeps) {
          /* the order of the candidates' angles must be certain */
          if (cadt_star_orientation(m, p, c, place, ub, u, sigma) <= 0) going = proven = 0u;
          c = place;
          uc = u;
        } else {
          ub = ua;
          ua = u;
        }
      }
    }
    if (going) answer = cadt_star_keeps_exactly(m, p, size, c, ua, ub, sigma);
  }
  if (size < 3u || size > CADT_CAST(cadt_u32, CADT_STAR_DEGREE)) proven = 0u;
  if (proven) { /* `first` must be a hull vertex too */
    const cadt_u32 second = cadt_star_place(m, 1u);
    cadt_set_star_place(m, size, first);
    cadt_u32 keeps = cadt_star_keeps(ub, us, cadt_invert(cadt_vector_to(w, p, second)), sigma);
    if (keeps == CADT_STAR_UNSURE) keeps = cadt_star_keeps_exactly(m, p, size + 1u, second, ub, us, sigma);
    if (keeps != 1u) proven = 0u;
  }

  /* The proof: each circle lies within the searched cells, or beyond the edge of the key grid, where there are no
   * points. */
  const float far = 1e30f, px = w->x[p], py = w->y[p];
  const cadt_i32 first_x = CADT_CAST(cadt_i32, x - reach), first_y = CADT_CAST(cadt_i32, y - reach);
  const cadt_i32 end_x = CADT_CAST(cadt_i32, x + reach) + 1, end_y = CADT_CAST(cadt_i32, y + reach) + 1;
  const float right = end_x >= w->shape.right ? far : CADT_CAST(float, end_x) - middle - px;
  const float left = first_x <= w->shape.left ? far : px + middle - CADT_CAST(float, first_x);
  const float top = end_y >= w->shape.top ? far : CADT_CAST(float, end_y) - middle - py;
  const float bottom = first_y <= w->shape.bottom ? far : py + middle - CADT_CAST(float, first_y);
  cadt_vector u = us;
  for (cadt_u32 k = 1u; k <= size && proven; ++k) {
    const cadt_u32 b = k < size ? cadt_star_place(m, k) : first;
    const cadt_vector v = cadt_invert(cadt_vector_to(w, p, b));
    const float cross = cadt_cross(u, v), lengths = cadt_size(u) * cadt_size(v);
    const float inverse = cadt_about_inverse(cross);
    const float cx = 0.5f * (v.y - u.y) * inverse, cy = 0.5f * (u.x - v.x) * inverse;
    const float reached = cadt_about_sqrt(cx * cx + cy * cy) * (1.0f + 16.0f * sigma * lengths * inverse) + 1e-4f;
    /* the angle at p is certainly positive, and the bound above holds */
    if (!(cross > 100.0f * sigma * lengths && cx + reached <= right && reached - cx <= left && cy + reached <= top &&
          reached - cy <= bottom))
      proven = 0u;
    u = v;
  }
  return proven ? size : 0u;
}

#endif
