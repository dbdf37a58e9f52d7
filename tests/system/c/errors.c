/* SPDX-License-Identifier: Apache-2.0 */
/* What goes wrong: statuses and their data, NULL for each argument. */
#include <math.h>

#include "check.h"

void test_errors(void) {
  double xy[] = {0, 0, 1, 0, 0, 1};
  cadt_points points = points_of(xy, 3);
  cadt_options options = on_host();
  cadt_triangulation* mesh = NULL;
  cadt_error error = {0};

  CHECK(last_error().status == CADT_OK);
  CHECK(strcmp(last_error().message, "") == 0 && last_error().index == -1);
  CHECK(strcmp(cadt_last_error_message(), "") == 0);
  CHECK(cadt_last_error(NULL) == CADT_INVALID_ARGUMENT);
  CHECK(cadt_last_error(&error) == CADT_INVALID_ARGUMENT); /* without its size */

  xy[3] = NAN;
  CHECK_STATUS(CADT_INPUT_ERROR, cadt_triangulate(&points, &options, &mesh));
  CHECK(mesh == NULL && last_error().index == 1);
  CHECK(strcmp(cadt_last_error_message(), last_error().message) == 0 && cadt_last_error_message()[0] != 0);
  xy[3] = 0;

  options.device = "no such device";
  CHECK_STATUS(CADT_BACKEND_UNAVAILABLE, cadt_triangulate(&points, &options, &mesh));
  CHECK(strcmp(last_error().name, "host") == 0 && last_error().detail[0] != 0);
  options = on_host();
  options.max_memory = 1;
  CHECK_STATUS(CADT_OUT_OF_MEMORY, cadt_triangulate(&points, &options, &mesh));
  CHECK(last_error().needed > 1 && last_error().available <= 1);
  options = on_host();
  points.count = (size_t)1 << 29;
  CHECK_STATUS(CADT_LIMIT_ERROR, cadt_triangulate(&points, &options, &mesh));
  CHECK(last_error().needed == (size_t)1 << 29 && last_error().available == ((size_t)1 << 29) - 2);
  points.count = 3;

  /* Structs and constants that are not what they should be. */
  options.size = 0;
  CHECK_NULL(cadt_triangulate(&points, &options, &mesh), "options");
  CHECK_NULL(cadt_options_init(&options, sizeof options - 1), "size");
  options = on_host();
  options.backend = 4;
  CHECK_NULL(cadt_triangulate(&points, &options, &mesh), "options->backend");
  options = on_host();
  options.order = -1;
  CHECK_NULL(cadt_triangulate(&points, &options, &mesh), "options->order");
  options = on_host();
  options.keep_points = 3;
  CHECK_NULL(cadt_triangulate(&points, &options, &mesh), "options->keep_points");
  options = on_host();
  options.statistics = 3;
  CHECK_NULL(cadt_triangulate(&points, &options, &mesh), "options->statistics");
  options = on_host();
  options.strategy = 3;
  CHECK_NULL(cadt_triangulate(&points, &options, &mesh), "options->strategy");
  points.scalar = 2;
  options = on_host();
  CHECK_NULL(cadt_triangulate(&points, &options, &mesh), "points->scalar");
  points.scalar = CADT_FLOAT64;
  points.stride = 8;
  CHECK_NULL(cadt_triangulate(&points, &options, &mesh), "points->stride");
  points.stride = 0;
  points.x = NULL;
  CHECK_NULL(cadt_triangulate(&points, &options, &mesh), "points->x");

  /* A longer struct, of a program that is newer than the library. */
  {
    struct {
      cadt_options known;
      int64_t unknown;
    } longer;
    memset(&longer, 255, sizeof longer);
    CHECK_OK(cadt_options_init(&longer.known, sizeof longer));
    CHECK(longer.unknown == 0 && longer.known.size == sizeof longer);
    points.x = xy;
    CHECK_OK(cadt_triangulate(&points, &longer.known, &mesh));
    cadt_triangulation_free(mesh);
    mesh = NULL;
    longer.unknown = 1;
    CHECK_NULL(cadt_triangulate(&points, &longer.known, &mesh), "options");
  }
  CHECK(mesh == NULL);

  CHECK(strcmp(cadt_status_name(CADT_OK), "CADT_OK") == 0);
  CHECK(strcmp(cadt_status_name(CADT_ERROR), "CADT_ERROR") == 0);
  CHECK(strcmp(cadt_status_name(CADT_BUFFER_TOO_SMALL), "CADT_BUFFER_TOO_SMALL") == 0);
  CHECK(strcmp(cadt_status_name(-1), "unknown status") == 0 && strcmp(cadt_status_name(17), "unknown status") == 0);
}

