/* SPDX-License-Identifier: Apache-2.0 */
/* Segments that must be edges, and polygons, from C. */
#include <math.h>

#include "check.h"

/* A square with a square hole. */
enum { n = 8, m = 8 };
static const double square[2 * n] = {0, 0, 3, 0, 3, 3, 0, 3, 1, 1, 2, 1, 2, 2, 1, 2};
static const int32_t rings[2 * m] = {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4};

static void test_arrays(const cadt_constrained* mesh) {
  cadt_triangulation* triangles = NULL;
  const int32_t *corners = NULL, *vertices = NULL, *edges = NULL, *sources = NULL, *region = NULL, *values = NULL,
                *list = NULL;
  const int64_t* offsets = NULL;
  const uint32_t* flags = NULL;
  const uint8_t* inside = NULL;
  const double *attributes = NULL, *xy = NULL;
  int32_t kept[24], valid = 0;
  uint64_t high = 0, low = 0;
  size_t points = 0, count = 0, size = 0, t, bits = 0;

  CHECK_OK(cadt_constrained_mesh(mesh, &triangles));
  CHECK_OK(cadt_triangulation_size(triangles, &points, &size));
  CHECK(points == n && size == 10);
  CHECK_OK(cadt_triangulation_triangles(triangles, &corners));
  CHECK_OK(cadt_constrained_edge_flags(mesh, &flags));
  for (t = 0; t < size; ++t) bits += (flags[t] & 1) + (flags[t] >> 1 & 1) + (flags[t] >> 2 & 1);
  CHECK(bits == 4 + 2 * 4); /* the outline from one side, the hole from both */
  cadt_triangulation_free(triangles);

  CHECK_OK(cadt_constrained_chains(mesh, &offsets, &count, &vertices));
  CHECK(count == m && offsets[m] == 2 * m && vertices[0] == 0 && vertices[1] == 1);
  CHECK_OK(cadt_constrained_edges(mesh, &edges, &count));
  CHECK(count == m && edges[0] == 0 && edges[1] == 1 && edges[2] == 0 && edges[3] == 3);
  CHECK_OK(cadt_constrained_sources(mesh, &offsets, &sources));
  CHECK(offsets[m] == m && sources[0] == 0 && sources[1] == -1 - 3);
  CHECK_OK(cadt_constrained_degenerate_segments(mesh, &list, &count));
  CHECK(count == 0);

  CHECK_OK(cadt_constrained_inside(mesh, &inside, &count));
  CHECK(count == 8);
  for (t = 0, count = 0; t < size; ++t) count += inside[t];
  CHECK(count == 8);
  CHECK_OK(cadt_constrained_triangles_inside(mesh, NULL, 0, &count));
  CHECK(count == 24);
  CHECK_STATUS(CADT_BUFFER_TOO_SMALL, cadt_constrained_triangles_inside(mesh, kept, 23, &count));
  CHECK_OK(cadt_constrained_triangles_inside(mesh, kept, 24, &count));
  CHECK(kept[0] == 0);
  CHECK_OK(cadt_constrained_regions(mesh, &region, &values, &attributes, &count));
  CHECK(count == 2 && region[0] == 0 && values[0] == 1 && values[1] == 0 && attributes[0] == 0);
  CHECK_OK(cadt_constrained_added_points(mesh, &xy, &list, &count));
  CHECK(count == 0);
  CHECK_OK(cadt_constrained_moved_points(mesh, &xy, &count));
  CHECK(count == 0);
  CHECK_OK(cadt_constrained_rounded_valid(mesh, &valid));
  CHECK(valid == 1);
  CHECK_OK(cadt_constrained_hash(mesh, &high, &low));
  CHECK(high != 0 && low != 0);
}

/* On a grid a view would be one of points that have moved. */
static void test_kept_points(const cadt_points* points, const int32_t* segments, const cadt_constraint_options* how) {
  cadt_options options = {0};
  cadt_constrained* mesh = NULL;
  cadt_triangulation* triangles = NULL;
  cadt_points kept = {0};

  CHECK_OK(cadt_options_init(&options, sizeof options));
  options.keep_points = CADT_KEEP_VIEW;
  CHECK_OK(cadt_triangulate_constrained(points, segments, 2, how, &options, &mesh));
  CHECK_OK(cadt_constrained_mesh(mesh, &triangles));
  cadt_constrained_free(mesh);
  CHECK_OK(cadt_triangulation_points(triangles, &kept));
  CHECK(kept.x != points->x && kept.count >= 4 && ((const double*)kept.x)[2] == 4);
  cadt_triangulation_free(triangles);
}

