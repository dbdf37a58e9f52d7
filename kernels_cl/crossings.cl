/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_OTHER
#include "common/constraints/exact_places.dev.h"
#include "common/constraints/segment_pairs.dev.h"
