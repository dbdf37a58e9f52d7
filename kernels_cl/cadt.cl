/* SPDX-License-Identifier: Apache-2.0
 *
 * Entry file of the OpenCL back end: the device text is OpenCL C already; GPUs get a sort and a scan of their own
 * besides. The build embeds this file with all its includes in the library (cmake/EmbedKernels.cmake).
 */
#include "common/portable/kernels.dev.h"

#if !CADT_CONTIGUOUS
#include "kernels_cl/primitives.cl"
#endif
