/* SPDX-License-Identifier: Apache-2.0 */
/* What a mesh can be asked, from C: answers for a square with a point in its middle, and arguments that are wrong. */
#include "check.h"

#include <math.h>

enum { n = 5 };
static const double square[2 * n] = {0, 0, 4, 0, 4, 4, 0, 4, 2, 2};

/* Who asks for a count alone hears what the call would refuse. */
static void test_counts_alone(cadt_queries* queries, const cadt_points* asked) {
  const double values[n] = {0};
  const cadt_grid right = {0, 0, 1, 1, 4, 4}, none = {0, 0, 1, 1, 0, SIZE_MAX}, large = {0, 0, 1, 1, SIZE_MAX, 2},
                  not_finite = {0, 0, NAN, 1, 4, 4};
  cadt_points many = *asked;
  size_t count = 7;

  many.count = (size_t)1 << 30;
  CHECK_STATUS(CADT_LIMIT_ERROR, cadt_queries_locate(queries, &many, NULL, 0, &count));
  CHECK_STATUS(CADT_LIMIT_ERROR, cadt_queries_locate_barycentric(queries, &many, NULL, NULL, 0, &count));
  CHECK_STATUS(CADT_LIMIT_ERROR, cadt_queries_nearest_vertices(queries, &many, 1, NULL, 0, &count));
  CHECK_STATUS(CADT_OPTION_ERROR, cadt_queries_nearest_vertices(queries, asked, 0, NULL, 0, &count));
  CHECK_STATUS(CADT_LIMIT_ERROR, cadt_queries_nearest_vertices(queries, asked, SIZE_MAX, NULL, 0, &count));
  CHECK_STATUS(CADT_INPUT_ERROR,
               cadt_queries_interpolate(queries, values, n - 1, asked, CADT_LINEAR, CADT_OUTSIDE_NAN, NULL, 0, &count));
  CHECK_STATUS(CADT_INPUT_ERROR,
               cadt_queries_rasterize(queries, &right, values, n - 1, CADT_LINEAR, INFINITY, NULL, 0, &count));
  CHECK_STATUS(CADT_OPTION_ERROR,
               cadt_queries_rasterize(queries, &right, values, n, CADT_LINEAR, NAN, NULL, 0, &count));
  CHECK_STATUS(CADT_INPUT_ERROR,
               cadt_queries_rasterize(queries, &not_finite, values, n, CADT_LINEAR, INFINITY, NULL, 0, &count));
  CHECK_STATUS(CADT_LIMIT_ERROR,
               cadt_queries_rasterize(queries, &large, values, n, CADT_LINEAR, INFINITY, NULL, 0, &count));
  CHECK(last_error().needed > last_error().available && last_error().available > 1);
  CHECK(count == 7);
  CHECK_OK(cadt_queries_rasterize(queries, &none, values, n, CADT_LINEAR, INFINITY, NULL, 0, &count));
  CHECK(count == 0);
}

