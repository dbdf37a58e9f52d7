// SPDX-License-Identifier: Apache-2.0
// The CUDA kernels with schedule noise (common/overlay/schedule_noise.dev.h), and an assertion of ownership at every
// store to a triangle; a failed assertion ends the kernel, and CUDA refuses all later calls of the process. Linked
// before the library, this table replaces the real one.
#define CADT_SCHEDULE_NOISE
#define CADT_CHECKED
#define cadt_assert_owned(owned) \
  do {                           \
    if (!(owned)) __trap();      \
  } while (0)
#include "kernels_cuda/narrow.cu"
