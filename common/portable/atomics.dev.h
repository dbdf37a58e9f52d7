/* SPDX-License-Identifier: Apache-2.0
 *
 * All atomic operations, at device scope, with their memory order in the name. Nothing else in the device text calls an
 * atomic or a fence.
 *
 * Order. Whoever takes a lock must see what the last owner wrote: acquire with the lock, release with the unlock. The
 * fields of a triangle are also read without a lock, and validated when the lock is taken. There are two ways to make
 * the lock prove them (lock.dev.h), because ordered accesses cost nothing on x86 and much on GPUs:
 * - CPUs: every field is stored with release and loaded with acquire. Then the version in the lock word proves the
 *   fields.
 * - GPUs: fields are stored and loaded relaxed; one fence of device scope after the locks acquires, one before the
 *   unlocks releases, and the owner reads the fields again.
 */
#ifndef CADT_PORTABLE_ATOMICS_H
#define CADT_PORTABLE_ATOMICS_H

#include "common/portable/teams.dev.h"

/* ---- OpenCL 3.0 with acquire/release at device scope: the C11 operations ----
 * NVIDIA's OpenCL does not advertise the features, yet compiles them to fences of device scope; the back end probes by
 * compiling (CADT_CL_C11 is set by it). */
#if defined(CADT_LANG_OPENCL) && defined(CADT_CL_C11)

#define CADT_ATOMIC(p) ((volatile __global atomic_uint*)(p))
/* Intel's library for CPUs takes 6.3 ns for it, the operation of the compiler that it stands for 0.3. (Other compilers
 * have the operation for some targets only; Mesa's ends the process.) */
#if defined(cl_intel_vec_len_hint)
#define CADT_ATOMIC_LOAD __opencl_atomic_load
#endif
#ifndef CADT_ATOMIC_LOAD
#define CADT_ATOMIC_LOAD atomic_load_explicit
#endif
CADT_FN cadt_u32 cadt_load_acquire(CADT_GLOBAL cadt_u32* p) {
  return CADT_ATOMIC_LOAD(CADT_ATOMIC(p), memory_order_acquire, memory_scope_device);
}
CADT_FN cadt_u32 cadt_load_relaxed(CADT_GLOBAL cadt_u32* p) {
  return CADT_ATOMIC_LOAD(CADT_ATOMIC(p), memory_order_relaxed, memory_scope_device);
}
CADT_FN void cadt_store_release(CADT_GLOBAL cadt_u32* p, cadt_u32 value) {
  atomic_store_explicit(CADT_ATOMIC(p), value, memory_order_release, memory_scope_device);
}
CADT_FN void cadt_store_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 value) {
  atomic_store_explicit(CADT_ATOMIC(p), value, memory_order_relaxed, memory_scope_device);
}
/* True if *p was `expected` and is `desired` now. */
CADT_FN cadt_u32 cadt_cas_acq_rel(CADT_GLOBAL cadt_u32* p, cadt_u32 expected, cadt_u32 desired) {
  return atomic_compare_exchange_strong_explicit(CADT_ATOMIC(p), &expected, desired, memory_order_acq_rel,
                                                 memory_order_relaxed, memory_scope_device)
             ? 1u
             : 0u;
}
CADT_FN cadt_u32 cadt_add_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 value) {
  return atomic_fetch_add_explicit(CADT_ATOMIC(p), value, memory_order_relaxed, memory_scope_device);
}
CADT_FN void cadt_min_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 value) {
  atomic_fetch_min_explicit(CADT_ATOMIC(p), value, memory_order_relaxed, memory_scope_device);
}
CADT_FN cadt_u32 cadt_cas_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 expected, cadt_u32 desired) {
  return atomic_compare_exchange_strong_explicit(CADT_ATOMIC(p), &expected, desired, memory_order_relaxed,
                                                 memory_order_relaxed, memory_scope_device)
             ? 1u
             : 0u;
}
CADT_FN cadt_u32 cadt_or_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 bits) {
  return atomic_fetch_or_explicit(CADT_ATOMIC(p), bits, memory_order_relaxed, memory_scope_device);
}
CADT_FN void cadt_fence_acq_rel(void) {
#if defined(__NV_CL_C_VERSION)
  /* the driver makes the function below sequentially consistent: more than needed */
  asm volatile("fence.acq_rel.gpu;" ::: "memory");
#else
  atomic_work_item_fence(CLK_GLOBAL_MEM_FENCE, memory_order_acq_rel, memory_scope_device);
#endif
}

