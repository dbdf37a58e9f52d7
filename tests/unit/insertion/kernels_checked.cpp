// SPDX-License-Identifier: Apache-2.0
// The host kernels with an assertion at every store to a record: the writer must own it.
#undef NDEBUG
#define CADT_WIDE 0
#define CADT_CHECKED
#include "backends/host/kernel_table.ipp"

namespace cadt::host {
const KernelTable narrow_kernels = table;
}
