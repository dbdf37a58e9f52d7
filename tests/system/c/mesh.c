/* SPDX-License-Identifier: Apache-2.0 */
/* Meshes of the host: points in all layouts, arrays, topology, adoption and verification. */
#include "check.h"

/* A square, its centre, and two points once more. */
static const double square[] = {0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5, 1, 0, -0.0, 0};
enum { points_in_square = 7 };

static cadt_triangulation* mesh_of(const double* xy, size_t count) {
  cadt_triangulation* mesh = NULL;
  const cadt_points points = points_of(xy, count);
  const cadt_options options = on_host();
  CHECK_OK(cadt_triangulate(&points, &options, &mesh));
  return mesh;
}

static int same_hash(const cadt_triangulation* a, const cadt_triangulation* b) {
  uint64_t a_high = 0, a_low = 0, b_high = 1, b_low = 1;
  CHECK_OK(cadt_triangulation_hash(a, &a_high, &a_low));
  CHECK_OK(cadt_triangulation_hash(b, &b_high, &b_low));
  return a_high == b_high && a_low == b_low;
}

void test_points(void) {
  struct station {
    char code;
    float x, y;
  };
  struct record {
    double y;
    int64_t id;
    double x;
  };
  struct station stations[points_in_square];
  struct record records[points_in_square];
  double xs[points_in_square], ys[points_in_square];
  cadt_triangulation *expected = mesh_of(square, points_in_square), *mesh = NULL;
  const cadt_options options = on_host();
  cadt_points points = {0};
  int i;
  for (i = 0; i < points_in_square; ++i) {
    xs[i] = records[i].x = square[2 * i];
    ys[i] = records[i].y = square[2 * i + 1];
    stations[i].x = (float)xs[i];
    stations[i].y = (float)ys[i];
  }
  points.count = points_in_square;
  points.x = xs;
  points.y = ys;
  CHECK_OK(cadt_triangulate(&points, &options, &mesh));
  CHECK(same_hash(mesh, expected));
  cadt_triangulation_free(mesh);
  points.x = &records[0].x;
  points.y = &records[0].y;
  points.stride = sizeof(struct record);
  CHECK_OK(cadt_triangulate(&points, &options, &mesh));
  CHECK(same_hash(mesh, expected));
  cadt_triangulation_free(mesh);
  points.x = &stations[0].x;
  points.y = NULL; /* behind x */
  points.stride = sizeof(struct station);
  points.scalar = CADT_FLOAT32;
  CHECK_OK(cadt_triangulate(&points, &options, &mesh));
  CHECK(same_hash(mesh, expected));
  cadt_triangulation_free(mesh);
  cadt_triangulation_free(expected);
}

void test_mesh(void) {
  cadt_triangulation *mesh = mesh_of(square, points_in_square), *copy = NULL, *kept = NULL;
  cadt_options options = on_host();
  cadt_points points = points_of(square, points_in_square);
  cadt_statistics statistics = {0};
  const int32_t *triangles = NULL, *neighbors = NULL, *hull = NULL;
  const cadt_duplicate* duplicates = NULL;
  size_t n = 0, count = 0, hull_count = 0, duplicate_count = 0;
  int32_t dimension = -2;
  static const int32_t expected_triangles[] = {0, 1, 4, 0, 4, 3, 1, 2, 4, 2, 3, 4};
  static const int32_t expected_neighbors[] = {2, 1, -1, 3, -1, 0, 3, 0, -1, 1, 2, -1};

  CHECK_OK(cadt_triangulation_copy(mesh, &copy));
  cadt_triangulation_free(mesh);
  CHECK_OK(cadt_triangulation_size(copy, &n, &count));
  CHECK(n == points_in_square && count == 4);
  CHECK_OK(cadt_triangulation_dimension(copy, &dimension));
  CHECK(dimension == 2);
  CHECK_OK(cadt_triangulation_triangles(copy, &triangles));
  CHECK(memcmp(triangles, expected_triangles, sizeof expected_triangles) == 0);
  CHECK_OK(cadt_triangulation_neighbors(copy, &neighbors));
  CHECK(memcmp(neighbors, expected_neighbors, sizeof expected_neighbors) == 0);
  CHECK_OK(cadt_triangulation_hull(copy, &hull, &hull_count));
  CHECK(hull_count == 4 && hull[0] == 0 && hull[1] == 1 && hull[2] == 2 && hull[3] == 3);
  CHECK_OK(cadt_triangulation_duplicates(copy, &duplicates, &duplicate_count));
  CHECK(duplicate_count == 2 && duplicates[0].point == 5 && duplicates[0].representative == 1);
  CHECK(duplicates[1].point == 6 && duplicates[1].representative == 0);
  statistics.size = sizeof statistics;
  CHECK_OK(cadt_triangulation_statistics(copy, &statistics));
  CHECK(strcmp(statistics.backend, "host") == 0 && statistics.points == n && statistics.distinct == 5);
  CHECK(statistics.certified == 1 && statistics.milliseconds > 0);

  options.keep_points = CADT_KEEP_VIEW;
  CHECK_OK(cadt_triangulate(&points, &options, &kept));
  CHECK_OK(cadt_triangulation_points(kept, &points));
  CHECK(points.x == square && points.y == square + 1 && points.count == n && points.stride == 16);
  cadt_triangulation_free(kept);
  CHECK_OK(cadt_triangulation_points(copy, &points));
  CHECK(points.count == 0);
  cadt_triangulation_free(copy);

  mesh = mesh_of(NULL, 0);
  CHECK_OK(cadt_triangulation_dimension(mesh, &dimension));
  CHECK(dimension == -1);
  cadt_triangulation_free(mesh);
}

