/* SPDX-License-Identifier: Apache-2.0 */
/* The library in C99, for programs and languages that do not speak C++ (docs/c.md has a complete program).
 *
 * Functions return a status; results go through pointers, which are set on CADT_OK alone (but for *count, below). No
 * exception leaves a function. NULL for an argument that is needed is CADT_INVALID_ARGUMENT; "may be NULL" is said
 * where it holds. After a failure cadt_last_error tells this thread what happened. Indices are 0-based, triangles
 * counterclockwise, -1 is outside.
 *
 * Handles are made by the functions that take a pointer to one, and released by the ..._free function of their type,
 * which takes NULL as well. Arrays that a function points to belong to the handle and are valid until it is freed;
 * results outlive the triangulator that made them. A handle may be read by several threads at once, but a
 * cadt_triangulator, and results in its device's memory, are used by one thread at a time.
 *
 * Functions that fill an array of the caller's take its capacity in elements and set *count to the number that there
 * are, also where they fail later. With too little room they write nothing else and return CADT_BUFFER_TOO_SMALL; to
 * ask for the number alone, give NULL and 0. */
#ifndef CADT_CADT_H
#define CADT_CADT_H

#include <stddef.h>
#include <stdint.h>
#include <cadt/export.hpp> /* macros alone, as in the next one */
#include <cadt/version.hpp>

