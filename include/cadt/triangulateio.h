/* SPDX-License-Identifier: Apache-2.0 */
/* C99: the call and the struct of Jonathan Shewchuk's Triangle, for programs that link it. Names differ, so that both
   can be linked; to change over a program, put these three lines before its calls:

       #define triangulateio cadt_triangulateio
       #define triangulate cadt_triangle
       #define trifree cadt_trifree

   docs/triangle.md says which switches there are, and what differs. */
#ifndef CADT_TRIANGULATEIO_H
#define CADT_TRIANGULATEIO_H

#include <cadt/export.hpp>

#ifdef __cplusplus
extern "C" {
#endif

/* The members of Triangle's struct, in its order. Arrays start at [0]; their first item has number 1, with switch z 0.
   `in` is read, `out` and `vorout` are written. Members that cadt has no use for are neither read nor written. */
struct cadt_triangulateio {
  double* pointlist;          /* in, out: numberofpoints x 2 */
  double* pointattributelist; /* in, out: numberofpoints x numberofpointattributes */
  int* pointmarkerlist;       /* in (NULL: all 0), out: numberofpoints */
  int numberofpoints;         /* in, out */
  int numberofpointattributes;

  int* trianglelist;              /* out: numberoftriangles x 3, counterclockwise */
  double* triangleattributelist;  /* out, with A: numberoftriangles */
  double* trianglearealist;       /* not used */
  int* neighborlist;              /* out: numberoftriangles x 3; the k-th is opposite corner k, -1 outside */
  int numberoftriangles;          /* out */
  int numberofcorners;            /* out: 3 */
  int numberoftriangleattributes; /* out: 0, with A 1 */

  int* segmentlist; /* in, with p. out, with c or p: numberofsegments x 2; with c alone the hull counterclockwise */
  int* segmentmarkerlist; /* in, with p (NULL: all 0). out: one a segment */
  int numberofsegments;   /* in, with p. out */

  double* holelist;  /* in, with p: numberofholes x 2. out, with p: that of in, as in Triangle */
  int numberofholes; /* the same */

  double* regionlist;  /* in, with p: numberofregions x 4: x y attribute, area (not used). out: as holelist */
  int numberofregions; /* the same */

  int* edgelist;       /* out: numberofedges x 2. vorout: numbers of two points of vorout; -1: a ray from the first */
  int* edgemarkerlist; /* out: that of the segment there, else 1 on the boundary, else 0. vorout: not used */
  double* normlist;    /* vorout: numberofedges x 2, the direction of a ray; 0 0 for other edges */
  int numberofedges;   /* out, vorout */
};

/* What cadt_triangle returns; the numbers are the exit codes of the program cadt. */
enum cadt_triangle_status {
  CADT_TRIANGLE_DONE = 0,
  CADT_TRIANGLE_INTERNAL = 1, /* a defect of cadt: please report it */
  CADT_TRIANGLE_INPUT = 3,  /* NaN, infinity, a missing array, too many points, an end of a segment that is no point */
  CADT_TRIANGLE_DEVICE = 5, /* the device failed */
  CADT_TRIANGLE_MEMORY = 6,
  CADT_TRIANGLE_SWITCHES = 8 /* a switch that cadt does not take */
};

/* Triangulates in->pointlist, and with p the segments between them, without holes and what is outside. `switches` are
   Triangle's ("zneQ"): n fills neighborlist, e edgelist and edgemarkerlist,
   c and p segmentlist and segmentmarkerlist, A triangleattributelist, v vorout, which may be NULL without it; B leaves
   markers out, N points, E triangles, P segments. An array of `out` or `vorout` that is to be filled is allocated with
   malloc if its member is NULL, and is to be freed with cadt_trifree; else it is written to the caller's memory, which
   must be large enough. It may be that of `in`. All counts are set. Nothing is printed, and g, I, Q, V, h have no
   effect.

   Returns 0, or a status after which nothing of `out` and `vorout` has changed. Points on one line give no triangles
   and no error. Computes on the fastest usable device. Thread-safe for different structs. Cost: that of
   cadt::triangulate and O(points + triangles). */
CADT_API int cadt_triangle(const char* switches, const struct cadt_triangulateio* in, struct cadt_triangulateio* out,
                           struct cadt_triangulateio* vorout);

/* What was wrong with the calling thread's last cadt_triangle, in UTF-8; "" if it succeeded. Valid until its next.
 */
CADT_API const char* cadt_triangle_message(void);

/* Frees an array that cadt_triangle has allocated; NULL is allowed. The same as free of the C library in use. */
CADT_API void cadt_trifree(void* array);

#ifdef __cplusplus
}
#endif

#endif
