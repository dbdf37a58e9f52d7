/* SPDX-License-Identifier: Apache-2.0
 *
 * The lock protocol: where locks are taken and given up. Nobody ever waits: a lock is tried, and after a failure all
 * locks already taken are given up.
 *
 * Lock word: 0: the triangle does not exist yet; even: unlocked, and the number is its version; odd: locked. A try-lock
 * is one compare-and-swap from the version that was read before the fields (GPUs: one OR, and a look at the word that
 * was there). It fails if the triangle is locked or has changed since. So success proves that the fields read are the
 * triangle's state: lock and validity check (paper, Algorithm 1, lines 9 and 15) in one operation. An unlock after a
 * change raises the version.
 *
 * Why the proof holds on CPUs: a change stores fields with release after its lock (acquire), and fields are loaded with
 * acquire, the lock word first. If a reader saw one field of a later change, the lock of that change happens before the
 * reader's compare-and-swap, which then cannot find the old version. On GPUs, where loads are relaxed, a field may be
 * older than the version beside it. So the owner reads the triangle again under its lock (cadt_validate), compares what
 * it has used and takes everything else from there; locks acquire, so it sees all that earlier owners wrote.
 *
 * Order: triangles are locked by ascending index. So of any set of threads in conflict, the one that has come furthest
 * meets nobody ahead of it:
 *
 *     thread 1 needs  { 3, 7, 12 }       3 -> 7 -> 12
 *     thread 2 needs  { 7, 12, 20 }           7 -> 12 -> 20
 *     thread 3 needs  { 12, 31 }                   12 -> 31
 *
 * (A fixed but unsorted order livelocks within a warp: docs/insertion.md.)
 */
#ifndef CADT_INSERTION_LOCK_H
#define CADT_INSERTION_LOCK_H

#include "common/mesh/locked_mesh.dev.h"
#include "common/overlay/lost_locks.dev.h"

#define CADT_ANY_VERSION 0u

typedef struct {
  cadt_u32 triangle[4]; /* ascending; CADT_NONE: unused */
  cadt_u32 version[4];
} cadt_lock_set;

CADT_FN cadt_u32 cadt_is_unlocked(cadt_u32 lock) { return lock != 0u && !(lock & 1u) ? 1u : 0u; }
CADT_FN cadt_u32 cadt_next_version(cadt_u32 version) { return version + 2u ? version + 2u : 2u; }

CADT_FN void cadt_order_locks(cadt_lock_set* c, cadt_u32 i, cadt_u32 j) {
  if (c->triangle[i] > c->triangle[j]) {
    cadt_u32 r = c->triangle[i], v = c->version[i];
    c->triangle[i] = c->triangle[j];
    c->version[i] = c->version[j];
    c->triangle[j] = r;
    c->version[j] = v;
  }
}

/* Unlocks the first `count` triangles, unchanged. \pre the caller owns them and has written nothing */
CADT_FN void cadt_unlock_unchanged(const cadt_locked_mesh* m, const cadt_lock_set* c, cadt_u32 count) {
  for (cadt_u32 i = 0u; i < count; ++i)
    if (c->triangle[i] != CADT_NONE) {
#if CADT_CONTIGUOUS
      cadt_store_lock(m->locked[c->triangle[i]].word + CADT_WORD_LOCK, c->version[i]);
#else
      /* By an addition: a store would replace the last owner's store as what the next lock synchronises with, and so
       * need a fence before it. */
      cadt_add_relaxed(m->locked[c->triangle[i]].word + CADT_WORD_LOCK, 0xFFFFFFFFu);
#endif
      CADT_NOISE_AT(m, CADT_SITE_UNLOCKED_UNCHANGED);
    }
}

/* Locks one triangle if its lock word is `*version`, or even where that is CADT_ANY_VERSION. */
CADT_FN cadt_u32 cadt_try_lock_one(CADT_GLOBAL cadt_u32* lock, cadt_u32* version, cadt_counters* counters) {
#if defined(CADT_TEST_NO_LOCKS)
  (void)counters;
  if (*version == CADT_ANY_VERSION) *version = cadt_load_field(lock);
  cadt_store_relaxed(lock, *version | 1u);
  return 1u;
#elif CADT_CONTIGUOUS
  if (*version == CADT_ANY_VERSION) *version = cadt_load_field(lock);
  if (cadt_is_unlocked(*version) && cadt_cas_lock(lock, *version, *version | 1u)) return 1u;
  if (!(cadt_load_field(lock) & 1u)) CADT_COUNT_NOW(counters, CADT_COUNT_INVALIDATED);
  return 0u;
#else
  /* One operation, where a compare-and-swap would first need the version. It changes nothing in an odd word. A word of
   * 0 becomes odd: the thread that creates the triangle is about to store 2 there. */
  const cadt_u32 found = cadt_or_relaxed(lock, 1u);
  if (!cadt_is_unlocked(found)) return 0u;
  if (*version != CADT_ANY_VERSION && *version != found) {
    cadt_add_relaxed(lock, 0xFFFFFFFFu);
    CADT_COUNT_NOW(counters, CADT_COUNT_INVALIDATED);
    return 0u;
  }
  *version = found;
  return 1u;
#endif
}

