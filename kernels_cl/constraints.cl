/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_OTHER
#include "common/constraints/domains.dev.h"
#include "common/constraints/find_segments.dev.h"
#include "common/constraints/segment_cavity.dev.h"
#include "common/constraints/segment_mountain.dev.h"
#include "common/constraints/segment_rings.dev.h"
#include "common/constraints/segment_strides.dev.h"
