/* SPDX-License-Identifier: Apache-2.0
 *
 * The dialect of the device text: C99 that is OpenCL C, CUDA C++ and host C++ at once. Here are the words in which the
 * other files are written: coordinates, vector accesses, and how work-items share elements. Outside of this folder only
 * schedule_noise.dev.h asks which language compiles it.
 */
#ifndef CADT_PORTABLE_DIALECT_H
#define CADT_PORTABLE_DIALECT_H

#include "common/portable/language.dev.h"

/* Coordinates, and what is computed from them (docs/decisions/0004-exact-integers-and-floats.md). */
#if CADT_FLOAT
typedef float cadt_real;
#define CADT_MANTISSA_BITS 23 /* stored bits */
#define CADT_EXPONENTS CADT_CAST(cadt_u64, 0xFF)
#define CADT_EXPONENT_BIAS 127
#define CADT_SIGN_SHIFT 31
#define cadt_bits_of_real(x) CADT_CAST(cadt_u64, cadt_bits_of_float(x))
/* Devices may take subnormal floats for 0 and turn them into 0, in comparisons too. */
#define CADT_GRADUAL_UNDERFLOW 0
/* \pre -126 <= e <= 127 */
#undef cadt_ldexp
#define cadt_ldexp(x, e) ((x)*cadt_float_of_bits(CADT_CAST(cadt_u32, (e) + CADT_EXPONENT_BIAS) << CADT_MANTISSA_BITS))
#else
typedef double cadt_real;
#define CADT_MANTISSA_BITS 52
#define CADT_EXPONENTS CADT_CAST(cadt_u64, 0x7FF)
#define CADT_EXPONENT_BIAS 1023
#define CADT_SIGN_SHIFT 63
#define cadt_bits_of_real(x) cadt_bits_of_double(x)
#define CADT_GRADUAL_UNDERFLOW 1 /* the self-test checks it */
#endif
#define CADT_EXPONENT_MASK (CADT_EXPONENTS << CADT_MANTISSA_BITS)
#define CADT_HIDDEN_BIT (CADT_CAST(cadt_u64, 1) << CADT_MANTISSA_BITS)

/* Comparisons of coordinates on which a decision depends. */
#if CADT_GRADUAL_UNDERFLOW
#define cadt_less(a, b) ((a) < (b))
#define cadt_same(a, b) ((a) == (b))
#else
/* Integers in the order of the values; -0 is 0. */
CADT_FN cadt_i32 cadt_float_order(cadt_real x) {
  const cadt_u32 bits = cadt_bits_of_float(x);
  const cadt_i32 magnitude = CADT_CAST(cadt_i32, bits & 0x7FFFFFFFu);
  return bits >> 31 ? -magnitude : magnitude;
}
#define cadt_less(a, b) (cadt_float_order(a) < cadt_float_order(b))
#define cadt_same(a, b) (cadt_float_order(a) == cadt_float_order(b))
#endif

typedef struct {
  cadt_real x, y;
} cadt_point;

#define CADT_NONE 0xFFFFFFFFu

/* A point at an address that is a multiple of its size, in one access: two would ask the L2 cache
 * twice for one sector. */
#if defined(CADT_LANG_OPENCL) || defined(CADT_LANG_CUDA)
#if CADT_FLOAT
typedef float2 cadt_real2;
#else
typedef double2 cadt_real2;
#endif
CADT_FN cadt_point cadt_load_point(CADT_GLOBAL const cadt_point* p) {
  const cadt_real2 both = *(CADT_GLOBAL const cadt_real2*)p;
  const cadt_point point = {both.x, both.y};
  return point;
}
#else
CADT_FN cadt_point cadt_load_point(const cadt_point* p) { return *p; }
#endif

#if CADT_FLOAT
#define CADT_NAN cadt_float_of_bits(0x7FC00000u)
#else
#define CADT_NAN cadt_double_of_bits(0x7FF8000000000000ul)
#endif

