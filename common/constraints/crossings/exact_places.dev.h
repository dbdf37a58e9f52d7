/* SPDX-License-Identifier: Apache-2.0
 *
 * Crossings as vertices: where they are, rounded, and which vertices each segment passes in which order; and whether a
 * mesh that was made with the rounded places is right for the exact ones.
 *
 *      a ---- v ---- x ---- y ---- b      the chain of the segment a b: a vertex v lies on it, and it crosses others at
 * x, y
 *
 * Vertices are input points, n of them, and from n on crossings, in the order of their pairs.
 */
#ifndef CADT_CONSTRAINTS_EXACT_PLACES_H
#define CADT_CONSTRAINTS_EXACT_PLACES_H

#include "common/constraints/crossings/segment_pairs.dev.h"

/* ---- sums of two doubles: about 106 bits (T. J. Dekker, "A floating-point technique for extending the available
 * precision", 1971) ---- */
typedef struct {
  double high, low;
} cadt_double2;

CADT_FN cadt_double2 cadt_two_sum(double a, double b) {
  cadt_double2 s;
  s.high = a + b;
  const double other = s.high - a;
  s.low = (a - (s.high - other)) + (b - other);
  return s;
}
CADT_FN cadt_double2 cadt_two_product(double a, double b) {
  const double split = 134217729.0; /* 2^27 + 1 */
  const double p = split * a, q = split * b;
  const double a1 = p - (p - a), b1 = q - (q - b), a2 = a - a1, b2 = b - b1;
  cadt_double2 s;
  s.high = a * b;
  s.low = a2 * b2 - (((s.high - a1 * b1) - a2 * b1) - a1 * b2);
  return s;
}
CADT_FN cadt_double2 cadt_add2(cadt_double2 a, cadt_double2 b) {
  const cadt_double2 s = cadt_two_sum(a.high, b.high), t = cadt_two_sum(a.low, b.low);
  const cadt_double2 u = cadt_two_sum(s.high, s.low + t.high);
  return cadt_two_sum(u.high, u.low + t.low);
}
CADT_FN cadt_double2 cadt_multiply2(cadt_double2 a, cadt_double2 b) {
  const cadt_double2 s = cadt_two_product(a.high, b.high);
  return cadt_two_sum(s.high, s.low + (a.high * b.low + a.low * b.high));
}
CADT_FN cadt_double2 cadt_minus2(cadt_double2 a) {
  const cadt_double2 s = {-a.high, -a.low};
  return s;
}

/* x y' - x' y, and a bound on its error. */
CADT_FN cadt_double2 cadt_cross2(cadt_double2 x, cadt_double2 y, cadt_double2 x2, cadt_double2 y2, double* error) {
  const cadt_double2 p = cadt_multiply2(x, y2), q = cadt_multiply2(x2, y);
  *error = (cadt_fabs(p.high) + cadt_fabs(q.high)) * 1.6e-29; /* 2^-95.7 */
  return cadt_add2(p, cadt_minus2(q));
}

/* The double nearest to from + u q, if it is certain. `error`: of q */
CADT_FN cadt_u32 cadt_round_along(double from, cadt_double2 u, cadt_double2 q, double error, double* rounded) {
  const cadt_double2 start = {from, 0.0};
  const cadt_double2 way = cadt_multiply2(u, q), at = cadt_add2(start, way);
  /* Products that underflow are off by less than the last term. */
  const double bound = 2.0 * (cadt_fabs(u.high) * error) + (cadt_fabs(from) + cadt_fabs(way.high)) * 1.6e-29 + 1e-320;
  const double most = at.high + (at.low + bound), least = at.high + (at.low - bound);
  *rounded = most;
  return most == least ? 1u : 0u;
}

/* Where the lines a b and c d cross, rounded to the nearest doubles. 0: it is not certain which these are.
 * a + u q with q = (c - a) x v / (u x v), u = b - a, v = d - c. */
