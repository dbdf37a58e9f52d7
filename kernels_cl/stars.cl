/* SPDX-License-Identifier: Apache-2.0 */
#define CADT_PROGRAM CADT_PROGRAM_STARS
#include "common/stars/assemble.dev.h"
#include "common/stars/assemble_wrapped.dev.h"
#include "common/stars/high_degree.dev.h"
#include "common/stars/stitch.dev.h"
#include "common/stars/tile_stars.dev.h"
#include "common/stars/tiles.dev.h"
#include "common/stars/wrap_exact.dev.h"
#include "common/stars/wrap_fast.dev.h"
