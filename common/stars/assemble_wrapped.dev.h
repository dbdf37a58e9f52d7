/* SPDX-License-Identifier: Apache-2.0
 *
 * The mesh from wrapped stars. A triangle belongs to the lowest of its vertices that has a star. A high-degree vertex
 * has none, so its triangles belong to its neighbours. An edge between two vertices without stars (high-degree
 * vertices, or the ghost) is listed with the apex on either side; high_degree.dev.h adds the triangles of three such
 * vertices, each as its three half-edges.
 */
#ifndef CADT_STARS_ASSEMBLE_WRAPPED_H
#define CADT_STARS_ASSEMBLE_WRAPPED_H

#include "common/batch/batch.dev.h"
#include "common/certify/certify.dev.h"

typedef struct {
  CADT_GLOBAL const cadt_u32* star_vertices;
  CADT_GLOBAL const cadt_u32* begins;
  CADT_GLOBAL const cadt_u32* sizes;
  CADT_GLOBAL const cadt_u32* bases; /* number of the first triangle of each vertex */
  CADT_GLOBAL const cadt_wrap_edge* edges;
  cadt_u32 edge_count;
  cadt_u32 first_extra;     /* the edges from here on are the half-edges of triangles that no star has, */
  cadt_u32 extra_real;      /* so many without the ghost first: */
  cadt_u32 first_extras[2]; /* numbers of the first of these, and of the first with the ghost */
  cadt_u32 ghosts;          /* number of the first ghost triangle of a star */
  cadt_u32 high_degree;     /* whether there are high-degree vertices */
  cadt_u32 apart;           /* the triangles without the ghost come before the others */
} cadt_wrap_set;

/* What a triangle of a vertex with its star vertices a and b adds to the packed count (layout.dev.h). */
CADT_FN cadt_u32 cadt_wrap_packed_one(cadt_u32 apart, cadt_u32 a, cadt_u32 b) {
  return apart && a != CADT_GHOST && b != CADT_GHOST ? CADT_WRAP_ONE_REAL : 1u;
}

/* Whether v precedes another vertex of its star: then v owns what they share. */
CADT_FN cadt_u32 cadt_wrap_precedes(CADT_GLOBAL const cadt_u32* sizes, cadt_u32 high_degree, cadt_u32 v,
                                    cadt_u32 other) {
  return other > v || (high_degree && sizes[other] == 0u) ? 1u : 0u;
}

/* Whether the vertex has no star: a high-degree vertex, or the ghost. */
CADT_FN cadt_u32 cadt_lacks_star(CADT_GLOBAL const cadt_u32* sizes, cadt_u32 v) {
  return v == CADT_GHOST || sizes[v] == 0u ? 1u : 0u;
}

/* Number of triangles that v owns. */
CADT_FN cadt_u32 cadt_wrap_owned(CADT_GLOBAL const cadt_u32* star, cadt_u32 size, CADT_GLOBAL const cadt_u32* sizes,
                                 cadt_u32 high_degree, cadt_u32 apart, cadt_u32 v) {
  cadt_u32 count = 0u;
  for (cadt_u32 k = 0u; k < size; ++k) {
    const cadt_u32 a = star[k], b = star[k + 1u < size ? k + 1u : 0u];
    if (cadt_wrap_precedes(sizes, high_degree, v, a) && cadt_wrap_precedes(sizes, high_degree, v, b))
      count += cadt_wrap_packed_one(apart, a, b);
  }
  return count;
}

/* owned[v]: triangles that v owns, as a packed count. Behind the last stand a 0, then the first words of `counts`, so
 * that they can be read with the scan's total, and `zeros` zeros for the next writer. The half-edges between two
 * vertices without stars are listed and counted. */