#ifdef __cplusplus
extern "C" {
#endif

/* Number of the binary interface: that of the shared library's name. It changes when a function or struct does; structs
 * that begin with their size may grow at their end without that. */
#define CADT_ABI_VERSION 0
CADT_API int32_t cadt_abi_version(void);
/* "0.2.0": that of the library, which may be newer than this header's CADT_VERSION. */
CADT_API const char* cadt_version(void);

/* ---- errors ---- */

typedef int32_t cadt_status;
enum {
  CADT_OK = 0,
  CADT_INVALID_ARGUMENT = 1,    /* NULL, a number that no constant has, a struct without its size */
  CADT_INPUT_ERROR = 2,         /* NaN or infinity, sizes that do not fit together: index */
  CADT_LIMIT_ERROR = 3,         /* more points than 32-bit indices allow: needed, available */
  CADT_OPTION_ERROR = 4,        /* an option that is out of range, or excluded by another: name */
  CADT_BACKEND_UNAVAILABLE = 5, /* name, detail: why */
  CADT_OUT_OF_MEMORY = 6,       /* needed and available bytes; 0 if unknown */
  CADT_DEVICE_ERROR = 7,        /* name of the call, code of its runtime, detail: the device */
  CADT_KERNEL_BUILD_ERROR = 8,  /* name of the device, detail: the compiler's output */
  CADT_CANCELLED = 9,           /* cadt_options.cancelled said so */
  CADT_INVALID_MESH = 10,       /* cadt_triangulation_adopt: name of the check, index of what failed */
  CADT_INTERNAL_ERROR = 11,     /* an error of the library: please report it */
  CADT_BUFFER_TOO_SMALL = 12,   /* needed, available: elements */
  CADT_ERROR = 13,              /* any other */
  CADT_SEGMENTS_CROSS = 14,     /* index: a segment that crosses another; needed: the number of pairs.
                                 * CADT_CROSSING_EXACT and CADT_CROSSING_GRID take them */
  CADT_OPEN_BOUNDARY = 15,      /* segments bound no domain; index: a point at which they do not close */
  CADT_NOT_DELAUNAY = 16        /* a question that only a Delaunay mesh answers; index: an edge that is not */
};
/* "CADT_OK", "CADT_INPUT_ERROR", ...; "unknown status" for other numbers. */
CADT_API const char* cadt_status_name(cadt_status status);

typedef struct cadt_error {
  size_t size; /* sizeof(cadt_error), set by the caller */
  cadt_status status;
  int32_t code;        /* of the device's runtime */
  const char* message; /* what went wrong, and what to do */
  const char* name;    /* an option, back end, call, check or argument; "" if none */
  const char* detail;  /* "" if none */
  int64_t index;       /* of a point, segment, triangle or edge (3 * triangle + k); -1 if none */
  uint64_t needed;     /* bytes, points, elements or pairs, by the status */
  uint64_t available;
} cadt_error;
/* The last failure in this thread; status CADT_OK if there was none. Its strings are valid until its next one. */
CADT_API cadt_status cadt_last_error(cadt_error* error);
/* Its message; "" if there was none. Never NULL. */
CADT_API const char* cadt_last_error_message(void);

/* ---- options ---- */

enum { CADT_BACKEND_AUTO = 0, CADT_BACKEND_HOST = 1, CADT_BACKEND_OPENCL = 2, CADT_BACKEND_CUDA = 3 };
enum { CADT_ORDER_CANONICAL = 0, CADT_ORDER_FAST = 1 };
/* Where crossings of segments have added or moved points (constrained.h), a view becomes a copy of all of them. */
enum { CADT_KEEP_NO_POINTS = 0, CADT_KEEP_COPY = 1, CADT_KEEP_VIEW = 2 };
enum { CADT_STATISTICS_NONE = 0, CADT_STATISTICS_COUNTERS = 1, CADT_STATISTICS_TIMING = 2 };
enum { CADT_STRATEGY_AUTO = 0, CADT_STRATEGY_LOCKS = 1, CADT_STRATEGY_STARS = 2 };

/* As cadt::Options (options.hpp), where each member is explained. The callbacks are called on the thread of the call
 * that computes, and must return: no exception, no longjmp. The options are copied; `user` must outlive what uses them.
 */
typedef struct cadt_options {
  size_t size;              /* set by cadt_options_init */
  int32_t backend;          /* CADT_BACKEND_... */
  int32_t order;            /* CADT_ORDER_... */
  const char* device;       /* number or part of the name; may be NULL */
  uint64_t max_memory;      /* bytes; 0: no limit. Options::max_memory says which calls ask step by step */
  uint32_t threads;         /* 0: one for each core */
  int32_t keep_points;      /* CADT_KEEP_... */
  int32_t statistics;       /* CADT_STATISTICS_... */
  int32_t has_queue;        /* whether `queue` is one: CUDA's default stream is NULL */
  void* queue;              /* cudaStream_t or cl_command_queue */
  int32_t strategy;         /* CADT_STRATEGY_... */
  uint32_t work_group_size; /* 0: the library chooses */
  void* user;               /* passed to all callbacks */
  void (*progress)(const char* phase, double fraction, void* user); /* may be NULL */
  int32_t (*cancelled)(void* user); /* asked between launches; anything but 0: CADT_CANCELLED. May be NULL */
  /* Device memory from the caller (cadt::DeviceAllocator): both or neither. */
  void* (*allocate)(size_t bytes, void* queue, void* user);
  void (*deallocate)(void* memory, size_t bytes, void* queue, void* user);
} cadt_options;
/* Sets `size`, and the defaults: `cadt_options_init(&options, sizeof options)`. A program that was compiled with an
 * older, shorter struct has the defaults for the rest. */
CADT_API cadt_status cadt_options_init(cadt_options* options, size_t size);

/* ---- points ---- */

enum { CADT_FLOAT64 = 0, CADT_FLOAT32 = 1 };

/* Points of the host. x0 y0 x1 y1 ... in `x` if `y` is NULL. The stride is the number of bytes from one point to the
 * next; 0: there is nothing between. Coordinates must stay until the call returns, and with CADT_KEEP_VIEW as long as
 * the mesh. */
typedef struct cadt_points {
  const void* x;
  const void* y;
  size_t count;
  size_t stride;
  int32_t scalar; /* CADT_FLOAT... */
} cadt_points;

/* Points of the device (cadt::DevicePoints): a device pointer, a cl_mem, or a pointer of the host. */
typedef struct cadt_device_points {
  const void* x;
  const void* y;
  size_t count;
  size_t skip;    /* points before the first */
  int32_t scalar; /* CADT_FLOAT... */
} cadt_device_points;

/* ---- meshes of the host (triangulation.hpp) ---- */

typedef struct cadt_triangulation cadt_triangulation;
typedef struct cadt_duplicate {
  int32_t point;
  int32_t representative;
} cadt_duplicate;
typedef struct cadt_statistics {
  size_t size; /* sizeof(cadt_statistics), set by the caller */
  const char* backend;
  const char* device;
  uint64_t threads, points, distinct, launches, lock_attempts, lock_failures, flips, exact_orientations,
      exact_incircles, ties;
  uint64_t proven_stars, wrapped_stars, sets, batched_sets, bytes_device_peak;
  double milliseconds; /* of all phases (statistics.hpp); 0 with CADT_STATISTICS_NONE */
  int32_t certified;
  uint64_t bytes_to_device, bytes_from_device;
  uint64_t inserted_segments, segment_retries; /* constrained.h */
} cadt_statistics;

/* Opens the device, triangulates, and closes it. `options` may be NULL: the defaults. */
CADT_API cadt_status cadt_triangulate(const cadt_points* points, const cadt_options* options,
                                      cadt_triangulation** mesh);
/* The mesh of another program (cadt::Triangulation::adopt). `neighbors` may be NULL: they are derived. `trusted`: its
 * geometry is believed, if not 0. */
CADT_API cadt_status cadt_triangulation_adopt(const cadt_points* points, const int32_t* triangles,
                                              const int32_t* neighbors, size_t triangle_count, int32_t trusted,
                                              int32_t keep_points, cadt_triangulation** mesh);
/* Another handle of the same mesh: O(1). */
CADT_API cadt_status cadt_triangulation_copy(const cadt_triangulation* mesh, cadt_triangulation** copy);
CADT_API void cadt_triangulation_free(cadt_triangulation* mesh);

CADT_API cadt_status cadt_triangulation_size(const cadt_triangulation* mesh, size_t* points, size_t* triangles);
/* -1 no points, 0 one distinct point, 1 collinear points, 2 otherwise. */
CADT_API cadt_status cadt_triangulation_dimension(const cadt_triangulation* mesh, int32_t* dimension);
/* 3 * triangles indices each: vertices, and the triangle opposite each vertex. */
CADT_API cadt_status cadt_triangulation_triangles(const cadt_triangulation* mesh, const int32_t** triangles);
CADT_API cadt_status cadt_triangulation_neighbors(const cadt_triangulation* mesh, const int32_t** neighbors);
CADT_API cadt_status cadt_triangulation_hull(const cadt_triangulation* mesh, const int32_t** hull, size_t* count);
CADT_API cadt_status cadt_triangulation_duplicates(const cadt_triangulation* mesh, const cadt_duplicate** list,
                                                   size_t* count);
/* The points that were kept; `count` is 0 if none were. */
CADT_API cadt_status cadt_triangulation_points(const cadt_triangulation* mesh, cadt_points* points);
CADT_API cadt_status cadt_triangulation_hash(const cadt_triangulation* mesh, uint64_t* high, uint64_t* low);
CADT_API cadt_status cadt_triangulation_statistics(const cadt_triangulation* mesh, cadt_statistics* statistics);

/* Filled arrays (topology.hpp). The lowest triangle of each point; -1 if it has none: as many as points. */
CADT_API cadt_status cadt_triangulation_vertex_triangle(const cadt_triangulation* mesh, int32_t* triangles,
                                                        size_t capacity, size_t* count);
/* Pairs of points, ascending: *count is the number of words, two an edge. */
CADT_API cadt_status cadt_triangulation_edges(const cadt_triangulation* mesh, int32_t* edges, size_t capacity,
                                              size_t* count);
/* The half-edge in the opposite direction of each, or -1: 3 * triangles. */
CADT_API cadt_status cadt_triangulation_half_edges(const cadt_triangulation* mesh, int64_t* half_edges, size_t capacity,
                                                   size_t* count);
/* Compressed rows, counterclockwise. `indptr` has points + 1 elements, without which nothing is written; it is NULL
 * where only the count is asked for. */
CADT_API cadt_status cadt_triangulation_vertex_neighbors(const cadt_triangulation* mesh, size_t* indptr,
                                                         int32_t* neighbors, size_t capacity, size_t* count);
CADT_API cadt_status cadt_triangulation_incident_triangles(const cadt_triangulation* mesh, size_t* indptr,
                                                           int32_t* triangles, size_t capacity, size_t* count);

/* ---- verification (verify.hpp) ---- */

typedef struct cadt_report cadt_report;
typedef struct cadt_mesh_view {
  size_t size; /* sizeof(cadt_mesh_view), set by the caller; the rest may be zero but for the triangles */
  const int32_t* triangles;
  size_t triangle_count;
  const int32_t* neighbors; /* as many as vertices of triangles, or NULL */
  const int32_t* hull;      /* or NULL */
  size_t hull_count;
  const cadt_duplicate* duplicates; /* compared if has_duplicates is not 0 */
  size_t duplicate_count;
  int32_t has_duplicates;
  uint32_t threads;           /* 0: all cores */
  int32_t any_ties;           /* not 0: cocircular points may be triangulated in any way */
  const uint32_t* edge_flags; /* one a triangle, bit k: edge k is constrained; or NULL */
} cadt_mesh_view;
typedef struct cadt_check {
  size_t size; /* sizeof(cadt_check), set by the caller */
  const char* name;
  const char* what; /* what failed; "" if passed */
  int32_t passed;
  uint64_t failures;
  int64_t first; /* first failing triangle, point or edge; -1 */
} cadt_check;
/* A wrong mesh is a report, not a failure of the call. `options` says where: NULL for the verifier of the host. */
CADT_API cadt_status cadt_verify(const cadt_points* points, const cadt_mesh_view* mesh, const cadt_options* options,
                                 cadt_report** report);
CADT_API cadt_status cadt_triangulation_verify(const cadt_triangulation* mesh, const cadt_points* points,
                                               const cadt_options* options, cadt_report** report);
CADT_API cadt_status cadt_report_ok(const cadt_report* report, int32_t* ok);
CADT_API cadt_status cadt_report_summary(const cadt_report* report, const char** summary);
CADT_API cadt_status cadt_report_size(const cadt_report* report, size_t* checks);
CADT_API cadt_status cadt_report_check(const cadt_report* report, size_t index, cadt_check* check);
CADT_API void cadt_report_free(cadt_report* report);

/* ---- an open device (triangulator.hpp) ---- */

typedef struct cadt_triangulator cadt_triangulator;
typedef struct cadt_device_triangulation cadt_device_triangulation;

/* Opens the device that the options name; NULL: the defaults. It stays open, with its memory, until it is freed. */
CADT_API cadt_status cadt_triangulator_open(const cadt_options* options, cadt_triangulator** triangulator);
CADT_API void cadt_triangulator_free(cadt_triangulator* triangulator);
/* For the calls from now on; what is read when a device is opened (device, threads, queue, ...) stays as it is. */
CADT_API cadt_status cadt_triangulator_set_options(cadt_triangulator* triangulator, const cadt_options* options);
CADT_API cadt_status cadt_triangulator_triangulate(cadt_triangulator* triangulator, const cadt_points* points,
                                                   cadt_triangulation** mesh);
CADT_API cadt_status cadt_triangulator_memory_needed(const cadt_triangulator* triangulator, size_t points,
                                                     size_t* bytes);
CADT_API cadt_status cadt_triangulator_reserve(cadt_triangulator* triangulator, size_t points);
CADT_API cadt_status cadt_triangulator_release_memory(cadt_triangulator* triangulator);

/* From device memory to device memory. */
CADT_API cadt_status cadt_triangulator_triangulate_device(cadt_triangulator* triangulator,
                                                          const cadt_device_points* points,
                                                          cadt_device_triangulation** mesh);
CADT_API cadt_status cadt_triangulator_verify(cadt_triangulator* triangulator, const cadt_device_points* points,
                                              const cadt_device_triangulation* mesh, cadt_report** report);
CADT_API cadt_status cadt_device_triangulation_size(const cadt_device_triangulation* mesh, size_t* points,
                                                    size_t* triangles, size_t* duplicates);
CADT_API cadt_status cadt_device_triangulation_dimension(const cadt_device_triangulation* mesh, int32_t* dimension);
/* Handles of device memory: int32 words, 3 * triangles each; NULL if there are none. */
CADT_API cadt_status cadt_device_triangulation_triangles(const cadt_device_triangulation* mesh, void** triangles);
CADT_API cadt_status cadt_device_triangulation_neighbors(const cadt_device_triangulation* mesh, void** neighbors);
/* Points that equal an earlier one, ascending, and what each equals. */
CADT_API cadt_status cadt_device_triangulation_duplicates(const cadt_device_triangulation* mesh, void** points,
                                                          void** representatives);
CADT_API cadt_status cadt_device_triangulation_statistics(const cadt_device_triangulation* mesh,
                                                          cadt_statistics* statistics);
CADT_API cadt_status cadt_device_triangulation_download(const cadt_device_triangulation* mesh,
                                                        cadt_triangulation** copy);
CADT_API void cadt_device_triangulation_free(cadt_device_triangulation* mesh);

/* ---- many sets (batch.hpp): set s has the points offsets[s] to offsets[s + 1] - 1; `offsets` has sets + 1 elements
 * ---- */

typedef struct cadt_batch cadt_batch;
typedef struct cadt_device_batch cadt_device_batch;

CADT_API cadt_status cadt_triangulate_batch(const cadt_points* points, const size_t* offsets, size_t sets,
                                            const cadt_options* options, cadt_batch** batch);
CADT_API cadt_status cadt_triangulator_triangulate_batch(cadt_triangulator* triangulator, const cadt_points* points,
                                                         const size_t* offsets, size_t sets, cadt_batch** batch);
/* sets + 1 numbers: the first triangle of each set, and the number of all. */
CADT_API cadt_status cadt_batch_triangle_offsets(const cadt_batch* batch, const size_t** offsets, size_t* sets);
/* Of all sets, one after another; the numbers are those of each set's own points and triangles. */
CADT_API cadt_status cadt_batch_triangles(const cadt_batch* batch, const int32_t** triangles);
CADT_API cadt_status cadt_batch_neighbors(const cadt_batch* batch, const int32_t** neighbors);
CADT_API cadt_status cadt_batch_dimension(const cadt_batch* batch, size_t set, int32_t* dimension);
CADT_API cadt_status cadt_batch_duplicates(const cadt_batch* batch, size_t set, const cadt_duplicate** list,
                                           size_t* count);
CADT_API cadt_status cadt_batch_statistics(const cadt_batch* batch, cadt_statistics* statistics);
/* One set's mesh, as a copy. */
CADT_API cadt_status cadt_batch_triangulation(const cadt_batch* batch, size_t set, cadt_triangulation** mesh);
CADT_API void cadt_batch_free(cadt_batch* batch);

CADT_API cadt_status cadt_triangulator_triangulate_device_batch(cadt_triangulator* triangulator,
                                                                const cadt_device_points* points, const size_t* offsets,
                                                                size_t sets, cadt_device_batch** batch);
/* On the host, as cadt_batch_triangle_offsets. */
CADT_API cadt_status cadt_device_batch_triangle_offsets(const cadt_device_batch* batch, const size_t** offsets,
                                                        size_t* sets);
/* Handles of device memory; the offsets there are 32-bit words. */
CADT_API cadt_status cadt_device_batch_arrays(const cadt_device_batch* batch, void** triangle_offsets, void** triangles,
                                              void** neighbors);
CADT_API cadt_status cadt_device_batch_download(const cadt_device_batch* batch, cadt_batch** copy);
CADT_API void cadt_device_batch_free(cadt_device_batch* batch);

/* ---- devices (devices.hpp) ---- */

typedef struct cadt_device_list cadt_device_list;
typedef struct cadt_device_info {
  size_t size;     /* sizeof(cadt_device_info), set by the caller */
  int32_t backend; /* CADT_BACKEND_... */
  int32_t index;   /* number within its back end; -1: the back end itself, which is not there, see `reason` */
  const char* platform;
  const char* name;
  const char* driver;
  const char* reason; /* why it is not usable; "" if it is */
  const char* atomics;
  uint64_t memory_bytes, largest_buffer_bytes;
  uint32_t compute_units;
  int32_t usable, fp64, gpu, watchdog; /* 0 or 1 */
} cadt_device_info;
CADT_API cadt_status cadt_list_devices(cadt_device_list** list);
CADT_API cadt_status cadt_device_list_size(const cadt_device_list* list, size_t* count);
/* Strings are valid until the list, or the triangulator, is freed. */
CADT_API cadt_status cadt_device_list_get(const cadt_device_list* list, size_t index, cadt_device_info* info);
CADT_API cadt_status cadt_triangulator_device(const cadt_triangulator* triangulator, cadt_device_info* info);
CADT_API void cadt_device_list_free(cadt_device_list* list);

#ifdef __cplusplus
}
#endif

#include <cadt/constrained.h>
#include <cadt/queries.h>

#endif
