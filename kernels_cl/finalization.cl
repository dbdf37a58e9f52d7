/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_OTHER
#include "common/finalization/certain.dev.h"
#include "common/finalization/finish.dev.h"
#include "common/finalization/join.dev.h"
#include "common/finalization/uniform_cells.dev.h"
