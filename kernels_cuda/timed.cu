// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 0
#define CADT_TIMED 1
#include "kernels_cuda/table.inc"

const void* const* cadt::cuda::timed_kernels() { return table; }
