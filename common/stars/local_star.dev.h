/* SPDX-License-Identifier: Apache-2.0
 *
 * Local stars: one lane computes the star of a vertex p from the points around it, without locks. A star is proven, or
 * its vertex is left to gift wrapping and insertion (docs/stars.md, "Local stars").
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
#include "common/stars/cell_scan.dev.h"
#include "common/stars/star_arithmetic.dev.h"

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
  do {
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
  } while (cadt_cell_scan_next(w, &cells));
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
    do {
      for (cadt_u32 i = 0u; i < CADT_CAST(cadt_u32, CADT_SCAN_POINTS); ++i) {
        const cadt_u32 place = cells.place + i;
        const cadt_vector d = cadt_vector_from(w, at_p, place);
        const float inverse = cadt_scanned_inverse(&cells, place, p, d), ux = d.x * inverse, uy = d.y * inverse;
        for (cadt_u32 k = 0u; k < 4u; ++k)
          best[2u * k + 1u] = cadt_maxf(best[2u * k + 1u], cadt_mark(cadt_about_fma(ex[k], ux, ey[k] * uy), place));
      }
    } while (cadt_cell_scan_next(w, &cells));
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
  do {
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
  } while (cadt_cell_scan_next(w, &cells));
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
    CADT_FIND_FIRST(low, high, centre, cadt_angle_key(m, p, first, start, cadt_star_place(m, centre)) < key);
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
