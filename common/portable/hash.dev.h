/* SPDX-License-Identifier: Apache-2.0
 *
 * The hash of a mesh: a sum over its parts, which does not depend on their order, in two lanes of 64 bits.
 */
#ifndef CADT_PORTABLE_HASH_H
#define CADT_PORTABLE_HASH_H

#include "common/portable/language.dev.h"

typedef struct {
  cadt_u64 high, low;
} cadt_hash;

/* What is hashed, so that no two kinds are mistaken for each other. */
enum {
  CADT_HASH_TRIANGLE = 1,
  CADT_HASH_DUPLICATE = 2,
  CADT_HASH_COUNTS = 3,
  CADT_HASH_DIMENSION = 4,
  CADT_HASH_CONSTRAINED = 5
};

#define CADT_LONG(high, low) (CADT_CAST(cadt_u64, high) << 32 | CADT_CAST(cadt_u64, low))

/* Mixes 64 bits so that every input bit affects every output bit: multiplications by odd constants between shifts. */
CADT_FN cadt_u64 cadt_mix(cadt_u64 x) {
  x ^= x >> 32;
  x *= CADT_LONG(0xd6e8feb8u, 0x6659fd93u);
  x ^= x >> 29;
  x *= CADT_LONG(0x9e3779b9u, 0x7f4a7c15u);
  return x ^ (x >> 32);
}

CADT_FN cadt_u64 cadt_hash_lane(cadt_u64 seed, cadt_u64 a, cadt_u64 b, cadt_u64 c) {
  return cadt_mix(cadt_mix(cadt_mix(seed + a) + b) + c);
}

/* Adds up to three numbers of a kind. */
CADT_FN void cadt_hash_add(cadt_hash* hash, cadt_u32 kind, cadt_u64 a, cadt_u64 b, cadt_u64 c) {
  hash->high += cadt_hash_lane(CADT_LONG(0x243f6a88u, 0x85a308d3u) + kind, a, b, c);
  hash->low += cadt_hash_lane(CADT_LONG(0x13198a2eu, 0x03707344u) ^ (CADT_CAST(cadt_u64, kind) << 32), c, a, b);
}

/* Adds a triangle, whichever of its vertices comes first. */
CADT_FN void cadt_hash_add_triangle(cadt_hash* hash, cadt_u64 a, cadt_u64 b, cadt_u64 c) {
  if (b < a && b < c)
    cadt_hash_add(hash, CADT_HASH_TRIANGLE, b, c, a);
  else if (c < a)
    cadt_hash_add(hash, CADT_HASH_TRIANGLE, c, a, b);
  else
    cadt_hash_add(hash, CADT_HASH_TRIANGLE, a, b, c);
}

#endif