CADT_KERNEL(cadt_wrap_counts, CADT_GLOBAL const cadt_u32* star_vertices, CADT_GLOBAL const cadt_u32* begins,
            CADT_GLOBAL const cadt_u32* sizes, cadt_u32 n, cadt_u32 grain, CADT_GLOBAL cadt_u32* counts,
            CADT_GLOBAL cadt_u32* owned, cadt_u32 zeros, CADT_GLOBAL cadt_wrap_edge* edges) {
  for (cadt_u32 k = cadt_item; k < zeros; k += cadt_items) owned[n + 1u + CADT_WRAP_DRIVER_WORDS + k] = 0u;
  if (cadt_item == 0u) {
    owned[n] = 0u;
    for (cadt_u32 k = 0u; k < CADT_CAST(cadt_u32, CADT_WRAP_DRIVER_WORDS); ++k) owned[n + 1u + k] = counts[k];
  }
  const cadt_u32 high_degree = counts[CADT_WRAP_FAILED];
  CADT_FOR(v, n, grain) {
    const cadt_u32 size = sizes[v]; /* a vertex without a star has no place either */
    CADT_GLOBAL const cadt_u32* star = star_vertices + (size ? begins[v] : 0u);
    for (cadt_u32 k = 0u; high_degree && k < size; ++k) {
      const cadt_u32 a = star[k], b = star[k + 1u < size ? k + 1u : 0u];
      if (cadt_lacks_star(sizes, a) && cadt_lacks_star(sizes, b)) {
        const cadt_u32 at = cadt_add_relaxed(counts + CADT_WRAP_OPEN_EDGES, 1u);
        if (at < CADT_CAST(cadt_u32, CADT_WRAP_EDGES)) {
          const cadt_wrap_edge edge = {a, b, v};
          edges[at] = edge;
        }
      }
    }
    owned[v] = cadt_wrap_owned(star, size, sizes, high_degree, 1u, v);
  }
}

/* The same for the batched sets, which have no high-degree vertices; sets that have failed lose their stars. Each set
 * has 2n slots and 2n - 2 triangles: its last two slots stay empty, as do all of a set without stars. */
CADT_KERNEL(cadt_batch_counts, CADT_GLOBAL const cadt_u32* star_vertices, CADT_GLOBAL const cadt_u32* begins,
            CADT_GLOBAL cadt_u32* sizes, CADT_GLOBAL const cadt_u32* starts, cadt_u32 set_count,
            CADT_GLOBAL const cadt_u32* states, cadt_u32 n, cadt_u32 grain, CADT_GLOBAL cadt_u32* owned) {
  if (cadt_item == 0u) owned[n] = 0u;
  CADT_FOR(v, n, grain) {
    const cadt_u32 set = cadt_set_of(starts, set_count, v);
    if (states[set] == CADT_SET_BATCHED) {
      owned[v] = cadt_wrap_owned(star_vertices + begins[v], sizes[v], sizes, 0u, 0u, v) +
                 (v + 1u == starts[set + 1u] ? 2u : 0u);
    } else {
      owned[v] = v == starts[set] ? 2u * (starts[set + 1u] - v) : 0u;
      sizes[v] = 0u;
    }
  }
}

/* Place of vertex a in the star of v, and the packed count of triangles before it that v owns. \pre a is there */
CADT_FN cadt_u32 cadt_wrap_place(const cadt_wrap_set* s, cadt_u32 v, cadt_u32 a, cadt_u32* owned) {
  CADT_GLOBAL const cadt_u32* star = s->star_vertices + s->begins[v];
  cadt_u32 k = 0u, count = 0u, now = star[0];
  while (now != a) {
    const cadt_u32 next = star[++k];
    if (cadt_wrap_precedes(s->sizes, s->high_degree, v, now) && cadt_wrap_precedes(s->sizes, s->high_degree, v, next))
      count += cadt_wrap_packed_one(s->apart, now, next);
    now = next;
  }
  *owned = count;
  return k;
}

/* The star vertex of v before or behind its star vertex a. */
CADT_FN cadt_u32 cadt_wrap_adjacent(const cadt_wrap_set* s, cadt_u32 v, cadt_u32 a, cadt_u32 behind) {
  cadt_u32 owned;
  const cadt_u32 k = cadt_wrap_place(s, v, a, &owned), size = s->sizes[v];
  const cadt_u32 other = behind ? (k + 1u < size ? k + 1u : 0u) : (k ? k - 1u : size - 1u);
  return s->star_vertices[s->begins[v] + other];
}

/* The apex to the right of the edge from a to b. */
CADT_FN cadt_u32 cadt_wrap_right_apex(const cadt_wrap_set* s, cadt_u32 a, cadt_u32 b) {
  if (!cadt_lacks_star(s->sizes, a)) return cadt_wrap_adjacent(s, a, b, 0u);
  if (!cadt_lacks_star(s->sizes, b)) return cadt_wrap_adjacent(s, b, a, 1u);
  for (cadt_u32 e = 0u; e < s->edge_count; ++e)
    if (s->edges[e].from == b && s->edges[e].to == a) return s->edges[e].left;
  return CADT_NONE; /* never: the driver has matched all of them */
}

/* Number of the triangle of v with its star vertices a and b; `before`: packed count of the triangles of v before it.
 */