static int32_t at_once(void* user) {
  (void)user;
  return 1;
}

static void test_crossings(void) {
  const double xy[] = {0, 0, 2, 2, 0, 2, 2, 0}, where[] = {1, 0.5}, heights[] = {0, 0, 0, 0, 1};
  const double slopes[] = {1, 10, 3, 30, 7, 70, 9, 90};
  const int32_t segments[] = {0, 1, 2, 3, 1, 1};
  const cadt_points points = points_of(xy, 4), asked = points_of(where, 1);
  cadt_constraint_options how = {0};
  cadt_constrained* mesh = NULL;
  cadt_queries* queries = NULL;
  const double* added = NULL;
  const int32_t *parents = NULL, *list = NULL;
  cadt_crossings* crossings = NULL;
  cadt_options options;
  double result = 0, rows[10] = {0};
  size_t count = 0;

  how.size = sizeof how;
  CHECK_STATUS(CADT_SEGMENTS_CROSS, cadt_triangulate_constrained(&points, segments, 3, NULL, NULL, &mesh));
  CHECK(mesh == NULL && last_error().index == 0 && last_error().needed == 1);
  CHECK(strcmp(cadt_status_name(CADT_SEGMENTS_CROSS), "CADT_SEGMENTS_CROSS") == 0);
  CHECK(strcmp(cadt_status_name(CADT_NOT_DELAUNAY), "CADT_NOT_DELAUNAY") == 0);
  CHECK_OK(cadt_find_crossings(&points, segments, 3, NULL, &crossings));
  CHECK_OK(cadt_crossings_pairs(crossings, &list, &count));
  CHECK(count == 1 && list[0] == 0 && list[1] == 1);
  CHECK_NULL(cadt_crossings_pairs(crossings, NULL, &count), "pairs");
  CHECK_NULL(cadt_crossings_pairs(crossings, &list, NULL), "count");
  CHECK_NULL(cadt_crossings_pairs(NULL, &list, &count), "crossings");
  cadt_crossings_free(crossings);
  cadt_crossings_free(NULL);
  CHECK_OK(cadt_find_crossings(&points, segments, 1, NULL, &crossings));
  CHECK_OK(cadt_crossings_pairs(crossings, &list, &count));
  CHECK(count == 0);
  cadt_crossings_free(crossings);
  crossings = NULL;
  CHECK_OK(cadt_options_init(&options, sizeof options));
  options.cancelled = at_once;
  CHECK_STATUS(CADT_CANCELLED, cadt_find_crossings(&points, segments, 3, &options, &crossings));
  CHECK(crossings == NULL);

  how.crossing = CADT_CROSSING_EXACT;
  CHECK_OK(cadt_triangulate_constrained(&points, segments, 3, &how, NULL, &mesh));
  CHECK_OK(cadt_constrained_added_points(mesh, &added, &parents, &count));
  CHECK(count == 1 && added[0] == 1 && added[1] == 1 && parents[0] == 0 && parents[1] == 1);
  CHECK_STATUS(CADT_BUFFER_TOO_SMALL, cadt_constrained_values_at_crossings(mesh, &points, slopes, 8, 2, rows, 9, &count));
  CHECK(count == 10);
  count = 0;
  CHECK_OK(cadt_constrained_values_at_crossings(mesh, &points, NULL, 0, 2, NULL, 0, &count));
  CHECK(count == 10);
  CHECK_OK(cadt_constrained_values_at_crossings(mesh, &points, slopes, 8, 2, rows, 10, &count));
  CHECK(count == 10 && rows[0] == 1 && rows[7] == 90 && rows[8] == 2 && rows[9] == 20);
  CHECK_STATUS(CADT_INPUT_ERROR, cadt_constrained_values_at_crossings(mesh, &points, slopes, 8, 1, rows, 10, &count));
  CHECK_NULL(cadt_constrained_values_at_crossings(mesh, &points, NULL, 8, 2, rows, 10, &count), "values");
  CHECK_NULL(cadt_constrained_values_at_crossings(mesh, &points, slopes, 8, 2, rows, 10, NULL), "count");
  CHECK_OK(cadt_constrained_degenerate_segments(mesh, &list, &count));
  CHECK(count == 1 && list[0] == 2);
  CHECK_OK(cadt_queries_open_constrained(&points, mesh, NULL, &queries));
  CHECK_OK(cadt_queries_interpolate(queries, heights, 5, &asked, CADT_LINEAR, CADT_OUTSIDE_NAN, &result, 1, &count));
  CHECK(count == 1 && result == 0.5);
  cadt_queries_free(queries);
  cadt_constrained_free(mesh);
  mesh = NULL;

  how.crossing = CADT_CROSSING_GRID;
  CHECK_STATUS(CADT_OPTION_ERROR, cadt_triangulate_constrained(&points, segments, 3, &how, NULL, &mesh));
  how.grid = 4;
  CHECK_OK(cadt_triangulate_constrained(&points, segments, 2, &how, NULL, &mesh));
  CHECK_OK(cadt_constrained_moved_points(mesh, &added, &count));
  CHECK(count == 4 && added[2] == 4);
  cadt_constrained_free(mesh);
  test_kept_points(&points, segments, &how);
  how.crossing = 3;
  CHECK_NULL(cadt_triangulate_constrained(&points, segments, 2, &how, NULL, &mesh), "constraints->crossing");
  how.crossing = 0;
  how.domain = 6;
  CHECK_NULL(cadt_triangulate_constrained(&points, segments, 2, &how, NULL, &mesh), "constraints->domain");
  how.domain = CADT_DOMAIN_EVEN_ODD;
  mesh = NULL;
  CHECK_STATUS(CADT_OPEN_BOUNDARY, cadt_triangulate_constrained(&points, segments, 1, &how, NULL, &mesh));
  CHECK(mesh == NULL && (last_error().index == 0 || last_error().index == 1));
  how.size = 1;
  CHECK_NULL(cadt_triangulate_constrained(&points, segments, 1, &how, NULL, &mesh), "constraints");
}