/* A function that fills an array: the count alone, too little room, enough room. */
#define CHECK_FILL(type, expected_count, call)                                        \
  do {                                                                                \
    type* out = NULL;                                                                 \
    size_t capacity = 0, count = 99;                                                  \
    CHECK_OK(call);                                                                   \
    CHECK(count == (expected_count));                                                 \
    out = values;                                                                     \
    memset(values, 0x55, sizeof values);                                              \
    capacity = (expected_count)-1;                                                    \
    CHECK_STATUS(CADT_BUFFER_TOO_SMALL, call);                                        \
    CHECK(last_error().needed == (expected_count) && last_error().available == capacity); \
    CHECK(count == (expected_count) && memcmp(values, untouched, sizeof values) == 0); \
    capacity = (expected_count);                                                      \
    CHECK_OK(call);                                                                   \
    CHECK(memcmp(values + (expected_count), untouched, sizeof *values) == 0);         \
  } while (0)

void test_topology(void) {
  cadt_triangulation* mesh = mesh_of(square, points_in_square);
  static const int32_t edges[] = {0, 1, 0, 3, 0, 4, 1, 2, 1, 4, 2, 3, 2, 4, 3, 4};
  static const int64_t half_edges[] = {-1, 8, 3, 2, 10, -1, -1, 11, 1, -1, 4, 7};
  static const int32_t around[] = {1, 4, 3, 2, 4, 0, 3, 4, 1, 0, 4, 2, 0, 1, 2, 3};
  static const int32_t incident[] = {0, 1, 2, 0, 3, 2, 1, 3, 0, 2, 3, 1};
  static const size_t around_begin[] = {0, 3, 6, 9, 12, 16, 16, 16}, incident_begin[] = {0, 2, 4, 6, 8, 12, 12, 12};
  unsigned char untouched[1024];
  size_t indptr[points_in_square + 1];
  memset(untouched, 0x55, sizeof untouched);
  {
    int32_t values[32];
    CHECK_FILL(int32_t, 7, cadt_triangulation_vertex_triangle(mesh, out, capacity, &count));
    CHECK(values[0] == 0 && values[3] == 1 && values[6] == 0);
    CHECK_FILL(int32_t, 16, cadt_triangulation_edges(mesh, out, capacity, &count));
    CHECK(memcmp(values, edges, sizeof edges) == 0);
    memset(indptr, 0x55, sizeof indptr);
    CHECK_FILL(int32_t, 16, cadt_triangulation_vertex_neighbors(mesh, out == NULL ? NULL : indptr, out, capacity, &count));
    CHECK(memcmp(values, around, sizeof around) == 0 && memcmp(indptr, around_begin, sizeof around_begin) == 0);
    CHECK_FILL(int32_t, 12, cadt_triangulation_incident_triangles(mesh, out == NULL ? NULL : indptr, out, capacity, &count));
    CHECK(memcmp(values, incident, sizeof incident) == 0 && memcmp(indptr, incident_begin, sizeof incident_begin) == 0);
  }
  {
    int64_t values[16];
    CHECK_FILL(int64_t, 12, cadt_triangulation_half_edges(mesh, out, capacity, &count));
    CHECK(memcmp(values, half_edges, sizeof half_edges) == 0);
  }
  {
    size_t count = 0;
    memset(indptr, 0x55, sizeof indptr);
    CHECK_STATUS(CADT_BUFFER_TOO_SMALL, cadt_triangulation_vertex_neighbors(mesh, indptr, NULL, 0, &count));
    CHECK(memcmp(indptr, untouched, sizeof indptr) == 0);
    cadt_triangulation_free(mesh);
    mesh = mesh_of(square, 2); /* no triangles, but rows */
    CHECK_OK(cadt_triangulation_vertex_neighbors(mesh, indptr, NULL, 0, &count));
    CHECK(count == 0 && indptr[0] == 0 && indptr[1] == 0 && indptr[2] == 0);
    cadt_triangulation_free(mesh);
  }
}

