/* SPDX-License-Identifier: Apache-2.0
 *
 * The mesh as arrays of input indices. Canonical order without a sort of all triangles: a triangle belongs to the
 * bucket of its smallest index; buckets are short and within one no two triangles have the same second vertex.
 */
#ifndef CADT_OUTPUT_RENUMBER_H
#define CADT_OUTPUT_RENUMBER_H

#include "common/certify/certify.dev.h"
#include "common/overlay/flip_histogram.dev.h"

/* A triangle in input indices, rotated so that the smallest comes first; `slot` is the slot of that vertex. */
typedef struct {
  cadt_u32 a, b, c, slot;
} cadt_triangle;

/* A real triangle in the bucket of its smallest vertex. */
typedef struct {
  cadt_u32 second, triangle;
} cadt_member;

/* `labels` null: these are input indices. */
CADT_FN cadt_triangle cadt_input_id(CADT_GLOBAL const cadt_u32* input_ids, cadt_u32 v0, cadt_u32 v1, cadt_u32 v2) {
  const cadt_u32 x = input_ids ? input_ids[v0] : v0, y = input_ids ? input_ids[v1] : v1,
                 z = input_ids ? input_ids[v2] : v2;
  cadt_triangle t;
  t.slot = x < y ? (x < z ? 0u : 2u) : (y < z ? 1u : 2u);
  t.a = CADT_PICK(t.slot, x, y, z);
  t.b = CADT_PICK(t.slot, y, z, x);
  t.c = CADT_PICK(t.slot, z, x, y);
  return t;
}

/* Whether the record is in use and not a ghost's. */
CADT_FN cadt_u32 cadt_is_real(const cadt_locked_triangle* r) {
  return r->word[CADT_WORD_LOCK] != 0u && r->word[0] != CADT_GHOST && r->word[1] != CADT_GHOST &&
                 r->word[2] != CADT_GHOST
             ? 1u
             : 0u;
}

/* Triangle t of the mesh, in records or, if these are null, in arrays that have real ones only: links are left out. */
CADT_FN void cadt_read_vertices(CADT_GLOBAL const cadt_locked_triangle* locked, CADT_GLOBAL const cadt_u32* vertices,
                                cadt_u32 t, cadt_locked_triangle* r) {
  if (locked) {
    *r = locked[t];
    return;
  }
  for (cadt_u32 k = 0u; k < 3u; ++k) r->word[k] = cadt_word_of_three(vertices, t, k);
  r->word[CADT_WORD_LOCK] = 2u;
  r->word[CADT_WORD_FLIPS] = 0u;
}

/* On CPUs an addition in memory that is far away holds up everything behind it, so triangles get their places in their
 * buckets (`places`, by record) when they are counted; GPUs have no use for the memory traffic, and add again. */
#define CADT_PLACES_KNOWN CADT_CONTIGUOUS

/* Size of each bucket, and edges by flips. \pre buckets are zero */
CADT_KERNEL(cadt_count_triangles, CADT_GLOBAL const cadt_locked_triangle* locked, CADT_GLOBAL const cadt_u32* vertices,
            CADT_GLOBAL const cadt_u32* input_ids, CADT_GLOBAL cadt_u32* buckets, CADT_GLOBAL cadt_u32* places,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* flips) {
  CADT_FLIPS_BEGIN(bins, flips);
  CADT_FOR(t, count, grain) {
    cadt_locked_triangle r;
    cadt_read_vertices(locked, vertices, t, &r);
    if (r.word[CADT_WORD_LOCK] == 0u) continue;
    CADT_FLIPS_COUNT(bins, flips, r);
    if (!cadt_is_real(&r)) continue;
#if CADT_PLACES_KNOWN
    places[t] = cadt_add_relaxed(buckets + cadt_input_id(input_ids, r.word[0], r.word[1], r.word[2]).a, 1u);
#else
    cadt_add_relaxed(buckets + cadt_input_id(input_ids, r.word[0], r.word[1], r.word[2]).a, 1u);
#endif
  }
  CADT_FLIPS_END(bins, flips);
}

/* Cuts scanned buckets in `parts` with about as many triangles each. cuts[2 * k]: the first bucket of part k, and the
 * first triangle; at the end those behind the last. \pre there are triangles */
CADT_KERNEL(cadt_cut_buckets, CADT_GLOBAL const cadt_u32* buckets, cadt_u32 count, cadt_u32 triangles, cadt_u32 parts,
            cadt_u32 grain, CADT_GLOBAL cadt_u32* cuts) {
  if (cadt_item == 0u) cuts[0] = cuts[1] = 0u;
  CADT_FOR(v, count, grain) {
    const cadt_u32 end = buckets[v + 1u];
    const cadt_u32 before = CADT_CAST(cadt_u32, CADT_CAST(cadt_u64, buckets[v]) * parts / triangles);
    const cadt_u32 after = CADT_CAST(cadt_u32, CADT_CAST(cadt_u64, end) * parts / triangles);
    for (cadt_u32 k = before + 1u; k <= after; ++k) {
      cuts[2u * k] = v + 1u;
      cuts[2u * k + 1u] = end;
    }
  }
}

