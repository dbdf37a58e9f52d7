// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 0
#include "backends/host/kernel_table.ipp"

namespace cadt::host {
const KernelTable narrow_kernels = table;
}