static void test_answers(cadt_queries* queries) {
  const double where[] = {2, 1, 2, 2, 9, 9}, values[n] = {0, 4, 4, 0, 2}; /* x */
  const cadt_points asked = points_of(where, 3);
  const cadt_grid grid = {0, 0, 1, 1, 4, 4};
  int32_t triangles[3] = {7, 7, 7}, nearest[6];
  double weights[9], results[3], cells[16], centers[8];
  cadt_circle circles[4];
  size_t count = 0, i;

  CHECK_OK(cadt_queries_locate(queries, &asked, NULL, 0, &count));
  CHECK(count == 3);
  CHECK_STATUS(CADT_BUFFER_TOO_SMALL, cadt_queries_locate(queries, &asked, triangles, 2, &count));
  CHECK(triangles[0] == 7 && last_error().needed == 3);
  CHECK_OK(cadt_queries_locate(queries, &asked, triangles, 3, &count));
  CHECK(triangles[0] == 0 && triangles[1] == 0 && triangles[2] == -1);
  CHECK_OK(cadt_queries_locate_barycentric(queries, &asked, triangles, weights, 3, &count));
  CHECK(fabs(weights[0] + weights[1] + weights[2] - 1) < 1e-15 && weights[6] != weights[6]);
  CHECK_OK(cadt_queries_nearest_vertices(queries, &asked, 2, nearest, 6, &count));
  CHECK(count == 6 && nearest[0] == 4 && nearest[2] == 4 && nearest[4] == 2 && nearest[5] == 4);
  for (i = 0; i < 3; ++i) {
    CHECK_OK(cadt_queries_interpolate(queries, values, n, &asked, (int32_t)i, CADT_OUTSIDE_NEAREST, results, 3, &count));
    CHECK(fabs(results[0] - 2) < 1e-12 && results[1] == 2 && results[2] == 4);
    CHECK_OK(cadt_queries_rasterize(queries, &grid, values, n, (int32_t)i, INFINITY, cells, 16, &count));
    CHECK(count == 16 && (i == CADT_NEAREST || fabs(cells[1] - 1.5) < 1e-12));
  }
  CHECK_STATUS(CADT_BUFFER_TOO_SMALL,
               cadt_queries_rasterize(queries, &grid, values, n, CADT_LINEAR, INFINITY, cells, 15, &count));
  CHECK_OK(cadt_queries_circumcenters(queries, centers, 8, &count));
  CHECK(count == 8 && centers[0] == 2 && centers[1] == 0);
  CHECK_OK(cadt_queries_largest_empty_circles(queries, 4, circles, 4, &count));
  CHECK(count == 4 && circles[0].radius == 2);
  CHECK_OK(cadt_queries_largest_empty_circles(queries, ((size_t)1 << 63) - 128, circles, 4, &count));
  CHECK(count == 4 && circles[0].radius == 2);
  CHECK_STATUS(CADT_INVALID_ARGUMENT,
               cadt_queries_interpolate(queries, values, n, &asked, 3, CADT_OUTSIDE_NAN, results, 3, &count));
  CHECK_STATUS(CADT_INVALID_ARGUMENT,
               cadt_queries_interpolate(queries, values, n, &asked, CADT_LINEAR, 2, results, 3, &count));
  CHECK_STATUS(CADT_INPUT_ERROR,
               cadt_queries_interpolate(queries, values, n - 1, &asked, CADT_LINEAR, CADT_OUTSIDE_NAN, results, 3, &count));
  CHECK_STATUS(CADT_OPTION_ERROR, cadt_queries_nearest_vertices(queries, &asked, 0, nearest, 6, &count));
  test_counts_alone(queries, &asked);
  CHECK_NULL(cadt_queries_locate(NULL, &asked, triangles, 3, &count), "queries");
  CHECK_NULL(cadt_queries_locate(queries, &asked, triangles, 3, NULL), "count");
  CHECK_NULL(cadt_queries_rasterize(queries, NULL, values, n, CADT_LINEAR, INFINITY, cells, 16, &count), "grid");
}

/* Each function refuses NULL for its handle, and for what it needs besides. */
static void test_nothing(cadt_queries* queries) {
  const double where[] = {1, 1}, values[n] = {0};
  const cadt_points asked = points_of(where, 1);
  const cadt_grid grid = {0, 0, 1, 1, 1, 1};
  const cadt_box box = {0, 0, 1, 1};
  cadt_voronoi* diagram = NULL;
  cadt_polygons* polygons = NULL;
  int32_t words[6];
  double numbers[9];
  cadt_circle circle;
  size_t count = 0;

  CHECK_NULL(cadt_queries_locate_barycentric(NULL, &asked, words, numbers, 1, &count), "queries");
  CHECK_NULL(cadt_queries_locate_barycentric(queries, &asked, words, NULL, 1, &count), "barycentric");
  CHECK_NULL(cadt_queries_nearest_vertices(NULL, &asked, 1, words, 1, &count), "queries");
  CHECK_NULL(cadt_queries_nearest_vertices(queries, NULL, 1, words, 1, &count), "points");
  CHECK_NULL(cadt_queries_interpolate(NULL, values, n, &asked, CADT_LINEAR, CADT_OUTSIDE_NAN, numbers, 1, &count), "queries");
  CHECK_NULL(cadt_queries_interpolate(queries, NULL, n, &asked, CADT_LINEAR, CADT_OUTSIDE_NAN, numbers, 1, &count), "values");
  CHECK_NULL(cadt_queries_rasterize(NULL, &grid, values, n, CADT_LINEAR, INFINITY, numbers, 1, &count), "queries");
  CHECK_NULL(cadt_queries_rasterize(queries, &grid, NULL, n, CADT_LINEAR, INFINITY, numbers, 1, &count), "values");
  CHECK_NULL(cadt_queries_circumcenters(NULL, numbers, 8, &count), "queries");
  CHECK_NULL(cadt_queries_largest_empty_circles(NULL, 1, &circle, 1, &count), "queries");
  CHECK_NULL(cadt_queries_voronoi(queries, NULL), "diagram");
  CHECK_NULL(cadt_queries_voronoi(NULL, &diagram), "queries");
  CHECK_NULL(cadt_voronoi_vertices(NULL, NULL, &count), "diagram");
  CHECK_NULL(cadt_voronoi_cells(NULL, NULL, &count, NULL), "diagram");
  CHECK_NULL(cadt_voronoi_edges(NULL, NULL, NULL, &count), "diagram");
  CHECK_NULL(cadt_queries_voronoi_polygons(queries, NULL, &polygons), "box");
  CHECK_NULL(cadt_queries_voronoi_polygons(NULL, &box, &polygons), "queries");
  CHECK_NULL(cadt_polygons_get(NULL, NULL, &count, NULL), "polygons");
  CHECK_NULL(cadt_outline_triangles(NULL, NULL, &count), "outline");
  CHECK_NULL(cadt_outline_edges(NULL, NULL, &count), "outline");
  CHECK_NULL(cadt_queries_locate_device(NULL, NULL, NULL), "queries");
  CHECK_NULL(cadt_queries_open_device(NULL, NULL, NULL, &queries), "triangulator");
  CHECK_NULL(cadt_triangulator_triangulate_into(NULL, &asked, words, 6, NULL, 0, &count), "triangulator");
  CHECK_NULL(cadt_triangulator_triangulate_device_into(NULL, NULL, NULL, NULL, &count), "triangulator");
}

