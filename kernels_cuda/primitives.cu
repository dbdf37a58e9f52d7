// SPDX-License-Identifier: Apache-2.0
#include "kernels_cuda/primitives.hpp"

#include <cub/block/block_radix_sort.cuh>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>

namespace cadt::cuda {
namespace {

// Few keys: one group sorts all in its own memory, in one launch instead of one for each digit and two before.
constexpr int block_threads = 1024, thread_keys = 8;
static_assert(most_in_group == block_threads * thread_keys);

__global__ void __launch_bounds__(block_threads)
    sort_in_block(std::uint32_t* keys, std::uint32_t* values, std::uint32_t count, int bits, bool places) {
  using Sort = cub::BlockRadixSort<std::uint32_t, block_threads, thread_keys, std::uint32_t>;
  __shared__ typename Sort::TempStorage memory;
  std::uint32_t key[thread_keys], value[thread_keys];
  const std::uint32_t first = threadIdx.x * thread_keys;
  for (int k = 0; k < thread_keys; ++k) {
    const bool here = first + k < count;
    key[k] = here ? keys[first + k] : 0xFFFFFFFFU;  // after all others, since they come last and the sort is stable
    value[k] = here && !places ? values[first + k] : first + k;
  }
  Sort(memory).SortBlockedToStriped(key, value, 0, bits);
  for (int k = 0; k < thread_keys; ++k) {
    const std::uint32_t at = k * block_threads + threadIdx.x;
    if (at >= count) continue;
    keys[at] = key[k];
    values[at] = value[k];
  }
}

}  // namespace

cudaError_t sort_pairs(void* scratch, std::size_t& scratch_bytes, std::uint32_t* keys, std::uint32_t* values,
                       std::uint32_t* other_keys, std::uint32_t* other_values, std::uint32_t count, unsigned bits,
                       bool places, cudaStream_t stream, bool* in_other) {
  if (count <= most_in_group) {
    if (scratch == nullptr) {
      scratch_bytes = 1;
      return cudaSuccess;
    }
    sort_in_block<<<1, block_threads, 0, stream>>>(keys, values, count, static_cast<int>(bits), places);
    if (in_other != nullptr) *in_other = false;
    return cudaGetLastError();
  }
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
