/* SPDX-License-Identifier: Apache-2.0 */
/* The tests of the C interface: each file is C99, and counts what does not hold. */
#ifndef CADT_TESTS_CHECK_H
#define CADT_TESTS_CHECK_H

#include <cadt/cadt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern int failures;

#define CHECK(what)                                                                                          \
  do {                                                                                                       \
    if (!(what)) {                                                                                           \
      ++failures;                                                                                            \
      fprintf(stderr, "%s:%d: %s (last error: %s)\n", __FILE__, __LINE__, #what, cadt_last_error_message()); \
    }                                                                                                        \
  } while (0)
/* A call with this status, which the last error has as well. */
#define CHECK_STATUS(expected, call) CHECK((call) == (expected) && last_error().status == (expected))
#define CHECK_OK(call) CHECK((call) == CADT_OK)
/* What must not be NULL, with the argument's name. */
#define CHECK_NULL(call, argument)                   \
  do {                                               \
    CHECK_STATUS(CADT_INVALID_ARGUMENT, call);       \
    CHECK(strcmp(last_error().name, argument) == 0); \
  } while (0)

cadt_error last_error(void);
cadt_options on_host(void);
cadt_points points_of(const double* xy, size_t count);

void test_errors(void);
void test_null(void);
void test_points(void);
void test_mesh(void);
void test_topology(void);
void test_adopt_and_verify(void);
void test_triangulator(void);
void test_callbacks(void);
void test_batches(void);
void test_queries(void);
void test_constrained(void);
void test_polygons(void);

#endif