/* A thin quadrilateral with its long diagonal. */
static void test_not_delaunay(void) {
  const double xy[] = {0, 0, 4, 0, 2, 0.5, 2, -0.5}, where[] = {2, 0};
  const int32_t segments[] = {0, 1};
  const cadt_points points = points_of(xy, 4), asked = points_of(where, 1);
  cadt_constrained* mesh = NULL;
  cadt_triangulation* triangles = NULL;
  cadt_statistics statistics = {0};
  cadt_mesh_view arrays = {0};
  cadt_queries* queries = NULL;
  int32_t nearest = -1;
  size_t count = 0;

  CHECK_OK(cadt_triangulate_constrained(&points, segments, 1, NULL, NULL, &mesh));
  CHECK_OK(cadt_constrained_mesh(mesh, &triangles));
  statistics.size = sizeof statistics;
  CHECK_OK(cadt_triangulation_statistics(triangles, &statistics));
  CHECK(statistics.inserted_segments == 1 && statistics.segment_retries == 0);
  CHECK_OK(cadt_queries_open_constrained(&points, mesh, NULL, &queries));
  CHECK_STATUS(CADT_NOT_DELAUNAY, cadt_queries_nearest_vertices(queries, &asked, 1, &nearest, 1, &count));
  CHECK(last_error().index >= 0 && nearest == -1);
  CHECK_OK(cadt_queries_locate(queries, &asked, &nearest, 1, &count));
  CHECK(nearest == 0);
  cadt_queries_free(queries);

  /* The same arrays from the caller: with the flags of edges they are no Delaunay mesh, either. */
  arrays.size = sizeof arrays;
  arrays.triangle_count = 2;
  CHECK_OK(cadt_triangulation_triangles(triangles, &arrays.triangles));
  CHECK_OK(cadt_triangulation_neighbors(triangles, &arrays.neighbors));
  CHECK_OK(cadt_constrained_edge_flags(mesh, &arrays.edge_flags));
  CHECK_OK(cadt_queries_open_arrays(&points, &arrays, NULL, &queries));
  CHECK_STATUS(CADT_NOT_DELAUNAY, cadt_queries_nearest_vertices(queries, &asked, 1, &nearest, 1, &count));
  cadt_queries_free(queries);
  cadt_triangulation_free(triangles);
  cadt_constrained_free(mesh);
}

