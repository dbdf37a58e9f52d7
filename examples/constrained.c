/* SPDX-License-Identifier: Apache-2.0 */
/* The same as constrained.cpp in C: a plate with a hole and a slit, slits that cross, and polygons in one call.
 *
 * usage: example-constrained_c */
#include <cadt/cadt.h>
#include <stdio.h>
#include <stdlib.h>

/* Ends the program if a call failed; its handles go with it. A program that goes on frees them instead. */
static void check(cadt_status status, const char* what) {
  if (status == CADT_OK) return;
  fprintf(stderr, "example-constrained_c: %s: %s: %s\n", what, cadt_status_name(status), cadt_last_error_message());
  exit(EXIT_FAILURE);
}

static size_t number_inside(const cadt_constrained* mesh) {
  const uint8_t* inside = NULL; /* 1 or 0 a triangle */
  size_t count = 0;
  check(cadt_constrained_inside(mesh, &inside, &count), "inside");
  return count;
}

int main(void) {
  /* Outline, hole, two slits; then a bow-tie, for the polygons alone. */
  const double xy[] = {0, 0, 6, 0, 6, 4, 0, 4, 1, 1, 3, 1, 3, 3, 1, 3, 4, 2, 5, 2, 4.5, 1, 4.5, 3};
  const double rings[] = {0, 0, 6, 0, 6, 4, 0, 4, 1, 1, 3, 1, 3, 3, 1, 3, 7, 0, 8, 1, 8, 0, 7, 1};
  const int32_t segments[] = {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4, 8, 9, 10, 11};
  const int64_t ring_offsets[] = {0, 4, 8, 12}, polygon_offsets[] = {0, 2, 3};
  const double hole[] = {2, 2};
  cadt_points points = {0};
  cadt_options options;
  cadt_constraint_options rules = {0};
  cadt_constrained* mesh = NULL;
  cadt_crossings* crossings = NULL;
  cadt_polygon_triangles* triangles = NULL;
  const cadt_polygon_problem* problems = NULL;
  const double* added = NULL;
  const int32_t *pairs = NULL, *parents = NULL, *vertices = NULL;
  const int64_t* offsets = NULL;
  size_t count = 0, inside, p;
  cadt_status status;
  int right;

  points.x = xy; /* y is NULL: x0 y0 x1 y1 ... */
  points.count = 12;
  check(cadt_options_init(&options, sizeof options), "options");
  options.backend = CADT_BACKEND_HOST;
  rules.size = sizeof rules;
  rules.domain = CADT_DOMAIN_SEEDS;
  rules.holes = hole;
  rules.hole_count = 1;
  check(cadt_triangulate_constrained(&points, segments, 9, &rules, &options, &mesh), "one slit");
  inside = number_inside(mesh);
  printf("plate      %lu triangles are inside\n", (unsigned long)inside);
  right = inside == 16;
  cadt_constrained_free(mesh);

  /* The second slit crosses the first one: the call says so, or makes the crossing a vertex. */
  status = cadt_triangulate_constrained(&points, segments, 10, &rules, &options, &mesh);
  if (status == CADT_SEGMENTS_CROSS) {
    check(cadt_find_crossings(&points, segments, 10, &options, &crossings), "find crossings");
    check(cadt_crossings_pairs(crossings, &pairs, &count), "pairs");
    for (p = 0; p < count; ++p) printf("crossing   segments %d and %d\n", (int)pairs[2 * p], (int)pairs[2 * p + 1]);
    cadt_crossings_free(crossings);
    rules.crossing = CADT_CROSSING_EXACT;
    status = cadt_triangulate_constrained(&points, segments, 10, &rules, &options, &mesh);
  }
  check(status, "two slits");
  check(cadt_constrained_added_points(mesh, &added, &parents, &count), "added points");
  inside = number_inside(mesh);
  printf("exact      %lu triangles inside, vertex 12 at (%g, %g)\n", (unsigned long)inside, added[0], added[1]);
  right = right && inside == 18 && count == 1;
  cadt_constrained_free(mesh);

  /* Two polygons: the plate of two rings, and the bow-tie, which has no triangles and is no failure of the call. */
  points.x = rings;
  check(cadt_triangulate_polygons(&points, ring_offsets, 3, polygon_offsets, 2, &options, &triangles), "polygons");
  check(cadt_polygon_triangles_get(triangles, &offsets, &count, &vertices), "triangles of polygons");
  for (p = 0; p < count; ++p)
    printf("polygon %lu  %ld triangles\n", (unsigned long)p, (long)(offsets[p + 1] - offsets[p]));
  right = right && count == 2 && offsets[1] == 8 && offsets[2] == 8;
  check(cadt_polygon_triangles_problems(triangles, &problems, &count), "problems");
  for (p = 0; p < count; ++p)
    printf("polygon %lu  %s: edges from points %d and %d\n", (unsigned long)problems[p].polygon,
           cadt_polygon_status_name(problems[p].status), (int)problems[p].first, (int)problems[p].second);
  right = right && count == 1;
  cadt_polygon_triangles_free(triangles);
  return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
