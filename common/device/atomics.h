/* SPDX-License-Identifier: Apache-2.0
 *
 * All atomic operations, with their memory order in the name, at device scope. Nothing else in this folder calls an
 * atomic or a fence.
 *
 * Order. Whoever takes a lock must see what the last owner wrote, hence acquire on the claim and release on the unlock.
 * The fields of a record are read without a lock as hints and are validated by the claim, which compares the record's
 * version (lock.h). For that proof a load of a field synchronises with the store of it: if a reader sees a field that a
 * later owner wrote, it also sees that owner's lock word, so its claim fails. Hence fields are stored with release and
 * loaded with acquire where that is free (x86) or required by the model.
 */
#ifndef CADT_DEVICE_ATOMICS_H
#define CADT_DEVICE_ATOMICS_H

#include "common/device/lang.h"

/* ---- OpenCL 3.0 with acquire/release at device scope: the C11 operations -------------------------------------------
 * NVIDIA's OpenCL does not advertise the features, yet compiles them to fences of device scope; the back end probes by
 * compiling (CADT_CL_C11 is set by it). */
#if defined(CADT_LANG_OPENCL) && defined(CADT_CL_C11)

#define CADT_ATOMIC(p) ((volatile __global atomic_uint*)(p))
CADT_FN cadt_u32 cadt_load_acquire(CADT_GLOBAL cadt_u32* p) {
  return atomic_load_explicit(CADT_ATOMIC(p), memory_order_acquire, memory_scope_device);
}
CADT_FN cadt_u32 cadt_load_relaxed(CADT_GLOBAL cadt_u32* p) {
  return atomic_load_explicit(CADT_ATOMIC(p), memory_order_relaxed, memory_scope_device);
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

/* ---- OpenCL 1.2: best effort; the standard promises no order between work-groups ---------------------------------- */
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

/* ---- CUDA: volatile accesses bypass a stale L1 line; __threadfence is device scope -------------------------------- */
#elif defined(CADT_LANG_CUDA)

CADT_FN cadt_u32 cadt_load_relaxed(CADT_GLOBAL cadt_u32* p) { return *(volatile cadt_u32*)p; }
CADT_FN cadt_u32 cadt_load_acquire(CADT_GLOBAL cadt_u32* p) {
  cadt_u32 value = *(volatile cadt_u32*)p;
  __threadfence();
  return value;
}
CADT_FN void cadt_store_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 value) { *(volatile cadt_u32*)p = value; }
CADT_FN void cadt_store_release(CADT_GLOBAL cadt_u32* p, cadt_u32 value) {
  __threadfence();
  *(volatile cadt_u32*)p = value;
}
CADT_FN cadt_u32 cadt_cas_acq_rel(CADT_GLOBAL cadt_u32* p, cadt_u32 expected, cadt_u32 desired) {
  __threadfence();
  cadt_u32 old = atomicCAS(p, expected, desired);
  __threadfence();
  return old == expected ? 1u : 0u;
}
CADT_FN cadt_u32 cadt_add_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 value) { return atomicAdd(p, value); }
CADT_FN void cadt_min_relaxed(CADT_GLOBAL cadt_u32* p, cadt_u32 value) { atomicMin(p, value); }

/* ---- host: ordered operations, no fences (ThreadSanitizer does not follow fences) ---------------------------------- */
#else

CADT_FN cadt_u32 cadt_load_acquire(cadt_u32* p) { return std::atomic_ref<cadt_u32>(*p).load(std::memory_order_acquire); }
CADT_FN cadt_u32 cadt_load_relaxed(cadt_u32* p) { return std::atomic_ref<cadt_u32>(*p).load(std::memory_order_relaxed); }
CADT_FN void cadt_store_release(cadt_u32* p, cadt_u32 value) {
  std::atomic_ref<cadt_u32>(*p).store(value, std::memory_order_release);
}
CADT_FN void cadt_store_relaxed(cadt_u32* p, cadt_u32 value) {
  std::atomic_ref<cadt_u32>(*p).store(value, std::memory_order_relaxed);
}
CADT_FN cadt_u32 cadt_cas_acq_rel(cadt_u32* p, cadt_u32 expected, cadt_u32 desired) {
  return std::atomic_ref<cadt_u32>(*p).compare_exchange_strong(expected, desired, std::memory_order_acq_rel,
                                                               std::memory_order_relaxed)
             ? 1u
             : 0u;
}
CADT_FN cadt_u32 cadt_add_relaxed(cadt_u32* p, cadt_u32 value) {
  return std::atomic_ref<cadt_u32>(*p).fetch_add(value, std::memory_order_relaxed);
}
CADT_FN void cadt_min_relaxed(cadt_u32* p, cadt_u32 value) {
  std::atomic_ref<cadt_u32> cell(*p);
  cadt_u32 old = cell.load(std::memory_order_relaxed);
  while (value < old && !cell.compare_exchange_weak(old, value, std::memory_order_relaxed)) {
  }
}

#endif
#endif