/* Tries to lock up to four triangles. \pre versions were read by cadt_snapshot_of before the fields, or are
 * CADT_ANY_VERSION for triangles of which the caller needs no field. \post 1: the caller owns all of them, and
 * `version` has the versions to restore if nothing changes; 0: it owns none. */
CADT_FN cadt_u32 cadt_try_lock(const cadt_locked_mesh* m, cadt_lock_set* c, cadt_counters* counters) {
  counters->count[CADT_COUNT_LOCK_ATTEMPTS]++;
  cadt_order_locks(c, 0, 1);
  cadt_order_locks(c, 2, 3);
  cadt_order_locks(c, 0, 2);
  cadt_order_locks(c, 1, 3);
  cadt_order_locks(c, 1, 2);
  CADT_NOISE_AT(m, CADT_SITE_TRY_LOCK);
  for (cadt_u32 i = 0u; i < 4u; ++i) {
    if (c->triangle[i] == CADT_NONE) break;
    if (CADT_NOISE_FAILS(m, CADT_SITE_TRY_LOCK) ||
        !cadt_try_lock_one(m->locked[c->triangle[i]].word + CADT_WORD_LOCK, &c->version[i], counters)) {
      cadt_unlock_unchanged(m, c, i);
      CADT_COUNT_NOW(counters, CADT_COUNT_LOCK_FAILURES);
      CADT_LOST_LOCK(counters, c->triangle[i]);
      CADT_ADD_TIME(counters, CADT_TIME_LOCK);
      return 0u;
    }
    CADT_NOISE_AT(m, CADT_SITE_LOCKED);
  }
  cadt_fence_after_lock(); /* from here on, all that earlier owners wrote is seen */
  CADT_ADD_TIME(counters, CADT_TIME_LOCK);
  return 1u;
}

/* Half-edges of a triangle that the caller has used: a bit for each. */
enum { CADT_HALF_EDGES_01 = 3, CADT_HALF_EDGES_12 = 6, CADT_HALF_EDGES_ALL = 7 };

/* Whether the vertices of triangle t, seen from edge k, and those of its half-edges that are in `used` are still those
 * of `s`. On GPUs, `s` then gets the half-edges and flip counters read again: what was not used before need not stay in
 * registers until here. On CPUs the lock has proved all of `s`. \pre the caller owns t */
CADT_FN cadt_u32 cadt_validate(const cadt_locked_mesh* m, cadt_u32 t, cadt_u32 k, cadt_u32 used, cadt_snapshot* s) {
  CADT_NOISE_AT(m, CADT_SITE_VALIDATE);
  if (CADT_NOISE_FAILS(m, CADT_SITE_VALIDATE)) return 0u;
#if CADT_CONTIGUOUS
  (void)m, (void)t, (void)k, (void)used, (void)s;
  return 1u;
#else
  const cadt_snapshot now = cadt_snapshot_from(m, t, k);
  cadt_u32 other = (now.v0 ^ s->v0) | (now.v1 ^ s->v1) | (now.v2 ^ s->v2);
  if (used & 1u) other |= now.n0 ^ s->n0;
  if (used & 2u) other |= now.n1 ^ s->n1;
  if (used & 4u) other |= now.n2 ^ s->n2;
  s->n0 = now.n0;
  s->n1 = now.n1;
  s->n2 = now.n2;
  s->flips = now.flips;
  return other == 0u ? 1u : 0u;
#endif
}

/* Unlocks changed triangles. \pre the caller owns them, and all stores to them are done */
CADT_FN void cadt_unlock(const cadt_locked_mesh* m, const cadt_lock_set* c) {
  CADT_NOISE_AT(m, CADT_SITE_UNLOCK);
  for (cadt_u32 i = 0u; i < 4u; ++i)
    if (c->triangle[i] != CADT_NONE) {
      cadt_store_lock(m->locked[c->triangle[i]].word + CADT_WORD_LOCK, cadt_next_version(c->version[i]));
      CADT_NOISE_AT(m, CADT_SITE_UNLOCKED);
    }
}

/* Unlocks triangles that turned out to have changed before they were locked. Returns 0. */
CADT_FN cadt_u32 cadt_unlock_invalid(const cadt_locked_mesh* m, const cadt_lock_set* locks, cadt_counters* counters) {
  cadt_unlock_unchanged(m, locks, 4u);
  CADT_COUNT_NOW(counters, CADT_COUNT_LOCK_FAILURES);
  CADT_COUNT_NOW(counters, CADT_COUNT_INVALIDATED);
  CADT_ADD_TIME(counters, CADT_TIME_LOCK);
  return 0u;
}

/* Unlocks a new triangle for the first time. \pre its fields and all half-edges to it are stored, and the caller still
 * owns the triangles it was split from; until then whoever finds it reads lock word 0 and retries */
CADT_FN void cadt_publish_triangle(const cadt_locked_mesh* m, cadt_u32 t) {
  CADT_NOISE_AT(m, CADT_SITE_PUBLISH);
  cadt_store_lock(m->locked[t].word + CADT_WORD_LOCK, 2u);
}

#endif
