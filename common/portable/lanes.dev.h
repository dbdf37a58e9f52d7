/* SPDX-License-Identifier: Apache-2.0
 *
 * Loops over floats and words: CADT_LANES neighbours at a time on CPUs, by the vectors of their compilers; one at a
 * time elsewhere. What comparisons give chooses by ?: and is combined by &; cadt_mask makes words of it, all bits or
 * none.
 */
#ifndef CADT_PORTABLE_LANES_H
#define CADT_PORTABLE_LANES_H

#include "common/portable/dialect.dev.h"

#if defined(CADT_LANG_HOST)

#define CADT_LANES 4u
typedef float cadt_lanes __attribute__((vector_size(16)));
typedef cadt_u32 cadt_words __attribute__((vector_size(16)));
typedef cadt_i32 cadt_lane_masks __attribute__((vector_size(16)));

CADT_FN cadt_lanes cadt_load_lanes(const float* p) {
  cadt_lanes x;
  std::memcpy(&x, p, sizeof x);
  return x;
}
CADT_FN cadt_lanes cadt_all_lanes(float x) { return cadt_lanes{x, x, x, x}; }
CADT_FN cadt_words cadt_load_words(const cadt_u32* p) {
  cadt_words x;
  std::memcpy(&x, p, sizeof x);
  return x;
}
CADT_FN void cadt_store_words(cadt_u32* p, cadt_words x) { std::memcpy(p, &x, sizeof x); }
CADT_FN cadt_words cadt_all_words(cadt_u32 x) { return cadt_words{x, x, x, x}; }
#define cadt_mask(x) ((cadt_words)(x))
/* Those below `count` */
CADT_FN cadt_lane_masks cadt_lanes_below(cadt_u32 count) {
  const cadt_i32 n = CADT_CAST(cadt_i32, count);
  return cadt_lane_masks{0, 1, 2, 3} < cadt_lane_masks{n, n, n, n};
}
CADT_FN cadt_lanes cadt_abs_lanes(cadt_lanes x) { return (cadt_lanes)((cadt_words)x & cadt_all_words(0x7FFFFFFFu)); }
CADT_FN cadt_lanes cadt_min_lanes(cadt_lanes a, cadt_lanes b) { return b < a ? b : a; }
CADT_FN float cadt_least_lane(cadt_lanes x) { return cadt_minf(cadt_minf(x[0], x[2]), cadt_minf(x[1], x[3])); }
/* The highest bit of each lane, as bits from bit 0 on. */
CADT_FN cadt_u32 cadt_bits_of_lanes(cadt_words x) {
#if defined(__SSE__)
  return CADT_CAST(cadt_u32, __builtin_ia32_movmskps((cadt_lanes)x));
#else
  return x[0] >> 31 | x[1] >> 31 << 1 | x[2] >> 31 << 2 | x[3] >> 31 << 3;
#endif
}
CADT_FN cadt_u32 cadt_any_word(cadt_words x) { return x[0] | x[1] | x[2] | x[3]; }

#else

#define CADT_LANES 1u
typedef float cadt_lanes;
typedef cadt_u32 cadt_words;

#define cadt_load_lanes(p) (*(p))
#define cadt_all_lanes(x) (x)
#define cadt_load_words(p) (*(p))
#define cadt_store_words(p, x) (*(p) = (x))
#define cadt_all_words(x) (x)
#define cadt_mask(x) ((x) ? 0xFFFFFFFFu : 0u)
#define cadt_lanes_below(count) 1
#define cadt_abs_lanes(x) cadt_fabsf(x)
#define cadt_min_lanes(a, b) cadt_minf(a, b)
#define cadt_least_lane(x) (x)
#define cadt_bits_of_lanes(x) ((x) >> 31)
#define cadt_any_word(x) (x)

#endif

#endif
