/* SPDX-License-Identifier: Apache-2.0
 *
 * Canonical order without a sort of all triangles: a triangle belongs to the bucket of its vertex with the smallest
 * input id; buckets are short, and within one no two triangles have the same second vertex. Buckets stand in the order
 * of the mesh's vertices, not of input ids: triangles of one bucket, and those of the next, are neighbours in the mesh,
 * so all but one word for each bucket is read and written near what was just read and written.
 *
 *   vertex of the mesh     0  1  2  3       triangles are counted, and members stand, by vertex
 *   its input id           2  0  3  1
 *   triangles              1  3  0  2
 *   bucket begins at       0  1  4  4
 *   by input id            3  2  1  0       the same sizes
 *   place in the result    0  3  5  6       scanned: the bucket of vertex 0, with input id 2, begins at place 5
 */
#ifndef CADT_OUTPUT_CANONICAL_ORDER_H
#define CADT_OUTPUT_CANONICAL_ORDER_H

#include "common/output/renumber.dev.h"
#include "common/portable/atomics.dev.h"

/* A triangle in the bucket of its smallest vertex: above, the input id of the next vertex, by which members are
 * sorted; below, the triangle and the slot of the smallest. A word of 64 bits is read and written in one access. */
typedef cadt_u64 cadt_member;
#define CADT_MEMBER(second, half_edge) (CADT_CAST(cadt_u64, second) << 32 | (half_edge))
#define CADT_SECOND_OF(member) CADT_CAST(cadt_u32, (member) >> 32)
#define CADT_HALF_EDGE_OF(member) CADT_CAST(cadt_u32, member)

/* On CPUs an atomic addition to distant memory holds up everything behind it, so triangles get their places in the
 * buckets (`places`, by triangle) when they are counted; GPUs spare the memory traffic and add again. */
#define CADT_PLACES_KNOWN CADT_CONTIGUOUS

/* The bucket of triangle t, the vertex of the mesh with the smallest input id, and what is a member of it. */
CADT_FN cadt_u32 cadt_bucket_of_triangle(CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* input_ids,
                                         cadt_u32 t, cadt_member* member) {
  const cadt_u32 x = vertices[3u * t], y = vertices[3u * t + 1u], z = vertices[3u * t + 2u];
  const cadt_triangle triangle = cadt_in_input_ids(input_ids, x, y, z);
  *member = CADT_MEMBER(triangle.b, CADT_HALF_EDGE(t, triangle.slot));
  return CADT_PICK(triangle.slot, x, y, z);
}

/* Gives the triangle of a member its place in the result (renumber.dev.h). */
CADT_FN void cadt_number_triangle(CADT_GLOBAL cadt_u32* numbers, cadt_u32 half_edge, cadt_u32 place) {
  numbers[CADT_TRIANGLE_OF(half_edge)] = CADT_HALF_EDGE(place, CADT_EDGE_OF(half_edge));
}

/* Counts the triangles of each bucket. \pre buckets are zero */
CADT_KERNEL(cadt_count_triangles, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* input_ids,
            CADT_GLOBAL cadt_u32* buckets, CADT_GLOBAL cadt_u32* places, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
    cadt_member member;
    const cadt_u32 bucket = cadt_bucket_of_triangle(vertices, input_ids, t, &member);
#if CADT_PLACES_KNOWN
    places[t] = cadt_add_relaxed(buckets + bucket, 1u);
#else
    cadt_add_relaxed(buckets + bucket, 1u);
#endif
  }
}

/* The sizes of the buckets by input id: a scan makes of them the place in the result at which each begins.
 * \pre sizes are zero; buckets behind the last vertex are */