static void test_nothing(const cadt_constrained* mesh) {
  const cadt_points points = points_of(square, n);
  cadt_constrained* other = NULL;
  cadt_constraint_options how = {0};
  size_t count = 0;

  how.size = sizeof how;
  how.hole_count = 1;
  CHECK_NULL(cadt_triangulate_constrained(&points, rings, m, &how, NULL, &other), "constraints->holes");
  how.hole_count = 0;
  how.region_count = 1;
  CHECK_NULL(cadt_triangulate_constrained(&points, rings, m, &how, NULL, &other), "constraints->regions");
  CHECK_NULL(cadt_triangulate_constrained(&points, NULL, m, NULL, NULL, &other), "segments");
  CHECK_NULL(cadt_triangulate_constrained(NULL, rings, m, NULL, NULL, &other), "points");
  CHECK_NULL(cadt_triangulate_constrained(&points, rings, m, NULL, NULL, NULL), "mesh");
  CHECK_STATUS(CADT_LIMIT_ERROR, cadt_triangulate_constrained(&points, rings, (size_t)1 << 30, NULL, NULL, &other));
  CHECK_NULL(cadt_triangulator_triangulate_constrained(NULL, &points, rings, m, NULL, &other), "triangulator");
  CHECK_NULL(cadt_constrained_mesh(NULL, NULL), "triangles");
  CHECK_NULL(cadt_constrained_edge_flags(mesh, NULL), "flags");
  CHECK_NULL(cadt_constrained_edge_flags(NULL, NULL), "mesh");
  CHECK_NULL(cadt_constrained_chains(mesh, NULL, &count, NULL), "offsets");
  CHECK_NULL(cadt_constrained_edges(mesh, NULL, &count), "array");
  CHECK_NULL(cadt_constrained_sources(mesh, NULL, NULL), "offsets");
  CHECK_NULL(cadt_constrained_degenerate_segments(mesh, NULL, &count), "array");
  CHECK_NULL(cadt_constrained_inside(mesh, NULL, &count), "inside");
  CHECK_NULL(cadt_constrained_triangles_inside(mesh, NULL, 0, NULL), "count");
  CHECK_NULL(cadt_constrained_regions(mesh, NULL, NULL, NULL, &count), "region");
  CHECK_NULL(cadt_constrained_added_points(mesh, NULL, NULL, &count), "parents");
  CHECK_NULL(cadt_constrained_moved_points(mesh, NULL, &count), "array");
  CHECK_NULL(cadt_constrained_rounded_valid(mesh, NULL), "valid");
  CHECK_NULL(cadt_constrained_hash(mesh, NULL, NULL), "high");
  CHECK_NULL(cadt_constrained_verify(mesh, &points, rings, m, NULL, NULL), "report");
  CHECK_NULL(cadt_find_crossings(&points, rings, m, NULL, NULL), "crossings");
  CHECK_NULL(cadt_queries_open_constrained(&points, mesh, NULL, NULL), "queries");
  CHECK_NULL(cadt_queries_open_constrained(NULL, mesh, NULL, (cadt_queries**)&other), "points");
  cadt_constrained_free(NULL);
}

