// SPDX-License-Identifier: Apache-2.0
// The host kernels with the locks removed. Linked before the library, this table takes the place of the real one.
#define CADT_WIDE 0
#define CADT_TEST_NO_LOCKS
#include "backends/host/kernel_table.ipp"

namespace cadt::host {
const KernelTable narrow_kernels = table;
}
