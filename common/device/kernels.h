/* SPDX-License-Identifier: Apache-2.0
 *
 * All kernels. A back end compiles this file; the names are listed in kernel_list.h. The build for floats has those of
 * the strategy `locks`: the star stage, gift wrapping and the verifier have error bounds of their own, for doubles, and
 * what they decide the others decide as well (docs/decisions/0015-float-path.md).
 */
#ifndef CADT_DEVICE_KERNELS_H
#define CADT_DEVICE_KERNELS_H

#include "common/device/lang.h"
/* The text for OpenCL compilers has each file once, where it is included first: not within a condition that is wider
 * than its own. */
#include "common/device/array_mesh.h"
#include "common/device/cavity.h"
#include "common/device/closing.h"
#include "common/device/emit.h"
#include "common/device/flips.h"
#include "common/device/insert.h"
#include "common/device/order.h"
#include "common/device/radix.h"
#include "common/device/range.h"
#include "common/device/refine.h"
#include "common/device/scan.h"
#include "common/device/selftest.h"
#include "common/device/signs.h"
#include "common/device/start.h"
#if !CADT_FLOAT
#include "common/device/join.h"
#include "common/device/set_insert.h"
#include "common/device/sets.h"
#include "common/device/star_mesh.h"
#include "common/device/star_tiles.h"
#include "common/device/tiles.h"
#include "common/device/verify.h"
#include "common/device/wrap.h"
#include "common/device/wrap_hubs.h"
#include "common/device/wrap_mesh.h"
#include "common/device/wrap_near.h"
#endif

#endif