CADT_FN cadt_u32 cadt_wrap_number(const cadt_wrap_set* s, cadt_u32 v, cadt_u32 before, cadt_u32 a, cadt_u32 b) {
  const cadt_u32 sum = s->bases[v] + before;
  if (!s->apart) return sum;
  return a == CADT_GHOST || b == CADT_GHOST ? s->ghosts + CADT_WRAP_GHOSTS(sum) : CADT_WRAP_REAL(sum);
}

/* Number of a triangle that no star has; `extra`: which of them. */
CADT_FN cadt_u32 cadt_wrap_extra_number(const cadt_wrap_set* s, cadt_u32 extra) {
  return extra < s->extra_real ? s->first_extras[0] + extra : s->first_extras[1] + (extra - s->extra_real);
}

/* The half-edge in the triangle x, y, z opposite of x (0), y (1) or z (2). */
CADT_FN cadt_u32 cadt_wrap_half_edge(const cadt_wrap_set* s, cadt_u32 x, cadt_u32 y, cadt_u32 z, cadt_u32 opposite) {
  const cadt_u32 none = CADT_GHOST; /* high-degree vertices own nothing */
  const cadt_u32 i = s->high_degree && cadt_lacks_star(s->sizes, x) ? none : x;
  const cadt_u32 j = s->high_degree && cadt_lacks_star(s->sizes, y) ? none : y;
  const cadt_u32 k = s->high_degree && cadt_lacks_star(s->sizes, z) ? none : z;
  const cadt_u32 lowest = i < j ? (i < k ? 0u : 2u) : (j < k ? 1u : 2u);
  const cadt_u32 owner = CADT_PICK(lowest, x, y, z), next = CADT_PICK(lowest, y, z, x);
  if (CADT_PICK(lowest, i, j, k) == none) {
    cadt_u32 e = s->first_extra;
    while (e + 1u < s->edge_count && (s->edges[e].from != x || s->edges[e].to != y || s->edges[e].left != z)) ++e;
    e -= s->first_extra;
    return CADT_HALF_EDGE(cadt_wrap_extra_number(s, e / 3u), (opposite + e % 3u) % 3u);
  }
  cadt_u32 before;
  cadt_wrap_place(s, owner, next, &before);
  return CADT_HALF_EDGE(cadt_wrap_number(s, owner, before, next, CADT_PICK(lowest, z, x, y)),
                        opposite >= lowest ? opposite - lowest : opposite + 3u - lowest);
}

/* A triangle of its owner: number, star vertices a and b, half-edges across its edges. */
typedef struct {
  cadt_u32 number, a, b, half_edges[3];
} cadt_wrap_triangle;

/* The triangle of v with star vertices k and k + 1; returns 0 if another vertex owns it. */
CADT_FN cadt_u32 cadt_wrap_triangle_of(const cadt_wrap_set* s, cadt_u32 v, cadt_u32 k, cadt_wrap_triangle* t) {
  CADT_GLOBAL const cadt_u32* star = s->star_vertices + s->begins[v];
  const cadt_u32 size = s->sizes[v], k1 = k + 1u < size ? k + 1u : 0u, a = star[k], b = star[k1];
  if (!cadt_wrap_precedes(s->sizes, s->high_degree, v, a) || !cadt_wrap_precedes(s->sizes, s->high_degree, v, b))
    return 0u;
  cadt_u32 before;
  cadt_wrap_place(s, v, a, &before);
  t->number = cadt_wrap_number(s, v, before, a, b);
  t->a = a;
  t->b = b;
  t->half_edges[0] = cadt_wrap_half_edge(s, a, cadt_wrap_right_apex(s, a, b), b, 1u);
  t->half_edges[1] = cadt_wrap_half_edge(s, v, b, star[k1 + 1u < size ? k1 + 1u : 0u], 2u);
  t->half_edges[2] = cadt_wrap_half_edge(s, v, star[k ? k - 1u : size - 1u], a, 1u);
  return 1u;
}

CADT_FN void cadt_write_wrapped(CADT_GLOBAL cadt_u32* vertices, CADT_GLOBAL cadt_u32* half_edges, cadt_u32 v,
                                const cadt_wrap_triangle* t) {
  vertices[3u * t->number] = v;
  vertices[3u * t->number + 1u] = t->a;
  vertices[3u * t->number + 2u] = t->b;
  for (cadt_u32 edge = 0u; edge < 3u; ++edge) half_edges[3u * t->number + edge] = t->half_edges[edge];
}

/* The mesh in arrays (mesh_view.dev.h). bases[n] is the total of the stars, the counts stand behind it: if these are
 * not those of a mesh with `extra` triangles that no star has, or have a high-degree vertex where none is expected,
 * nothing is written. Else the number of triangles without the ghost goes to the words of cadt_certify, in `bases` from
 * `row` on. CADT_WRAP_SHARES work-items a vertex. */
