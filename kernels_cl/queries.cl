/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_OTHER
#include "common/queries/locate_queries.dev.h"
#include "common/queries/nearest.dev.h"
#include "common/queries/rasterize.dev.h"
#include "common/queries/voronoi.dev.h"
