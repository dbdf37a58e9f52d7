/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_POINTS
#include "common/points/bounds.dev.h"
#include "common/points/duplicates.dev.h"
#include "common/points/hilbert_keys.dev.h"
#include "common/points/import.dev.h"
#include "common/points/key_refinement.dev.h"
#include "common/points/point_profile.dev.h"
#include "common/points/spatial_sort.dev.h"