CADT_FN cadt_u32 cadt_round_crossing(cadt_point a, cadt_point b, cadt_point c, cadt_point d, cadt_point* place) {
  const cadt_double2 ux = cadt_two_sum(b.x, -a.x), uy = cadt_two_sum(b.y, -a.y);
  const cadt_double2 vx = cadt_two_sum(d.x, -c.x), vy = cadt_two_sum(d.y, -c.y);
  const cadt_double2 ex = cadt_two_sum(c.x, -a.x), ey = cadt_two_sum(c.y, -a.y);
  double error_w, error_g;
  const cadt_double2 w = cadt_cross2(ux, uy, vx, vy, &error_w), g = cadt_cross2(ex, ey, vx, vy, &error_g);
  const double size = cadt_fabs(w.high);
  place->x = place->y = 0.0;
  /* Written so that NaN fails. Terms up to 1e150 do not overflow; where w is not small, what underflows is no part of
   * the quotient. */
  const double most = cadt_fabs(a.x) + cadt_fabs(a.y) + cadt_fabs(b.x) + cadt_fabs(b.y) + cadt_fabs(c.x) +
                      cadt_fabs(c.y) + cadt_fabs(d.x) + cadt_fabs(d.y);
  if (!(most < 1e70 && size > 1e-140 && error_w < 1e-3 * size)) return 0u;
  cadt_double2 q = {g.high / w.high, 0.0};
  for (cadt_u32 step = 0u; step < 2u; ++step) {
    const cadt_double2 rest = cadt_add2(g, cadt_minus2(cadt_multiply2(q, w)));
    const cadt_double2 more = {rest.high / w.high, 0.0};
    q = cadt_add2(q, more);
  }
  const double error = 2.0 * ((error_g + cadt_fabs(q.high) * error_w) / size) + cadt_fabs(q.high) * 1.6e-29 + 1e-170;
  return cadt_round_along(a.x, ux, q, error, &place->x) && cadt_round_along(a.y, uy, q, error, &place->y) ? 1u : 0u;
}

/* Behind `point_count` input points, the crossings of pairs of segments between them. Those that are not certain are
 * listed. */
CADT_KERNEL(cadt_place_crossings, CADT_GLOBAL const cadt_u32* segments, CADT_GLOBAL const cadt_u32* ordered,
            cadt_u32 count, cadt_u32 grain, cadt_u32 point_count, CADT_GLOBAL cadt_point* places,
            CADT_GLOBAL cadt_u32* unsure, CADT_GLOBAL cadt_u32* words) {
  CADT_FOR(i, count, grain) {
    cadt_point end[4], place;
    for (cadt_u32 k = 0u; k < 4u; ++k)
      end[k] = cadt_load_point(places + segments[2u * ordered[2u * i + k / 2u] + k % 2u]);
    if (!cadt_round_crossing(end[0], end[1], end[2], end[3], &place))
      unsure[cadt_add_relaxed(words + CADT_PAIRS_UNSURE, 1u)] = i;
    places[point_count + i] = place;
  }
}

/* ---- chains ---- */

/* How many vertices the chain of each segment has; none for a segment of no length. */
CADT_KERNEL(cadt_count_chains, CADT_GLOBAL const cadt_u32* piece_begins, CADT_GLOBAL const cadt_u32* counts,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* chain_begins) {
  if (cadt_item == 0u) chain_begins[count] = 0u;
  CADT_FOR(s, count, grain) {
    const cadt_u32 pieces = piece_begins[s + 1u] - piece_begins[s];
    chain_begins[s] = pieces != 0u ? pieces + counts[s] + 1u : 0u;
  }
}

/* The partners of segments (segment_pairs.dev.h). */
typedef struct {
  CADT_GLOBAL const cadt_u32* ends;
  CADT_GLOBAL const cadt_u32* partners;
  CADT_GLOBAL const cadt_u32* counts;
  CADT_GLOBAL const cadt_u32* owned; /* scanned */
} cadt_partner_lists;
#define CADT_PARTNER_PARAMETERS                                                   \
  CADT_GLOBAL const cadt_u32 *partner_ends, CADT_GLOBAL const cadt_u32 *partners, \
      CADT_GLOBAL const cadt_u32 *partner_counts, CADT_GLOBAL const cadt_u32 *owned
#define CADT_PARTNERS(lists) const cadt_partner_lists lists = {partner_ends, partners, partner_counts, owned}

CADT_FN cadt_u32 cadt_begin_of_partners(const cadt_partner_lists* m, cadt_u32 s) {
  return s == 0u ? 0u : m->ends[s - 1u];
}
/* The number of the crossing of segments s < t. */
CADT_FN cadt_u32 cadt_number_of_pair(const cadt_partner_lists* m, cadt_u32 s, cadt_u32 t) {
  const cadt_u32 begin = cadt_begin_of_partners(m, s), end = begin + m->counts[s];
  const cadt_u32 first = end - (m->owned[s + 1u] - m->owned[s]);
  cadt_u32 low = first, high = end;
  CADT_FIND_FIRST(low, high, middle, m->partners[middle] < t)
  return m->owned[s] + (low - first);
}

