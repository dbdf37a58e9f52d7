/* SPDX-License-Identifier: Apache-2.0 */
/* The part of cadt.h with segments that must be edges, and with polygons; constrained.hpp and polygons.hpp explain each
 * function. The rules of cadt.h hold here. */
#ifndef CADT_CONSTRAINED_C_H
#define CADT_CONSTRAINED_C_H

#include <cadt/cadt.h>
#include <cadt/queries.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { CADT_CROSSING_ERROR = 0, CADT_CROSSING_EXACT = 1, CADT_CROSSING_GRID = 2 };
enum {
  CADT_DOMAIN_HULL = 0,
  CADT_DOMAIN_OUTER = 1,
  CADT_DOMAIN_EVEN_ODD = 2,
  CADT_DOMAIN_NONZERO = 3,
  CADT_DOMAIN_LAYERS = 4,
  CADT_DOMAIN_SEEDS = 5
};
/* A place in a region, and what the region is called. */
typedef struct cadt_region {
  double x, y, attribute;
} cadt_region;
/* As cadt::ConstraintOptions; all zero but for the size: segments must not cross, and all triangles are inside. Its
 * arrays are read during the call alone. */
typedef struct cadt_constraint_options {
  size_t size;         /* sizeof(cadt_constraint_options), set by the caller */
  int32_t crossing;    /* CADT_CROSSING_... */
  int32_t domain;      /* CADT_DOMAIN_... */
  double grid;         /* with CADT_CROSSING_GRID: the width of its cells, above 0 */
  const double* holes; /* with CADT_DOMAIN_SEEDS: x0 y0 x1 y1 ...; else none, as regions: CADT_OPTION_ERROR */
  size_t hole_count;
  const cadt_region* regions; /* with CADT_DOMAIN_SEEDS */
  size_t region_count;
} cadt_constraint_options;

typedef struct cadt_constrained cadt_constrained;

/* Triangulates points with segments between them: pairs of point indices, 2 * segment_count words. `constraints` and
 * `options` may be NULL: the defaults. CADT_SEGMENTS_CROSS (cadt_find_crossings lists all pairs),
 * CADT_OPEN_BOUNDARY, CADT_INPUT_ERROR with the index of a segment whose end is no point. */
CADT_API cadt_status cadt_triangulate_constrained(const cadt_points* points, const int32_t* segments,
                                                  size_t segment_count, const cadt_constraint_options* constraints,
                                                  const cadt_options* options, cadt_constrained** mesh);
/* The same by an open device. */
CADT_API cadt_status cadt_triangulator_triangulate_constrained(cadt_triangulator* triangulator,
                                                               const cadt_points* points, const int32_t* segments,
                                                               size_t segment_count,
                                                               const cadt_constraint_options* constraints,
                                                               cadt_constrained** mesh);
CADT_API void cadt_constrained_free(cadt_constrained* mesh);
/* From device memory to device memory; `segments`: two int32 words each. */
CADT_API cadt_status cadt_triangulator_triangulate_constrained_device(cadt_triangulator* triangulator,
                                                                      const cadt_device_points* points,
                                                                      const cadt_device_array* segments,
                                                                      const cadt_constraint_options* constraints,
                                                                      cadt_device_triangulation** mesh);
/* Handles of device memory: the flags of edges and the region of each triangle, and the vertices of the triangles
 * inside, 3 words each; NULL where there are none (DeviceTriangulation). */
CADT_API cadt_status cadt_device_triangulation_constraints(const cadt_device_triangulation* mesh, void** edge_flags,
                                                           void** regions, void** triangles_inside,
                                                           size_t* number_inside);
/* More of them: 1 or 0 for each triangle, whether it is inside, a word; of `count` regions the value of each, a word,
 * and the attribute, a double. */
CADT_API cadt_status cadt_device_triangulation_regions(const cadt_device_triangulation* mesh, void** inside,
                                                       void** values, void** attributes, size_t* count);
/* Handles of the vertices along segment s: words from that with the number in word s of the offsets to that before the
 * one in word s + 1; `length`: of the vertices. NULL without segments. */
