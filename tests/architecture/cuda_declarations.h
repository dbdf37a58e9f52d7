/* SPDX-License-Identifier: Apache-2.0
 *
 * The few names of CUDA that common/device uses, declared for clang's front end where no CUDA toolkit is installed.
 * Only for checking syntax and types.
 */
#define __global__ __attribute__((global))
#define __device__ __attribute__((device))
#define __host__ __attribute__((host))
#define __noinline__ __attribute__((noinline))
struct uint3 {
  unsigned x, y, z;
};
extern __device__ const uint3 threadIdx, blockIdx, blockDim, gridDim;
__device__ unsigned atomicCAS(unsigned*, unsigned, unsigned);
__device__ unsigned atomicAdd(unsigned*, unsigned);
__device__ unsigned atomicMin(unsigned*, unsigned);
__device__ void __threadfence();
__device__ int __clzll(long long);
__device__ unsigned long long __umul64hi(unsigned long long, unsigned long long);
__device__ long long __double_as_longlong(double);
__device__ double fabs(double);
__device__ double ldexp(double, int);
