// SPDX-License-Identifier: Apache-2.0
// What a mesh can be asked: where points lie, their nearest vertices, values between the points, rasters, the Voronoi
// diagram, holes and outlines. On the host or on a device, in batches.
#pragma once

#include <cadt/constrained.hpp>
#include <cadt/devices.hpp>
#include <cadt/errors.hpp>
#include <cadt/export.hpp>
#include <cadt/points.hpp>
#include <cadt/triangulation.hpp>
#include <cadt/triangulator.hpp>
#include <cadt/verify.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace cadt {

/// Most results of one call: neighbours, values and cells of all its queries, which have 32-bit indices.
[[nodiscard]] constexpr std::size_t max_results() noexcept { return (std::size_t{1} << 31) - 1; }

/// How values at the points become values between them.
enum class Interpolation {
  linear,   ///< in the triangle that contains the query: continuous, cheapest
  nearest,  ///< the value of the nearest vertex
  natural   ///< natural neighbours (Sibson, 1981): smooth except at the points; reproduces linear functions
};
/// "linear", "nearest", "natural".
[[nodiscard]] CADT_API std::string_view to_string(Interpolation method) noexcept;

/// What a query outside of the convex hull gets.
enum class Outside {
  nan,     ///< NaN
  nearest  ///< the value of the nearest vertex
};

/// A grid of columns x rows cells. Cell (column i, row j) has its centre at x0 + (i + 0.5) dx, y0 + (j + 0.5) dy, and
/// is element j * columns + i of a raster. For images and GIS formats, whose first row is the top one, y0 is the top
/// edge and dy is negative. A part of a larger grid has the corner and the cell size of that one and says which of its
/// cells come first: centres are then the same doubles, whatever the parts are.
struct Grid {
  double x0 = 0, y0 = 0;  ///< a corner of the grid
  double dx = 1, dy = 1;  ///< width and height of a cell; not 0
  std::size_t columns = 0, rows = 0;
  std::size_t first_column = 0, first_row = 0;  ///< centres are at x0 + (first_column + i + 0.5) dx, and so on
  [[nodiscard]] std::size_t cells() const noexcept { return columns * rows; }
};

/// A rectangle.
struct Box {
  double min_x = 0, min_y = 0, max_x = 0, max_y = 0;
};

/// Triangles and barycentric coordinates of queries.
struct Located {
  std::vector<std::int32_t> triangles;  ///< as MeshQueries::locate
  std::vector<double> barycentric;      ///< n x 3, of the triangle's vertices in order; not negative; NaN outside
};

/// The Voronoi diagram of the vertices. Its vertices are the circumcentres of the triangles, in the order of the
/// triangles.
struct VoronoiDiagram {
  std::vector<double> vertices;  ///< n x 2: x0 y0 x1 y1 ..., one a triangle; infinite if a triangle is too thin
  /// Cell of point p: the Voronoi vertices cells[cell_begin[p]] to cells[cell_begin[p + 1] - 1], counterclockwise. The
  /// cell of a hull vertex is unbounded: between its last and its first vertex it reaches to infinity. A duplicate has
  /// none.
  std::vector<std::uint32_t> cell_begin;
  std::vector<std::int32_t> cells;
  /// Edges, two words each: the points on both sides (generators), and the two Voronoi vertices; -1: it is a ray, from
  /// the first vertex to the outside, at a right angle to the hull edge, on the right of the line from the first
  /// generator to the second.
  std::vector<std::int32_t> edge_points, edge_vertices;
};

/// Voronoi cells within a box, as polygons.
struct VoronoiPolygons {
  /// Polygon of point p: points begin[p] to begin[p + 1] - 1 of xy, counterclockwise. None for a duplicate, or if the
  /// cell does not meet the box.
  std::vector<std::uint32_t> begin;
  std::vector<double> xy;
};

struct Circle {
  double x = 0, y = 0, radius = 0;
  std::int32_t triangle = -1;  ///< whose circumcircle it is
};

/// Triangles that a bound on size keeps, and their boundary.
struct Outline {
  std::vector<std::int32_t> triangles;  ///< ascending
  std::vector<std::int32_t> edges;      ///< n x 2 points; the kept triangles are on the left
};

/// Where a Voronoi diagram goes (VoronoiDiagram); `cell_begin` is needed for `cells`.
struct DeviceVoronoi {
  DeviceArray vertices, cell_begin, cells, edge_points, edge_vertices;
};

