// SPDX-License-Identifier: Apache-2.0
// Addresses of the CUDA kernels in the order of common/portable/kernel_list.h.
#pragma once

namespace cadt::cuda {

const void* const* narrow_kernels();  ///< exponents within 240 binades
const void* const* wide_kernels();    ///< any double
const void* const* timed_kernels();   ///< narrow, with clocks

}  // namespace cadt::cuda
