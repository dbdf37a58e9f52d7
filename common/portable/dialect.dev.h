/* SPDX-License-Identifier: Apache-2.0
 *
 * The dialect of common/device: C99 that is OpenCL C, CUDA C++ and host C++ at once.
 * This file finds the language once, then defines the words in which the rest is written. Nothing else in this folder
 * asks which language it is, but atomics.dev.h.
 *
 * A compile may set: CADT_WIDE (0: exponents of all coordinates within 240 binades, 1: any double), CADT_FLOAT (1:
 * coordinates are floats, any of them, and there are no doubles; this build is wide),
 * CADT_CONTIGUOUS (1: a work-item takes neighbouring elements, right for CPUs; 0: strided, right for GPUs),
 * CADT_RADIX_BITS (digit of the radix sort), CADT_TIMED (1: threads take
 * the time of what they do, counters.dev.h). For tests only: CADT_CHECKED (who stores to a record must own it,
 * locked_mesh.dev.h), CADT_SCHEDULE_NOISE (delays and failures, schedule_noise.dev.h), CADT_TEST_NO_LOCKS (a control:
 * locks are not taken).
 */
#ifndef CADT_PORTABLE_DIALECT_H
#define CADT_PORTABLE_DIALECT_H

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

#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)
#define CADT_LANG_OPENCL 1
#elif defined(__CUDACC__) || defined(__CUDA__)
#define CADT_LANG_CUDA 1
#else
#define CADT_LANG_HOST 1
#endif

/* ---- OpenCL C ------------------------------------------------------------------------------------------------- */
#if defined(CADT_LANG_OPENCL)

#if CADT_FLOAT
/* Any use is an error of the compiler, on devices that have them as well. Literals are floats by an option
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
#define CADT_FN_EACH static __attribute__((always_inline))
#define CADT_KERNEL(name, ...) __kernel void name(__VA_ARGS__)
#define CADT_TEAM_KERNEL(lanes, teams, name, ...) CADT_KERNEL(name, __VA_ARGS__)
#define cadt_item ((cadt_u32)get_global_id(0))
#define cadt_items ((cadt_u32)get_global_size(0))
#define CADT_LOCAL __local
#define CADT_LOCAL_PTR __local
#define cadt_item_of_group ((cadt_u32)get_local_id(0))
#define cadt_group_items ((cadt_u32)get_local_size(0))
#define cadt_group_barrier() barrier(CLK_LOCAL_MEM_FENCE)
#define CADT_CAST(type, value) ((type)(value))

#define cadt_bits_of_double(x) as_ulong(x)
#define cadt_double_of_bits(x) as_double(x)
#define cadt_bits_of_float(x) as_uint(x)
#define cadt_float_of_bits(x) as_float(x)
#define cadt_popcount(x) ((cadt_u32)popcount((uint)(x)))
#define cadt_fabsf(x) fabs((float)(x))
#define cadt_maxf(a, b) fmax((float)(a), (float)(b))
#define cadt_minf(a, b) fmin((float)(a), (float)(b))
/* approximations, for what has a bound of its error: a * b + c, 1 / x, square root of
 * what is not 0 */
#define cadt_about_fma(a, b, c) fma((float)(a), (float)(b), (float)(c))
#if defined(__NV_CL_C_VERSION)
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
#else
#define cadt_about_inverse(x) (1.0f / (x))
#define cadt_about_sqrt(x) sqrt((float)(x))
#endif
#define cadt_clz64(x) ((cadt_u32)clz((ulong)(x)))
#define cadt_mulhi_u64(a, b) mul_hi((ulong)(a), (ulong)(b))
#define cadt_fabs(x) fabs(x)
#define cadt_sqrt(x) sqrt(x)
#define CADT_INFINITY INFINITY
#define cadt_ldexp(x, e) ldexp((x), (e))
#define cadt_atan2(y, x) atan2((y), (x))

/* A clock of the thread's processor, for differences; 0 where there is none. */
#if defined(__NV_CL_C_VERSION)
CADT_FN cadt_u64 cadt_clock(void) {
  cadt_u64 ticks;
  asm volatile("mov.u64 %0, %%clock64;" : "=l"(ticks)::"memory");
  return ticks;
}
#elif CADT_TIMED && CADT_CONTIGUOUS && defined(__clang__) && defined(__x86_64__)
CADT_FN cadt_u64 cadt_clock(void) { return __builtin_readcyclecounter(); }
#else
CADT_FN cadt_u64 cadt_clock(void) { return 0; }
#endif

