/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_OTHER
#include "common/self_test/arithmetic.dev.h"
#include "common/self_test/locks.dev.h"