/* ---- OpenCL 1.2: best effort; the standard promises no order between work-groups ---- */
#elif defined(CADT_LANG_OPENCL)

CADT_FN cadt_u32 cadt_load_acquire(CADT_GLOBAL cadt_u32* p) {
  cadt_u32 value = *(volatile CADT_GLOBAL cadt_u32*)p;
  mem_fence(CLK_GLOBAL_MEM_FENCE);
  return value;
}
CADT_FN cadt_u32 cadt_load_relaxed(CADT_GLOBAL cadt_u32* p) { return *(volatile CADT_GLOBAL cadt_u32*)p; }
CADT_FN void cadt_store_release(CADT_GLOBAL cadt_u32* p, cadt_u32 value) {
  mem_fence(CLK_GLOBAL_MEM_FENCE);
  *(volatile CADT_GLOBAL cadt_u32*)p = value;
}
CADT_FN void cadt_store_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 value) { *(volatile CADT_GLOBAL cadt_u32*)p = value; }
CADT_FN cadt_u32 cadt_cas_acq_rel(CADT_GLOBAL cadt_u32* p, cadt_u32 expected, cadt_u32 desired) {
  mem_fence(CLK_GLOBAL_MEM_FENCE);
  cadt_u32 old = atomic_cmpxchg((volatile CADT_GLOBAL cadt_u32*)p, expected, desired);
  mem_fence(CLK_GLOBAL_MEM_FENCE);
  return old == expected ? 1u : 0u;
}
CADT_FN cadt_u32 cadt_add_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 value) {
  return atomic_add((volatile CADT_GLOBAL cadt_u32*)p, value);
}
CADT_FN void cadt_min_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 value) {
  atomic_min((volatile CADT_GLOBAL cadt_u32*)p, value);
}
CADT_FN cadt_u32 cadt_cas_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 expected, cadt_u32 desired) {
  return atomic_cmpxchg((volatile CADT_GLOBAL cadt_u32*)p, expected, desired) == expected ? 1u : 0u;
}
CADT_FN cadt_u32 cadt_or_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 bits) {
  return atomic_or((volatile CADT_GLOBAL cadt_u32*)p, bits);
}
CADT_FN void cadt_fence_acq_rel(void) { mem_fence(CLK_GLOBAL_MEM_FENCE); }

/* ---- CUDA: volatile accesses are relaxed and bypass the L1 cache; orders are PTX at device scope ---- */
#elif defined(CADT_LANG_CUDA)

CADT_FN cadt_u32 cadt_load_relaxed(CADT_GLOBAL cadt_u32* p) { return *(volatile cadt_u32*)p; }
CADT_FN void cadt_store_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 value) { *(volatile cadt_u32*)p = value; }
CADT_FN cadt_u32 cadt_load_acquire(CADT_GLOBAL cadt_u32* p) {
  cadt_u32 value;
  asm volatile("ld.acquire.gpu.global.u32 %0, [%1];" : "=r"(value) : "l"(p) : "memory");
  return value;
}
CADT_FN void cadt_store_release(CADT_GLOBAL cadt_u32* p, cadt_u32 value) {
  asm volatile("st.release.gpu.global.u32 [%0], %1;" ::"l"(p), "r"(value) : "memory");
}
CADT_FN cadt_u32 cadt_cas_acq_rel(CADT_GLOBAL cadt_u32* p, cadt_u32 expected, cadt_u32 desired) {
  __threadfence();
  cadt_u32 old = atomicCAS(p, expected, desired);
  __threadfence();
  return old == expected ? 1u : 0u;
}
CADT_FN cadt_u32 cadt_add_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 value) { return atomicAdd(p, value); }
CADT_FN void cadt_min_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 value) { atomicMin(p, value); }
CADT_FN cadt_u32 cadt_cas_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 expected, cadt_u32 desired) {
  return atomicCAS(p, expected, desired) == expected ? 1u : 0u;
}
/* __threadfence is sequentially consistent: more than needed. */
CADT_FN void cadt_fence_acq_rel() { asm volatile("fence.acq_rel.gpu;" ::: "memory"); }
CADT_FN cadt_u32 cadt_or_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 bits) { return atomicOr(p, bits); }

