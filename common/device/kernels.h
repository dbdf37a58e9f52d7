/* SPDX-License-Identifier: Apache-2.0
 *
 * All kernels. A back end compiles this file; the names are listed in kernel_list.h. The build for floats has those of
 * the strategy `locks`: the star stage, gift wrapping and the verifier have error bounds of their own, for doubles, and
 * what they decide the others decide as well (docs/decisions/0015-float-path.md).
 */
#ifndef CADT_DEVICE_KERNELS_H
#define CADT_DEVICE_KERNELS_H

#include "common/device/lang.h"
#if !CADT_FLOAT
#include "common/device/array_mesh.h"
#endif
#include "common/device/closing.h"
#include "common/device/emit.h"
#include "common/device/flips.h"
#include "common/device/insert.h"
#if !CADT_FLOAT
#include "common/device/join.h"
#endif
#include "common/device/order.h"
#include "common/device/radix.h"
#include "common/device/range.h"
#include "common/device/refine.h"
#include "common/device/scan.h"
#include "common/device/selftest.h"
#if !CADT_FLOAT
#include "common/device/set_insert.h"
#include "common/device/sets.h"
#endif
#include "common/device/signs.h"
#if !CADT_FLOAT
#include "common/device/star.h"
#include "common/device/star_mesh.h"
#endif
#include "common/device/start.h"
#if !CADT_FLOAT
#include "common/device/tiles.h"
#include "common/device/verify.h"
#include "common/device/wrap.h"
#include "common/device/wrap_mesh.h"
#endif

#endif