/* The host's memory is device memory of the host back end. */
static void test_on_device(cadt_triangulator* triangulator) {
  cadt_device_points points = {0};
  cadt_device_array segments = {0};
  cadt_constraint_options how = {0};
  cadt_device_triangulation* mesh = NULL;
  cadt_constrained* copy = NULL;
  void *flags = NULL, *regions = NULL, *inside = NULL, *all = NULL, *parents = NULL;
  const double cross[] = {0, 0, 2, 2, 0, 2, 2, 0};
  const int32_t diagonals[] = {0, 1, 2, 3};
  size_t count = 0, triangles = 0, t, bits = 0;

  points.x = square;
  points.count = n;
  segments.memory = (void*)rings;
  segments.size = 2 * m;
  how.size = sizeof how;
  how.domain = CADT_DOMAIN_EVEN_ODD;
  CHECK_OK(cadt_triangulator_triangulate_constrained_device(triangulator, &points, &segments, &how, &mesh));
  CHECK_OK(cadt_device_triangulation_size(mesh, &count, &triangles, &count));
  CHECK_OK(cadt_device_triangulation_constraints(mesh, &flags, &regions, &inside, &count));
  CHECK(triangles == 10 && count == 8 && ((const int32_t*)inside)[0] == 0 && ((const int32_t*)regions)[0] == 0);
  for (t = 0; t < triangles; ++t)
    bits += (((const uint32_t*)flags)[t] & 1) + (((const uint32_t*)flags)[t] >> 1 & 1) +
            (((const uint32_t*)flags)[t] >> 2 & 1);
  CHECK(bits == 4 + 2 * 4);
  CHECK_NULL(cadt_device_triangulation_constraints(mesh, NULL, &regions, &inside, &count), "edge_flags");
  CHECK_NULL(cadt_device_triangulation_constraints(NULL, &flags, &regions, &inside, &count), "mesh");
  CHECK_OK(cadt_device_triangulation_regions(mesh, &inside, &regions, &all, &count));
  CHECK(count == 2 && ((const int32_t*)regions)[0] == 1 && ((const int32_t*)regions)[1] == 0);
  CHECK(((const double*)all)[0] == 0 && ((const double*)all)[1] == 0);
  for (t = 0, count = 0; t < triangles; ++t) count += ((const uint32_t*)inside)[t];
  CHECK(count == 8);
  CHECK_NULL(cadt_device_triangulation_regions(mesh, &inside, &regions, NULL, &count), "attributes");
  CHECK_NULL(cadt_device_triangulation_regions(NULL, &inside, &regions, &all, &count), "mesh");
  CHECK_OK(cadt_device_triangulation_chains(mesh, &regions, &inside, &count));
  CHECK(count == 2 * m && ((const uint32_t*)regions)[m] == 2 * m && ((const int32_t*)inside)[1] == 1);
  CHECK_NULL(cadt_device_triangulation_chains(mesh, &regions, NULL, &count), "vertices");
  CHECK_NULL(cadt_device_triangulation_chains(NULL, &regions, &inside, &count), "mesh");
  CHECK_OK(cadt_device_triangulation_download_constrained(mesh, &copy));
  test_arrays(copy);
  cadt_constrained_free(copy);
  CHECK_NULL(cadt_device_triangulation_download_constrained(mesh, NULL), "copy");
  CHECK_NULL(cadt_device_triangulation_download_constrained(NULL, &copy), "mesh");
  cadt_device_triangulation_free(mesh);
  mesh = NULL;
  CHECK_NULL(cadt_triangulator_triangulate_constrained_device(triangulator, &points, NULL, &how, &mesh), "segments");
  how.crossing = CADT_CROSSING_GRID;
  CHECK_STATUS(CADT_OPTION_ERROR,
               cadt_triangulator_triangulate_constrained_device(triangulator, &points, &segments, &how, &mesh));
  CHECK(mesh == NULL);
  how.grid = 2; /* halves go upwards: 1 and 2 to 2, 3 to 4 */
  CHECK_OK(cadt_triangulator_triangulate_constrained_device(triangulator, &points, &segments, &how, &mesh));
  CHECK_OK(cadt_device_triangulation_crossings(mesh, &all, &parents, &count));
  CHECK(count == 0 && parents == NULL && ((const double*)all)[2] == 4 && ((const double*)all)[8] == 2);
  cadt_device_triangulation_free(mesh);
  mesh = NULL;

  how.crossing = CADT_CROSSING_EXACT;
  how.domain = CADT_DOMAIN_HULL;
  points.x = cross;
  points.count = 4;
  segments.memory = (void*)diagonals;
  segments.size = 4;
  CHECK_OK(cadt_triangulator_triangulate_constrained_device(triangulator, &points, &segments, &how, &mesh));
  CHECK_OK(cadt_device_triangulation_crossings(mesh, &all, &parents, &count));
  CHECK(count == 1 && ((const double*)all)[8] == 1 && ((const double*)all)[9] == 1);
  CHECK(((const int32_t*)parents)[0] == 0 && ((const int32_t*)parents)[1] == 1);
  CHECK_NULL(cadt_device_triangulation_crossings(mesh, NULL, &parents, &count), "all_points");
  CHECK_NULL(cadt_device_triangulation_crossings(NULL, &all, &parents, &count), "mesh");
  cadt_device_triangulation_free(mesh);
}

