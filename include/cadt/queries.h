/* SPDX-License-Identifier: Apache-2.0 */
/* The part of cadt.h that asks a mesh, and gives meshes in arrays of the caller's; docs/queries.md and queries.hpp
 * explain each function. The rules of cadt.h hold here. */
#include <cadt/cadt.h> /* before the guard: it includes this header */

#ifndef CADT_QUERIES_C_H
#define CADT_QUERIES_C_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct cadt_queries cadt_queries;
enum { CADT_LINEAR = 0, CADT_NEAREST = 1, CADT_NATURAL = 2 };
enum { CADT_OUTSIDE_NAN = 0, CADT_OUTSIDE_NEAREST = 1 };

/* Cell (column i, row j) has its centre at x0 + (i + 0.5) dx, y0 + (j + 0.5) dy, and is element j * columns + i. */
typedef struct cadt_grid {
  double x0, y0, dx, dy;
  size_t columns, rows;
} cadt_grid;
typedef struct cadt_box {
  double min_x, min_y, max_x, max_y;
} cadt_box;
typedef struct cadt_circle {
  double x, y, radius;
  int32_t triangle;
} cadt_circle;
/* Device memory of the caller's; `size` in elements. */
typedef struct cadt_device_array {
  void* memory;
  size_t size;
} cadt_device_array;

/* Prepares a mesh for queries on the device that the options name. `points` may be NULL if the mesh has kept them; else
 * they must live as long as the handle. */
CADT_API cadt_status cadt_queries_open(const cadt_points* points, const cadt_triangulation* mesh,
                                       const cadt_options* options, cadt_queries** queries);
/* The mesh of another program, with neighbours, and the flags of edges if it has segments; points and arrays must live
 * as long as the handle. */
CADT_API cadt_status cadt_queries_open_arrays(const cadt_points* points, const cadt_mesh_view* mesh,
                                              const cadt_options* options, cadt_queries** queries);
/* A mesh in the memory of the triangulator's device; all three must live as long as the handle. */
CADT_API cadt_status cadt_queries_open_device(cadt_triangulator* triangulator, const cadt_device_points* points,
                                              const cadt_device_triangulation* mesh, cadt_queries** queries);
CADT_API void cadt_queries_free(cadt_queries* queries);

/* The lowest triangle that contains each point; -1 outside. */
CADT_API cadt_status cadt_queries_locate(cadt_queries* queries, const cadt_points* where, int32_t* triangles,
                                         size_t capacity, size_t* count);
/* Three barycentric coordinates a point besides; `capacity` is that of `triangles`. */
CADT_API cadt_status cadt_queries_locate_barycentric(cadt_queries* queries, const cadt_points* where,
                                                     int32_t* triangles, double* barycentric, size_t capacity,
                                                     size_t* count);
/* Rows of the k nearest vertices. */
CADT_API cadt_status cadt_queries_nearest_vertices(cadt_queries* queries, const cadt_points* where, size_t k,
                                                   int32_t* vertices, size_t capacity, size_t* count);
/* `value_count`: a multiple of the number of points; as many for each query. */
CADT_API cadt_status cadt_queries_interpolate(cadt_queries* queries, const double* values, size_t value_count,
                                              const cadt_points* where, int32_t method, int32_t outside,
                                              double* results, size_t capacity, size_t* count);
/* Values of the points to cells. `max_edge`: INFINITY for all triangles. */
CADT_API cadt_status cadt_queries_rasterize(cadt_queries* queries, const cadt_grid* grid, const double* values,
                                            size_t value_count, int32_t method, double max_edge, double* cells,
                                            size_t capacity, size_t* count);
/* x0 y0 x1 y1 ..., one a triangle. */
CADT_API cadt_status cadt_queries_circumcenters(cadt_queries* queries, double* xy, size_t capacity, size_t* count);
CADT_API cadt_status cadt_queries_largest_empty_circles(cadt_queries* queries, size_t k, cadt_circle* circles,
                                                        size_t capacity, size_t* count);

