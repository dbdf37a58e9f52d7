/* SPDX-License-Identifier: Apache-2.0
 *
 * Schedule noise: sites of the lock protocol at which tests (tests/robustness/concurrency) delay a work-item or let a
 * lock fail. Nothing of it is in the library: without CADT_SCHEDULE_NOISE all macros are empty.
 *
 * Seed and mode come with each call in Tuning::quality_epsilon, which insertion does not read while Options::stabilize
 * is off: eight times a seed, plus a mode. So the same kernels serve all modes, on every back end.
 */
#ifndef CADT_OVERLAY_SCHEDULE_NOISE_H
#define CADT_OVERLAY_SCHEDULE_NOISE_H

#include "common/portable/dialect.dev.h"

#if defined(CADT_SCHEDULE_NOISE)

enum {
  CADT_SITE_WALK,               /* before a walk reads the next triangle */
  CADT_SITE_FIELDS,             /* CPUs: between a lock word and the fields behind it */
  CADT_SITE_WALK_START,         /* before a walk starts */
  CADT_SITE_SECOND_TRIANGLE,    /* between the reads of the two triangles of an edge */
  CADT_SITE_TRY_LOCK,           /* the decision is made; before the first lock */
  CADT_SITE_LOCKED,             /* after each lock, and so between them. From here on triangles are locked */
  CADT_SITE_VALIDATE,           /* all are locked; before they are read again */
  CADT_SITE_WRITE,              /* before the first store */
  CADT_SITE_NEXT_TRIANGLE,      /* between the triangles of a split or flip */
  CADT_SITE_HALF_EDGE,          /* before a neighbour's half-edge back */
  CADT_SITE_PUBLISH,            /* before a new triangle is published */
  CADT_SITE_UNLOCK,             /* before the first unlock of a changed triangle */
  CADT_SITE_UNLOCKED,           /* after each of these unlocks */
  CADT_SITE_UNLOCKED_UNCHANGED, /* after each unlock of an unchanged triangle. Up to here triangles are locked */
  CADT_SITE_VERTEX_TRIANGLE,    /* between a flip and vertex_to_triangle of its vertices */
  CADT_SITE_TAKE_EDGE,          /* before an edge is taken from the worklist */
  CADT_SITE_PUSH_EDGE,          /* beside an edge's way to the worklist or to the next launch */
  CADT_SITE_PUSH_POINT,         /* between the place on the list of deferred points and its store */
  CADT_SITE_PARTITION,          /* partitions without locks: between the stores of a split and its publication */
  CADT_SITES
};

/* The modes. */
enum {
  CADT_NOISE_OFF,
  CADT_NOISE_UNIFORM,  /* every fourth site delays, up to some microseconds */
  CADT_NOISE_SLOW,     /* one work-item of sixteen is slow everywhere */
  CADT_NOISE_HOLDERS,  /* whoever holds locks is slow */
  CADT_NOISE_FAILURES, /* locks fail with probability 1/2 each, validations with 1/4 */
  CADT_NOISE_ALL       /* some of each */
};

typedef struct {
  cadt_u32 state, mode, slow;
} cadt_noise;

CADT_FN cadt_u32 cadt_noise_mix(cadt_u32 x) {
  x = (x ^ (x >> 16)) * 0x85EBCA6Bu;
  x = (x ^ (x >> 13)) * 0xC2B2AE35u;
  return x ^ (x >> 16);
}

/* Failures must differ from launch to launch: else a lone work-item that has failed once would fail for ever. */
CADT_FN cadt_u32 cadt_noise_clock(void) {
#if defined(CADT_LANG_OPENCL) && defined(__clang__) && defined(__x86_64__)
  return CADT_CAST(cadt_u32, __builtin_readcyclecounter());
#else
  return CADT_CAST(cadt_u32, cadt_clock());
#endif
}

CADT_FN cadt_noise cadt_noise_of(cadt_u32 item, cadt_real setting) {
  const cadt_u32 s = setting < 4e9 ? CADT_CAST(cadt_u32, setting) : 0u;
  cadt_noise noise;
  noise.mode = s & 7u;
  noise.state = cadt_noise_mix((s >> 3) * 0x9E3779B9u ^ cadt_noise_mix(item + 1u)) | 1u;
  if (noise.mode >= CADT_CAST(cadt_u32, CADT_NOISE_FAILURES)) noise.state ^= cadt_noise_mix(cadt_noise_clock()) << 1;
  noise.slow = (noise.state >> 8) % 16u == 0u ? 1u : 0u;
  return noise;
}

CADT_FN cadt_u32 cadt_noise_next(cadt_noise* noise) {
  noise->state ^= noise->state << 13;
  noise->state ^= noise->state >> 17;
  noise->state ^= noise->state << 5;
  return noise->state * 0x9E3779B1u;
}

CADT_FN void cadt_delay(cadt_u32 rounds) {
  volatile cadt_u32 sink = 0u;
  for (cadt_u32 i = 0u; i < rounds; ++i) sink = i;
  (void)sink;
#if defined(CADT_LANG_HOST)
  if (rounds >= 256u) std::this_thread::yield(); /* there are more threads than processors */
#endif
}

CADT_FN void cadt_noise_at(cadt_noise* noise, cadt_u32 site) {
#if defined(CADT_LANG_HOST)
  cadt_count_site(site); /* defined by the test program */
#endif
  if (noise->mode == CADT_NOISE_OFF) return;
  const cadt_u32 r = cadt_noise_next(noise) >> 8;
  const cadt_u32 held = site >= CADT_SITE_LOCKED && site <= CADT_SITE_UNLOCKED_UNCHANGED ? 1u : 0u;
  if (noise->mode == CADT_NOISE_UNIFORM) {
    if ((r & 3u) == 0u) cadt_delay(1u << ((r >> 2) % 12u));
  } else if (noise->mode == CADT_NOISE_SLOW) {
    if (noise->slow) cadt_delay(1024u);
  } else if (noise->mode == CADT_NOISE_HOLDERS) {
    if (held && (r & 1u)) cadt_delay(64u << ((r >> 1) % 6u));
  } else if (noise->mode == CADT_NOISE_ALL) {
    if ((r & (held ? 1u : 7u)) == 0u) cadt_delay(1u << ((r >> 3) % 11u));
  }
}

/* Whether this lock or validation is to fail though it need not. */
CADT_FN cadt_u32 cadt_noise_fails(cadt_noise* noise, cadt_u32 site) {
  const cadt_u32 r = cadt_noise_next(noise) >> 12;
  if (noise->mode == CADT_NOISE_FAILURES) return (r & (site == CADT_SITE_TRY_LOCK ? 1u : 3u)) == 0u ? 1u : 0u;
  return noise->mode == CADT_NOISE_ALL && (r & 7u) == 0u ? 1u : 0u;
}

#define CADT_NOISE_AT(m, site) cadt_noise_at((m)->noise, (site))
#define CADT_NOISE_FAILS(m, site) cadt_noise_fails((m)->noise, (site))
#define CADT_NOISE_BEGIN(mesh, item, setting)                 \
  cadt_noise mesh##_noise = cadt_noise_of((item), (setting)); \
  mesh.noise = &mesh##_noise
#else
#define CADT_NOISE_AT(m, site) ((void)0)
#define CADT_NOISE_FAILS(m, site) 0u
#define CADT_NOISE_BEGIN(mesh, item, setting) ((void)0)
#endif

#endif