CADT_KERNEL(cadt_sizes_by_input, CADT_GLOBAL const cadt_u32* buckets, CADT_GLOBAL const cadt_u32* input_ids,
            CADT_GLOBAL cadt_u32* sizes, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(v, count, grain) {
    const cadt_u32 size = buckets[v];
    if (size) sizes[input_ids[v]] = size;
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
 * bucket. \pre buckets are scanned: where they begin; \post where they end, or still where
 * they begin if places are known */
CADT_KERNEL(cadt_bucket_triangles, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* input_ids,
            CADT_GLOBAL cadt_u32* buckets, CADT_GLOBAL const cadt_u32* places, CADT_GLOBAL cadt_member* members,
            cadt_u32 from, cadt_u32 size, cadt_u32 base, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
    cadt_member member;
    const cadt_u32 bucket = cadt_bucket_of_triangle(vertices, input_ids, t, &member);
    if (bucket - from >= size) continue;
#if CADT_PLACES_KNOWN
    members[buckets[bucket] + places[t] - base] = member;
#else
    members[cadt_add_relaxed(buckets + bucket, 1u) - base] = member;
#endif
  }
}

/* Heap sort. */
CADT_FN void cadt_sift_down(CADT_GLOBAL cadt_member* bucket, cadt_u32 at, cadt_u32 size) {
  const cadt_member moving = bucket[at];
  for (;;) {
    cadt_u32 child = 2u * at + 1u;
    if (child >= size) break;
    if (child + 1u < size && bucket[child + 1u] > bucket[child]) ++child;
    if (bucket[child] <= moving) break;
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

/* Where the members of bucket v begin, after cadt_bucket_triangles. */
CADT_FN cadt_u32 cadt_bucket_begin(CADT_GLOBAL const cadt_u32* buckets, cadt_u32 v) {
#if CADT_PLACES_KNOWN
  return buckets[v];
#else
  return v ? buckets[v - 1u] : 0u;
#endif
}

/* Where bucket v, whose members begin at `begin`, begins in the result: if vertices are input ids, without
 * `result_begins`, at the same place. */
CADT_FN cadt_u32 cadt_place_of_bucket(CADT_GLOBAL const cadt_u32* input_ids, CADT_GLOBAL const cadt_u32* result_begins,
                                      cadt_u32 v, cadt_u32 begin) {
  return result_begins ? result_begins[input_ids[v]] : begin;
}

/* numbers[t] = place of triangle t in the result and its slot, for the triangles of the `count` buckets from `from` on;
 * the first member of these, of all the one with number `base`, stands at members[0]. A short bucket stays as it is: a
 * triangle comes behind those with a smaller second vertex. Skips buckets with more than `longest` triangles and counts
 * these in `skipped`: the longest, around vertices of high degree, are sorted together by all work-items if there is
 * memory for it. */
CADT_KERNEL(cadt_number_buckets, CADT_GLOBAL const cadt_u32* buckets, CADT_GLOBAL cadt_member* members,
            CADT_GLOBAL const cadt_u32* input_ids, CADT_GLOBAL const cadt_u32* result_begins,
            CADT_GLOBAL cadt_u32* numbers, cadt_u32 from, cadt_u32 count, cadt_u32 base, cadt_u32 longest,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* skipped) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 begin = cadt_bucket_begin(buckets, from + i);
    const cadt_u32 size = cadt_bucket_begin(buckets, from + i + 1u) - begin;
    if (!size) continue; /* behind the last vertex there are no input ids either */
    if (size > longest) {
      cadt_add_relaxed(skipped, size);
      continue;
    }
    CADT_GLOBAL cadt_member* bucket = members + (begin - base);
    const cadt_u32 first = cadt_place_of_bucket(input_ids, result_begins, from + i, begin);
    if (size <= CADT_CAST(cadt_u32, CADT_SHORT_BUCKET)) {
      for (cadt_u32 e = 0u; e < size; ++e) {
        const cadt_member member = bucket[e];
        cadt_u32 place = first;
        for (cadt_u32 f = 0u; f < size; ++f) place += bucket[f] < member ? 1u : 0u;
        cadt_number_triangle(numbers, CADT_HALF_EDGE_OF(member), place);
      }
    } else {
      cadt_heap_sort(bucket, size);
      for (cadt_u32 e = 0u; e < size; ++e) cadt_number_triangle(numbers, CADT_HALF_EDGE_OF(bucket[e]), first + e);
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

/* Packs these triangles into one list: second vertex, triangle and slot, bucket, and the place in the result of whoever
 * comes here once the list is sorted. `ranks` is the scan of the flags. */
CADT_KERNEL(cadt_long_pack, CADT_GLOBAL const cadt_u32* buckets, CADT_GLOBAL const cadt_member* members,
            CADT_GLOBAL const cadt_u32* input_ids, CADT_GLOBAL const cadt_u32* result_begins, cadt_u32 from,
            cadt_u32 size, cadt_u32 base, CADT_GLOBAL const cadt_u32* ranks, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* seconds, CADT_GLOBAL cadt_u32* half_edges, CADT_GLOBAL cadt_u32* owners,
            CADT_GLOBAL cadt_u32* places) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 at = ranks[i];
    if (ranks[i + 1u] == at) continue;
    seconds[at] = CADT_SECOND_OF(members[i]);
    half_edges[at] = CADT_HALF_EDGE_OF(members[i]);
    const cadt_u32 v = cadt_bucket_of(buckets, from, size, base + i), begin = cadt_bucket_begin(buckets, v);
    owners[at] = v - from;
    places[at] = cadt_place_of_bucket(input_ids, result_begins, v, begin) + (base + i - begin);
  }
}

/* numbers[t] of the triangles of the sorted list: entry order[at] comes to the place of entry `at`. */
CADT_KERNEL(cadt_long_numbers, CADT_GLOBAL const cadt_u32* order, CADT_GLOBAL const cadt_u32* half_edges,
            CADT_GLOBAL const cadt_u32* places, CADT_GLOBAL cadt_u32* numbers, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(at, count, grain) { cadt_number_triangle(numbers, half_edges[order[at]], places[at]); }
}

#endif