/* Puts each real triangle of `size` buckets from `from` on, whose first is triangle `base`, in its bucket: (second
 * vertex, record). \pre buckets are scanned (their beginnings); \post their ends, or still their beginnings where
 * places are known */
CADT_KERNEL(cadt_bucket_triangles, CADT_GLOBAL const cadt_locked_triangle* locked, CADT_GLOBAL const cadt_u32* vertices,
            CADT_GLOBAL const cadt_u32* input_ids, CADT_GLOBAL cadt_u32* buckets, CADT_GLOBAL const cadt_u32* places,
            CADT_GLOBAL cadt_member* members, cadt_u32 from, cadt_u32 size, cadt_u32 base, cadt_u32 count,
            cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
    cadt_locked_triangle r;
    cadt_read_vertices(locked, vertices, t, &r);
    if (!cadt_is_real(&r)) continue;
    const cadt_triangle input_id = cadt_input_id(input_ids, r.word[0], r.word[1], r.word[2]);
    if (input_id.a - from >= size) continue;
    cadt_member member;
    member.second = input_id.b;
    member.triangle = t;
#if CADT_PLACES_KNOWN
    members[buckets[input_id.a] + places[t] - base] = member;
#else
    members[cadt_add_relaxed(buckets + input_id.a, 1u) - base] = member;
#endif
  }
}

/* Sorts each bucket by the second vertex. The hub of a wheel has one triangle a point: long buckets are sorted by heap
 * sort, the longest as one list by all work-items, if there is memory for that. */
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

enum { CADT_SHORT_BUCKET = 24 };

/* Where bucket v begins, after cadt_bucket_triangles. */
CADT_FN cadt_u32 cadt_bucket_begin(CADT_GLOBAL const cadt_u32* buckets, cadt_u32 v) {
#if CADT_PLACES_KNOWN
  return buckets[v];
#else
  return v ? buckets[v - 1u] : 0u;
#endif
}

/* `count` buckets from `from` on; the first triangle is `base`, at members. Buckets with more than `longest` are
 * skipped; `skipped` counts their triangles. */
CADT_KERNEL(cadt_sort_buckets, CADT_GLOBAL const cadt_u32* buckets, CADT_GLOBAL cadt_member* members, cadt_u32 from,
            cadt_u32 count, cadt_u32 base, cadt_u32 longest, cadt_u32 grain, CADT_GLOBAL cadt_u32* skipped) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 begin = cadt_bucket_begin(buckets, from + i);
    const cadt_u32 size = cadt_bucket_begin(buckets, from + i + 1u) - begin;
    if (size > longest) {
      cadt_add_relaxed(skipped, size);
      continue;
    }
    CADT_GLOBAL cadt_member* bucket = members + (begin - base);
    if (size <= CADT_CAST(cadt_u32, CADT_SHORT_BUCKET)) {
      for (cadt_u32 e = 1u; e < size; ++e) {
        const cadt_member moving = bucket[e];
        cadt_u32 at = e;
        for (; at > 0u && bucket[at - 1u].second > moving.second; --at) bucket[at] = bucket[at - 1u];
        bucket[at] = moving;
      }
    } else {
      for (cadt_u32 at = size / 2u; at-- > 0u;) cadt_sift_down(bucket, at, size);
      for (cadt_u32 left = size - 1u; left > 0u; --left) {
        const cadt_member last = bucket[left];
        bucket[left] = bucket[0];
        bucket[0] = last;
        cadt_sift_down(bucket, 0u, left);
      }
    }
  }
}

