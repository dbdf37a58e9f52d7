/* SPDX-License-Identifier: Apache-2.0 */
/* A program of Triangle's users, changed over by the three lines of the header. */
#include <cadt/triangulateio.h>

#include <stddef.h>
#include <string.h>

#define triangulateio cadt_triangulateio
#define triangulate cadt_triangle
#define trifree cadt_trifree

int run_as_c99(int* triangles, double* center);

int run_as_c99(int* triangles, double* center) {
  double points[6] = {0, 0, 2, 0, 0, 2};
  struct triangulateio in, out, vorout;
  int status;
  memset(&in, 0, sizeof in);
  memset(&out, 0, sizeof out);
  memset(&vorout, 0, sizeof vorout);
  in.pointlist = points;
  in.numberofpoints = 3;
  status = triangulate("zvQ", &in, &out, &vorout);
  if (status != CADT_TRIANGLE_DONE) return status;
  if (out.numberoftriangles == 1) memcpy(triangles, out.trianglelist, 3 * sizeof(int));
  if (vorout.numberofpoints == 1) memcpy(center, vorout.pointlist, 2 * sizeof(double));
  trifree(out.pointlist);
  trifree(out.pointmarkerlist);
  trifree(out.trianglelist);
  trifree(vorout.pointlist);
  trifree(vorout.edgelist);
  trifree(vorout.normlist);
  trifree(NULL);
  return status;
}
