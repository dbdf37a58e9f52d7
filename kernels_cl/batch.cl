/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_BATCH
#include "common/batch/batch.dev.h"
#include "common/batch/batch_insertion.dev.h"
