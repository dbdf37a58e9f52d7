// SPDX-License-Identifier: Apache-2.0
// Triangles inside many polygons with holes, from one call.
#pragma once

#include <cadt/export.hpp>
#include <cadt/options.hpp>
#include <cadt/points.hpp>
#include <cadt/statistics.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

namespace cadt {

/// What has become of a polygon.
enum class PolygonStatus : std::uint8_t {
  ok,
  too_few_points,  ///< the first ring has fewer than three different points, or the polygon has no ring
  not_finite,      ///< a coordinate is not a finite number
  self_crossing,   ///< two edges of one ring cross
  ring_crossing,   ///< edges of two rings cross
  zero_area        ///< no place is inside an odd number of rings
};
/// "ok", "too few points", "not finite", "self-crossing", "ring crosses ring", "zero area".
[[nodiscard]] CADT_API std::string_view to_string(PolygonStatus status) noexcept;

/// A polygon without triangles, and where the reason is.
struct PolygonProblem {
  std::size_t polygon = 0;
  PolygonStatus status = PolygonStatus::ok;
  /// Indices of ring points. Of edges that cross: where they begin; the lowest pair of them. Too few points, zero
  /// area: twice where the polygon begins, or -1 if its first ring has no points or there is no ring. Not finite: twice
  /// the first such point.
  std::int32_t first = 0, second = 0;
};

/// The triangles of many polygons, one polygon after another. Polygon p, of size(), has the triangles
/// triangle_offsets()[p] to triangle_offsets()[p + 1] - 1. Indices are 0-based. Spans are valid as long as this object
/// lives and is not moved from. const functions may run concurrently.
class CADT_API PolygonsResult {
 public:
  PolygonsResult();
  ~PolygonsResult();
  PolygonsResult(PolygonsResult&&) noexcept;
  PolygonsResult& operator=(PolygonsResult&&) noexcept;

  /// Number of polygons.
  [[nodiscard]] std::size_t size() const noexcept;
  /// size() + 1 numbers: the first triangle of each polygon, then the number of all triangles.
  [[nodiscard]] std::span<const std::int64_t> triangle_offsets() const noexcept;
  /// n x 3 indices of ring points, counterclockwise; of equal points of a polygon the lowest. The order is the same
  /// from every device.
  [[nodiscard]] std::span<const std::int32_t> triangles() const noexcept;
  /// The same of one polygon. \throws InputError if there is no such polygon
  [[nodiscard]] std::span<const std::int32_t> triangles(std::size_t polygon) const;

  /// One a polygon.
  [[nodiscard]] std::span<const PolygonStatus> status() const noexcept;
  /// The polygons whose status is not ok, ascending.
  [[nodiscard]] std::span<const PolygonProblem> problems() const noexcept;

  /// Statistics of the whole call.
  [[nodiscard]] const Statistics& statistics() const noexcept;

  struct Data;  // internal
  explicit PolygonsResult(std::unique_ptr<Data> data);

 private:
  std::unique_ptr<Data> data_;
};

/// Triangulates polygons in the layout of GeoArrow: ring r has the points ring_offsets[r] to ring_offsets[r + 1] - 1,
/// polygon p the rings polygon_offsets[p] to polygon_offsets[p + 1] - 1, usually the outline and then the holes. Rings
/// may repeat their first point at their end, and have any direction.
///
/// Inside is what an odd number of rings goes around. The triangles are those of the constrained Delaunay triangulation
/// of the polygon's points and edges (triangulate_constrained with Domain::even_odd). Rings may touch themselves and
/// each other, in points and along edges, and may go along an edge twice. Rings behind the first may have fewer than
/// three different points: one is a vertex of the mesh, two are an edge, and none is nothing. A polygon whose edges
/// cross or that has another defect has no triangles and is listed in PolygonsResult::problems(); the others do not
/// suffer.
///
/// All views are read only and need to live until the call returns. Small polygons are each the work of one thread of
/// the device; those of more than 512 points of a call of their own. Small ones with rings of one or two different
/// points, or with coordinates too far apart for the narrow arithmetic, are calls of the host, whatever the device is
/// (some ten microseconds each). O(n log n) expected for each polygon of n points, O(n^2) if edges cross. Memory: 24
/// bytes a point for the result; on a GPU at most 300 MB more. Thread-safe. \throws InputError (offsets that descend or
/// reach behind the points; index() is that of the offset), LimitError, OptionError, OutOfMemory, BackendUnavailable,
/// Cancelled
[[nodiscard]] CADT_API PolygonsResult triangulate_polygons(PointsView ring_points,
                                                           std::span<const std::int64_t> ring_offsets,
                                                           std::span<const std::int64_t> polygon_offsets,
                                                           const Options& options = {});

}  // namespace cadt