/* The bucket of triangle i, among `count` from `from` on. */
CADT_FN cadt_u32 cadt_bucket_of(CADT_GLOBAL const cadt_u32* buckets, cadt_u32 from, cadt_u32 count, cadt_u32 i) {
  cadt_u32 low = from, high = from + count;
  while (high - low > 1u) {
    const cadt_u32 middle = low + (high - low) / 2u;
    if (cadt_bucket_begin(buckets, middle) <= i)
      low = middle;
    else
      high = middle;
  }
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

/* Those triangles in one list: second vertex, record, bucket and place of each. `ranks` is the scan of the flags. */
CADT_KERNEL(cadt_long_pack, CADT_GLOBAL const cadt_u32* buckets, CADT_GLOBAL const cadt_member* members, cadt_u32 from,
            cadt_u32 size, cadt_u32 base, CADT_GLOBAL const cadt_u32* ranks, cadt_u32 count, cadt_u32 grain,
            CADT_GLOBAL cadt_u32* seconds, CADT_GLOBAL cadt_u32* locked, CADT_GLOBAL cadt_u32* owners,
            CADT_GLOBAL cadt_u32* places) {
  CADT_FOR(i, count, grain) {
    const cadt_u32 at = ranks[i];
    if (ranks[i + 1u] == at) continue;
    seconds[at] = members[i].second;
    locked[at] = members[i].triangle;
    owners[at] = cadt_bucket_of(buckets, from, size, base + i) - from;
    places[at] = i;
  }
}

/* The list back to its places, sorted: entry `order[at]` goes to that of entry `at`. */
CADT_KERNEL(cadt_long_store, CADT_GLOBAL const cadt_u32* order, CADT_GLOBAL const cadt_u32* seconds,
            CADT_GLOBAL const cadt_u32* locked, CADT_GLOBAL const cadt_u32* places, CADT_GLOBAL cadt_member* members,
            cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(at, count, grain) {
    members[places[at]].second = seconds[order[at]];
    members[places[at]].triangle = locked[order[at]];
  }
}

/* numbers[record] = index of the triangle. \pre numbers of ghosts are CADT_NONE */
CADT_KERNEL(cadt_number_triangles, CADT_GLOBAL const cadt_member* members, CADT_GLOBAL cadt_u32* numbers, cadt_u32 base,
            cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(i, count, grain) { numbers[members[i].triangle] = base + i; }
}

/* Writes a triangle to its place. n0, n1, n2: the triangles across the edges as the mesh has them. */
CADT_FN void cadt_write_triangle(const cadt_triangle t, cadt_u32 at, cadt_u32 n0, cadt_u32 n1, cadt_u32 n2,
                                 CADT_GLOBAL cadt_u32* triangles, CADT_GLOBAL cadt_u32* neighbors) {
  if (triangles) {
    triangles[3u * at] = t.a;
    triangles[3u * at + 1u] = t.b;
    triangles[3u * at + 2u] = t.c;
  }
  if (neighbors) {
    neighbors[3u * at] = CADT_PICK(t.slot, n0, n1, n2);
    neighbors[3u * at + 1u] = CADT_PICK(t.slot, n1, n2, n0);
    neighbors[3u * at + 2u] = CADT_PICK(t.slot, n2, n0, n1);
  }
}

/* Writes the triangles to their places, behind `first` others that have nothing to do with them. By record, so that
 * what is read (neighbours' numbers, labels) is near. */
CADT_KERNEL(cadt_write_triangles, CADT_GLOBAL const cadt_locked_triangle* locked, CADT_GLOBAL const cadt_u32* input_ids,
            CADT_GLOBAL const cadt_u32* numbers, CADT_GLOBAL cadt_u32* triangles, CADT_GLOBAL cadt_u32* neighbors,
            cadt_u32 first, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(triangle, count, grain) {
    const cadt_u32 i = numbers[triangle];
    if (i == CADT_NONE) continue;
    const cadt_locked_triangle r = locked[triangle];
    /* ghosts have no number: CADT_NONE is -1 */
    cadt_write_triangle(cadt_input_id(input_ids, r.word[0], r.word[1], r.word[2]), first + i,
                        numbers[CADT_TRIANGLE_OF(r.word[4])], numbers[CADT_TRIANGLE_OF(r.word[5])],
                        numbers[CADT_TRIANGLE_OF(r.word[6])], triangles, neighbors);
  }
}

/* For the order of the records: 1 for each real triangle. flags[count] becomes 0, so its scan is the total. Edges by
 * flips besides. */
CADT_KERNEL(cadt_flag_triangles, CADT_GLOBAL const cadt_locked_triangle* locked, CADT_GLOBAL cadt_u32* flags,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* flips) {
  CADT_FLIPS_BEGIN(bins, flips);
  if (cadt_item == 0u) flags[count] = 0u;
  CADT_FOR(t, count, grain) {
    const cadt_locked_triangle r = locked[t];
    flags[t] = cadt_is_real(&r);
    if (r.word[CADT_WORD_LOCK] != 0u) {
      CADT_FLIPS_COUNT(bins, flips, r);
    }
  }
  CADT_FLIPS_END(bins, flips);
}

/* Number of a triangle from the exclusive scan of the flags. */
CADT_FN cadt_u32 cadt_rank(CADT_GLOBAL const cadt_u32* ranks, cadt_u32 half_edge) {
  const cadt_u32 t = CADT_TRIANGLE_OF(half_edge), rank = ranks[t];
  return ranks[t + 1u] != rank ? rank : CADT_NONE;
}

/* As cadt_write_triangles, in the order of the records. `ranks` is the exclusive scan of the flags. */
CADT_KERNEL(cadt_write_ranked, CADT_GLOBAL const cadt_locked_triangle* locked, CADT_GLOBAL const cadt_u32* input_ids,
            CADT_GLOBAL const cadt_u32* ranks, CADT_GLOBAL cadt_u32* triangles, CADT_GLOBAL cadt_u32* neighbors,
            cadt_u32 first, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(triangle, count, grain) {
    const cadt_u32 i = ranks[triangle];
    if (ranks[triangle + 1u] == i) continue;
    const cadt_locked_triangle r = locked[triangle];
    cadt_write_triangle(cadt_input_id(input_ids, r.word[0], r.word[1], r.word[2]), first + i,
                        cadt_rank(ranks, r.word[4]), cadt_rank(ranks, r.word[5]), cadt_rank(ranks, r.word[6]),
                        triangles, neighbors);
  }
}

/* Number of the triangle behind a link in arrays; `numbers` null: as it is. */
CADT_FN cadt_u32 cadt_number_behind(CADT_GLOBAL const cadt_u32* numbers, cadt_u32 half_edge, cadt_u32 count) {
  const cadt_u32 t = CADT_TRIANGLE_OF(half_edge);
  return t >= count ? CADT_NONE : (numbers ? numbers[t] : t);
}

/* As cadt_write_triangles, from arrays of which the first `count` triangles are real, each array by itself if the other
 * result is null. Without numbers the results may be the arrays themselves. */
CADT_KERNEL(cadt_write_arrays, CADT_GLOBAL const cadt_u32* vertices, CADT_GLOBAL const cadt_u32* half_edges,
            CADT_GLOBAL const cadt_u32* input_ids, CADT_GLOBAL const cadt_u32* numbers, CADT_GLOBAL cadt_u32* triangles,
            CADT_GLOBAL cadt_u32* neighbors, cadt_u32 first, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
    const cadt_triangle input_id =
        cadt_input_id(input_ids, cadt_word_of_three(vertices, t, 0u), cadt_word_of_three(vertices, t, 1u),
                      cadt_word_of_three(vertices, t, 2u));
    cadt_u32 n0 = CADT_NONE, n1 = CADT_NONE, n2 = CADT_NONE;
    if (neighbors) { /* else there may be no links any more */
      n0 = cadt_number_behind(numbers, cadt_word_of_three(half_edges, t, 0u), count);
      n1 = cadt_number_behind(numbers, cadt_word_of_three(half_edges, t, 1u), count);
      n2 = cadt_number_behind(numbers, cadt_word_of_three(half_edges, t, 2u), count);
    }
    cadt_write_triangle(input_id, first + (numbers ? numbers[t] : t), n0, n1, n2, triangles, neighbors);
  }
}