static void test_duals(cadt_queries* queries) {
  const cadt_box box = {-1, -1, 5, 5}, flat = {0, 0, 0, 1};
  cadt_voronoi* diagram = NULL;
  cadt_polygons* polygons = NULL;
  cadt_outline* outline = NULL;
  const double *xy = NULL, *corners = NULL;
  const uint32_t *begin = NULL, *first = NULL;
  const int32_t *cells = NULL, *points = NULL, *vertices = NULL, *kept = NULL;
  size_t count = 0, edges = 0, p, i;
  double area = 0;

  CHECK_OK(cadt_queries_voronoi(queries, &diagram));
  CHECK_OK(cadt_voronoi_vertices(diagram, &xy, &count));
  CHECK(count == 4 && xy[0] == 2);
  CHECK_OK(cadt_voronoi_cells(diagram, &begin, &count, &cells));
  CHECK(count == n && begin[n] == 12 && begin[5] - begin[4] == 4 && cells[begin[4]] == 0);
  CHECK_OK(cadt_voronoi_edges(diagram, &points, &vertices, &edges));
  CHECK(edges == 8 && points[0] >= 0 && vertices[0] >= 0);
  cadt_voronoi_free(diagram);
  CHECK_OK(cadt_queries_voronoi_polygons(queries, &box, &polygons));
  CHECK_OK(cadt_polygons_get(polygons, &first, &count, &corners));
  for (p = 0; p < count; ++p)
    for (i = first[p]; i < first[p + 1]; ++i) {
      const size_t j = i + 1 < first[p + 1] ? i + 1 : first[p];
      area += 0.5 * (corners[2 * i] * corners[2 * j + 1] - corners[2 * i + 1] * corners[2 * j]);
    }
  CHECK(count == n && fabs(area - 36) < 1e-12);
  cadt_polygons_free(polygons);
  CHECK_STATUS(CADT_INPUT_ERROR, cadt_queries_voronoi_polygons(queries, &flat, &polygons));
  CHECK_OK(cadt_queries_outline(queries, INFINITY, INFINITY, &outline));
  CHECK_OK(cadt_outline_triangles(outline, &kept, &count));
  CHECK(count == 4 && kept[3] == 3);
  CHECK_OK(cadt_outline_edges(outline, &kept, &count));
  CHECK(count == 4);
  cadt_outline_free(outline);
  CHECK_NULL(cadt_queries_outline(queries, 1, 1, NULL), "outline");
}