CADT_KERNEL(cadt_wrap_arrays, CADT_GLOBAL const cadt_u32* star_vertices, CADT_GLOBAL const cadt_u32* begins,
            CADT_GLOBAL const cadt_u32* sizes, CADT_GLOBAL cadt_u32* bases, cadt_u32 star_words, cadt_u32 row,
            CADT_GLOBAL const cadt_wrap_edge* edges, cadt_u32 edge_count, cadt_u32 first_extra, cadt_u32 extra_real,
            cadt_u32 high_degree, cadt_u32 n, cadt_u32 grain, CADT_GLOBAL cadt_u32* vertices,
            CADT_GLOBAL cadt_u32* half_edges) {
  const cadt_u32 total = bases[n], extra = (edge_count - first_extra) / 3u;
  const cadt_u32 real = CADT_WRAP_REAL(total) + extra_real, ghosts = CADT_WRAP_GHOSTS(total) + (extra - extra_real);
  if (real + ghosts != 2u * n - 2u || bases[n + 1u + CADT_WRAP_OVERFLOWED] > star_words ||
      (bases[n + 1u + CADT_WRAP_FAILED] && !high_degree))
    return;
  if (cadt_item == 0u) bases[row + CADT_CERTIFY_REAL] = real;
  const cadt_wrap_set stars = {star_vertices, begins,      sizes,
                               bases,         edges,       edge_count,
                               first_extra,   extra_real,  {CADT_WRAP_REAL(total), real + CADT_WRAP_GHOSTS(total)},
                               real,          high_degree, 1u};
  if (cadt_item == 0u) {
    for (cadt_u32 e = first_extra; e < edge_count; e += 3u) {
      const cadt_u32 x = edges[e].from, y = edges[e].to, z = edges[e].left;
      cadt_wrap_triangle t;
      t.number = cadt_wrap_extra_number(&stars, (e - first_extra) / 3u);
      t.a = y;
      t.b = z;
      t.half_edges[0] = cadt_wrap_half_edge(&stars, y, cadt_wrap_right_apex(&stars, y, z), z, 1u);
      t.half_edges[1] = cadt_wrap_half_edge(&stars, z, cadt_wrap_right_apex(&stars, z, x), x, 1u);
      t.half_edges[2] = cadt_wrap_half_edge(&stars, x, cadt_wrap_right_apex(&stars, x, y), y, 1u);
      cadt_write_wrapped(vertices, half_edges, x, &t);
    }
  }
  CADT_FOR(i, n * CADT_WRAP_SHARES, grain) {
    const cadt_u32 v = i / CADT_WRAP_SHARES, size = sizes[v];
    for (cadt_u32 k = i % CADT_WRAP_SHARES; k < size; k += CADT_WRAP_SHARES) {
      cadt_wrap_triangle t;
      if (cadt_wrap_triangle_of(&stars, v, k, &t)) cadt_write_wrapped(vertices, half_edges, v, &t);
    }
  }
}

/* Writes batched sets as locked triangles. These sets have no high-degree vertices. CADT_WRAP_SHARES work-items a
 * vertex. \pre no triangle is missing */
CADT_KERNEL(cadt_batch_locked, CADT_GLOBAL const cadt_u32* star_vertices, CADT_GLOBAL const cadt_u32* begins,
            CADT_GLOBAL const cadt_u32* sizes, CADT_GLOBAL const cadt_u32* bases, cadt_u32 n, cadt_u32 grain,
            CADT_GLOBAL cadt_locked_triangle* locked) {
  const cadt_wrap_set stars = {star_vertices, begins, sizes, bases, 0, 0u, 0u, 0u, {0u, 0u}, 0u, 0u, 0u};
  CADT_FOR(i, n * CADT_WRAP_SHARES, grain) {
    const cadt_u32 v = i / CADT_WRAP_SHARES, size = sizes[v];
    for (cadt_u32 k = i % CADT_WRAP_SHARES; k < size; k += CADT_WRAP_SHARES) {
      cadt_wrap_triangle t;
      if (!cadt_wrap_triangle_of(&stars, v, k, &t)) continue;
      CADT_GLOBAL cadt_u32* w = locked[t.number].word;
      cadt_store_four(w, v, t.a, t.b, 2u);
      cadt_store_four(w + CADT_WORD_HALF_EDGE, t.half_edges[0], t.half_edges[1], t.half_edges[2], 0u);
    }
  }
}

#endif
