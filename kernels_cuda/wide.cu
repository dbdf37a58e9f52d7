// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 1
#include "kernels_cuda/table.inc"

const void* const* cadt::cuda::wide_kernels() { return table; }