/// A question that only a Delaunay mesh answers right, and a mesh of which an edge (a constrained one, or one beside a
/// rounded crossing) is none of the Delaunay triangulation: ask that of the same vertices, triangulate(), instead.
class CADT_API NotDelaunay : public Error {
 public:
  NotDelaunay(const std::string& message, std::int64_t edge) : Error(message), edge_(edge) {}
  /// The first such edge: 3 * triangle + k, opposite vertex k.
  [[nodiscard]] std::int64_t edge() const noexcept { return edge_; }

 private:
  std::int64_t edge_;
};

/// A mesh prepared for queries on a device: the vertices are sorted along Hilbert's curve, so a query starts near.
/// Which triangle, vertex or cell an answer is about is exact: the same from every device, however many are asked at a
/// time. Values and places are doubles and rounded. Points on an edge or vertex belong to the lowest of its triangles.
///
/// The first queries sort the vertices: O(n log n) for n points, about a tenth of the triangulation, and 12 bytes of
/// device memory a point beside points and mesh. Linear rasters and Voronoi diagrams need 4 of them and no sort. Not
/// thread-safe: one thread at a time may use an object; different ones are independent.
/// Devices without double precision are refused (BackendUnavailable).
///
///     cadt::Triangulation mesh = cadt::triangulate(xy);
///     cadt::MeshQueries queries(xy, mesh);
///     std::vector<std::int32_t> triangles = queries.locate(where);
///     std::vector<double> heights = queries.interpolate(z, where);
///
/// Constrained meshes answer where queries lie, linear interpolation and rasters (breaklines), circumcentres and
/// outlines. Nearest vertices (Outside::nearest is such a question), natural neighbours, Voronoi diagrams and empty
/// circles are right as long as all edges, constrained or beside rounded crossings, happen to be Delaunay, which the
/// first such question examines in O(triangles); else it is refused: NotDelaunay. All triangles of the hull are asked,
/// whatever the domain is.
class CADT_API MeshQueries {
 public:
  /// A mesh of the host, and its points, which are not copied where the device can read them: they must live as long as
  /// this object, and must not change. `options` says where: backend, device, threads, queue, allocator, max_memory,
  /// stop and progress are as for triangulate(); memory is asked for step by step. \throws InputError if the mesh has
  /// another number of points, and as triangulate()
  MeshQueries(PointsView points, const Triangulation& mesh, const Options& options = {});
  /// The same with the points that the mesh has kept (Options::keep_points). \throws InputError if it has kept none
  explicit MeshQueries(const Triangulation& mesh, const Options& options = {});
  /// A constrained mesh of the host, and the points that it was made of. Those that it has added stand behind them, so
  /// values are given for number_of_points() of them all; those that it has moved are where it has moved them. \throws
  /// InvalidMesh if triangles are not counterclockwise with rounded coordinates
  /// (ConstrainedTriangulation::rounded_valid), with the first one, and as the others
  MeshQueries(PointsView points, const ConstrainedTriangulation& mesh, const Options& options = {});
  /// The mesh of another program, with neighbours; its arrays are checked. Like the points, they must outlive this
  /// object. Nearest vertices, natural neighbours and the Voronoi diagram take a Delaunay mesh, the rest any
  /// triangulation of the convex hull. \throws InputError if an index is out of range, or an edge is not the same from
  /// both sides, with the first such triangle as index
  MeshQueries(PointsView points, const MeshView& mesh, const Options& options = {});
  /// A mesh on the device of `triangulator`, which it shares. Both must live as long as this object. The points of a
  /// mesh with crossings are DeviceTriangulation::all_points(). \throws InputError for a mesh of another triangulator
  /// or of other points, InvalidMesh as for a constrained mesh of the host
  MeshQueries(Triangulator& triangulator, const DevicePoints& points, const DeviceTriangulation& mesh);
  ~MeshQueries();
  MeshQueries(MeshQueries&&) noexcept;
  MeshQueries& operator=(MeshQueries&&) noexcept;

  /// With those that a constrained mesh has added.
  [[nodiscard]] std::size_t number_of_points() const noexcept;
  [[nodiscard]] std::size_t number_of_triangles() const noexcept;
  [[nodiscard]] const DeviceInfo& device() const noexcept;
  /// `stop` and `progress` may be changed between calls; the rest was read when this was opened.
  [[nodiscard]] Options& options() noexcept;

  /// The triangle that contains each query (hull and edges included), the lowest if there are several; -1 outside.
  /// O(log n) each, and a walk of a few triangles, which is long between two far rows of points, through their fan of
  /// triangles. \throws InputError for a query that is NaN or infinite, with its index
  [[nodiscard]] std::vector<std::int32_t> locate(PointsView queries);
  [[nodiscard]] Located locate_barycentric(PointsView queries);
  /// Whether each query lies in the convex hull, its boundary included: 1 or 0.
  [[nodiscard]] std::vector<std::uint8_t> within_hull(PointsView queries);

