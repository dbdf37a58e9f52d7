/* SPDX-License-Identifier: Apache-2.0 */
/* Open devices, device memory, callbacks and batches. The host is a device too: its memory is that of the program. */
#include "check.h"

enum { n = 5000 };

/* Distinct points that nobody else has: an additive sequence modulo 1. */
static double* many_points(void) {
  double* xy = malloc(2 * n * sizeof *xy);
  int i;
  for (i = 0; i < n; ++i) {
    const double x = i * 0.7548776662466927, y = i * 0.5698402909980532;
    xy[2 * i] = x - (double)(int64_t)x;
    xy[2 * i + 1] = y - (double)(int64_t)y;
  }
  return xy;
}

void test_triangulator(void) {
  double* xy = many_points();
  const cadt_points points = points_of(xy, n);
  cadt_device_points on_device = {0};
  cadt_options options = on_host();
  cadt_triangulator* triangulator = NULL;
  cadt_triangulation *mesh = NULL, *copy = NULL;
  cadt_device_triangulation* device_mesh = NULL;
  cadt_report* report = NULL;
  cadt_device_list* list = NULL;
  cadt_device_info info = {0};
  cadt_statistics statistics = {0};
  size_t bytes = 0, devices = 0, i, hosts = 0, size = 0, triangles = 0, duplicates = 0, expected = 0;
  int32_t ok = 0, dimension = 0;
  void *array = NULL, *others = NULL;
  const int32_t* vertices = NULL;

  info.size = sizeof info;
  CHECK_OK(cadt_list_devices(&list));
  CHECK_OK(cadt_device_list_size(list, &devices));
  for (i = 0; i < devices; ++i) {
    CHECK_OK(cadt_device_list_get(list, i, &info));
    hosts += info.backend == CADT_BACKEND_HOST && info.usable && info.name[0] != 0 && info.reason[0] == 0;
  }
  CHECK(hosts == 1);
  cadt_device_list_free(list);

  CHECK_OK(cadt_triangulator_open(&options, &triangulator));
  CHECK_OK(cadt_triangulator_device(triangulator, &info));
  CHECK(info.backend == CADT_BACKEND_HOST && info.fp64 == 1 && info.gpu == 0);
  CHECK_OK(cadt_triangulator_memory_needed(triangulator, SIZE_MAX, &bytes));
  CHECK(bytes == SIZE_MAX);
  CHECK_OK(cadt_triangulator_memory_needed(triangulator, n, &bytes));
  CHECK(bytes > 24 * n);
  options.strategy = CADT_STRATEGY_STARS;
  CHECK_OK(cadt_triangulator_set_options(triangulator, &options));
  CHECK_OK(cadt_triangulator_memory_needed(triangulator, n, &size));
  CHECK(size > bytes);
  options.strategy = CADT_STRATEGY_AUTO;
  CHECK_OK(cadt_triangulator_set_options(triangulator, &options));
  CHECK_OK(cadt_triangulator_reserve(triangulator, n));
  CHECK_OK(cadt_triangulator_triangulate(triangulator, &points, &mesh));
  CHECK_OK(cadt_triangulation_triangles(mesh, &vertices));

  on_device.x = xy + 2; /* the first point is skipped in another way */
  on_device.count = n - 1;
  CHECK_OK(cadt_triangulator_triangulate_device(triangulator, &on_device, &device_mesh));
  CHECK_OK(cadt_device_triangulation_size(device_mesh, &size, &expected, &duplicates));
  cadt_device_triangulation_free(device_mesh);
  on_device.x = xy;
  on_device.skip = 1;
  CHECK_OK(cadt_triangulator_triangulate_device(triangulator, &on_device, &device_mesh));
  CHECK_OK(cadt_device_triangulation_size(device_mesh, &size, &triangles, &duplicates));
  CHECK(size == n - 1 && triangles == expected && duplicates == 0);
  cadt_device_triangulation_free(device_mesh);
  on_device.skip = 0;
  on_device.count = n;
  CHECK_OK(cadt_triangulator_triangulate_device(triangulator, &on_device, &device_mesh));
  CHECK_OK(cadt_device_triangulation_size(device_mesh, &size, &triangles, &duplicates));
  CHECK_OK(cadt_device_triangulation_triangles(device_mesh, &array));
  CHECK(memcmp(array, vertices, 3 * triangles * sizeof *vertices) == 0);
  CHECK_OK(cadt_device_triangulation_neighbors(device_mesh, &array));
  CHECK(array != NULL);
  CHECK_OK(cadt_device_triangulation_duplicates(device_mesh, &array, &others));
  CHECK(array == NULL && others == NULL);
  CHECK_OK(cadt_device_triangulation_dimension(device_mesh, &dimension));
  CHECK(dimension == 2);
  statistics.size = sizeof statistics;
  CHECK_OK(cadt_device_triangulation_statistics(device_mesh, &statistics));
  CHECK(statistics.points == n);
  CHECK_OK(cadt_triangulator_verify(triangulator, &on_device, device_mesh, &report));
  CHECK_OK(cadt_report_ok(report, &ok));
  CHECK(ok == 1);
  cadt_report_free(report);

  /* The threads are read when the device is opened, the order for each call. */
  options.threads = 7;
  options.statistics = CADT_STATISTICS_NONE;
  options.order = CADT_ORDER_FAST;
  CHECK_OK(cadt_triangulator_set_options(triangulator, &options));
  cadt_triangulation_free(mesh);
  CHECK_OK(cadt_triangulator_triangulate(triangulator, &points, &mesh));
  CHECK_OK(cadt_triangulation_statistics(mesh, &statistics));
  CHECK(statistics.milliseconds == 0 && statistics.threads == 1);

  CHECK_OK(cadt_triangulator_release_memory(triangulator));
  cadt_triangulator_free(triangulator); /* its results live on */
  CHECK_OK(cadt_device_triangulation_download(device_mesh, &copy));
  CHECK_OK(cadt_triangulation_verify(copy, &points, NULL, &report));
  CHECK_OK(cadt_report_ok(report, &ok));
  CHECK(ok == 1);
  cadt_report_free(report);
  cadt_triangulation_free(copy);
  cadt_device_triangulation_free(device_mesh);
  cadt_triangulation_free(mesh);
  free(xy);
}

