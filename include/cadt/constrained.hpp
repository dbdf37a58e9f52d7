// SPDX-License-Identifier: Apache-2.0
// The constrained Delaunay triangulation: the one that has given segments as edges.
#pragma once

#include <cadt/errors.hpp>
#include <cadt/export.hpp>
#include <cadt/options.hpp>
#include <cadt/points.hpp>
#include <cadt/triangulation.hpp>
#include <cadt/verify.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace cadt {

/// The two ends of a segment: indices of points, 0-based.
using Segment = std::array<std::int32_t, 2>;

/// Segments between consecutive points of polylines in the layout of GeoArrow: polyline i has the points from
/// offsets[i] to offsets[i + 1] - 1. `vertices`: where not empty, offsets count in this list of point indices. O(n).
/// \throws InputError if the offsets do not ascend or reach behind the list
[[nodiscard]] CADT_API std::vector<Segment> polyline_segments(std::span<const std::int64_t> offsets,
                                                              std::span<const std::int32_t> vertices = {});
/// The same for rings: the last point of each is joined with the first one, and one of a single point has no segment. A
/// ring that repeats its first point at its end gets a segment of zero length there, which is dropped like any other if
/// the points are equal. O(n).
[[nodiscard]] CADT_API std::vector<Segment> ring_segments(std::span<const std::int64_t> offsets,
                                                          std::span<const std::int32_t> vertices = {});

/// What to do with segments that cross: that have one common point, inside both, at which no input point lies.
enum class Crossing {
  error,  ///< CrossingError with all pairs
  exact,  ///< the crossing becomes a vertex. All decisions are made with its exact place; only the coordinates that are
          ///< given out are rounded (ConstrainedTriangulation::rounded_valid)
  grid    ///< snap rounding: all points move to a grid of the width ConstraintOptions::grid, and segments with them
};

/// Which triangles are inside.
enum class Domain {
  hull,      ///< all
  outer,     ///< those that cannot be reached from outside of the hull without crossing a segment
  even_odd,  ///< those from which one crosses an odd number of segments to the outside; a segment that is given twice
             ///< counts twice
  nonzero,   ///< those with a winding number other than 0: segments that run upwards count against those downwards
  layers,    ///< those at an odd depth: the fewest segments to be crossed to the outside, several along one edge being
             ///< one; dangling segments are no harm
  seeds      ///< those that no hole reaches: holes spread from their points, and from outside of the hull, up to the
             ///< next segment, as Triangle's do. Crossings count where they are exactly
};

/// A place in a region and what the region is called, as in Triangle's files.
struct Region {
  double x = 0, y = 0;
  double attribute = 0;
  double largest_area = -1;  ///< not used, and kept for who refines: cadt adds no points
};

struct ConstraintOptions {
  Crossing crossing = Crossing::error;
  /// With Crossing::grid: the width of its cells, above 0; a power of two where coordinates are 2^25 times as large or
  /// more, so that its multiples are doubles. Else OptionError.
  double grid = 0;
  Domain domain = Domain::hull;
  std::vector<std::array<double, 2>> holes = {};  ///< with Domain::seeds; else OptionError
  std::vector<Region> regions = {};               ///< the same: their attributes go to region_attribute()
};

/// Segments that cross, with Crossing::error: repair them, or take Crossing::exact or Crossing::grid.
class CADT_API CrossingError : public Error {
 public:
  CrossingError(const std::string& message, std::vector<std::array<std::int32_t, 2>> pairs)
      : Error(message), pairs_(std::move(pairs)) {}
  /// All pairs of indices of segments that cross, each once with the lower index first, ascending.
  [[nodiscard]] const std::vector<std::array<std::int32_t, 2>>& pairs() const noexcept { return pairs_; }

 private:
  std::vector<std::array<std::int32_t, 2>> pairs_;
};

