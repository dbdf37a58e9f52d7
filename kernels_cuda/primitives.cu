// SPDX-License-Identifier: Apache-2.0
#include "kernels_cuda/primitives.hpp"

#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

namespace cadt::cuda {

cudaError_t sort_pairs(void* scratch, std::size_t& scratch_bytes, std::uint32_t* keys, std::uint32_t* values,
                       std::uint32_t* other_keys, std::uint32_t* other_values, std::uint32_t count, unsigned bits,
                       cudaStream_t stream, bool* in_other) {
  cub::DoubleBuffer<std::uint32_t> key_buffers(keys, other_keys), value_buffers(values, other_values);
  const cudaError_t code = cub::DeviceRadixSort::SortPairs(scratch, scratch_bytes, key_buffers, value_buffers, count, 0,
                                                           static_cast<int>(bits), stream);
  if (in_other != nullptr) *in_other = key_buffers.Current() == other_keys;
  return code;
}

cudaError_t exclusive_sum(void* scratch, std::size_t& scratch_bytes, std::uint32_t* data, std::uint32_t count,
                          cudaStream_t stream) {
  return cub::DeviceScan::ExclusiveSum(scratch, scratch_bytes, data, data, count, stream);
}

}  // namespace cadt::cuda
