/* SPDX-License-Identifier: Apache-2.0
 *
 * Memory layout that the kernels of the verifier share with their driver.
 */
#ifndef CADT_VERIFY_DEVICE_VERIFY_LAYOUT_H
#define CADT_VERIFY_DEVICE_VERIFY_LAYOUT_H

/* Results: rows of words; each work-item adds to one row. Findings have three words each. */
enum {
  CADT_FOUND_RANGE = 0,        /* triangles with an index out of range or a vertex twice */
  CADT_FOUND_NEIGHBORS = 3,    /* edges (3 * triangle + k) that the neighbour does not share */
  CADT_FOUND_POINTS = 6,       /* points that are not finite */
  CADT_FOUND_DUPLICATES = 9,   /* entries of the list of duplicates that are wrong */
  CADT_FOUND_ORIENTATION = 12, /* triangles that are not counterclockwise */
  CADT_FOUND_EDGES = 15,       /* interior edges that are not legal */
  CADT_FOUND_TIES = 18,        /* cocircular edges that are not decided as the perturbation says */
  CADT_FOUND_BOUNDARY = 21,    /* edges without a neighbour */
  CADT_FOUND_USED,             /* points that are vertices */
  CADT_FOUND_OPEN,             /* signs that cadt_verify_filter could not find */
  CADT_FOUND_EXACT,            /* those found by cadt_verify_exact */
  CADT_FOUND_WORDS = 32,
  CADT_FOUND_ROWS = 64
};

/* Entries of the lists: 4 * (triangle - begin) + k for edge k, k = 3 for the orientation. */
#define CADT_OPEN_ORIENTATION 3u
#define CADT_OPEN_A_TRIANGLE 4u

#endif