struct seen {
  int calls, allocations;
  double fraction;
  int cancel_after;
  int fail_allocation;
  char phases[256];
};

static void on_progress(const char* phase, double fraction, void* user) {
  struct seen* seen = user;
  ++seen->calls;
  CHECK(fraction > seen->fraction || seen->calls == 1);
  seen->fraction = fraction;
  if (strlen(seen->phases) + strlen(phase) + 2 < sizeof seen->phases) strcat(strcat(seen->phases, phase), " ");
}

static int32_t is_cancelled(void* user) {
  const struct seen* seen = user;
  return seen->cancel_after >= 0 && seen->calls >= seen->cancel_after;
}

static void* give(size_t bytes, void* queue, void* user) {
  struct seen* seen = user;
  CHECK(queue == NULL);
  if (seen->fail_allocation == seen->allocations) return NULL;
  ++seen->allocations;
  {
    /* C99 has no aligned memory: the address that malloc gave stands before it. */
    char* whole = malloc(bytes + 512);
    char* memory = whole + 512 - (uintptr_t)whole % 256 - 256;
    memory += (size_t)(memory - whole) < sizeof whole ? 256 : 0;
    memcpy(memory - sizeof whole, &whole, sizeof whole);
    return memory;
  }
}

static void take_back(void* memory, size_t bytes, void* queue, void* user) {
  (void)bytes;
  (void)queue;
  (void)user;
  if (memory != NULL) {
    char* whole;
    memcpy(&whole, (char*)memory - sizeof whole, sizeof whole);
    free(whole);
  }
}

