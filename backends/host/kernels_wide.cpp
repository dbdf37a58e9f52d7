// SPDX-License-Identifier: Apache-2.0
#define CADT_WIDE 1
#include "backends/host/kernel_table.ipp"

namespace cadt::host {
const KernelTable wide_kernels = table;
}