/* The host's memory is device memory of the host back end. */
static void test_on_device(void) {
  const double where[] = {2, 1, 9, 9}, values[n] = {0, 4, 4, 0, 2};
  const cadt_options options = on_host();
  const cadt_points from_host = points_of(square, n);
  cadt_device_points points = {0}, asked = {0};
  cadt_triangulator* triangulator = NULL;
  cadt_device_triangulation* mesh = NULL;
  cadt_queries* queries = NULL;
  int32_t words[30], others[30];
  double results[16];
  cadt_device_array to = {0}, from = {0}, heights = {0};
  const cadt_grid grid = {0, 0, 1, 1, 4, 4};
  size_t count = 0;

  points.x = square;
  points.count = n;
  asked.x = where;
  asked.count = 2;
  heights.memory = (void*)values;
  heights.size = n;
  to.memory = words;
  to.size = 30;
  from.memory = results;
  from.size = 16;
  CHECK_OK(cadt_triangulator_open(&options, &triangulator));
  CHECK_OK(cadt_triangulator_triangulate_device(triangulator, &points, &mesh));
  CHECK_OK(cadt_queries_open_device(triangulator, &points, mesh, &queries));
  CHECK_OK(cadt_queries_locate_device(queries, &asked, &to));
  CHECK(words[0] == 0 && words[1] == -1);
  CHECK_OK(cadt_queries_nearest_vertices_device(queries, &asked, 2, &to));
  CHECK(words[0] == 4 && words[2] == 2);
  CHECK_OK(cadt_queries_interpolate_device(queries, &heights, &asked, CADT_LINEAR, CADT_OUTSIDE_NEAREST, &from));
  CHECK(results[0] == 2 && results[1] == 4);
  CHECK_OK(cadt_queries_rasterize_device(queries, &grid, &heights, CADT_LINEAR, INFINITY, &from));
  CHECK(results[0] == 0.5 && results[15] == 3.5);
  from.size = 15;
  CHECK_STATUS(CADT_INPUT_ERROR,
               cadt_queries_rasterize_device(queries, &grid, &heights, CADT_LINEAR, INFINITY, &from));
  cadt_queries_free(queries);
  cadt_device_triangulation_free(mesh);

  CHECK_OK(cadt_triangulator_triangulate_device_into(triangulator, &points, &to, NULL, &count));
  CHECK(count == 4 && words[0] == 0 && words[1] == 1 && words[2] == 4);
  CHECK_OK(cadt_triangulator_triangulate_into(triangulator, &from_host, others, 30, NULL, 0, &count));
  CHECK(count == 4 && memcmp(words, others, 12 * sizeof *words) == 0);
  CHECK_STATUS(CADT_INPUT_ERROR, cadt_triangulator_triangulate_into(triangulator, &from_host, others, 11, NULL, 0, &count));
  cadt_triangulator_free(triangulator);
}

void test_queries(void) {
  const cadt_points points = points_of(square, n);
  cadt_options options = on_host();
  cadt_triangulation* mesh = NULL;
  cadt_queries* queries = NULL;
  cadt_mesh_view arrays = {0};
  const int32_t *triangles = NULL, *neighbors = NULL;
  size_t size = 0;

  CHECK_OK(cadt_triangulate(&points, &options, &mesh));
  CHECK_STATUS(CADT_INPUT_ERROR, cadt_queries_open(NULL, mesh, &options, &queries));
  CHECK_OK(cadt_queries_open(&points, mesh, &options, &queries));
  test_answers(queries);
  test_duals(queries);
  test_nothing(queries);
  cadt_queries_free(queries);

  arrays.size = sizeof arrays;
  CHECK_OK(cadt_triangulation_size(mesh, &size, &arrays.triangle_count));
  CHECK_OK(cadt_triangulation_triangles(mesh, &triangles));
  CHECK_OK(cadt_triangulation_neighbors(mesh, &neighbors));
  CHECK_NULL(cadt_queries_open_arrays(&points, &arrays, &options, &queries), "mesh->triangles");
  arrays.triangles = triangles;
  CHECK_NULL(cadt_queries_open_arrays(&points, &arrays, &options, &queries), "mesh->neighbors");
  arrays.neighbors = neighbors;
  CHECK_OK(cadt_queries_open_arrays(&points, &arrays, &options, &queries));
  test_answers(queries);
  cadt_queries_free(queries);
  arrays.neighbors = triangles;
  CHECK_STATUS(CADT_INPUT_ERROR, cadt_queries_open_arrays(&points, &arrays, &options, &queries));
  cadt_triangulation_free(mesh);

  options.keep_points = CADT_KEEP_COPY;
  CHECK_OK(cadt_triangulate(&points, &options, &mesh));
  CHECK_OK(cadt_queries_open(NULL, mesh, &options, &queries));
  cadt_triangulation_free(mesh);
  test_answers(queries);
  cadt_queries_free(queries);
  cadt_queries_free(NULL);
  test_on_device();
}