/* Writes the chain of each segment, and of each of its vertices the pair with the next one, or with itself at the end.
 * Counts segments with equal places in their chain, whose order is not known. */
CADT_KERNEL(cadt_write_chains, CADT_DIVIDED_PARAMETERS, CADT_PARTNER_PARAMETERS,
            CADT_GLOBAL const cadt_u32* chain_begins, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL const cadt_u32* input_ids, CADT_GLOBAL const cadt_point* places, cadt_u32 point_count,
            CADT_GLOBAL cadt_u32* chains, CADT_GLOBAL cadt_u32* pairs, CADT_GLOBAL cadt_u32* words) {
  CADT_DIVIDED(divided);
  CADT_PARTNERS(lists);
  CADT_FOR(s, count, grain) {
    const cadt_u32 begin = chain_begins[s], end = chain_begins[s + 1u], crossings = lists.counts[s];
    if (begin == end) continue;
    cadt_u32 to = begin, v = 0u;
    for (cadt_u32 p = divided.begins[s]; p < divided.begins[s + 1u]; ++p) {
      v = divided.ends[2u * p];
      chains[to++] = input_ids ? input_ids[v] : v;
      v = divided.ends[2u * p + 1u];
    }
    const cadt_u32 first = cadt_begin_of_partners(&lists, s);
    for (cadt_u32 i = first; i < first + crossings; ++i) {
      const cadt_u32 t = lists.partners[i];
      chains[to++] = point_count + (s < t ? cadt_number_of_pair(&lists, s, t) : cadt_number_of_pair(&lists, t, s));
    }
    chains[to] = input_ids ? input_ids[v] : v;
    if (crossings != 0u) {
      const cadt_point p = cadt_load_point(places + chains[begin]), q = cadt_load_point(places + chains[end - 1u]);
      const cadt_sorting along = {places, p.x < q.x ? 1u : 0u, p.y < q.y ? 1u : 0u};
      cadt_sort_list(chains + begin + 1u, end - begin - 2u, &along);
      cadt_u32 tied = 0u;
      for (cadt_u32 i = begin; i + 1u < end; ++i) tied |= cadt_comes_before(&along, chains[i], chains[i + 1u]) ^ 1u;
      if (tied) cadt_add_relaxed(words + CADT_PAIRS_TIED, 1u);
    }
    for (cadt_u32 i = begin; i < end; ++i) {
      pairs[2u * i] = chains[i];
      pairs[2u * i + 1u] = chains[i + 1u < end ? i + 1u : i];
    }
  }
}

/* ---- the certificate ---- */

/* Rounded coordinates, and how far from them the exact ones may be. */
typedef struct {
  cadt_point at;
  double x_error, y_error;
} cadt_rounded;

CADT_FN cadt_rounded cadt_rounded_of(CADT_GLOBAL const cadt_point* places, cadt_u32 v, cadt_u32 point_count) {
  cadt_rounded place;
  place.at = cadt_load_point(places + v);
  place.x_error = place.y_error = 0.0;
  if (v >= point_count) { /* half a unit in the last place */
    place.x_error = cadt_fabs(place.at.x) * 1.1102230246251565e-16 + 5e-324;
    place.y_error = cadt_fabs(place.at.y) * 1.1102230246251565e-16 + 5e-324;
  }
  return place;
}

CADT_FN double cadt_max(double a, double b) { return a < b ? b : a; }

/* The signs of determinants of places that are off by their errors: 1 or -1 if it is certain, else 0. With X, Y the
 * greatest computed differences and E, F bounds on the errors of exact differences in x and y, a product of a
 * difference in x and one in y is off by X F + Y E + E F, and there are two. Twice that makes up for its own roundings;
 * the first term of the bound is the rounding of the determinant (as the verifier's filters, exact_sign.hpp). */
CADT_FN cadt_i32 cadt_orientation_about(cadt_rounded a, cadt_rounded b, cadt_rounded c) {
  const double ax = a.at.x - c.at.x, ay = a.at.y - c.at.y, bx = b.at.x - c.at.x, by = b.at.y - c.at.y;
  const double X = cadt_max(cadt_fabs(ax), cadt_fabs(bx)), Y = cadt_max(cadt_fabs(ay), cadt_fabs(by));
  if (!(X > 1e-140 && Y > 1e-140 && X < 1e150 && Y < 1e150)) return 0;
  const double E = cadt_max(a.x_error, b.x_error) + c.x_error, F = cadt_max(a.y_error, b.y_error) + c.y_error;
  const double det = ax * by - ay * bx;
  const double bound = 1.8e-15 * (X * Y) + 4.0 * (X * F + Y * E + E * F);
  return det > bound ? 1 : (det < -bound ? -1 : 0);
}