void test_constrained(void) {
  const cadt_points points = points_of(square, n);
  const cadt_options options = on_host();
  cadt_constraint_options how = {0};
  cadt_constrained *mesh = NULL, *same = NULL;
  cadt_triangulator* triangulator = NULL;
  cadt_report* report = NULL;
  const double hole[] = {1.5, 1.5};
  const cadt_region region = {0.5, 0.5, 7};
  const int32_t *of = NULL, *values = NULL, bad[] = {0, 1, 0, 8};
  const double* attributes = NULL;
  uint64_t high = 0, low = 0, other_high = 0, other_low = 0;
  int32_t ok = 0;
  size_t count = 0;

  how.size = sizeof how;
  how.domain = CADT_DOMAIN_EVEN_ODD;
  CHECK_OK(cadt_triangulate_constrained(&points, rings, m, &how, &options, &mesh));
  test_arrays(mesh);
  test_nothing(mesh);
  CHECK_OK(cadt_constrained_verify(mesh, &points, rings, m, &how, &report));
  CHECK_OK(cadt_report_ok(report, &ok));
  CHECK(ok == 1);
  cadt_report_free(report);
  CHECK_OK(cadt_constrained_verify(mesh, &points, rings, m - 1, &how, &report)); /* of other segments */
  CHECK_OK(cadt_report_ok(report, &ok));
  CHECK(ok == 0);
  cadt_report_free(report);

  how.domain = CADT_DOMAIN_SEEDS;
  how.holes = hole;
  how.hole_count = 1;
  how.regions = &region;
  how.region_count = 1;
  CHECK_OK(cadt_triangulator_open(&options, &triangulator));
  CHECK_OK(cadt_triangulator_triangulate_constrained(triangulator, &points, rings, m, &how, &same));
  test_on_device(triangulator);
  cadt_triangulator_free(triangulator);
  CHECK_OK(cadt_constrained_hash(mesh, &high, &low));
  CHECK_OK(cadt_constrained_hash(same, &other_high, &other_low));
  CHECK(high == other_high && low == other_low);
  CHECK_OK(cadt_constrained_regions(same, &of, &values, &attributes, &count));
  CHECK(count == 2 && attributes[0] == 7 && attributes[1] == 0);
  cadt_constrained_free(same);
  cadt_constrained_free(mesh);
  CHECK_STATUS(CADT_INPUT_ERROR, cadt_triangulate_constrained(&points, bad, 2, NULL, &options, &mesh));
  CHECK(last_error().index == 1);
  test_crossings();
  test_not_delaunay();
}

void test_polygons(void) {
  /* The square with its hole, and a bow-tie. */
  const double xy[] = {0, 0, 3, 0, 3, 3, 0, 3, 1, 1, 2, 1, 2, 2, 1, 2, 0, 0, 1, 1, 1, 0, 0, 1};
  const int64_t ring_offsets[] = {0, 4, 8, 12}, polygon_offsets[] = {0, 2, 3}, bad[] = {0, 4, 8, 13};
  const cadt_points points = points_of(xy, 12);
  const cadt_options options = on_host();
  cadt_polygon_triangles* triangles = NULL;
  const cadt_polygon_problem* problems = NULL;
  const int64_t* offsets = NULL;
  const int32_t* vertices = NULL;
  size_t count = 0;

  CHECK_OK(cadt_triangulate_polygons(&points, ring_offsets, 3, polygon_offsets, 2, &options, &triangles));
  CHECK_OK(cadt_polygon_triangles_get(triangles, &offsets, &count, &vertices));
  CHECK(count == 2 && offsets[0] == 0 && offsets[1] == 8 && offsets[2] == 8 && vertices[23] < 8);
  CHECK_OK(cadt_polygon_triangles_problems(triangles, &problems, &count));
  CHECK(count == 1 && problems[0].polygon == 1 && problems[0].status == CADT_POLYGON_SELF_CROSSING);
  CHECK(problems[0].first == 8 && problems[0].second == 10);
  CHECK(strcmp(cadt_polygon_status_name(problems[0].status), "self-crossing") == 0);
  CHECK(strcmp(cadt_polygon_status_name(6), "unknown status") == 0);
  CHECK(strcmp(cadt_polygon_status_name(-1), "unknown status") == 0);
  CHECK_NULL(cadt_polygon_triangles_get(triangles, NULL, &count, &vertices), "offsets");
  CHECK_NULL(cadt_polygon_triangles_problems(triangles, NULL, &count), "list");
  CHECK_NULL(cadt_polygon_triangles_problems(NULL, &problems, &count), "triangles");
  cadt_polygon_triangles_free(triangles);
  cadt_polygon_triangles_free(NULL);
  CHECK_STATUS(CADT_INPUT_ERROR, cadt_triangulate_polygons(&points, bad, 3, polygon_offsets, 2, &options, &triangles));
  CHECK(last_error().index == 3);
  CHECK_NULL(cadt_triangulate_polygons(&points, NULL, 3, polygon_offsets, 2, &options, &triangles), "ring_offsets");
  CHECK_NULL(cadt_triangulate_polygons(&points, ring_offsets, 3, NULL, 2, &options, &triangles), "polygon_offsets");
}
