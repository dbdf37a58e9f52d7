/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_OTHER
#include "common/constraints/polygons/polygons.dev.h"