/* Moves the triangles of a finished array to their places in three steps, one for each word `k` of a triangle, by way
 * of `moved`: it costs more time than a second array, and a third of its memory. `links`: the words are triangles. */
CADT_KERNEL(cadt_move_words, CADT_GLOBAL const cadt_u32* words, CADT_GLOBAL const cadt_u32* numbers, cadt_u32 k,
            cadt_u32 half_edges, CADT_GLOBAL cadt_u32* moved, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
    const cadt_u32 value = cadt_word_of_three(words, t, k);
    moved[numbers[t]] = half_edges && value != CADT_NONE ? numbers[value] : value;
  }
}

CADT_KERNEL(cadt_put_words, CADT_GLOBAL const cadt_u32* moved, CADT_GLOBAL cadt_u32* words, cadt_u32 k, cadt_u32 count,
            cadt_u32 grain) {
  CADT_FOR(t, count, grain) { words[3u * t + k] = moved[t]; }
}

/* Edges of the boundary counterclockwise as pairs of input indices, in any order. `size` counts them. */
CADT_KERNEL(cadt_boundary_edges, CADT_GLOBAL const cadt_u32* triangles, CADT_GLOBAL const cadt_u32* neighbors,
            cadt_u32 count, cadt_u32 grain, CADT_GLOBAL cadt_u32* pairs, CADT_GLOBAL cadt_u32* size,
            cadt_u32 capacity) {
  CADT_FOR(t, count, grain) {
    for (cadt_u32 k = 0u; k < 3u; ++k) {
      if (neighbors[3u * t + k] != CADT_NONE) continue;
      const cadt_u32 at = cadt_add_relaxed(size, 1u);
      if (at >= capacity) continue;
      pairs[2u * at] = triangles[3u * t + CADT_NEXT(k)];
      pairs[2u * at + 1u] = triangles[3u * t + CADT_PREV(k)];
    }
  }
}

#endif