/* ---- host: ordered operations, no fences (ThreadSanitizer does not follow fences) ---- */
#else

#if defined(__cpp_lib_atomic_ref)
typedef std::atomic_ref<cadt_u32> cadt_atomic;
#else /* libc++ before version 19 */
struct cadt_atomic {
  explicit cadt_atomic(cadt_u32& word) : cell(&word) {}
  cadt_u32 load(std::memory_order order) const { return __atomic_load_n(cell, CADT_CAST(int, order)); }
  void store(cadt_u32 value, std::memory_order order) const { __atomic_store_n(cell, value, CADT_CAST(int, order)); }
  cadt_u32 fetch_add(cadt_u32 value, std::memory_order order) const {
    return __atomic_fetch_add(cell, value, CADT_CAST(int, order));
  }
  cadt_u32 fetch_or(cadt_u32 bits, std::memory_order order) const {
    return __atomic_fetch_or(cell, bits, CADT_CAST(int, order));
  }
  bool compare_exchange_strong(cadt_u32& expected, cadt_u32 desired, std::memory_order success,
                               std::memory_order failure = std::memory_order_relaxed) const {
    return __atomic_compare_exchange_n(cell, &expected, desired, false, CADT_CAST(int, success),
                                       CADT_CAST(int, failure));
  }
  bool compare_exchange_weak(cadt_u32& expected, cadt_u32 desired, std::memory_order order) const {
    return __atomic_compare_exchange_n(cell, &expected, desired, true, CADT_CAST(int, order), __ATOMIC_RELAXED);
  }
  cadt_u32* cell;
};
#endif

CADT_FN cadt_u32 cadt_load_acquire(cadt_u32* p) { return cadt_atomic(*p).load(std::memory_order_acquire); }
CADT_FN cadt_u32 cadt_load_relaxed(cadt_u32* p) { return cadt_atomic(*p).load(std::memory_order_relaxed); }
CADT_FN void cadt_store_release(cadt_u32* p, cadt_u32 value) {
  cadt_atomic(*p).store(value, std::memory_order_release);
}
CADT_FN void cadt_store_relaxed(cadt_u32* p, cadt_u32 value) {
  cadt_atomic(*p).store(value, std::memory_order_relaxed);
}
CADT_FN cadt_u32 cadt_cas_acq_rel(cadt_u32* p, cadt_u32 expected, cadt_u32 desired) {
  return cadt_atomic(*p).compare_exchange_strong(expected, desired, std::memory_order_acq_rel,
                                                 std::memory_order_relaxed)
             ? 1u
             : 0u;
}
CADT_FN cadt_u32 cadt_cas_relaxed(cadt_u32* p, cadt_u32 expected, cadt_u32 desired) {
  return cadt_atomic(*p).compare_exchange_strong(expected, desired, std::memory_order_relaxed) ? 1u : 0u;
}
CADT_FN cadt_u32 cadt_add_relaxed(cadt_u32* p, cadt_u32 value) {
  return cadt_atomic(*p).fetch_add(value, std::memory_order_relaxed);
}
CADT_FN cadt_u32 cadt_or_relaxed(cadt_u32* p, cadt_u32 bits) {
  return cadt_atomic(*p).fetch_or(bits, std::memory_order_relaxed);
}
CADT_FN void cadt_min_relaxed(cadt_u32* p, cadt_u32 value) {
  cadt_atomic cell(*p);
  cadt_u32 old = cell.load(std::memory_order_relaxed);
  while (value < old && !cell.compare_exchange_weak(old, value, std::memory_order_relaxed)) {
  }
}

