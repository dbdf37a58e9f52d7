/* SPDX-License-Identifier: Apache-2.0
 *
 * What each language calls the types, qualifiers and functions of the device text. This file finds out which language
 * compiles it: OpenCL C, CUDA C++ or host C++.
 *
 * A compilation may set: CADT_WIDE (0: exponents of all coordinates within 240 binades, 1: any double), CADT_FLOAT (1:
 * coordinates are floats, any of them, and there are no doubles; this variant is wide), CADT_CONTIGUOUS (1: a work-item
 * takes neighbouring elements, right for CPUs; 0: strided, right for GPUs), CADT_RADIX_BITS (digit of the radix sort),
 * CADT_TIMED (1: timers, counters.dev.h), CADT_PROGRAM (the kernels of one stage alone). For tests only: CADT_CHECKED
 * (whoever stores to a triangle must own it, locked_mesh.dev.h), CADT_SCHEDULE_NOISE (delays and failures,
 * schedule_noise.dev.h), CADT_TEST_NO_LOCKS (a control: locks are not taken).
 */
#ifndef CADT_PORTABLE_LANGUAGE_H
#define CADT_PORTABLE_LANGUAGE_H

#ifndef CADT_FLOAT
#define CADT_FLOAT 0
#endif
#if CADT_FLOAT
#undef CADT_WIDE
#define CADT_WIDE 1
#endif
#ifndef CADT_WIDE
#define CADT_WIDE 0
#endif
#ifndef CADT_CONTIGUOUS
#define CADT_CONTIGUOUS 1
#endif
#ifndef CADT_TIMED
#define CADT_TIMED 0
#endif
#ifndef CADT_RADIX_BITS
#define CADT_RADIX_BITS 8
#endif

/* Stages of kernel_list.h. A file that other stages include for its functions asks CADT_BUILDS before its kernels. */
#define CADT_PROGRAM_POINTS 1
#define CADT_PROGRAM_INSERTION 2
#define CADT_PROGRAM_STARS 3
#define CADT_PROGRAM_BATCH 4
#define CADT_PROGRAM_CERTIFY 5
#define CADT_PROGRAM_OTHER 6
#ifdef CADT_PROGRAM
#define CADT_BUILDS(stage) (CADT_PROGRAM == CADT_PROGRAM_##stage)
#else
#define CADT_BUILDS(stage) 1
#endif

#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)
#define CADT_LANG_OPENCL 1
#elif defined(__CUDACC__) || defined(__CUDA__)
#define CADT_LANG_CUDA 1
#else
#define CADT_LANG_HOST 1
#endif

/* ---- OpenCL C ---- */
#if defined(CADT_LANG_OPENCL)

#if CADT_FLOAT
/* Any use is a compile-time error, even on devices that have doubles. Literals are floats by a compiler option
 * (backends/opencl/program.cpp). */
#define double cadt_there_are_no_doubles_on_this_device
#define double2 cadt_there_are_no_doubles_on_this_device
#elif defined(__OPENCL_C_VERSION__) && __OPENCL_C_VERSION__ < 120
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#endif
/* Without this PoCL fuses a*b+c, which voids the error bounds of the filters. */
#pragma OPENCL FP_CONTRACT OFF

typedef ushort cadt_u16;
typedef uint cadt_u32;
typedef int cadt_i32;
typedef ulong cadt_u64;
typedef long cadt_i64;

#define CADT_GLOBAL __global
#define CADT_FN static
#define CADT_FN_SLOW static __attribute__((noinline))
#define CADT_FN_INLINE static __attribute__((always_inline))
/* Groups of a CPU have one work-item: Intel's compiler would spend three quarters of its time on vectors of them. */
#if CADT_CONTIGUOUS && defined(cl_intel_vec_len_hint)
#define CADT_KERNEL(name, ...) __kernel __attribute__((intel_vec_len_hint(1))) void name(__VA_ARGS__)
#else
#define CADT_KERNEL(name, ...) __kernel void name(__VA_ARGS__)
#endif
#define CADT_TEAM_KERNEL(lanes, teams, name, ...) CADT_KERNEL(name, __VA_ARGS__)
#define cadt_item ((cadt_u32)get_global_id(0))
#define cadt_items ((cadt_u32)get_global_size(0))
#define CADT_LOCAL __local
#define CADT_LOCAL_PTR __local
#define cadt_item_of_group ((cadt_u32)get_local_id(0))
#define cadt_group_items ((cadt_u32)get_local_size(0))
#define cadt_group_barrier() barrier(CLK_LOCAL_MEM_FENCE)
#define cadt_group_barrier_all() barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE)

