/* SPDX-License-Identifier: Apache-2.0
 *
 * Known answers of the arithmetic that the filters rely on, computed on the actual device from values in memory (a
 * compiler would fold literals). The host compares the bits and refuses the device with the name of the probe that
 * failed (arithmetic.cpp).
 */
#ifndef CADT_SELF_TEST_ARITHMETIC_H
#define CADT_SELF_TEST_ARITHMETIC_H

#include "common/portable/atomics.dev.h"
#include "common/predicates/bigint.dev.h"

/* in: 16 coordinates; out: 8 of them; words: 5, zero at the start but the last, which is CADT_NONE; items: so many
 * work-items count, for the launch may be rounded up */
CADT_KERNEL(cadt_selftest, CADT_GLOBAL const cadt_real* in, CADT_GLOBAL cadt_real* out, CADT_GLOBAL cadt_u32* words,
            cadt_u32 items) {
  if (cadt_item == 0u) {
    /* contraction: a*a+b where the exact product needs 54 bits; fused it is not zero */
    out[0] = in[0] * in[0] + in[1];
    /* Two-Sum: the rounding error of a sum; fast-math folds it to zero */
    cadt_real s = in[2] + in[3], t = s - in[2];
    out[1] = (in[2] - (s - t)) + (in[3] - t);
#if CADT_GRADUAL_UNDERFLOW
    /* gradual underflow of a product and of a difference */
    out[2] = in[4] * in[5];
    out[3] = in[6] - in[7];
#else
    /* subnormal numbers that are copied and compared, not computed with, keep their bits */
    out[2] = in[4];
    out[3] = cadt_less(in[6], in[7]) ? in[6] : in[7];
#endif
    /* rounding to nearest, ties to even: the tie of the sum goes up, that of the product goes down */
    out[4] = in[8] + in[9];
    out[5] = in[10] * in[11];
    /* a quotient that differs from the product with the reciprocal */
    out[6] = in[12] / in[13];
    /* 64 x 64 -> 128 bits, and the bits of a coordinate; floats are repeated in the upper word */
    const cadt_u64 repeat = CADT_FLOAT ? 0x100000001ul : 1ul;
    cadt_i128 p = cadt_mul_i64(CADT_CAST(cadt_i64, cadt_bits_of_real(in[14]) * repeat),
                               -CADT_CAST(cadt_i64, cadt_bits_of_real(in[15]) * repeat));
    out[7] = CADT_CAST(cadt_real, p.high);
    words[0] = CADT_CAST(cadt_u32, p.low);
    words[1] = CADT_CAST(cadt_u32, p.low >> 32);
  }
  if (cadt_item < items) {
    /* every work-item adds one; the one that finds zero makes it seven and doubles it; the last one has the minimum */
    cadt_add_relaxed(words + 2, 1u);
    if (cadt_cas_acq_rel(words + 3, 0u, 7u)) cadt_add_relaxed(words + 3, cadt_load_acquire(words + 3));
    cadt_min_relaxed(words + 4, items - cadt_item + 4u);
  }
}

#endif