#endif

/* ---- memory of a team; the lanes come in any order ----
 * cadt_team_add returns the value before. cadt_team_min keeps the lesser of two values; cadt_team_least does the same
 * where many lanes have a value for one place, 0xFFFFFFFF being none. cadt_fence_local is for groups only. */
#if CADT_GROUP_SUMS && defined(CADT_LANG_OPENCL)
CADT_FN cadt_u32 cadt_team_add(CADT_LOCAL_PTR cadt_u32* p, cadt_u32 value) {
  return atomic_add((volatile CADT_LOCAL_PTR cadt_u32*)p, value);
}
CADT_FN void cadt_team_min(CADT_LOCAL_PTR cadt_u32* p, cadt_u32 value) {
  atomic_min((volatile CADT_LOCAL_PTR cadt_u32*)p, value);
}
CADT_FN void cadt_team_least(CADT_LOCAL_PTR cadt_u32* p, cadt_u32 value) {
  if (value != 0xFFFFFFFFu) cadt_team_min(p, value);
}
CADT_FN void cadt_fence_local(void) { mem_fence(CLK_LOCAL_MEM_FENCE); }
#elif CADT_GROUP_SUMS
CADT_FN cadt_u32 cadt_team_add(cadt_u32* p, cadt_u32 value) { return atomicAdd(p, value); }
CADT_FN void cadt_team_min(cadt_u32* p, cadt_u32 value) { atomicMin(p, value); }
CADT_FN void cadt_team_least(cadt_u32* p, cadt_u32 value) {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
  /* One operation for all active lanes: at one address they would wait for each other. */
  const cadt_u32 mask = __activemask(), lane = threadIdx.x & 31u;
  value = __reduce_min_sync(mask, value);
  if (mask & ((1u << lane) - 1u)) return;
#endif
  if (value != 0xFFFFFFFFu) cadt_team_min(p, value);
}
CADT_FN void cadt_fence_local() { __threadfence_block(); }
#else
CADT_FN cadt_u32 cadt_team_add(cadt_u32* p, cadt_u32 value) {
  const cadt_u32 old = *p;
  *p += value;
  return old;
}
CADT_FN void cadt_team_min(cadt_u32* p, cadt_u32 value) {
  if (value < *p) *p = value;
}
CADT_FN void cadt_team_least(cadt_u32* p, cadt_u32 value) { cadt_team_min(p, value); }
#endif

/* ---- the two ways to order fields and locks ---- */
#if CADT_CONTIGUOUS
CADT_FN cadt_u32 cadt_load_field(CADT_GLOBAL cadt_u32* p) { return cadt_load_acquire(p); }
CADT_FN void cadt_store_field(CADT_GLOBAL cadt_u32* p, cadt_u32 value) { cadt_store_release(p, value); }
CADT_FN cadt_u32 cadt_cas_lock(CADT_GLOBAL cadt_u32* p, cadt_u32 expected, cadt_u32 desired) {
  return cadt_cas_acq_rel(p, expected, desired);
}
CADT_FN void cadt_store_lock(CADT_GLOBAL cadt_u32* p, cadt_u32 value) { cadt_store_release(p, value); }
/* after locks and before unlocks: the operations themselves are ordered */
CADT_FN void cadt_fence_before_unlock(void) {}
CADT_FN void cadt_fence_after_lock(void) {}
#else
CADT_FN cadt_u32 cadt_load_field(CADT_GLOBAL cadt_u32* p) { return cadt_load_relaxed(p); }
CADT_FN void cadt_store_field(CADT_GLOBAL cadt_u32* p, cadt_u32 value) { cadt_store_relaxed(p, value); }
CADT_FN void cadt_store_lock(CADT_GLOBAL cadt_u32* p, cadt_u32 value) { cadt_store_relaxed(p, value); }
#if defined(__CUDACC_VER_MAJOR__) && __CUDACC_VER_MAJOR__ >= 13
CADT_FN void cadt_fence_before_unlock(void) { asm volatile("fence.release.gpu;" ::: "memory"); }
CADT_FN void cadt_fence_after_lock(void) { asm volatile("fence.acquire.gpu;" ::: "memory"); }
#else /* older assemblers have no one-sided fences */
CADT_FN void cadt_fence_before_unlock(void) { cadt_fence_acq_rel(); }
CADT_FN void cadt_fence_after_lock(void) { cadt_fence_acq_rel(); }
#endif
#endif

