/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_OTHER
#include "common/constraints/domains/domains.dev.h"
#include "common/constraints/insert/few_pieces.dev.h"
#include "common/constraints/insert/find_segments.dev.h"
#include "common/constraints/insert/random_insertion.dev.h"
#include "common/constraints/insert/segment_rings.dev.h"
#include "common/constraints/insert/segment_strides.dev.h"
