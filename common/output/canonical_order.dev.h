/* SPDX-License-Identifier: Apache-2.0
 *
 * Canonical order without a sort of all triangles: a triangle belongs to the bucket of its smallest input id; buckets
 * are short, and within one no two triangles have the same second vertex.
 */
#ifndef CADT_OUTPUT_CANONICAL_ORDER_H
#define CADT_OUTPUT_CANONICAL_ORDER_H

#include "common/output/renumber.dev.h"
#include "common/portable/atomics.dev.h"

/* A triangle in the bucket of its smallest vertex. */
typedef struct {
  cadt_u32 second, triangle;
} cadt_member;

/* On CPUs an atomic addition to distant memory holds up everything behind it, so triangles get their places in the
 * buckets (`places`, by triangle) when they are counted; GPUs spare the memory traffic and add again. */
#define CADT_PLACES_KNOWN CADT_CONTIGUOUS

CADT_FN cadt_triangle cadt_read_triangle(CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* input_ids,
                                         cadt_u32 t) {
  return cadt_in_input_ids(input_ids, vertices[3u * t], vertices[3u * t + 1u], vertices[3u * t + 2u]);
}

/* Counts the triangles of each bucket. \pre buckets are zero */
CADT_KERNEL(cadt_count_triangles, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* input_ids,
            CADT_GLOBAL cadt_u32* buckets, CADT_GLOBAL cadt_u32* places, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
#if CADT_PLACES_KNOWN
    places[t] = cadt_add_relaxed(buckets + cadt_read_triangle(vertices, input_ids, t).a, 1u);
#else
    cadt_add_relaxed(buckets + cadt_read_triangle(vertices, input_ids, t).a, 1u);
#endif
  }
}

/* Splits scanned buckets into `parts` of about as many triangles each. begins[2 * k] and the next word: the first
 * bucket and the first triangle of part k; at the end those behind the last part. \pre there are triangles */
CADT_KERNEL(cadt_split_buckets, CADT_GLOBAL const cadt_u32* buckets, cadt_u32 count, cadt_u32 triangles, cadt_u32 parts,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* begins) {
  if (cadt_item == 0u) begins[0] = begins[1] = 0u;
  CADT_FOR(v, count, grain) {
    const cadt_u32 end = buckets[v + 1u];
    const cadt_u32 before = CADT_CAST(cadt_u32, CADT_CAST(cadt_u64, buckets[v]) * parts / triangles);
    const cadt_u32 after = CADT_CAST(cadt_u32, CADT_CAST(cadt_u64, end) * parts / triangles);
    for (cadt_u32 k = before + 1u; k <= after; ++k) {
      begins[2u * k] = v + 1u;
      begins[2u * k + 1u] = end;
    }
  }
}

/* Puts each triangle of the `size` buckets from `from` on, whose first triangle has number `base`, into its
 * bucket: (second vertex, triangle). \pre buckets are scanned: where they begin; \post where they end, or still where
 * they begin if places are known */
CADT_KERNEL(cadt_bucket_triangles, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* input_ids,
            CADT_GLOBAL cadt_u32* buckets, CADT_GLOBAL const cadt_u32* places, CADT_GLOBAL cadt_member* members,
            cadt_u32 from, cadt_u32 size, cadt_u32 base, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
    const cadt_triangle triangle = cadt_read_triangle(vertices, input_ids, t);
    if (triangle.a - from >= size) continue;
    const cadt_member member = {triangle.b, t};
#if CADT_PLACES_KNOWN
    members[buckets[triangle.a] + places[t] - base] = member;
#else
    members[cadt_add_relaxed(buckets + triangle.a, 1u) - base] = member;
#endif
  }
}

/* Heap sort by the second vertex. */
CADT_FN void cadt_sift_down(CADT_GLOBAL cadt_member* bucket, cadt_u32 at, cadt_u32 size) {
  const cadt_member moving = bucket[at];
  for (;;) {
    cadt_u32 child = 2u * at + 1u;
    if (child >= size) break;
    if (child + 1u < size && bucket[child + 1u].second > bucket[child].second) ++child;
    if (bucket[child].second <= moving.second) break;
    bucket[at] = bucket[child];
    at = child;
  }
  bucket[at] = moving;
}

CADT_FN void cadt_heap_sort(CADT_GLOBAL cadt_member* bucket, cadt_u32 size) {
  for (cadt_u32 at = size / 2u; at-- > 0u;) cadt_sift_down(bucket, at, size);
  for (cadt_u32 last = size - 1u; last > 0u; --last) {
    const cadt_member moving = bucket[last];
    bucket[last] = bucket[0];
    bucket[0] = moving;
    cadt_sift_down(bucket, 0u, last);
  }
}