  /// The nearest vertex of each query; of equally near ones the lowest. -1 without triangles. \throws as locate
  [[nodiscard]] std::vector<std::int32_t> nearest_vertex(PointsView queries);
  /// The k nearest vertices of each query: n x k, nearest first, equally near ones by index (but of those at the very
  /// smallest distance only the first is certain to be the lowest, and the others may be any of them); -1 where there
  /// are no more. Along the mesh: O(k^2) each. \throws OptionError for k = 0, LimitError for more than max_results()
  [[nodiscard]] std::vector<std::int32_t> nearest_vertices(PointsView queries, std::size_t k);

  /// `values`: m for each point, point by point. Returns m for each query. Values are the device's doubles: equal on
  /// all devices but for what their compilers do to divisions. \throws InputError if the number of values is no
  /// multiple of the points', for queries as locate, and for natural neighbours if the coordinates span more than 240
  /// binades
  [[nodiscard]] std::vector<double> interpolate(std::span<const double> values, PointsView queries,
                                                Interpolation method = Interpolation::linear,
                                                Outside outside = Outside::nan);
  /// The same at the centre of each cell. A cell belongs to the triangle that `locate` finds for its centre; NaN
  /// outside of the hull, and in triangles with an edge longer than `max_edge`. Linear: O(triangles + cells). \throws
  /// InputError for a grid that is not finite, or whose cells have no size; LimitError for more than
  /// max_results() cells
  [[nodiscard]] std::vector<double> rasterize(const Grid& grid, std::span<const double> values,
                                              Interpolation method = Interpolation::linear,
                                              double max_edge = std::numeric_limits<double>::infinity());

  /// The circumcentre of each triangle: x0 y0 x1 y1 ...
  [[nodiscard]] std::vector<double> circumcenters();
  [[nodiscard]] VoronoiDiagram voronoi();
  /// The cells within `box`. Their areas sum to that of the box but for rounding; without triangles there are none.
  /// \throws InputError for a box that is not finite or has no area
  [[nodiscard]] VoronoiPolygons voronoi_polygons(const Box& box);
  /// The k largest circumcircles of triangles, which have no point inside, with their centres in the convex hull,
  /// largest first; fewer if there are no more. A centre on the hull, or within rounding of it, is in the hull.
  /// Cocircular points give a circle for each of their triangles. A larger circle can have its centre on the boundary
  /// of the hull, where it is no circumcentre.
  [[nodiscard]] std::vector<Circle> largest_empty_circles(std::size_t k);
  /// The triangles without an edge longer than `max_edge` and with a circumradius of at most `max_radius` (an alpha
  /// shape: H. Edelsbrunner, D. Kirkpatrick, R. Seidel, "On the shape of a set of points in the plane", 1983), and
  /// their boundary. \throws OptionError for a bound that is negative or NaN
  [[nodiscard]] Outline outline(double max_radius, double max_edge = std::numeric_limits<double>::infinity());

  /// The same on the device: queries, values and results in its memory, in the order of the caller's stream or queue,
  /// or complete when the call returns if the triangulator has one of its own. Each returns the number of elements
  /// written, known before: one, or k, or 3, or m a query; one a cell.
  std::size_t locate(const DevicePoints& queries, const DeviceArray& triangles);
  std::size_t locate_barycentric(const DevicePoints& queries, const DeviceArray& triangles,
                                 const DeviceArray& barycentric);
  std::size_t nearest_vertices(const DevicePoints& queries, std::size_t k, const DeviceArray& vertices);
  std::size_t interpolate(const DeviceArray& values, const DevicePoints& queries, const DeviceArray& results,
                          Interpolation method = Interpolation::linear, Outside outside = Outside::nan);
  std::size_t rasterize(const Grid& grid, const DeviceArray& values, const DeviceArray& cells,
                        Interpolation method = Interpolation::linear,
                        double max_edge = std::numeric_limits<double>::infinity());
  std::size_t circumcenters(const DeviceArray& xy);
  /// As voronoi(), in arrays that may be null (left out). Sizes: vertices 2 a triangle, cell_begin points + 1, cells 3
  /// a triangle, edge_points and edge_vertices at most 3 a triangle + 3 points each. Returns the number of edges; 0 if
  /// both are left out.
  std::size_t voronoi(const DeviceVoronoi& to);

  struct State;  // internal

 private:
  std::unique_ptr<State> state_;
};

}  // namespace cadt