CADT_API cadt_status cadt_device_triangulation_chains(const cadt_device_triangulation* mesh, void** offsets,
                                                      void** vertices, size_t* length);
/* Of segments that cross: how many crossings are vertices, behind the points that were given, and handles of the
 * coordinates of all of these, two doubles each, and of the pair of segments of each crossing, two words; NULL without
 * crossings, but with CADT_CROSSING_GRID the coordinates are there of any points (DeviceTriangulation). */
CADT_API cadt_status cadt_device_triangulation_crossings(const cadt_device_triangulation* mesh, void** all_points,
                                                         void** added_parents, size_t* count);
/* A copy on the host, with all of the segments. */
CADT_API cadt_status cadt_device_triangulation_download_constrained(const cadt_device_triangulation* mesh,
                                                                    cadt_constrained** copy);

/* Its triangles, neighbours, hull, duplicates, statistics, as a handle of its own: O(1). Its points are those of the
 * input and, behind them, the added ones. */
CADT_API cadt_status cadt_constrained_mesh(const cadt_constrained* mesh, cadt_triangulation** triangles);
/* One a triangle, bit k: edge k (opposite vertex k) is constrained. NULL without triangles. */
CADT_API cadt_status cadt_constrained_edge_flags(const cadt_constrained* mesh, const uint32_t** flags);
/* The vertices along segment s are vertices[offsets[s]] to vertices[offsets[s + 1] - 1]; none if its ends are equal
 * points. */
CADT_API cadt_status cadt_constrained_chains(const cadt_constrained* mesh, const int64_t** offsets, size_t* segments,
                                             const int32_t** vertices);
/* The constrained edges, the lower vertex first, ascending: 2 * count words. Edge e is part of the segments
 * sources[offsets[e]] to sources[offsets[e + 1] - 1]: i for segment i in its direction, -1 - i against it. */
CADT_API cadt_status cadt_constrained_edges(const cadt_constrained* mesh, const int32_t** edges, size_t* count);
CADT_API cadt_status cadt_constrained_sources(const cadt_constrained* mesh, const int64_t** offsets,
                                              const int32_t** sources);
CADT_API cadt_status cadt_constrained_degenerate_segments(const cadt_constrained* mesh, const int32_t** segments,
                                                          size_t* count);
/* One a triangle, 1 or 0, and how many are 1. */
CADT_API cadt_status cadt_constrained_inside(const cadt_constrained* mesh, const uint8_t** inside, size_t* count);
/* The vertices of the triangles inside: 3 words each; *count is the number of words. */
CADT_API cadt_status cadt_constrained_triangles_inside(const cadt_constrained* mesh, int32_t* triangles,
                                                       size_t capacity, size_t* count);
/* The region of each triangle, and a value and an attribute for each of `count` regions. */
CADT_API cadt_status cadt_constrained_regions(const cadt_constrained* mesh, const int32_t** region,
                                              const int32_t** values, const double** attributes, size_t* count);
/* Vertices made for crossings: x0 y0 x1 y1 ..., rounded, and two words each: the lowest pair of segments that cross
 * there. */
CADT_API cadt_status cadt_constrained_added_points(const cadt_constrained* mesh, const double** xy,
                                                   const int32_t** parents, size_t* count);
/* Whether triangles are still counterclockwise with rounded coordinates. */
CADT_API cadt_status cadt_constrained_rounded_valid(const cadt_constrained* mesh, int32_t* valid);
/* With CADT_CROSSING_GRID: where each input point has moved; else `count` is 0. */
CADT_API cadt_status cadt_constrained_moved_points(const cadt_constrained* mesh, const double** xy, size_t* count);
/* The vertices that were added are numbered in the order of segments, which shows in the hash. */
CADT_API cadt_status cadt_constrained_hash(const cadt_constrained* mesh, uint64_t* high, uint64_t* low);
/* By the verifier of the host, for the same points, segments and constraints. */
CADT_API cadt_status cadt_constrained_verify(const cadt_constrained* mesh, const cadt_points* points,
                                             const int32_t* segments, size_t segment_count,
                                             const cadt_constraint_options* constraints, cadt_report** report);

