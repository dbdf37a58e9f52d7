/* SPDX-License-Identifier: Apache-2.0
 *
 * How the programs begin: with schedule noise (common/overlay/schedule_noise.dev.h), and an assertion of ownership at
 * every store to a triangle; a failed assertion ends the process.
 */
#define CADT_SCHEDULE_NOISE
#define CADT_CHECKED
#define cadt_assert_owned(owned)    \
  do {                              \
    if (!(owned)) __builtin_trap(); \
  } while (0)