void test_callbacks(void) {
  double* xy = many_points();
  const cadt_points points = points_of(xy, n);
  cadt_options options = on_host();
  cadt_triangulator* triangulator = NULL;
  cadt_triangulation* mesh = NULL;
  struct seen seen = {0};
  int all, i;

  seen.cancel_after = -1;
  seen.fail_allocation = -1;
  options.user = &seen;
  options.progress = on_progress;
  options.cancelled = is_cancelled;
  CHECK_OK(cadt_triangulator_open(&options, &triangulator));
  CHECK_OK(cadt_triangulator_triangulate(triangulator, &points, &mesh));
  cadt_triangulation_free(mesh);
  mesh = NULL;
  CHECK(strstr(seen.phases, "sort ") && strstr(seen.phases, "insert ") && strstr(seen.phases, "output "));
  all = seen.calls;
  CHECK(all >= 3);
  for (i = 0; i <= all; ++i) {
    seen.calls = 0;
    seen.cancel_after = i;
    CHECK_STATUS(CADT_CANCELLED, cadt_triangulator_triangulate(triangulator, &points, &mesh));
    CHECK(mesh == NULL && seen.calls == i);
  }
  seen.calls = 0;
  seen.cancel_after = -1; /* the next call is not cancelled */
  CHECK_OK(cadt_triangulator_triangulate(triangulator, &points, &mesh));
  cadt_triangulation_free(mesh);
  mesh = NULL;
  cadt_triangulator_free(triangulator);

  /* so it is with queries */
  {
    cadt_triangulation* kept = NULL;
    cadt_queries* queries = NULL;
    int32_t triangle = -1;
    const cadt_points one = points_of(xy, 1);
    size_t count = 0;
    CHECK_OK(cadt_triangulate(&points, NULL, &kept));
    seen.calls = 0;
    CHECK_OK(cadt_queries_open(&points, kept, &options, &queries));
    CHECK(seen.calls > 0);
    seen.calls = 0;
    seen.cancel_after = 1;
    CHECK_STATUS(CADT_CANCELLED, cadt_queries_locate(queries, &one, &triangle, 1, &count));
    CHECK(triangle == -1 && seen.calls == 1);
    seen.calls = 0;
    seen.cancel_after = -1;
    CHECK_OK(cadt_queries_locate(queries, &one, &triangle, 1, &count));
    CHECK(triangle >= 0);
    cadt_queries_free(queries);
    cadt_triangulation_free(kept);
  }

  options = on_host();
  options.user = &seen;
  options.allocate = give;
  CHECK_NULL(cadt_triangulate(&points, &options, &mesh), "options->allocate");
  options.deallocate = take_back;
  CHECK_OK(cadt_triangulate(&points, &options, &mesh));
  cadt_triangulation_free(mesh);
  mesh = NULL;
  CHECK(seen.allocations > 3);
  seen.fail_allocation = seen.allocations + 2;
  CHECK_STATUS(CADT_OUT_OF_MEMORY, cadt_triangulate(&points, &options, &mesh));
  CHECK(mesh == NULL);
  free(xy);
}

