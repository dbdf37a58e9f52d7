/* SPDX-License-Identifier: Apache-2.0
 *
 * Sites of the lock protocol at which tests (tests/robustness/concurrency) delay a work-item or let a claim fail.
 * Nothing of it is in the library: without CADT_SCHEDULE_NOISE all macros are empty.
 *
 * What is done comes with each call in Options::quality_epsilon, which insertion asks for nothing else while
 * Options::stabilize is off: eight times a seed, and a mode of cadt_noise_mode. So the same kernels serve all modes, on
 * every back end.
 */
#ifndef CADT_OVERLAY_SCHEDULE_NOISE_H
#define CADT_OVERLAY_SCHEDULE_NOISE_H

#include "common/portable/dialect.dev.h"

#if defined(CADT_SCHEDULE_NOISE)

enum {
  CADT_SITE_WALK,               /* before a walk reads the next record as a hint */
  CADT_SITE_FIELDS,             /* CPUs: between a lock word and the fields behind it */
  CADT_SITE_WALK_START,         /* before the hint of a vertex is followed */
  CADT_SITE_SECOND_TRIANGLE,    /* between the reads of the two triangles of an edge */
  CADT_SITE_TRY_LOCK,           /* what was read is decided upon; before the first claim */
  CADT_SITE_LOCKED,             /* behind each claim that is won, and so between them. From here on records are held */
  CADT_SITE_VALIDATE,           /* all are claimed; before they are read again */
  CADT_SITE_WRITE,              /* before the first store */
  CADT_SITE_NEXT_TRIANGLE,      /* between the records of a change */
  CADT_SITE_HALF_EDGES,         /* before the links back from the neighbours */
  CADT_SITE_NEXT_HALF_EDGE,     /* between them */
  CADT_SITE_PUBLISH,            /* before new records are made free */
  CADT_SITE_NEXT_PUBLISH,       /* between them */
  CADT_SITE_UNLOCK,             /* before the first record is given back, changed */
  CADT_SITE_UNLOCKED,           /* behind each of them */
  CADT_SITE_UNLOCKED_UNCHANGED, /* behind each one that is given back unchanged. Up to here records are held */
  CADT_SITE_VERTEX_TRIANGLE,    /* between a flip and the hints of its vertices */
  CADT_SITE_TAKE_EDGE,          /* before an edge is taken from the worklist */
  CADT_SITE_PUSH_EDGE,          /* before or behind an edge's way to the worklist or to the next launch */
  CADT_SITE_PUSH_POINT,         /* between the place on the list of points and its store */
  CADT_SITE_PARTITION,          /* ranges without locks: between the stores of a split and its publication */
  CADT_SITES
};

/* cadt_noise_mode */
enum {
  CADT_NOISE_OFF,
  CADT_NOISE_UNIFORM,  /* every fourth site delays, from nothing to some microseconds */
  CADT_NOISE_SLOW,     /* one work-item of sixteen is slow everywhere */
  CADT_NOISE_HOLDERS,  /* who holds records is slow */
  CADT_NOISE_FAILURES, /* claims fail with probability 1/2 each, and confirmations with 1/4 */
  CADT_NOISE_ALL,      /* some of each */
  CADT_NOISE_MODES
};

typedef struct {
  cadt_u32 state, mode, slow;
} cadt_noise;

CADT_FN cadt_u32 cadt_noise_mix(cadt_u32 x) {
  x = (x ^ (x >> 16)) * 0x85EBCA6Bu;
  x = (x ^ (x >> 13)) * 0xC2B2AE35u;
  return x ^ (x >> 16);
}

/* Failures must differ from launch to launch: else who is alone and has failed once would fail for ever. */
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
  cadt_count_site(site); /* of the program of the test */
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

/* Whether this claim or confirmation is to fail though it need not. */
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