/* ---- CUDA C++ ------------------------------------------------------------------------------------------------- */
#elif defined(CADT_LANG_CUDA)

typedef unsigned short cadt_u16;
typedef unsigned int cadt_u32;
typedef int cadt_i32;
typedef unsigned long long cadt_u64;
typedef long long cadt_i64;

#define CADT_GLOBAL
#define CADT_FN static __device__ inline
#define CADT_FN_SLOW static __device__ __noinline__
#define CADT_FN_EACH static __device__ __forceinline__
#define CADT_KERNEL(name, ...) static __global__ void name(__VA_ARGS__)
/* Registers are given out so that so many teams run on a multiprocessor at the same time, if it has so many threads and
 * takes so many. */
#if !defined(__CUDA_ARCH__) || __CUDA_ARCH__ == 800 || (__CUDA_ARCH__ >= 900 && __CUDA_ARCH__ < 1200)
#define CADT_THREADS_MOST 2048
#define CADT_TEAMS_MOST 32
#elif __CUDA_ARCH__ < 800
#define CADT_THREADS_MOST 1024
#define CADT_TEAMS_MOST 16
#else
#define CADT_THREADS_MOST 1536
#define CADT_TEAMS_MOST (__CUDA_ARCH__ < 890 ? 16 : 24)
#endif
#define CADT_TEAMS_OF(most, teams) ((teams) > (most) ? (most) : (teams))
#define CADT_TEAMS(lanes, teams) CADT_TEAMS_OF(CADT_TEAMS_MOST, CADT_TEAMS_OF(CADT_THREADS_MOST / (lanes), teams))
#define CADT_TEAM_KERNEL(lanes, teams, name, ...) \
  static __global__ void __launch_bounds__((lanes), CADT_TEAMS(lanes, teams)) name(__VA_ARGS__)
#define cadt_item ((cadt_u32)(blockIdx.x * blockDim.x + threadIdx.x))
#define cadt_items ((cadt_u32)(gridDim.x * blockDim.x))
#define CADT_LOCAL __shared__
#define CADT_LOCAL_PTR
#define cadt_item_of_group ((cadt_u32)threadIdx.x)
#define cadt_group_items ((cadt_u32)blockDim.x)
#define cadt_group_barrier() __syncthreads()
#define CADT_CAST(type, value) ((type)(value))

#define cadt_bits_of_double(x) ((cadt_u64)__double_as_longlong(x))
#define cadt_double_of_bits(x) __longlong_as_double((long long)(x))
#define cadt_bits_of_float(x) ((cadt_u32)__float_as_uint(x))
#define cadt_float_of_bits(x) __uint_as_float(x)
#define cadt_popcount(x) ((cadt_u32)__popc(x))
#define cadt_fabsf(x) fabsf(x)
#define cadt_maxf(a, b) fmaxf((a), (b))
#define cadt_minf(a, b) fminf((a), (b))
#define cadt_about_fma(a, b, c) __fmaf_rn((a), (b), (c))
/* Numbers that are not normal count as 0. */
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
#define cadt_clz64(x) ((cadt_u32)__clzll((long long)(x)))
#define cadt_mulhi_u64(a, b) __umul64hi((a), (b))
#define cadt_fabs(x) fabs(x)
#define cadt_sqrt(x) sqrt(x)
#define CADT_INFINITY INFINITY
#define cadt_ldexp(x, e) ldexp((x), (e))
#define cadt_atan2(y, x) atan2((y), (x))
CADT_FN cadt_u64 cadt_clock() {
  cadt_u64 ticks;
  asm volatile("mov.u64 %0, %%clock64;" : "=l"(ticks)::"memory");
  return ticks;
}

/* ---- host C++; the file that includes the kernels has included <atomic>, <chrono>, <cmath>, <cstdint>, <cstring>
 * before ---- */
#else

typedef std::uint16_t cadt_u16;
typedef std::uint32_t cadt_u32;
typedef std::int32_t cadt_i32;
typedef std::uint64_t cadt_u64;
typedef std::int64_t cadt_i64;

