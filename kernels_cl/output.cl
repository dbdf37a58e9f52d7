/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_OTHER
#include "common/output/canonical_order.dev.h"
#include "common/output/hull.dev.h"
#include "common/output/renumber.dev.h"