#define cadt_prefetch_to_write(p) ((void)(p))
#define cadt_prefetch_to_read(p) ((void)(p))
#define cadt_bits_of_double(x) as_ulong(x)
#define cadt_double_of_bits(x) as_double(x)
#define cadt_bits_of_float(x) as_uint(x)
#define cadt_float_of_bits(x) as_float(x)
#define cadt_popcount(x) ((cadt_u32)popcount((uint)(x)))
#define cadt_fabsf(x) fabs((float)(x))
#define cadt_maxf(a, b) fmax((float)(a), (float)(b))
#define cadt_minf(a, b) fmin((float)(a), (float)(b))
/* Approximations, for use within an error bound: a * b + c, 1 / x, and the square root of what is not 0. */
#define cadt_about_fma(a, b, c) fma((float)(a), (float)(b), (float)(c))
#define cadt_clz64(x) ((cadt_u32)clz((ulong)(x)))
#define cadt_mulhi_u64(a, b) mul_hi((ulong)(a), (ulong)(b))
#if !defined(__NV_CL_C_VERSION) /* see below */
#define cadt_about_inverse(x) (1.0f / (x))
#define cadt_about_sqrt(x) sqrt((float)(x))
/* A clock of the work-item's processor, for differences; 0 where there is none. */
#if CADT_TIMED && CADT_CONTIGUOUS && defined(__clang__) && defined(__x86_64__)
CADT_FN cadt_u64 cadt_clock(void) { return __builtin_readcyclecounter(); }
#else
CADT_FN cadt_u64 cadt_clock(void) { return 0; }
#endif
#endif

/* ---- CUDA C++ ---- */
#elif defined(CADT_LANG_CUDA)

typedef unsigned short cadt_u16;
typedef unsigned int cadt_u32;
typedef int cadt_i32;
typedef unsigned long long cadt_u64;
typedef long long cadt_i64;

#define CADT_GLOBAL
#define CADT_FN static __device__ inline
#define CADT_FN_SLOW static __device__ __noinline__
#define CADT_FN_INLINE static __device__ __forceinline__
#define CADT_KERNEL(name, ...) static __global__ void name(__VA_ARGS__)
/* The compiler limits registers so that so many teams run on a multiprocessor at the same time, as far as it takes so
 * many teams and threads. */
#if !defined(__CUDA_ARCH__) || __CUDA_ARCH__ == 800 || (__CUDA_ARCH__ >= 900 && __CUDA_ARCH__ < 1200)
#define CADT_MAX_THREADS 2048
#define CADT_MAX_TEAMS 32
#elif __CUDA_ARCH__ < 800
#define CADT_MAX_THREADS 1024
#define CADT_MAX_TEAMS 16
#else
#define CADT_MAX_THREADS 1536
#define CADT_MAX_TEAMS (__CUDA_ARCH__ < 890 ? 16 : 24)
#endif
#define CADT_LESSER_OF(most, teams) ((teams) > (most) ? (most) : (teams))
#define CADT_TEAMS(lanes, teams) CADT_LESSER_OF(CADT_MAX_TEAMS, CADT_LESSER_OF(CADT_MAX_THREADS / (lanes), teams))
#define CADT_TEAM_KERNEL(lanes, teams, name, ...) \
  static __global__ void __launch_bounds__((lanes), CADT_TEAMS(lanes, teams)) name(__VA_ARGS__)
#define cadt_item ((cadt_u32)(blockIdx.x * blockDim.x + threadIdx.x))
#define cadt_items ((cadt_u32)(gridDim.x * blockDim.x))
#define CADT_LOCAL __shared__
#define CADT_LOCAL_PTR
#define cadt_item_of_group ((cadt_u32)threadIdx.x)
#define cadt_group_items ((cadt_u32)blockDim.x)
#define cadt_group_barrier() __syncthreads()
#define cadt_group_barrier_all() __syncthreads()

#define cadt_prefetch_to_write(p) ((void)(p))
#define cadt_prefetch_to_read(p) ((void)(p))
#define cadt_bits_of_double(x) ((cadt_u64)__double_as_longlong(x))
#define cadt_double_of_bits(x) __longlong_as_double((long long)(x))
#define cadt_bits_of_float(x) ((cadt_u32)__float_as_uint(x))
#define cadt_float_of_bits(x) __uint_as_float(x)
#define cadt_popcount(x) ((cadt_u32)__popc(x))
#define cadt_fabsf(x) fabsf(x)
#define cadt_maxf(a, b) fmaxf((a), (b))
#define cadt_minf(a, b) fminf((a), (b))
#define cadt_about_fma(a, b, c) __fmaf_rn((a), (b), (c))
#define cadt_clz64(x) ((cadt_u32)__clzll((long long)(x)))
#define cadt_mulhi_u64(a, b) __umul64hi((a), (b))

