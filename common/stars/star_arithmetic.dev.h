/* SPDX-License-Identifier: Apache-2.0
 *
 * Arithmetic of local stars: vectors of a neighbourhood grid in single precision with error bounds, and the predicates
 * of a star, which fall back on exact ones where a bound does not decide.
 */
#ifndef CADT_STARS_STAR_ARITHMETIC_H
#define CADT_STARS_STAR_ARITHMETIC_H

#include "common/predicates/filtered_predicates.dev.h"
#include "common/stars/neighborhood_grid.dev.h"

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
  const cadt_vector v = {*CADT_CAST(volatile CADT_TEAM_PTR const float*, w->x + place),
                         *CADT_CAST(volatile CADT_TEAM_PTR const float*, w->y + place)};
  return v;
}
CADT_FN cadt_vector cadt_vector_from(CADT_TEAM_PTR const cadt_neighborhood* w, cadt_vector from, cadt_u32 to) {
  const cadt_vector d = {w->x[to] - from.x, w->y[to] - from.y};
  return d;
}
CADT_FN cadt_vector cadt_vector_to(CADT_TEAM_PTR const cadt_neighborhood* w, cadt_u32 from, cadt_u32 to) {
  const cadt_vector d = {w->x[to] - w->x[from], w->y[to] - w->y[from]};
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
  const cadt_vector e = {ub.x - ua.x, ub.y - ua.y}, f = {uc.x - ub.x, uc.y - ub.y};
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

#endif