enum { CADT_SHORT_BUCKET = 24 };

/* Where bucket v begins, after cadt_bucket_triangles. */
CADT_FN cadt_u32 cadt_bucket_begin(CADT_GLOBAL const cadt_u32* buckets, cadt_u32 v) {
#if CADT_PLACES_KNOWN
  return buckets[v];
#else
  return v ? buckets[v - 1u] : 0u;
#endif
}

/* numbers[t] = place of triangle t in the result, for the triangles of the `count` buckets from `from` on; the first
 * has number `base`, and stands at members[0]. A short bucket stays as it is: a triangle comes behind those with a
 * smaller second vertex. Skips buckets with more than `longest` triangles and counts these in `skipped`: the longest,
 * around vertices of high degree, are sorted together by all work-items if there is memory for it. */
CADT_KERNEL(cadt_number_buckets, CADT_GLOBAL const cadt_u32* buckets, CADT_GLOBAL cadt_member* members,
            CADT_GLOBAL cadt_u32* numbers, cadt_u32 from, cadt_u32 count, cadt_u32 base, cadt_u32 longest,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* skipped) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 begin = cadt_bucket_begin(buckets, from + i);
    const cadt_u32 size = cadt_bucket_begin(buckets, from + i + 1u) - begin;
    if (size > longest) {
      cadt_add_relaxed(skipped, size);
      continue;
    }
    CADT_GLOBAL cadt_member* bucket = members + (begin - base);
    if (size <= CADT_CAST(cadt_u32, CADT_SHORT_BUCKET)) {
      for (cadt_u32 e = 0u; e < size; ++e) {
        const cadt_member member = bucket[e];
        cadt_u32 place = begin;
        for (cadt_u32 f = 0u; f < size; ++f) place += bucket[f].second < member.second ? 1u : 0u;
        numbers[member.triangle] = place;
      }
    } else {
      cadt_heap_sort(bucket, size);
      for (cadt_u32 e = 0u; e < size; ++e) numbers[bucket[e].triangle] = begin + e;
    }
  }
}

/* The bucket of triangle i, among `count` from `from` on. */
CADT_FN cadt_u32 cadt_bucket_of(CADT_GLOBAL const cadt_u32* buckets, cadt_u32 from, cadt_u32 count, cadt_u32 i) {
  cadt_u32 low = from, high = from + count;
  CADT_FIND_LAST(low, high, middle, cadt_bucket_begin(buckets, middle) <= i);
  return low;
}

/* 1 for each of `count` triangles from `base` on whose bucket has more than `longest`; flags[count] becomes 0. */
CADT_KERNEL(cadt_long_flags, CADT_GLOBAL const cadt_u32* buckets, cadt_u32 from, cadt_u32 size, cadt_u32 base,
            cadt_u32 longest, cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* flags) {
  if (cadt_item == 0u) flags[count] = 0u;
  CADT_FOR(i, count, grain) {
    const cadt_u32 v = cadt_bucket_of(buckets, from, size, base + i);
    flags[i] = cadt_bucket_begin(buckets, v + 1u) - cadt_bucket_begin(buckets, v) > longest ? 1u : 0u;
  }
}

/* Packs these triangles into one list: second vertex, triangle, bucket and place of each. `ranks` is the scan of the
 * flags. */
CADT_KERNEL(cadt_long_pack, CADT_GLOBAL const cadt_u32* buckets, CADT_GLOBAL const cadt_member* members, cadt_u32 from,
            cadt_u32 size, cadt_u32 base, CADT_GLOBAL const cadt_u32* ranks, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* seconds, CADT_GLOBAL cadt_u32* triangles, CADT_GLOBAL cadt_u32* owners,
            CADT_GLOBAL cadt_u32* places) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 at = ranks[i];
    if (ranks[i + 1u] == at) continue;
    seconds[at] = members[i].second;
    triangles[at] = members[i].triangle;
    owners[at] = cadt_bucket_of(buckets, from, size, base + i) - from;
    places[at] = i;
  }
}

/* numbers[t] of the triangles of the sorted list: entry order[at] comes to the place of entry `at`. */
CADT_KERNEL(cadt_long_numbers, CADT_GLOBAL const cadt_u32* order, CADT_GLOBAL const cadt_u32* triangles,
            CADT_GLOBAL const cadt_u32* places, CADT_GLOBAL cadt_u32* numbers, cadt_u32 base, cadt_u32 count,
            cadt_u32 grain) {
  CADT_FOR(at, count, grain) { numbers[triangles[order[at]]] = base + places[at]; }
}

#endif
