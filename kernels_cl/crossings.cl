/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_OTHER
#include "common/constraints/crossings/exact_places.dev.h"
#include "common/constraints/crossings/segment_pairs.dev.h"
