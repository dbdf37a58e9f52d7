/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_OTHER
#include "common/portable/radix_sort.dev.h"
#include "common/portable/scan.dev.h"

/* GPUs have a sort and a scan of their own besides. */
#if !CADT_CONTIGUOUS
#include "kernels_cl/primitives.cl"
#endif