/* Four words, at an address that is a multiple of 16. \pre nobody changes them meanwhile */
#if defined(CADT_LANG_OPENCL) || defined(CADT_LANG_CUDA)
CADT_FN void cadt_store_four(CADT_GLOBAL cadt_u32* p, cadt_u32 a, cadt_u32 b, cadt_u32 c, cadt_u32 d) {
  uint4 four;
  four.x = a;
  four.y = b;
  four.z = c;
  four.w = d;
  *(CADT_GLOBAL uint4*)p = four;
}
CADT_FN void cadt_load_four(CADT_GLOBAL const cadt_u32* p, cadt_u32* w) {
  const uint4 four = *(CADT_GLOBAL const uint4*)p;
  w[0] = four.x;
  w[1] = four.y;
  w[2] = four.z;
  w[3] = four.w;
}
#else
CADT_FN void cadt_load_four(const cadt_u32* p, cadt_u32* w) { std::memcpy(w, p, 4 * sizeof *w); }
CADT_FN void cadt_store_four(cadt_u32* p, cadt_u32 a, cadt_u32 b, cadt_u32 c, cadt_u32 d) {
  p[0] = a;
  p[1] = b;
  p[2] = c;
  p[3] = d;
}
#endif

/* Before a loop that must not be unrolled. */
#if defined(CADT_LANG_HOST) && defined(__GNUC__) && !defined(__clang__)
#define CADT_ROLLED _Pragma("GCC unroll 1")
#else
#define CADT_ROLLED _Pragma("unroll 1")
#endif

/* One of three values; keeps them in registers where an array would go to memory. */
#define CADT_PICK(k, a, b, c) ((k) == 0u ? (a) : ((k) == 1u ? (b) : (c)))
/* The next and the previous of 0, 1, 2, by a table in a word: no branch. */
#define CADT_NEXT(k) ((0x9u >> (2u * (k))) & 3u)
#define CADT_PREV(k) ((0x12u >> (2u * (k))) & 3u)

CADT_FN cadt_u32 cadt_min_u32(cadt_u32 a, cadt_u32 b) { return a < b ? a : b; }

/* Binary search: moves `low` to the first place below `high` for which `before` is false, or to `high`. `before` is a
 * condition on the place `middle`, true up to some place and false from there on. \pre high < 2^31 */
#define CADT_FIND_FIRST(low, high, middle, before) \
  while (low < high) {                             \
    const cadt_u32 middle = (low + high) / 2u;     \
    if (before)                                    \
      low = middle + 1u;                           \
    else                                           \
      high = middle;                               \
  }
/* Moves `low` to the last place below `high` for which `at_or_before` is true. \pre it is true for `low` */
#define CADT_FIND_LAST(low, high, middle, at_or_before) \
  while (high - low > 1u) {                             \
    const cadt_u32 middle = (low + high) / 2u;          \
    if (at_or_before)                                   \
      low = middle;                                     \
    else                                                \
      high = middle;                                    \
  }

/* The first element of a work-item that takes `size` neighbouring ones. The product may exceed 32 bits: devices round
 * the number of work-items up to whole groups. */
CADT_FN cadt_u32 cadt_begin_of(cadt_u32 item, cadt_u32 size, cadt_u32 count) {
  const cadt_u64 begin = CADT_CAST(cadt_u64, item) * size;
  return begin < count ? CADT_CAST(cadt_u32, begin) : count;
}

/* The elements of part `part` of `parts`, for partial results: chunks of neighbours, or strided. */
#if CADT_CONTIGUOUS
#define CADT_FOR_PART(i, part, parts, count, chunk)                                                        \
  for (cadt_u32 i = cadt_begin_of((part), (chunk), (count)), i##_end = cadt_min_u32(i + (chunk), (count)); \
       i < i##_end; ++i)
#else
#define CADT_FOR_PART(i, part, parts, count, chunk) for (cadt_u32 i = (part); i < (count); i += (parts))
#endif
/* The elements i < count of this work-item. `grain`: the number of neighbouring elements on CPUs. */
#define CADT_FOR(i, count, grain) CADT_FOR_PART(i, cadt_item, cadt_items, count, grain)

/* As CADT_FOR, for work of many steps and branches, in loops that are not over the elements alone: the first element,
 * one behind the last, and the step. Divergent lanes of a warp run one after another, so where there are fewer elements
 * than lanes, `grain` lanes share an element and one of them works. */
#if CADT_CONTIGUOUS
#define CADT_SPREAD_BEGIN(count, grain) cadt_begin_of(cadt_item, (grain), (count))
#define CADT_SPREAD_END(count, grain) cadt_min_u32(CADT_SPREAD_BEGIN(count, grain) + (grain), (count))
#define CADT_SPREAD_STEP(grain) 1u
#else
#define CADT_SPREAD_BEGIN(count, grain) (cadt_item % (grain) ? (count) : cadt_item / (grain))
#define CADT_SPREAD_END(count, grain) (count)
#define CADT_SPREAD_STEP(grain) ((cadt_items - 1u) / (grain) + 1u)
#endif

#endif