/* The Voronoi diagram (cadt::VoronoiDiagram). */
typedef struct cadt_voronoi cadt_voronoi;
CADT_API cadt_status cadt_queries_voronoi(cadt_queries* queries, cadt_voronoi** diagram);
/* 2 * vertices doubles. */
CADT_API cadt_status cadt_voronoi_vertices(const cadt_voronoi* diagram, const double** xy, size_t* vertices);
/* points + 1 numbers, and the vertices of each cell. */
CADT_API cadt_status cadt_voronoi_cells(const cadt_voronoi* diagram, const uint32_t** begin, size_t* points,
                                        const int32_t** cells);
/* 2 * edges words each. */
CADT_API cadt_status cadt_voronoi_edges(const cadt_voronoi* diagram, const int32_t** points, const int32_t** vertices,
                                        size_t* edges);
CADT_API void cadt_voronoi_free(cadt_voronoi* diagram);

/* Its cells within a box, as polygons: points begin[p] to begin[p + 1] - 1 of xy. */
typedef struct cadt_polygons cadt_polygons;
CADT_API cadt_status cadt_queries_voronoi_polygons(cadt_queries* queries, const cadt_box* box,
                                                   cadt_polygons** polygons);
CADT_API cadt_status cadt_polygons_get(const cadt_polygons* polygons, const uint32_t** begin, size_t* points,
                                       const double** xy);
CADT_API void cadt_polygons_free(cadt_polygons* polygons);

/* Triangles with a circumradius and edges that are not too large (alpha shape), ascending, and their boundary: two
 * points an edge. */
typedef struct cadt_outline cadt_outline;
CADT_API cadt_status cadt_queries_outline(cadt_queries* queries, double max_radius, double max_edge,
                                          cadt_outline** outline);
CADT_API cadt_status cadt_outline_triangles(const cadt_outline* outline, const int32_t** triangles, size_t* count);
CADT_API cadt_status cadt_outline_edges(const cadt_outline* outline, const int32_t** edges, size_t* count);
CADT_API void cadt_outline_free(cadt_outline* outline);

/* In device memory. An array that is too small is CADT_INPUT_ERROR, and nothing is written. */
CADT_API cadt_status cadt_queries_locate_device(cadt_queries* queries, const cadt_device_points* where,
                                                const cadt_device_array* triangles);
CADT_API cadt_status cadt_queries_nearest_vertices_device(cadt_queries* queries, const cadt_device_points* where,
                                                          size_t k, const cadt_device_array* vertices);
CADT_API cadt_status cadt_queries_interpolate_device(cadt_queries* queries, const cadt_device_array* values,
                                                     const cadt_device_points* where, int32_t method, int32_t outside,
                                                     const cadt_device_array* results);
CADT_API cadt_status cadt_queries_rasterize_device(cadt_queries* queries, const cadt_grid* grid,
                                                   const cadt_device_array* values, int32_t method, double max_edge,
                                                   const cadt_device_array* cells);
/* The mesh in arrays of the caller's, 3 words a triangle; at most 2 triangles a point. `neighbors` may be NULL. */
CADT_API cadt_status cadt_triangulator_triangulate_device_into(cadt_triangulator* triangulator,
                                                               const cadt_device_points* points,
                                                               const cadt_device_array* triangles,
                                                               const cadt_device_array* neighbors, size_t* count);
/* The same from host to host; capacities in words, NULL and 0 for an array that is left out. */
CADT_API cadt_status cadt_triangulator_triangulate_into(cadt_triangulator* triangulator, const cadt_points* points,
                                                        int32_t* triangles, size_t triangles_capacity,
                                                        int32_t* neighbors, size_t neighbors_capacity, size_t* count);

#ifdef __cplusplus
}
#endif

#endif
