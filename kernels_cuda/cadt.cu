// SPDX-License-Identifier: Apache-2.0
// Entry file of the CUDA kernels: those of common/device are already CUDA C++. Until the CUDA back end is there, the tests
// compile it with nvcc, or with clang's CUDA front end, so that the dialect stays CUDA.
#include "common/device/kernels.h"

// A kernel of internal linkage is compiled only if something refers to it.
#define CADT_ADDRESS(name) reinterpret_cast<const void*>(&name),
#include "common/device/kernel_list.h"
extern const void* const cadt_cuda_kernels[];
const void* const cadt_cuda_kernels[] = {CADT_KERNEL_LIST(CADT_ADDRESS)};