/* d in the circle of the counterclockwise triangle a, b, c. The determinant is a sum of six monomials x^3 y and six x
 * y^3 of differences, each off by 3 X^2 Y E + X^3 F or the same with x and y exchanged, as long as E and F are that
 * small that their squares do not matter. */
CADT_FN cadt_i32 cadt_incircle_about(cadt_rounded a, cadt_rounded b, cadt_rounded c, cadt_rounded d) {
  const double ax = a.at.x - d.at.x, ay = a.at.y - d.at.y, bx = b.at.x - d.at.x, by = b.at.y - d.at.y;
  const double cx = c.at.x - d.at.x, cy = c.at.y - d.at.y;
  const double X = cadt_max(cadt_fabs(ax), cadt_max(cadt_fabs(bx), cadt_fabs(cx)));
  const double Y = cadt_max(cadt_fabs(ay), cadt_max(cadt_fabs(by), cadt_fabs(cy)));
  if (!(X > 1e-65 && Y > 1e-65 && X < 1e75 && Y < 1e75)) return 0;
  const double E = cadt_max(a.x_error, cadt_max(b.x_error, c.x_error)) + d.x_error;
  const double F = cadt_max(a.y_error, cadt_max(b.y_error, c.y_error)) + d.y_error;
  if (!(E < 9e-7 * X && F < 9e-7 * Y)) return 0;
  const double det = (ax * ax + ay * ay) * (bx * cy - cx * by) + (bx * bx + by * by) * (cx * ay - ax * cy) +
                     (cx * cx + cy * cy) * (ax * by - bx * ay);
  const double bound =
      1.5e-14 * (X * Y * (X * X + Y * Y)) + 12.0 * (3.0 * (X * Y) * (X * E + Y * F) + X * X * X * F + Y * Y * Y * E);
  return det > bound ? 1 : (det < -bound ? -1 : 0);
}

/* What is to be examined: CADT_SUSPECT(t, k), edge k of triangle t, or the triangle itself if k is 3. */
#define CADT_SUSPECT(t, k) (4u * (t) + (k))

/* Lists what is not certainly right of a mesh that is right for the rounded places: triangles that are
 * counterclockwise, and edges that are legal or constrained, where a crossing is concerned. Counts all; the first
 * `room` are listed. */
CADT_KERNEL(cadt_certify_places, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* neighbors,
            CADT_GLOBAL const cadt_u32* edge_flags, CADT_GLOBAL const cadt_point* places, cadt_u32 count,
            cadt_u32 grain, cadt_u32 point_count, CADT_GLOBAL cadt_u32* suspects, cadt_u32 room,
            CADT_GLOBAL cadt_u32* words) {
  CADT_FOR(t, count, grain) {
    cadt_u32 v[3], wrong = 0u;
    cadt_rounded at[3];
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      v[k] = vertices[3u * t + k];
      at[k] = cadt_rounded_of(places, v[k], point_count);
    }
    const cadt_u32 moved = v[0] >= point_count || v[1] >= point_count || v[2] >= point_count ? 1u : 0u;
    if (moved && cadt_orientation_about(at[0], at[1], at[2]) != 1) wrong = 8u;
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      const cadt_u32 u = neighbors[3u * t + k];
      if (u == CADT_NONE) { /* crossings lie inside of the hull */
        if (v[CADT_NEXT(k)] >= point_count || v[CADT_PREV(k)] >= point_count) wrong |= 1u << k;
        continue;
      }
      if (u < t || (edge_flags[t] >> k & 1u)) continue;
      cadt_u32 q = CADT_NONE;
      for (cadt_u32 j = 0u; j < 3u; ++j)
        if (neighbors[3u * u + j] == t) q = vertices[3u * u + j];
      if (!moved && q < point_count) continue;
      if (q == CADT_NONE || cadt_incircle_about(at[0], at[1], at[2], cadt_rounded_of(places, q, point_count)) != -1)
        wrong |= 1u << k;
    }
    for (cadt_u32 k = 0u; wrong != 0u && k < 4u; ++k) {
      if (!(wrong >> k & 1u)) continue;
      const cadt_u32 at_list = cadt_add_relaxed(words + CADT_PAIRS_SUSPECTS, 1u);
      if (at_list < room) suspects[at_list] = CADT_SUSPECT(t, k);
    }
  }
}

#endif
