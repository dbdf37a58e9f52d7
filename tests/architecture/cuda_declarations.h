/* SPDX-License-Identifier: Apache-2.0
 *
 * The few names of CUDA that common/device uses, declared for clang's front end where no CUDA toolkit is installed.
 * Only for checking syntax and types.
 */
#define __global__ __attribute__((global))
#define __device__ __attribute__((device))
#define __host__ __attribute__((host))
#define __noinline__ __attribute__((noinline))
#define __forceinline__ inline __attribute__((always_inline))
#define __shared__ __attribute__((shared))
#define __launch_bounds__(...) __attribute__((launch_bounds(__VA_ARGS__)))
struct uint3 {
  unsigned x, y, z;
};
struct uint2 {
  unsigned x, y;
};
struct uint4 {
  unsigned x, y, z, w;
};
struct double2 {
  double x, y;
};
extern __device__ const uint3 threadIdx, blockIdx, blockDim, gridDim;
__device__ unsigned atomicCAS(unsigned*, unsigned, unsigned);
__device__ unsigned atomicAdd(unsigned*, unsigned);
__device__ unsigned atomicMin(unsigned*, unsigned);
__device__ unsigned __activemask();
__device__ unsigned __reduce_min_sync(unsigned, unsigned);
__device__ unsigned atomicOr(unsigned*, unsigned);
__device__ void __threadfence();
__device__ int __any_sync(unsigned, int);
__device__ void __syncwarp(unsigned);
__device__ double __longlong_as_double(long long);
__device__ int __clzll(long long);
__device__ unsigned long long __umul64hi(unsigned long long, unsigned long long);
__device__ long long __double_as_longlong(double);
__device__ double fabs(double);
__device__ double ldexp(double, int);
__device__ double atan2(double, double);
__device__ double sqrt(double);
__device__ float fabsf(float);
__device__ float fmaxf(float, float);
__device__ float fminf(float, float);
__device__ float __fmaf_rn(float, float, float);
__device__ unsigned __float_as_uint(float);
__device__ float __uint_as_float(unsigned);
__device__ int __popc(unsigned);
__device__ void __threadfence_block();
__device__ void __syncthreads();
#define INFINITY __builtin_inff()