/* ---- host C++; whoever includes the kernels has included <atomic>, <chrono>, <cmath>, <cstdint>, <cstring> ---- */
#else

typedef std::uint16_t cadt_u16;
typedef std::uint32_t cadt_u32;
typedef std::int32_t cadt_i32;
typedef std::uint64_t cadt_u64;
typedef std::int64_t cadt_i64;

#define CADT_GLOBAL
#define CADT_FN static inline
#define CADT_FN_SLOW __attribute__((noinline)) static
/* Inlined into each caller, so that what a caller keeps in registers need not go through memory for another's sake. */
#define CADT_FN_INLINE __attribute__((always_inline)) static inline
/* A kernel is a function of its work-item; the host back end supplies the two numbers (backends/host). */
#define CADT_KERNEL(name, ...) \
  static void name([[maybe_unused]] cadt_u32 cadt_item, [[maybe_unused]] cadt_u32 cadt_items, __VA_ARGS__)
#define CADT_TEAM_KERNEL(lanes, teams, name, ...) CADT_KERNEL(name, __VA_ARGS__)
#define CADT_CAST(type, value) static_cast<type>(value)

/* The processor may fetch the word at p, which will be written, or read, soon. */
#define cadt_prefetch_to_write(p) __builtin_prefetch((p), 1)
#define cadt_prefetch_to_read(p) __builtin_prefetch((p), 0)
CADT_FN cadt_u64 cadt_bits_of_double(double x) { return __builtin_bit_cast(cadt_u64, x); }
CADT_FN double cadt_double_of_bits(cadt_u64 bits) { return __builtin_bit_cast(double, bits); }
CADT_FN cadt_u32 cadt_bits_of_float(float x) { return __builtin_bit_cast(cadt_u32, x); }
CADT_FN float cadt_float_of_bits(cadt_u32 bits) { return __builtin_bit_cast(float, bits); }
CADT_FN cadt_u32 cadt_popcount(cadt_u32 x) { return CADT_CAST(cadt_u32, __builtin_popcount(x)); }
CADT_FN float cadt_fabsf(float x) { return std::fabs(x); }
/* a if b is NaN */
CADT_FN float cadt_maxf(float a, float b) { return b > a ? b : a; }
CADT_FN float cadt_minf(float a, float b) { return b < a ? b : a; }
CADT_FN float cadt_about_fma(float a, float b, float c) { return a * b + c; }
CADT_FN float cadt_about_inverse(float x) { return 1.0f / x; }
CADT_FN float cadt_about_sqrt(float x) { return std::sqrt(x); }
CADT_FN cadt_u32 cadt_clz64(cadt_u64 x) { return x ? CADT_CAST(cadt_u32, __builtin_clzll(x)) : 64u; }
CADT_FN cadt_u64 cadt_mulhi_u64(cadt_u64 a, cadt_u64 b) {
  __extension__ typedef unsigned __int128 u128;
  return CADT_CAST(cadt_u64, (CADT_CAST(u128, a) * b) >> 64);
}
#define cadt_fabs(x) std::fabs(x)
#define cadt_sqrt(x) std::sqrt(x)
#define CADT_INFINITY std::numeric_limits<cadt_real>::infinity()
#define cadt_ldexp(x, e) std::ldexp((x), (e))
#define cadt_atan2(y, x) std::atan2((y), (x))
CADT_FN cadt_u64 cadt_clock() {
#if defined(__x86_64__)
  return __builtin_ia32_rdtsc();
#else
  return CADT_CAST(cadt_u64, std::chrono::steady_clock::now().time_since_epoch().count());
#endif
}

#endif

/* ---- what OpenCL C and CUDA C++ have in common ---- */
#if !defined(CADT_LANG_HOST)
#define CADT_CAST(type, value) ((type)(value))
#define cadt_fabs(x) fabs(x)
#define cadt_sqrt(x) sqrt(x)
#define CADT_INFINITY INFINITY
#define cadt_ldexp(x, e) ldexp((x), (e))
#define cadt_atan2(y, x) atan2((y), (x))
#endif
/* NVIDIA's OpenCL C has the assembler of CUDA. */
#if defined(CADT_LANG_CUDA) || defined(__NV_CL_C_VERSION)
/* Subnormal numbers count as 0. */
CADT_FN float cadt_about_inverse(float x) {
  float y;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  return y;
}
CADT_FN float cadt_about_sqrt(float x) {
  float y;
  asm("sqrt.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  return y;
}
CADT_FN cadt_u64 cadt_clock(void) {
  cadt_u64 ticks;
  asm volatile("mov.u64 %0, %%clock64;" : "=l"(ticks)::"memory");
  return ticks;
}
#endif

#endif