void test_null(void) {
  const double xy[] = {0, 0, 1, 0, 0, 1};
  const size_t offsets[] = {0, 3};
  const cadt_points points = points_of(xy, 3);
  const cadt_options options = on_host();
  cadt_device_points on_device = {0};
  cadt_mesh_view view = {0};
  cadt_triangulation *mesh = NULL, *other = NULL;
  cadt_triangulator* triangulator = NULL;
  cadt_device_triangulation* device_mesh = NULL;
  cadt_batch* batch = NULL;
  cadt_device_batch* device_batch = NULL;
  cadt_report* report = NULL;
  cadt_device_list* list = NULL;
  size_t a, b;
  uint64_t high;
  int32_t number;
  const int32_t* words;
  const size_t* sizes;
  const cadt_duplicate* duplicates;
  void* handle;
  cadt_device_info info = {0};

  on_device.x = xy;
  on_device.count = 3;
  view.size = sizeof view;
  CHECK_OK(cadt_triangulate(&points, &options, &mesh));
  CHECK_OK(cadt_triangulator_open(&options, &triangulator));
  CHECK_OK(cadt_triangulator_triangulate_device(triangulator, &on_device, &device_mesh));
  CHECK_OK(cadt_triangulate_batch(&points, offsets, 1, &options, &batch));
  CHECK_OK(cadt_triangulator_triangulate_device_batch(triangulator, &on_device, offsets, 1, &device_batch));
  CHECK_OK(cadt_triangulation_verify(mesh, &points, NULL, &report));
  CHECK_OK(cadt_list_devices(&list));

  CHECK_NULL(cadt_options_init(NULL, sizeof options), "options");
  CHECK_NULL(cadt_triangulate(NULL, &options, &other), "points");
  CHECK_NULL(cadt_triangulate(&points, &options, NULL), "mesh");
  CHECK_NULL(cadt_triangulation_adopt(NULL, NULL, NULL, 0, 0, 0, &other), "points");
  CHECK_NULL(cadt_triangulation_adopt(&points, NULL, NULL, 1, 0, 0, &other), "triangles");
  CHECK_NULL(cadt_triangulation_adopt(&points, NULL, NULL, 0, 0, 0, NULL), "mesh");
  CHECK_NULL(cadt_triangulation_copy(NULL, &other), "mesh");
  CHECK_NULL(cadt_triangulation_copy(mesh, NULL), "copy");
  CHECK_NULL(cadt_triangulation_size(NULL, &a, &b), "mesh");
  CHECK_NULL(cadt_triangulation_size(mesh, NULL, &b), "points");
  CHECK_NULL(cadt_triangulation_size(mesh, &a, NULL), "triangles");
  CHECK_NULL(cadt_triangulation_dimension(NULL, &number), "mesh");
  CHECK_NULL(cadt_triangulation_dimension(mesh, NULL), "dimension");
  CHECK_NULL(cadt_triangulation_triangles(NULL, &words), "mesh");
  CHECK_NULL(cadt_triangulation_triangles(mesh, NULL), "triangles");
  CHECK_NULL(cadt_triangulation_neighbors(NULL, &words), "mesh");
  CHECK_NULL(cadt_triangulation_neighbors(mesh, NULL), "neighbors");
  CHECK_NULL(cadt_triangulation_hull(NULL, &words, &a), "mesh");
  CHECK_NULL(cadt_triangulation_hull(mesh, NULL, &a), "hull");
  CHECK_NULL(cadt_triangulation_hull(mesh, &words, NULL), "count");
  CHECK_NULL(cadt_triangulation_duplicates(NULL, &duplicates, &a), "mesh");
  CHECK_NULL(cadt_triangulation_duplicates(mesh, NULL, &a), "list");
  CHECK_NULL(cadt_triangulation_duplicates(mesh, &duplicates, NULL), "count");
  CHECK_NULL(cadt_triangulation_points(mesh, NULL), "points");
  CHECK_NULL(cadt_triangulation_points(NULL, NULL), "mesh");
  CHECK_NULL(cadt_triangulation_hash(NULL, &high, &high), "mesh");
  CHECK_NULL(cadt_triangulation_hash(mesh, NULL, &high), "high");
  CHECK_NULL(cadt_triangulation_hash(mesh, &high, NULL), "low");
  CHECK_NULL(cadt_triangulation_statistics(NULL, NULL), "mesh");
  CHECK_NULL(cadt_triangulation_statistics(mesh, NULL), "statistics");
  CHECK_NULL(cadt_triangulation_vertex_triangle(NULL, NULL, 0, &a), "mesh");
  CHECK_NULL(cadt_triangulation_vertex_triangle(mesh, NULL, 0, NULL), "count");
  CHECK_NULL(cadt_triangulation_edges(NULL, NULL, 0, &a), "mesh");
  CHECK_NULL(cadt_triangulation_edges(mesh, NULL, 6, &a), "capacity");
  CHECK_NULL(cadt_triangulation_half_edges(NULL, NULL, 0, &a), "mesh");
  CHECK_NULL(cadt_triangulation_half_edges(mesh, NULL, 0, NULL), "count");
  CHECK_NULL(cadt_triangulation_vertex_neighbors(NULL, NULL, NULL, 0, &a), "mesh");
  CHECK_NULL(cadt_triangulation_vertex_neighbors(mesh, NULL, &number, 100, &a), "indptr");
  CHECK_NULL(cadt_triangulation_incident_triangles(NULL, NULL, NULL, 0, &a), "mesh");
  CHECK_NULL(cadt_triangulation_incident_triangles(mesh, NULL, NULL, 0, NULL), "count");

  CHECK_NULL(cadt_verify(NULL, &view, NULL, &report), "points");
  CHECK_NULL(cadt_verify(&points, NULL, NULL, &report), "mesh");
  CHECK_NULL(cadt_verify(&points, &view, NULL, NULL), "report");
  view.triangle_count = 1;
  CHECK_NULL(cadt_verify(&points, &view, NULL, &report), "mesh->triangles");
  view.size = 8;
  CHECK_NULL(cadt_verify(&points, &view, NULL, &report), "mesh");
  CHECK_NULL(cadt_triangulation_verify(NULL, &points, NULL, &report), "mesh");
  CHECK_NULL(cadt_triangulation_verify(mesh, NULL, NULL, &report), "points");
  CHECK_NULL(cadt_triangulation_verify(mesh, &points, NULL, NULL), "report");
  CHECK_NULL(cadt_report_ok(NULL, &number), "report");
  CHECK_NULL(cadt_report_ok(report, NULL), "ok");
  CHECK_NULL(cadt_report_summary(NULL, NULL), "report");
  CHECK_NULL(cadt_report_summary(report, NULL), "summary");
  CHECK_NULL(cadt_report_size(NULL, &a), "report");
  CHECK_NULL(cadt_report_size(report, NULL), "checks");
  CHECK_NULL(cadt_report_check(NULL, 0, NULL), "report");
  CHECK_NULL(cadt_report_check(report, 0, NULL), "check");
  CHECK_NULL(cadt_report_check(report, 10, NULL), "index");

  CHECK_NULL(cadt_triangulator_open(&options, NULL), "triangulator");
  CHECK_NULL(cadt_triangulator_set_options(NULL, &options), "triangulator");
  CHECK_NULL(cadt_triangulator_triangulate(NULL, &points, &other), "triangulator");
  CHECK_NULL(cadt_triangulator_triangulate(triangulator, NULL, &other), "points");
  CHECK_NULL(cadt_triangulator_triangulate(triangulator, &points, NULL), "mesh");
  CHECK_NULL(cadt_triangulator_memory_needed(NULL, 1, &a), "triangulator");
  CHECK_NULL(cadt_triangulator_memory_needed(triangulator, 1, NULL), "bytes");
  CHECK_NULL(cadt_triangulator_reserve(NULL, 1), "triangulator");
  CHECK_NULL(cadt_triangulator_release_memory(NULL), "triangulator");
  CHECK_NULL(cadt_triangulator_triangulate_device(NULL, &on_device, &device_mesh), "triangulator");
  CHECK_NULL(cadt_triangulator_triangulate_device(triangulator, NULL, &device_mesh), "points");
  CHECK_NULL(cadt_triangulator_triangulate_device(triangulator, &on_device, NULL), "mesh");
  CHECK_NULL(cadt_triangulator_verify(NULL, &on_device, device_mesh, &report), "triangulator");
  CHECK_NULL(cadt_triangulator_verify(triangulator, NULL, device_mesh, &report), "points");
  CHECK_NULL(cadt_triangulator_verify(triangulator, &on_device, NULL, &report), "mesh");
  CHECK_NULL(cadt_triangulator_verify(triangulator, &on_device, device_mesh, NULL), "report");
  CHECK_NULL(cadt_triangulator_device(NULL, &info), "triangulator");
  CHECK_NULL(cadt_triangulator_device(triangulator, &info), "info"); /* without its size */
  CHECK_NULL(cadt_device_triangulation_size(NULL, &a, &a, &a), "mesh");
  CHECK_NULL(cadt_device_triangulation_size(device_mesh, NULL, &a, &a), "points");
  CHECK_NULL(cadt_device_triangulation_size(device_mesh, &a, NULL, &a), "triangles");
  CHECK_NULL(cadt_device_triangulation_size(device_mesh, &a, &a, NULL), "duplicates");
  CHECK_NULL(cadt_device_triangulation_dimension(NULL, &number), "mesh");
  CHECK_NULL(cadt_device_triangulation_dimension(device_mesh, NULL), "dimension");
  CHECK_NULL(cadt_device_triangulation_triangles(NULL, &handle), "mesh");
  CHECK_NULL(cadt_device_triangulation_triangles(device_mesh, NULL), "triangles");
  CHECK_NULL(cadt_device_triangulation_neighbors(NULL, &handle), "mesh");
  CHECK_NULL(cadt_device_triangulation_neighbors(device_mesh, NULL), "neighbors");
  CHECK_NULL(cadt_device_triangulation_duplicates(NULL, &handle, &handle), "mesh");
  CHECK_NULL(cadt_device_triangulation_duplicates(device_mesh, NULL, &handle), "points");
  CHECK_NULL(cadt_device_triangulation_duplicates(device_mesh, &handle, NULL), "representatives");
  CHECK_NULL(cadt_device_triangulation_statistics(NULL, NULL), "mesh");
  CHECK_NULL(cadt_device_triangulation_statistics(device_mesh, NULL), "statistics");
  CHECK_NULL(cadt_device_triangulation_download(NULL, &other), "mesh");
  CHECK_NULL(cadt_device_triangulation_download(device_mesh, NULL), "copy");

  CHECK_NULL(cadt_triangulate_batch(NULL, offsets, 1, NULL, &batch), "points");
  CHECK_NULL(cadt_triangulate_batch(&points, NULL, 1, NULL, &batch), "offsets");
  CHECK_NULL(cadt_triangulate_batch(&points, offsets, 1, NULL, NULL), "batch");
  CHECK_NULL(cadt_triangulator_triangulate_batch(NULL, &points, offsets, 1, &batch), "triangulator");
  CHECK_NULL(cadt_triangulator_triangulate_batch(triangulator, &points, NULL, 1, &batch), "offsets");
  CHECK_NULL(cadt_triangulator_triangulate_batch(triangulator, &points, offsets, 1, NULL), "batch");
  CHECK_NULL(cadt_batch_triangle_offsets(NULL, &sizes, &a), "batch");
  CHECK_NULL(cadt_batch_triangle_offsets(batch, NULL, &a), "offsets");
  CHECK_NULL(cadt_batch_triangle_offsets(batch, &sizes, NULL), "sets");
  CHECK_NULL(cadt_batch_triangles(NULL, &words), "batch");
  CHECK_NULL(cadt_batch_triangles(batch, NULL), "triangles");
  CHECK_NULL(cadt_batch_neighbors(NULL, &words), "batch");
  CHECK_NULL(cadt_batch_neighbors(batch, NULL), "neighbors");
  CHECK_NULL(cadt_batch_dimension(NULL, 0, &number), "batch");
  CHECK_NULL(cadt_batch_dimension(batch, 0, NULL), "dimension");
  CHECK_NULL(cadt_batch_duplicates(NULL, 0, &duplicates, &a), "batch");
  CHECK_NULL(cadt_batch_duplicates(batch, 0, NULL, &a), "list");
  CHECK_NULL(cadt_batch_duplicates(batch, 0, &duplicates, NULL), "count");
  CHECK_NULL(cadt_batch_statistics(NULL, NULL), "batch");
  CHECK_NULL(cadt_batch_statistics(batch, NULL), "statistics");
  CHECK_NULL(cadt_batch_triangulation(NULL, 0, &other), "batch");
  CHECK_NULL(cadt_batch_triangulation(batch, 0, NULL), "mesh");
  CHECK_NULL(cadt_triangulator_triangulate_device_batch(NULL, &on_device, offsets, 1, &device_batch), "triangulator");
  CHECK_NULL(cadt_triangulator_triangulate_device_batch(triangulator, NULL, offsets, 1, &device_batch), "points");
  CHECK_NULL(cadt_triangulator_triangulate_device_batch(triangulator, &on_device, NULL, 1, &device_batch), "offsets");
  CHECK_NULL(cadt_triangulator_triangulate_device_batch(triangulator, &on_device, offsets, 1, NULL), "batch");
  CHECK_NULL(cadt_device_batch_triangle_offsets(NULL, &sizes, &a), "batch");
  CHECK_NULL(cadt_device_batch_arrays(NULL, &handle, &handle, &handle), "batch");
  CHECK_NULL(cadt_device_batch_arrays(device_batch, NULL, &handle, &handle), "triangle_offsets");
  CHECK_NULL(cadt_device_batch_arrays(device_batch, &handle, NULL, &handle), "triangles");
  CHECK_NULL(cadt_device_batch_arrays(device_batch, &handle, &handle, NULL), "neighbors");
  CHECK_NULL(cadt_device_batch_download(NULL, &batch), "batch");
  CHECK_NULL(cadt_device_batch_download(device_batch, NULL), "copy");
  CHECK_NULL(cadt_list_devices(NULL), "list");
  CHECK_NULL(cadt_device_list_size(NULL, &a), "list");
  CHECK_NULL(cadt_device_list_size(list, NULL), "count");
  CHECK_NULL(cadt_device_list_get(NULL, 0, &info), "list");
  CHECK_NULL(cadt_device_list_get(list, 1000, &info), "index");
  CHECK_NULL(cadt_device_list_get(list, 0, NULL), "info");

  CHECK(other == NULL);
  cadt_device_list_free(list);
  cadt_report_free(report);
  cadt_device_batch_free(device_batch);
  cadt_batch_free(batch);
  cadt_device_triangulation_free(device_mesh);
  cadt_triangulator_free(triangulator);
  cadt_triangulation_free(mesh);
  cadt_device_list_free(NULL);
  cadt_report_free(NULL);
  cadt_device_batch_free(NULL);
  cadt_batch_free(NULL);
  cadt_device_triangulation_free(NULL);
  cadt_triangulator_free(NULL);
  cadt_triangulation_free(NULL);
}
