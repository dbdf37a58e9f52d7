/* SPDX-License-Identifier: Apache-2.0
 *
 * The mesh as arrays of input ids: vertices become input ids, half-edges become numbers of triangles.
 */
#ifndef CADT_OUTPUT_RENUMBER_H
#define CADT_OUTPUT_RENUMBER_H

#include "common/mesh/finished_triangle.dev.h"
#include "common/mesh/mesh_view.dev.h"
#include "common/portable/teams.dev.h"

/* So many triangles later a CPU writes to a place that it fetches now: 26 -> 15 ms for a million points in random
 * order. */
enum { CADT_TRIANGLES_AHEAD = 16 };

/* Writes triangle t to place first + t, or, with `numbers`, to the place that these say, each as a half-edge: the
 * triangle of the result, and which vertex of the mesh's triangle comes first in it. In the order of the mesh, so that
 * what is read (numbers of neighbours, input ids) is near. Results that are null are skipped. Without numbers they may
 * be the arrays of the mesh; with them GPUs have a kernel of their own, below. */
CADT_KERNEL(cadt_write_triangles, CADT_MESH_VIEW_PARAMETERS, CADT_GLOBAL const cadt_u32* input_ids,
            CADT_GLOBAL const cadt_u32* numbers, CADT_GLOBAL cadt_u32* triangles, CADT_GLOBAL cadt_u32* neighbors,
            CADT_GLOBAL cadt_u32* flags, cadt_u32 first, cadt_u32 grain) {
  CADT_MESH_VIEW(mesh);
  CADT_FOR(t, mesh.triangles, grain) {
    if (numbers && mesh.triangles - t > CADT_CAST(cadt_u32, CADT_TRIANGLES_AHEAD)) {
      const cadt_u32 soon = first + CADT_TRIANGLE_OF(numbers[t + CADT_TRIANGLES_AHEAD]);
      if (neighbors) cadt_prefetch_to_write(neighbors + 3u * soon);
      if (triangles) cadt_prefetch_to_write(triangles + 3u * soon);
    }
    const cadt_triangle r = cadt_in_input_ids(input_ids, cadt_vertex_of(&mesh, t, 0u), cadt_vertex_of(&mesh, t, 1u),
                                              cadt_vertex_of(&mesh, t, 2u));
    const cadt_u32 at = first + (numbers ? CADT_TRIANGLE_OF(numbers[t]) : t);
    if (neighbors) { /* else the words across may be gone already */
      cadt_u32 n[3];
      for (cadt_u32 k = 0u; k < 3u; ++k) {
        n[k] = cadt_neighbor_of(&mesh, t, k);
        if (numbers && n[k] != CADT_NONE) n[k] = CADT_TRIANGLE_OF(numbers[n[k]]);
      }
      cadt_write_finished_neighbors(neighbors, at, r.slot, n[0], n[1], n[2]);
    }
    if (triangles) cadt_write_finished_vertices(triangles, at, &r);
    if (flags) flags[at] = cadt_turned_flags(mesh.edge_flags[t], r.slot);
  }
}

/* The same with numbers on GPUs, by teams: the places are in no order, and what costs is how many sectors a warp writes
 * to. Lanes that write the words of a row together write to one or two of them, where a lane for each row writes to
 * three. */
enum { CADT_OUTPUT_LANES = 128 };

typedef struct {
  cadt_u32 number[CADT_OUTPUT_LANES], word[3 * CADT_OUTPUT_LANES];
} cadt_row_page;

/* Writes `count` rows to their places, each turned so that the word of its slot comes first. */
CADT_FN void cadt_write_rows(CADT_TEAM_PTR const cadt_row_page* page, CADT_GLOBAL cadt_u32* rows, cadt_u32 first,
                             cadt_u32 count) {
  CADT_TEAM_SYNC();
  CADT_TEAM_FOR(i, 3u * count) {
    const cadt_u32 row = i / 3u, k = i % 3u, number = page->number[row], from = CADT_EDGE_OF(number) + k;
    rows[3u * (first + CADT_TRIANGLE_OF(number)) + k] = page->word[3u * row + (from < 3u ? from : from - 3u)];
  }
  CADT_TEAM_SYNC();
}

CADT_TEAM_KERNEL(CADT_OUTPUT_LANES, 16, cadt_write_numbered, CADT_MESH_VIEW_PARAMETERS,
                 CADT_GLOBAL const cadt_u32* input_ids, CADT_GLOBAL const cadt_u32* numbers,
                 CADT_GLOBAL cadt_u32* triangles, CADT_GLOBAL cadt_u32* neighbors, CADT_GLOBAL cadt_u32* flags,
                 cadt_u32 first, cadt_u32 groups, cadt_u32 grain) {
  CADT_TEAM_MEMORY cadt_row_page page;
  CADT_MESH_VIEW(mesh);
  CADT_FOR_TEAMS(g, groups, grain) {
    const cadt_u32 begin = g * CADT_OUTPUT_LANES;
    const cadt_u32 count = cadt_min_u32(CADT_OUTPUT_LANES, mesh.triangles - begin);
    CADT_TEAM_FOR(i, count) { page.number[i] = numbers[begin + i]; }
    if (neighbors) {
      CADT_TEAM_FOR(i, 3u * count) {
        const cadt_u32 n = cadt_neighbor_of(&mesh, begin, i); /* word i from this triangle on */
        page.word[i] = n != CADT_NONE ? CADT_TRIANGLE_OF(numbers[n]) : CADT_NONE;
      }
      cadt_write_rows(&page, neighbors, first, count);
    }
    if (triangles) {
      CADT_TEAM_FOR(i, 3u * count) {
        const cadt_u32 v = cadt_vertex_of(&mesh, begin, i);
        page.word[i] = input_ids ? input_ids[v] : v;
      }
      cadt_write_rows(&page, triangles, first, count);
    }
    if (flags) {
      CADT_TEAM_SYNC();
      CADT_TEAM_FOR(i, count) {
        const cadt_u32 number = page.number[i];
        flags[first + CADT_TRIANGLE_OF(number)] = cadt_turned_flags(mesh.edge_flags[begin + i], CADT_EDGE_OF(number));
      }
    }
    CADT_TEAM_SYNC();
  }
}

/* Moves a finished array of `row` words a triangle to the places of the triangles in as many steps, one for each word
 * `k`, by way of `moved`. It takes more time than a second array and a third of its memory. `neighbors`: the words are
 * triangles. */
CADT_KERNEL(cadt_move_words, CADT_GLOBAL const cadt_u32* words, CADT_GLOBAL const cadt_u32* numbers, cadt_u32 row,
            cadt_u32 k, cadt_u32 neighbors, CADT_GLOBAL cadt_u32* moved, cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(t, count, grain) {
    const cadt_u32 value = words[row * t + k];
    moved[CADT_TRIANGLE_OF(numbers[t])] = neighbors && value != CADT_NONE ? CADT_TRIANGLE_OF(numbers[value]) : value;
  }
}

CADT_KERNEL(cadt_put_words, CADT_GLOBAL const cadt_u32* moved, CADT_GLOBAL cadt_u32* words, cadt_u32 row, cadt_u32 k,
            cadt_u32 count, cadt_u32 grain) {
  CADT_FOR(t, count, grain) { words[row * t + k] = moved[t]; }
}

#endif