/// The segments do not bound a domain: an end of a segment hangs loose, and the rule (even_odd, nonzero) has no answer.
/// Close the outlines, or take Domain::layers or outer.
class CADT_API DomainError : public Error {
 public:
  DomainError(const std::string& message, std::int32_t vertex) : Error(message), vertex_(vertex) {}
  /// A point at which the segments do not close.
  [[nodiscard]] std::int32_t vertex() const noexcept { return vertex_; }

 private:
  std::int32_t vertex_;
};

/// The unique triangulation of the points that has all segments as chains of edges and whose other edges are legal
/// under the symbolic perturbation of Triangulation; CGAL's Constrained_Delaunay_triangulation_2 has the same
/// triangles. It does not depend on the order or the direction of segments; added points alone have their numbers from
/// the order of segments, as others have theirs from the order of points. (Its proof: docs/constrained.md.)
///
/// Special cases: ends at equal points are those of the representative; a segment between equal points is dropped
/// (degenerate_segments); segments may repeat and overlap; a point on a segment divides it, exactly, without tolerance;
/// loose ends, points on no segment and segments on the hull are allowed; collinear points have chains and no
/// triangles.
///
/// Never changes; copies share everything. Indices are 0-based; triangles are counterclockwise. const functions may run
/// concurrently.
class CADT_API ConstrainedTriangulation {
 public:
  ConstrainedTriangulation();
  ~ConstrainedTriangulation();
  ConstrainedTriangulation(const ConstrainedTriangulation&) noexcept;
  ConstrainedTriangulation& operator=(const ConstrainedTriangulation&) noexcept;
  ConstrainedTriangulation(ConstrainedTriangulation&&) noexcept;
  ConstrainedTriangulation& operator=(ConstrainedTriangulation&&) noexcept;

  /// Triangles, neighbours, hull, duplicates. Its points are those of the input and, behind them, added_points(); with
  /// Crossing::grid all are on the grid.
  [[nodiscard]] const Triangulation& mesh() const noexcept;

  /// A word a triangle. Bit k: edge k, the one opposite vertex k, is constrained; the triangle across says so as well.
  [[nodiscard]] std::span<const std::uint32_t> edge_flags() const noexcept;
  [[nodiscard]] bool is_constrained(std::size_t triangle, std::size_t k) const;

  /// The vertices along segment s, from its first end to its second one, are chain_vertices() from chain_offsets()[s]
  /// to chain_offsets()[s + 1] - 1; none for a degenerate segment.
  [[nodiscard]] std::span<const std::int64_t> chain_offsets() const noexcept;
  [[nodiscard]] std::span<const std::int32_t> chain_vertices() const noexcept;

  /// The constrained edges, the lower vertex first, ascending. These three are made when first asked for, in O(n log
  /// n).
  [[nodiscard]] std::span<const Segment> constrained_edges() const;
  /// The segments that edge e is part of are edge_sources() from source_offsets()[e] to source_offsets()[e + 1] - 1:
  /// i for segment i in the direction of the edge, -1 - i against it. A segment appears as often as it was given.
  [[nodiscard]] std::span<const std::int64_t> source_offsets() const;
  [[nodiscard]] std::span<const std::int32_t> edge_sources() const;

  /// Segments whose ends are equal points, ascending.
  [[nodiscard]] std::span<const std::int32_t> degenerate_segments() const noexcept;

  /// Whether each triangle is inside (ConstraintOptions::domain): 1 or 0 a triangle.
  [[nodiscard]] std::span<const std::uint8_t> inside() const noexcept;
  [[nodiscard]] std::size_t number_inside() const noexcept;
  /// The region of each triangle: that of all triangles that can be reached without crossing a segment. Ways around
  /// outside of the hull count, so a single segment across it leaves one region. Regions are numbered by their lowest
  /// triangles, from 0.
  [[nodiscard]] std::span<const std::int32_t> region() const noexcept;
  [[nodiscard]] std::size_t number_of_regions() const noexcept;
  /// A number a region: its depth with Domain::layers, its winding number with nonzero, the number of crossed segments
  /// modulo 2 with even_odd; else 0 outside and 1 inside.
  [[nodiscard]] std::span<const std::int32_t> region_value() const noexcept;
  /// The attribute of each region (ConstraintOptions::regions; the first that lies there); 0 without one.
  [[nodiscard]] std::span<const double> region_attribute() const noexcept;
  /// The vertices of the triangles inside, in the order of mesh().
  [[nodiscard]] std::vector<std::int32_t> triangles_inside() const;

