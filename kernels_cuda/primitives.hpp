// SPDX-License-Identifier: Apache-2.0
// Sort and scan by the toolkit's CUB. With null `scratch` both only tell its size.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>

namespace cadt::cuda {

/// One group sorts up to so many keys, in one launch.
constexpr std::uint32_t most_in_group = 8192;

/// Stable radix sort by the lowest `bits` bits. `places`: the values are 0, 1, 2, ..., and are not read; at most
/// most_in_group. `in_other`: whether the result is in the other pair of arrays.
[[nodiscard]] cudaError_t sort_pairs(void* scratch, std::size_t& scratch_bytes, std::uint32_t* keys,
                                     std::uint32_t* values, std::uint32_t* other_keys, std::uint32_t* other_values,
                                     std::uint32_t count, unsigned bits, bool places, cudaStream_t stream,
                                     bool* in_other);

/// Exclusive prefix sum in place.
[[nodiscard]] cudaError_t exclusive_sum(void* scratch, std::size_t& scratch_bytes, std::uint32_t* data,
                                        std::uint32_t count, cudaStream_t stream);

}  // namespace cadt::cuda