#define CADT_GLOBAL
#define CADT_FN static inline
#define CADT_FN_SLOW __attribute__((noinline)) static
/* Each caller has the code to itself: what it keeps in registers need not go through memory for the other's sake. */
#define CADT_FN_EACH __attribute__((always_inline)) static inline
/* A kernel is a function of its work-item; the host back end supplies the two numbers (backends/host). */
#define CADT_KERNEL(name, ...) \
  static void name([[maybe_unused]] cadt_u32 cadt_item, [[maybe_unused]] cadt_u32 cadt_items, __VA_ARGS__)
#define CADT_TEAM_KERNEL(lanes, teams, name, ...) CADT_KERNEL(name, __VA_ARGS__)
#define CADT_CAST(type, value) static_cast<type>(value)

CADT_FN cadt_u64 cadt_bits_of_double(double x) {
  cadt_u64 bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
CADT_FN double cadt_double_of_bits(cadt_u64 bits) {
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}
CADT_FN cadt_u32 cadt_bits_of_float(float x) {
  cadt_u32 bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
CADT_FN float cadt_float_of_bits(cadt_u32 bits) {
  float x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}
CADT_FN cadt_u32 cadt_popcount(cadt_u32 x) { return CADT_CAST(cadt_u32, __builtin_popcount(x)); }
CADT_FN float cadt_fabsf(float x) { return std::fabs(x); }
/* a if b is no number */
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
#if CADT_FLOAT
CADT_FN float cadt_fabs(float x) { return std::fabs(x); }
#define CADT_INFINITY std::numeric_limits<float>::infinity()
CADT_FN float cadt_atan2(float y, float x) { return std::atan2(y, x); }
#else
CADT_FN double cadt_fabs(double x) { return std::fabs(x); }
CADT_FN double cadt_sqrt(double x) { return std::sqrt(x); }
#define CADT_INFINITY std::numeric_limits<double>::infinity()
CADT_FN double cadt_ldexp(double x, cadt_i32 e) { return std::ldexp(x, e); }
CADT_FN double cadt_atan2(double y, double x) { return std::atan2(y, x); }
#endif
CADT_FN cadt_u64 cadt_clock() {
#if defined(__x86_64__)
  return __builtin_ia32_rdtsc();
#else
  return CADT_CAST(cadt_u64, std::chrono::steady_clock::now().time_since_epoch().count());
#endif
}

#endif

/* Whether work-items of a group share memory. */
#if CADT_CONTIGUOUS || defined(CADT_LANG_HOST)
#define CADT_GROUP_SUMS 0
#else
#define CADT_GROUP_SUMS 1
#endif

/* A team works on one thing with memory of its own: on GPUs a group, elsewhere a single work-item. Lanes share the
 * elements of CADT_TEAM_FOR; what one wrote is seen by the others after CADT_TEAM_SYNC, which all lanes must reach. */
#if CADT_GROUP_SUMS
#define CADT_TEAM_MEMORY CADT_LOCAL
#define CADT_TEAM_PTR CADT_LOCAL_PTR
#define cadt_team_lane cadt_item_of_group
#define cadt_team_lanes cadt_group_items
#define CADT_TEAM_SYNC() cadt_group_barrier()
#define CADT_FOR_TEAMS(t, count, grain) \
  for (cadt_u32 t = cadt_item / cadt_group_items; t < (count); t += cadt_items / cadt_group_items)
#else
#define CADT_TEAM_MEMORY
#define CADT_TEAM_PTR
#define cadt_team_lane 0u
#define cadt_team_lanes 1u
#define CADT_TEAM_SYNC() ((void)0)
#define CADT_FOR_TEAMS(t, count, grain) CADT_FOR(t, count, grain)
#endif
#define CADT_TEAM_FOR(i, count) for (cadt_u32 i = cadt_team_lane; i < (count); i += cadt_team_lanes)

/* Coordinates, and what is computed from them (docs/decisions/0004-exact-integers-and-floats.md). */
#if CADT_FLOAT
typedef float cadt_real;
#define CADT_MANTISSA_BITS 23 /* that are stored */
#define CADT_EXPONENTS 0xFFul
#define CADT_EXPONENT_BIAS 127
#define CADT_SIGN_SHIFT 31
#define cadt_bits_of_real(x) CADT_CAST(cadt_u64, cadt_bits_of_float(x))
/* Devices may take subnormal floats for 0 and make them 0, in comparisons too. */
#define CADT_GRADUAL 0
/* \pre -126 <= e <= 127 */
#undef cadt_ldexp
#define cadt_ldexp(x, e) ((x)*cadt_float_of_bits(CADT_CAST(cadt_u32, (e) + CADT_EXPONENT_BIAS) << CADT_MANTISSA_BITS))
#else
typedef double cadt_real;
#define CADT_MANTISSA_BITS 52
#define CADT_EXPONENTS 0x7FFul
#define CADT_EXPONENT_BIAS 1023
#define CADT_SIGN_SHIFT 63
#define cadt_bits_of_real(x) cadt_bits_of_double(x)
#define CADT_GRADUAL 1 /* the self-test asks for it */
#endif
#define CADT_EXPONENT_MASK (CADT_EXPONENTS << CADT_MANTISSA_BITS)
#define CADT_HIDDEN_BIT (1ul << CADT_MANTISSA_BITS)

/* Comparison of coordinates that decides something. */
#if CADT_GRADUAL
#define cadt_less(a, b) ((a) < (b))
#define cadt_same(a, b) ((a) == (b))
#else
/* Whole numbers in the order of the values; -0 is 0. */
CADT_FN cadt_i32 cadt_float_order(cadt_real x) {
  const cadt_u32 bits = cadt_bits_of_float(x);
  const cadt_i32 magnitude = CADT_CAST(cadt_i32, bits & 0x7FFFFFFFu);
  return bits >> 31 ? -magnitude : magnitude;
}
#define cadt_less(a, b) (cadt_float_order(a) < cadt_float_order(b))
#define cadt_same(a, b) (cadt_float_order(a) == cadt_float_order(b))
#endif

typedef struct {
  cadt_real x, y;
} cadt_point;

#define CADT_NONE 0xFFFFFFFFu

/* A point at an address that is a multiple of its size, in one access: two would ask the L2 cache twice for one sector.
 */
#if defined(CADT_LANG_OPENCL) || defined(CADT_LANG_CUDA)
#if CADT_FLOAT
typedef float2 cadt_real2;
#else
typedef double2 cadt_real2;
#endif
CADT_FN cadt_point cadt_load_point(CADT_GLOBAL const cadt_point* p) {
  const cadt_real2 both = *(CADT_GLOBAL const cadt_real2*)p;
  cadt_point point;
  point.x = both.x;
  point.y = both.y;
  return point;
}
#else
CADT_FN cadt_point cadt_load_point(const cadt_point* p) { return *p; }
#endif

/* Four words of memory that nobody changes meanwhile, at an address that is a multiple of 16; two, of 8. */
#if defined(CADT_LANG_OPENCL) || defined(CADT_LANG_CUDA)
CADT_FN void cadt_store_four(CADT_GLOBAL cadt_u32* p, cadt_u32 a, cadt_u32 b, cadt_u32 c, cadt_u32 d) {
  uint4 four;
  four.x = a;
  four.y = b;
  four.z = c;
  four.w = d;
  *(CADT_GLOBAL uint4*)p = four;
}
CADT_FN void cadt_store_two(CADT_GLOBAL cadt_u32* p, cadt_u32 a, cadt_u32 b) {
  uint2 two;
  two.x = a;
  two.y = b;
  *(CADT_GLOBAL uint2*)p = two;
}
CADT_FN void cadt_load_four(CADT_GLOBAL const cadt_u32* p, cadt_u32* w) {
  const uint4 four = *(CADT_GLOBAL const uint4*)p;
  w[0] = four.x;
  w[1] = four.y;
  w[2] = four.z;
  w[3] = four.w;
}
#else
CADT_FN void cadt_load_four(const cadt_u32* p, cadt_u32* w) { std::memcpy(w, p, 4 * sizeof *w); }
CADT_FN void cadt_store_four(cadt_u32* p, cadt_u32 a, cadt_u32 b, cadt_u32 c, cadt_u32 d) {
  p[0] = a;
  p[1] = b;
  p[2] = c;
  p[3] = d;
}
CADT_FN void cadt_store_two(cadt_u32* p, cadt_u32 a, cadt_u32 b) {
  p[0] = a;
  p[1] = b;
}
#endif

/* Before a loop: it is not to be unrolled. */
#if defined(CADT_LANG_HOST) && defined(__GNUC__) && !defined(__clang__)
#define CADT_ROLLED _Pragma("GCC unroll 1")
#else
#define CADT_ROLLED _Pragma("unroll 1")
#endif

/* One of three values; keeps them in registers where an array would go to memory. */
#define CADT_PICK(k, a, b, c) ((k) == 0u ? (a) : ((k) == 1u ? (b) : (c)))
/* The next and the previous of 0, 1, 2, by a table in a word: no branch. */
#define CADT_NEXT(k) ((0x9u >> (2u * (k))) & 3u)
#define CADT_PREV(k) ((0x12u >> (2u * (k))) & 3u)

CADT_FN cadt_u32 cadt_min_u32(cadt_u32 a, cadt_u32 b) { return a < b ? a : b; }

/* The first element of a work-item that takes `size` neighbouring ones. The product may leave 32 bits: devices round
 * the number of work-items up to whole groups. */
CADT_FN cadt_u32 cadt_begin_of(cadt_u32 item, cadt_u32 size, cadt_u32 count) {
  const cadt_u64 begin = CADT_CAST(cadt_u64, item) * size;
  return begin < count ? CADT_CAST(cadt_u32, begin) : count;
}

/* The elements i < count that this work-item owns. `grain` is the number of neighbouring elements on CPUs. */
#if CADT_CONTIGUOUS
#define CADT_FOR(i, count, grain)                                                                             \
  for (cadt_u32 i = cadt_begin_of(cadt_item, (grain), (count)), i##_end = cadt_min_u32(i + (grain), (count)); \
       i < i##_end; ++i)
#else
#define CADT_FOR(i, count, grain) for (cadt_u32 i = cadt_item; i < (count); i += cadt_items)
#endif

/* The elements of part `part` of `parts`, for partial results: one after another in chunks, or strided. */
#if CADT_CONTIGUOUS
#define CADT_FOR_PART(i, part, parts, count, chunk)                                                        \
  for (cadt_u32 i = cadt_begin_of((part), (chunk), (count)), i##_end = cadt_min_u32(i + (chunk), (count)); \
       i < i##_end; ++i)
#else
#define CADT_FOR_PART(i, part, parts, count, chunk) for (cadt_u32 i = (part); i < (count); i += (parts))
#endif

/* Lanes of a warp that went separate ways meet at cadt_any_lane and cadt_sync_lanes, which all lanes of `warp` must
 * reach. Elsewhere each work-item is a warp of its own. */
#if defined(CADT_LANG_CUDA)
CADT_FN cadt_u32 cadt_lanes_of_warp() {
  const cadt_u32 left = blockDim.x - (threadIdx.x & ~31u);
  return left >= 32u ? 0xFFFFFFFFu : (1u << left) - 1u;
}
CADT_FN cadt_u32 cadt_any_lane(cadt_u32 warp, cadt_u32 yes) { return __any_sync(warp, yes != 0u) ? 1u : 0u; }
CADT_FN void cadt_sync_lanes(cadt_u32 warp) { __syncwarp(warp); }
#else
CADT_FN cadt_u32 cadt_lanes_of_warp(void) { return 1u; }
CADT_FN cadt_u32 cadt_any_lane(cadt_u32 warp, cadt_u32 yes) { return warp & yes; }
CADT_FN void cadt_sync_lanes(cadt_u32 warp) { (void)warp; }
#endif

/* As CADT_FOR, for work that takes many steps and branches, in loops that are not over the elements alone: the first
 * element, one behind the last, and from one to the next. Lanes of a GPU's warp go separate ways one after another, so
 * where there are fewer elements than the device has lanes, `grain` lanes share an element and one of them works. */
#if CADT_CONTIGUOUS
#define CADT_SPREAD_BEGIN(count, grain) cadt_begin_of(cadt_item, (grain), (count))
#define CADT_SPREAD_END(count, grain) cadt_min_u32(CADT_SPREAD_BEGIN(count, grain) + (grain), (count))
#define CADT_SPREAD_STEP(grain) 1u
#else
#define CADT_SPREAD_BEGIN(count, grain) (cadt_item % (grain) ? (count) : cadt_item / (grain))
#define CADT_SPREAD_END(count, grain) (count)
#define CADT_SPREAD_STEP(grain) ((cadt_items - 1u) / (grain) + 1u)
#endif

#endif
