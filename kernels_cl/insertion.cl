/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_INSERTION
#include "common/insertion/base_mesh.dev.h"
#include "common/insertion/drop_locks.dev.h"
#include "common/insertion/insert.dev.h"
#include "common/insertion/legality_sweep.dev.h"
#include "common/insertion/legalize.dev.h"
#include "common/insertion/partitioned.dev.h"
#include "common/insertion/seed_triangle.dev.h"
