// SPDX-License-Identifier: Apache-2.0
// The CUDA kernels with delays and failures (common/overlay/schedule_noise.dev.h), and an assertion at every store to a
// record, which ends the kernel: CUDA refuses all later calls of the process. Linked before the library, this table
// takes the place of the real one.
#define CADT_SCHEDULE_NOISE
#define CADT_CHECKED
#define cadt_assert_owned(owned) \
  do {                           \
    if (!(owned)) __trap();      \
  } while (0)
#include "kernels_cuda/narrow.cu"