void test_adopt_and_verify(void) {
  static const double kite[] = {0, 0, 4, 0, 2, 1, 2, -1};
  static const int32_t right[] = {0, 3, 2, 3, 1, 2}, wrong[] = {0, 1, 2, 0, 3, 1}, neighbors[] = {1, -1, -1, -1, 0, -1};
  const cadt_points points = points_of(kite, 4);
  const cadt_options options = on_host();
  cadt_triangulation *mesh = NULL, *own = mesh_of(kite, 4);
  cadt_mesh_view view;
  cadt_report* report = NULL;
  cadt_check check = {0};
  size_t checks = 0, i, failed = 0;
  int32_t ok = -1;
  const char* summary = NULL;
  const cadt_options* where[2];

  CHECK_OK(cadt_triangulation_adopt(&points, right, neighbors, 2, 0, CADT_KEEP_COPY, &mesh));
  CHECK(same_hash(mesh, own));
  cadt_triangulation_free(mesh);
  mesh = NULL;
  CHECK_STATUS(CADT_INVALID_MESH, cadt_triangulation_adopt(&points, wrong, NULL, 2, 0, 0, &mesh));
  CHECK(mesh == NULL && strcmp(last_error().name, "delaunay") == 0 && last_error().index == 2);
  CHECK_NULL(cadt_triangulation_adopt(&points, right, NULL, 2, 0, 7, &mesh), "keep_points");
  CHECK_STATUS(CADT_LIMIT_ERROR, cadt_triangulation_adopt(&points, right, NULL, (size_t)-1 / 3 + 1, 1, 0, &mesh));
  CHECK_OK(cadt_triangulation_adopt(&points, wrong, NULL, 2, 1, 0, &mesh));

  where[0] = NULL;
  where[1] = &options;
  for (i = 0; i < 2; ++i) {
    size_t k;
    memset(&view, 0, sizeof view);
    view.size = sizeof view;
    view.triangles = right;
    view.triangle_count = 2;
    CHECK_OK(cadt_verify(&points, &view, where[i], &report));
    CHECK_OK(cadt_report_ok(report, &ok));
    CHECK(ok == 1);
    cadt_report_free(report);
    CHECK_OK(cadt_triangulation_verify(own, &points, where[i], &report));
    CHECK_OK(cadt_report_ok(report, &ok));
    CHECK(ok == 1);
    CHECK_OK(cadt_report_summary(report, &summary));
    CHECK(strncmp(summary, "ok", 2) == 0);
    cadt_report_free(report);
    CHECK_OK(cadt_triangulation_verify(mesh, &points, where[i], &report));
    CHECK_OK(cadt_report_ok(report, &ok));
    CHECK(ok == 0);
    CHECK_OK(cadt_report_size(report, &checks));
    CHECK(checks == 10);
    check.size = sizeof check;
    for (k = 0; k < checks; ++k) {
      CHECK_OK(cadt_report_check(report, k, &check));
      if (check.passed) continue;
      ++failed;
      CHECK(strcmp(check.name, "delaunay") == 0 && check.what[0] != 0 && check.failures == 1 && check.first == 2);
    }
    CHECK(failed == i + 1);
    cadt_report_free(report);
    /* Each further array is compared. */
    view.duplicate_count = 0;
    view.has_duplicates = 1;
    view.hull = right;
    view.hull_count = 3;
    CHECK_OK(cadt_verify(&points, &view, where[i], &report));
    CHECK_OK(cadt_report_ok(report, &ok));
    CHECK(ok == 0);
    cadt_report_free(report);
  }
  view.triangle_count = (size_t)-1 / 3 + 1;
  CHECK_STATUS(CADT_LIMIT_ERROR, cadt_verify(&points, &view, NULL, &report));
  cadt_triangulation_free(mesh);
  cadt_triangulation_free(own);
}
