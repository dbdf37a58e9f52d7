/* SPDX-License-Identifier: Apache-2.0 */
/* The C interface from C, through all functions of cadt.h. */
#include "check.h"

int failures = 0;

cadt_error last_error(void) {
  cadt_error error;
  memset(&error, 0, sizeof error);
  error.size = sizeof error;
  if (cadt_last_error(&error) != CADT_OK) {
    fprintf(stderr, "cadt_last_error failed\n");
    exit(1);
  }
  return error;
}

cadt_options on_host(void) {
  cadt_options options;
  CHECK_OK(cadt_options_init(&options, sizeof options));
  options.backend = CADT_BACKEND_HOST;
  options.threads = 1;
  return options;
}

cadt_points points_of(const double* xy, size_t count) {
  cadt_points points = {0};
  points.x = xy;
  points.count = count;
  return points;
}

int main(void) {
  CHECK(strcmp(cadt_version(), CADT_VERSION) == 0);
  CHECK(cadt_abi_version() == CADT_ABI_VERSION);
  test_errors(); /* first: nothing has failed before */
  test_null();
  test_points();
  test_mesh();
  test_topology();
  test_adopt_and_verify();
  test_triangulator();
  test_callbacks();
  test_batches();
  test_queries();
  test_constrained();
  test_polygons();
  if (failures == 0) printf("the C interface does what it says\n");
  return failures == 0 ? 0 : 1;
}
