/* SPDX-License-Identifier: Apache-2.0
 *
 * The OpenCL kernels with delays and failures (common/device/perturb.h), and an assertion at every store to a record,
 * which ends the process.
 */
#define CADT_PERTURBED
#define CADT_CHECKED
#define cadt_assert_owned(owned)    \
  do {                              \
    if (!(owned)) __builtin_trap(); \
  } while (0)
#include "kernels_cl/cadt.cl"
