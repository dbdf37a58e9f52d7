// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 0
#include "kernels_cuda/table.inc"

const void* const* cadt::cuda::narrow_kernels() { return table; }
