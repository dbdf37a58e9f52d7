// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 0
#define CADT_TIMED 1
#include "backends/host/kernel_table.ipp"

namespace cadt::host {
const KernelTable timed_kernels = table;
}