void test_batches(void) {
  double* xy = many_points();
  const cadt_points points = points_of(xy, n);
  cadt_device_points on_device = {0};
  const cadt_options options = on_host();
  const size_t offsets[] = {0, 1000, 1000, 1002, n}, descending[] = {0, 10, 5, n};
  cadt_triangulator* triangulator = NULL;
  cadt_batch* batches[3] = {NULL, NULL, NULL};
  cadt_device_batch* device_batch = NULL;
  cadt_triangulation* set = NULL;
  cadt_report* report = NULL;
  cadt_statistics statistics = {0};
  const size_t* begins = NULL;
  const int32_t *triangles = NULL, *neighbors = NULL, *expected = NULL;
  const cadt_duplicate* duplicates = NULL;
  void *device_begins = NULL, *device_triangles = NULL, *device_neighbors = NULL;
  size_t sets = 0, count = 0, total;
  int32_t dimension = 0, ok = 0;
  int i;

  xy[2 * 4000] = xy[2 * 4001]; /* one duplicate, in the last set */
  xy[2 * 4000 + 1] = xy[2 * 4001 + 1];
  on_device.x = xy;
  on_device.count = n;
  CHECK_OK(cadt_triangulate_batch(&points, offsets, 4, &options, &batches[0]));
  CHECK_OK(cadt_triangulator_open(&options, &triangulator));
  CHECK_OK(cadt_triangulator_triangulate_batch(triangulator, &points, offsets, 4, &batches[1]));
  CHECK_OK(cadt_triangulator_triangulate_device_batch(triangulator, &on_device, offsets, 4, &device_batch));
  CHECK_OK(cadt_device_batch_download(device_batch, &batches[2]));
  CHECK_OK(cadt_batch_triangles(batches[0], &expected));
  for (i = 0; i < 3; ++i) {
    CHECK_OK(cadt_batch_triangle_offsets(batches[i], &begins, &sets));
    CHECK(sets == 4 && begins[0] == 0 && begins[1] == begins[2] && begins[2] == begins[3]);
    total = begins[4];
    CHECK_OK(cadt_batch_triangles(batches[i], &triangles));
    CHECK(memcmp(triangles, expected, 3 * total * sizeof *triangles) == 0);
    CHECK_OK(cadt_batch_neighbors(batches[i], &neighbors));
    CHECK(neighbors[0] >= -1 && (size_t)neighbors[0] + 1 <= begins[1]);
    CHECK_OK(cadt_batch_dimension(batches[i], 1, &dimension));
    CHECK(dimension == -1);
    CHECK_OK(cadt_batch_dimension(batches[i], 2, &dimension));
    CHECK(dimension == 1);
    CHECK_OK(cadt_batch_duplicates(batches[i], 3, &duplicates, &count));
    CHECK(count == 1 && duplicates[0].point == 4001 - 1002 && duplicates[0].representative == 4000 - 1002);
    statistics.size = sizeof statistics;
    CHECK_OK(cadt_batch_statistics(batches[i], &statistics));
    CHECK(statistics.sets == 4);
  }
  CHECK_OK(cadt_device_batch_arrays(device_batch, &device_begins, &device_triangles, &device_neighbors));
  CHECK(((const uint32_t*)device_begins)[4] == total);
  CHECK(memcmp(device_triangles, expected, 3 * total * sizeof *expected) == 0 && device_neighbors != NULL);
  CHECK_OK(cadt_device_batch_triangle_offsets(device_batch, &begins, &sets));
  CHECK(sets == 4 && begins[4] == total);

  CHECK_OK(cadt_batch_triangulation(batches[0], 0, &set));
  {
    const cadt_points first = points_of(xy, 1000);
    CHECK_OK(cadt_triangulation_verify(set, &first, NULL, &report));
  }
  CHECK_OK(cadt_report_ok(report, &ok));
  CHECK(ok == 1);
  cadt_report_free(report);
  cadt_triangulation_free(set);
  set = NULL;
  CHECK_STATUS(CADT_INPUT_ERROR, cadt_batch_triangulation(batches[0], 4, &set));
  CHECK(set == NULL && last_error().index == 4);
  for (i = 0; i < 3; ++i) cadt_batch_free(batches[i]);
  batches[0] = NULL;
  CHECK_STATUS(CADT_INPUT_ERROR, cadt_triangulate_batch(&points, descending, 3, &options, &batches[0]));
  CHECK(batches[0] == NULL && last_error().index == 2);
  CHECK_STATUS(CADT_LIMIT_ERROR, cadt_triangulate_batch(&points, offsets, (size_t)-1, &options, &batches[0]));
  cadt_device_batch_free(device_batch);
  cadt_triangulator_free(triangulator);
  free(xy);
}