/* The eight words of a locked triangle, in two accesses where the language can. NVIDIA's OpenCL C has the assembler of
 * CUDA. */
#if defined(CADT_LANG_CUDA) || (defined(__NV_CL_C_VERSION) && defined(CADT_CL_C11) && !CADT_CONTIGUOUS)
CADT_FN void cadt_load_triangle(CADT_GLOBAL const cadt_u32* p, cadt_u32* w0, cadt_u32* w1, cadt_u32* w2, cadt_u32* w3,
                                cadt_u32* w4, cadt_u32* w5, cadt_u32* w6, cadt_u32* w7) {
  asm volatile("ld.relaxed.gpu.global.v4.u32 {%0, %1, %2, %3}, [%4];"
               : "=r"(*w0), "=r"(*w1), "=r"(*w2), "=r"(*w3)
               : "l"(p)
               : "memory");
  asm volatile("ld.relaxed.gpu.global.v4.u32 {%0, %1, %2, %3}, [%4];"
               : "=r"(*w4), "=r"(*w5), "=r"(*w6), "=r"(*w7)
               : "l"(p + 4)
               : "memory");
}
CADT_FN void cadt_store_triangle(CADT_GLOBAL cadt_u32* p, cadt_u32 w0, cadt_u32 w1, cadt_u32 w2, cadt_u32 w3,
                                 cadt_u32 w4, cadt_u32 w5, cadt_u32 w6, cadt_u32 w7) {
  asm volatile("st.relaxed.gpu.global.v4.u32 [%0], {%1, %2, %3, %4};" ::"l"(p), "r"(w0), "r"(w1), "r"(w2), "r"(w3)
               : "memory");
  asm volatile("st.relaxed.gpu.global.v4.u32 [%0], {%1, %2, %3, %4};" ::"l"(p + 4), "r"(w4), "r"(w5), "r"(w6), "r"(w7)
               : "memory");
}
#else
CADT_FN void cadt_load_triangle(CADT_GLOBAL cadt_u32* p, cadt_u32* w0, cadt_u32* w1, cadt_u32* w2, cadt_u32* w3,
                                cadt_u32* w4, cadt_u32* w5, cadt_u32* w6, cadt_u32* w7) {
  *w3 = cadt_load_field(p + 3); /* the lock word first: it validates what is read after it */
  *w0 = cadt_load_field(p);
  *w1 = cadt_load_field(p + 1);
  *w2 = cadt_load_field(p + 2);
  *w4 = cadt_load_field(p + 4);
  *w5 = cadt_load_field(p + 5);
  *w6 = cadt_load_field(p + 6);
  *w7 = cadt_load_field(p + 7);
}
CADT_FN void cadt_store_triangle(CADT_GLOBAL cadt_u32* p, cadt_u32 w0, cadt_u32 w1, cadt_u32 w2, cadt_u32 w3,
                                 cadt_u32 w4, cadt_u32 w5, cadt_u32 w6, cadt_u32 w7) {
  cadt_store_field(p, w0);
  cadt_store_field(p + 1, w1);
  cadt_store_field(p + 2, w2);
  cadt_store_field(p + 3, w3);
  cadt_store_field(p + 4, w4);
  cadt_store_field(p + 5, w5);
  cadt_store_field(p + 6, w6);
  cadt_store_field(p + 7, w7);
}
#endif

#endif
