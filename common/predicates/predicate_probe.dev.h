/* SPDX-License-Identifier: Apache-2.0
 *
 * The predicates by themselves, for points in memory. Tests compare the signs with those of integers of any length, on
 * the device and in the kernel variant that makes the mesh.
 */
#ifndef CADT_PREDICATES_PREDICATE_PROBE_H
#define CADT_PREDICATES_PREDICATE_PROBE_H

#include "common/predicates/filtered_predicates.dev.h"

/* The word of a case: signs plus one take two bits; which stages ran takes one bit each. */
enum {
  CADT_SIGN_ORIENTATION = 0,        /* of a, b, c, by all stages */
  CADT_SIGN_INCIRCLE = 2,           /* of a, b, c and p, by all stages; 0 if a, b, c is not counterclockwise */
  CADT_SIGN_ORIENTED = 4,           /* orientation, exact stage */
  CADT_SIGN_ORIENTED_LONG = 6,      /* the same, by integers of any length */
  CADT_SIGN_INSIDE = 8,             /* incircle determinant, exact stage, of any size */
  CADT_SIGN_INSIDE_SMALL = 10,      /* the same, known to be small */
  CADT_SIGN_INSIDE_LONG = 12,       /* the same, by integers of any length */
  CADT_SIGN_TIE = 14,               /* as if all four were on a circle; 0 if a, b, c is not counterclockwise */
  CADT_SIGN_EXACT_ORIENTATION = 16, /* the filter did not decide */
  CADT_SIGN_EXACT_INCIRCLE,
  CADT_SIGN_TIED
};

CADT_FN cadt_u32 cadt_sign_bits(cadt_i32 sign, cadt_u32 at) { return CADT_CAST(cadt_u32, sign + 1) << at; }

/* points: a, b, c, p of each case; max_det: an upper bound of the magnitude of its incircle determinant. The narrow
 * variant takes coordinates as the driver scales them: multiples of 2^-240 below 1. */
CADT_KERNEL(cadt_predicate_probe, CADT_GLOBAL const cadt_point* points, CADT_GLOBAL const cadt_real* max_det,
            CADT_GLOBAL cadt_u32* words, cadt_u32 cases, cadt_u32 grain) {
  CADT_FOR(i, cases, grain) {
    const cadt_point a = points[4u * i], b = points[4u * i + 1u], c = points[4u * i + 2u], p = points[4u * i + 3u];
    CADT_DECLARE_COUNTERS(counters);
    const cadt_i32 turn = cadt_orientation(a, b, c, &counters);
    cadt_u32 word = cadt_sign_bits(turn, CADT_SIGN_ORIENTATION);
    word |= cadt_sign_bits(turn > 0 ? cadt_incircle(a, b, c, p, &counters) : 0, CADT_SIGN_INCIRCLE);
    word |= cadt_sign_bits(cadt_orientation_exact(a, b, c), CADT_SIGN_ORIENTED);
    word |= cadt_sign_bits(cadt_orientation_limbs(a, b, c), CADT_SIGN_ORIENTED_LONG);
    word |= cadt_sign_bits(cadt_incircle_exact(a, b, c, p, CADT_INFINITY), CADT_SIGN_INSIDE);
    word |= cadt_sign_bits(cadt_incircle_exact(a, b, c, p, max_det[i]), CADT_SIGN_INSIDE_SMALL);
    word |= cadt_sign_bits(cadt_incircle_limbs(a, b, c, p), CADT_SIGN_INSIDE_LONG);
    word |= cadt_sign_bits(turn > 0 ? cadt_tie(a, b, c, p) : 0, CADT_SIGN_TIE);
    if (counters.count[CADT_COUNT_EXACT_ORIENTATIONS]) word |= 1u << CADT_SIGN_EXACT_ORIENTATION;
    if (counters.count[CADT_COUNT_EXACT_INCIRCLES]) word |= 1u << CADT_SIGN_EXACT_INCIRCLE;
    if (counters.count[CADT_COUNT_TIES]) word |= 1u << CADT_SIGN_TIED;
    words[i] = word;
  }
}

#endif