  /// Vertices made for crossings, in the order of their pairs of segments; x0 y0 x1 y1 ..., rounded to nearest.
  [[nodiscard]] std::span<const double> added_points() const noexcept;
  /// For each of them, the lowest pair of segments that cross there.
  [[nodiscard]] std::span<const std::array<std::int32_t, 2>> added_parents() const noexcept;
  /// Whether the triangles are still counterclockwise with the rounded coordinates. True without added points.
  [[nodiscard]] bool rounded_valid() const noexcept;
  /// With Crossing::grid: where each input point has moved, x0 y0 x1 y1 ...; else empty.
  [[nodiscard]] std::span<const double> moved_points() const noexcept;

  /// Hash of triangles and constrained edges, by the numbers of their vertices; the same for each device and direction
  /// of segments and, without added points, for each order of them.
  [[nodiscard]] Hash128 hash() const;
  [[nodiscard]] const Statistics& statistics() const noexcept;

  struct Data;  // internal
  explicit ConstrainedTriangulation(std::shared_ptr<const Data> data);

 private:
  std::shared_ptr<const Data> data_;
};

/// Triangulates points with segments between them. Points and segments are read only and need to live until the call
/// returns. Expected O(n log n + crossed triangles log) work. Thread-safe. \throws CrossingError, DomainError,
/// InputError (a bad index: InputError::index() is that of the segment), OptionError, and what `triangulate` throws
[[nodiscard]] CADT_API ConstrainedTriangulation triangulate_constrained(PointsView points,
                                                                        std::span<const Segment> segments,
                                                                        const ConstraintOptions& constraints = {},
                                                                        const Options& options = {});

/// All pairs of segments that cross (Crossing), each once with the lower index first, ascending. Exact.
/// O(n log n + pairs) expected, on the host. Thread-safe. Of `options`, `threads`, `stop` and `progress` count.
/// \throws InputError, Cancelled, LimitError if points and crossings are more than max_points(), Error if the
/// floating-point mode is not IEEE 754
[[nodiscard]] CADT_API std::vector<std::array<std::int32_t, 2>> find_crossings(PointsView points,
                                                                               std::span<const Segment> segments,
                                                                               const Options& options = {});

/// Values of the input points, `columns` of them a point, and behind them those of added_points(): linear along the
/// first of their two segments (added_parents), at their rounded places, from the nearest input point before them to
/// the nearest one behind. O(values + length of chains). \throws InputError if there are not `columns` values for each
/// of the points
[[nodiscard]] CADT_API std::vector<double> values_at_crossings(PointsView points, std::span<const double> values,
                                                               std::size_t columns,
                                                               const ConstrainedTriangulation& mesh);

/// The checks of `verify`, with constrained edges exempt from that of circles, and "constraints": the flags of edges
/// are those of the segments, and, if all else has passed, "regions": no region crosses a segment, and what is inside
/// fits the rule of `constraints`. Points made for crossings are where they were rounded to: triangles are examined
/// there (rounded_valid), but no circles that they take part in; that each is the crossing of its added_parents(),
/// rounded to nearest, and on the chains of both, belongs to "constraints". With Crossing::grid "constraints" asks
/// where points have moved, to the centres of their cells, and that each segment meets the cells of its chain; it must
/// be given with its rule and width. \throws as `verify`, InputError
[[nodiscard]] CADT_API VerifyReport verify(PointsView points, std::span<const Segment> segments,
                                           const ConstrainedTriangulation& mesh,
                                           const ConstraintOptions& constraints = {},
                                           const VerifyOptions& options = {});

}  // namespace cadt