/* `columns` values of each input point, and behind them those at the vertices made for crossings: linear along the
 * first of their two segments. `values`: value_count numbers, `columns` for each point. `result`: as many for each
 * point and each crossing; *count is their number, for which no values need be given. CADT_INPUT_ERROR if there are not
 * `columns` values for each of the points. */
CADT_API cadt_status cadt_constrained_values_at_crossings(const cadt_constrained* mesh, const cadt_points* points,
                                                          const double* values, size_t value_count, size_t columns,
                                                          double* result, size_t capacity, size_t* count);

/* Pairs of segments that cross, for cadt_crossings_free. */
typedef struct cadt_crossings cadt_crossings;

/* Finds all of them, on the host. Of `options`, which may be NULL, `threads`, `cancelled` and `progress` count.
 * CADT_LIMIT_ERROR if points and crossings are more than 32-bit indices allow. */
CADT_API cadt_status cadt_find_crossings(const cadt_points* points, const int32_t* segments, size_t segment_count,
                                         const cadt_options* options, cadt_crossings** crossings);
CADT_API void cadt_crossings_free(cadt_crossings* crossings);
/* Two words each, the lower index first; ascending. They live as long as the handle. */
CADT_API cadt_status cadt_crossings_pairs(const cadt_crossings* crossings, const int32_t** pairs, size_t* count);

/* Prepares a constrained mesh for queries; `points`: those that it was made of, which must live as long as the handle.
 * Values are given for the added points as well. Nearest vertices and what else takes a Delaunay mesh is
 * CADT_NOT_DELAUNAY if a constrained edge, or one beside a rounded crossing, is not. */
CADT_API cadt_status cadt_queries_open_constrained(const cadt_points* points, const cadt_constrained* mesh,
                                                   const cadt_options* options, cadt_queries** queries);

/* ---- many polygons (polygons.hpp) ---- */

enum {
  CADT_POLYGON_OK = 0,
  CADT_POLYGON_TOO_FEW_POINTS = 1,
  CADT_POLYGON_NOT_FINITE = 2,
  CADT_POLYGON_SELF_CROSSING = 3,
  CADT_POLYGON_RING_CROSSING = 4,
  CADT_POLYGON_ZERO_AREA = 5
};
/* A polygon without triangles, and the ring points where the reason is, or -1 (cadt::PolygonProblem). */
typedef struct cadt_polygon_problem {
  size_t polygon;
  int32_t status; /* CADT_POLYGON_... */
  int32_t first, second;
} cadt_polygon_problem;

typedef struct cadt_polygon_triangles cadt_polygon_triangles;

/* Ring r has the points ring_offsets[r] to ring_offsets[r + 1] - 1, polygon p the rings polygon_offsets[p] to
 * polygon_offsets[p + 1] - 1; there are rings + 1 and polygons + 1 offsets. Invalid polygons are no failure of the
 * call. `options` may be NULL. */
CADT_API cadt_status cadt_triangulate_polygons(const cadt_points* ring_points, const int64_t* ring_offsets,
                                               size_t rings, const int64_t* polygon_offsets, size_t polygons,
                                               const cadt_options* options, cadt_polygon_triangles** triangles);
CADT_API void cadt_polygon_triangles_free(cadt_polygon_triangles* triangles);
/* The triangles of polygon p, three words each, begin with number offsets[p] and end before offsets[p + 1]. */
CADT_API cadt_status cadt_polygon_triangles_get(const cadt_polygon_triangles* triangles, const int64_t** offsets,
                                                size_t* polygons, const int32_t** vertices);
/* Polygons without triangles, ascending. */
CADT_API cadt_status cadt_polygon_triangles_problems(const cadt_polygon_triangles* triangles,
                                                     const cadt_polygon_problem** list, size_t* count);
/* "ok", "self-crossing", ...; "unknown status" for other numbers. */
CADT_API const char* cadt_polygon_status_name(int32_t status);

#ifdef __cplusplus
}
#endif

#endif
