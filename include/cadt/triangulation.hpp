// SPDX-License-Identifier: Apache-2.0
// The Delaunay triangulation of a set of points in the plane.
#pragma once

#include <cadt/export.hpp>
#include <cadt/options.hpp>
#include <cadt/points.hpp>
#include <cadt/statistics.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace cadt {

/// A 128-bit hash of a canonical mesh.
struct CADT_API Hash128 {
  std::uint64_t high = 0, low = 0;
  friend bool operator==(const Hash128&, const Hash128&) = default;
  /// 32 lower-case hexadecimal digits.
  [[nodiscard]] std::string to_string() const;
};

/// An input point that equals an earlier one (-0.0 equals 0.0), and the lowest index that it equals: its
/// representative, which is the vertex. Both 0-based.
struct Duplicate {
  std::int32_t point;
  std::int32_t representative;
  friend bool operator==(const Duplicate&, const Duplicate&) = default;
};

/// What Triangulation::adopt believes.
enum class Trust {
  verify,   ///< nothing: the mesh is verified, at the cost of `cadt::verify` with all cores
  geometry  ///< that triangles are counterclockwise, the boundary is the convex hull and all circles are empty. The
            ///< structure is checked all the same, so that no function reads outside the arrays or runs for ever
};

/// A triangulation. Indices are those of the input, 0-based. The set of triangles is a function of the point set alone:
/// ties between cocircular points are broken by the symbolic perturbation of Devillers and Teillaud ("Perturbations and
/// vertex removal in a 3D Delaunay triangulation", SODA 2003) in the lexicographic order of the points, as in CGAL.
///
/// It never changes, and copies share its arrays: a copy costs O(1). Spans, references and `points()` are valid as long
/// as this object or a copy of it lives; an object that was moved from can only be assigned to or destroyed. const
/// functions may run concurrently, also on copies.
class CADT_API Triangulation {
 public:
  Triangulation();
  ~Triangulation();
  Triangulation(const Triangulation&) noexcept;
  Triangulation& operator=(const Triangulation&) noexcept;
  Triangulation(Triangulation&&) noexcept;
  Triangulation& operator=(Triangulation&&) noexcept;

  /// The mesh of another program. `triangles`: n x 3 indices, counterclockwise, 0-based. `neighbors`: n x 3, the k-th
  /// opposite vertex k, -1 outside; derived if empty. Cocircular points may be triangulated in any way. Points that are
  /// no vertices must equal one, which becomes their representative (Duplicate), also if it is not the lowest index.
  /// The arrays are copied; statistics() has the sizes alone. O(triangles), and O(points log points) if there are
  /// duplicates. Thread-safe. \throws InvalidMesh, InputError for NaN or infinity
  [[nodiscard]] static Triangulation adopt(PointsView points, std::span<const std::int32_t> triangles,
                                           std::span<const std::int32_t> neighbors = {}, Trust trust = Trust::verify,
                                           KeepPoints keep_points = KeepPoints::no);

  /// Number of input points.
  [[nodiscard]] std::size_t number_of_points() const noexcept;
  /// Number of triangles: 2 * distinct - 2 - (points on the hull), or 0 if dimension() < 2.
  [[nodiscard]] std::size_t number_of_triangles() const noexcept;

  /// Vertices: number_of_triangles() x 3 input indices, counterclockwise.
  [[nodiscard]] std::span<const std::int32_t> triangles() const noexcept;
  /// Neighbours: number_of_triangles() x 3 triangle indices; the k-th is opposite vertex k, -1 outside.
  [[nodiscard]] std::span<const std::int32_t> neighbors() const noexcept;
  /// The vertices of triangle t, counterclockwise. \throws InputError if there is none
  [[nodiscard]] std::array<std::int32_t, 3> triangle(std::size_t t) const;
  /// The triangle beyond the edge opposite vertex k of triangle t; -1 outside. \throws InputError if there is no
  /// triangle t, or k is above 2
  [[nodiscard]] std::int32_t neighbor(std::size_t t, std::size_t k) const;
  /// The input points, with Options::keep_points; else an empty view. Of a constrained mesh also its added points,
  /// behind them, and with Crossing::grid all where they have moved.
  [[nodiscard]] PointsView points() const noexcept;
  /// The hull: input indices as one counterclockwise loop that starts with the smallest, including points on hull
  /// edges. Empty if dimension() < 2.
  [[nodiscard]] std::span<const std::int32_t> hull() const noexcept;
  /// Points that are not vertices because they equal an earlier one, ascending by point.
  [[nodiscard]] std::span<const Duplicate> duplicates() const noexcept;
  /// The representative of a point that equals another one; -1 if the point is its own. O(log duplicates). \throws
  /// InputError if there is no such point
  [[nodiscard]] std::int32_t duplicate_of(std::size_t point) const;
  /// Dimension of the point set: -1 no points, 0 one distinct point, 1 collinear points, 2 otherwise.
  [[nodiscard]] int dimension() const noexcept;
  /// For each input point the lowest triangle that has it as a vertex; -1 if dimension() < 2. A duplicate has that of
  /// its representative. O(points + triangles).
  [[nodiscard]] std::vector<std::int32_t> vertex_triangle() const;
  /// Hash of the set of triangles, the hull size and the duplicates; the same for every device, order of triangles and
  /// call. It is the same for all versions of the library with the same major number. O(triangles).
  [[nodiscard]] Hash128 hash() const;
  [[nodiscard]] const Statistics& statistics() const noexcept;

  struct Data;  // internal
  explicit Triangulation(std::unique_ptr<Data> data);
  [[nodiscard]] const Data& data() const noexcept { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

/// Number of triangles of `mesh` that are not in `other`, both over the same points. O(n log n).
[[nodiscard]] CADT_API std::size_t count_differing(const Triangulation& mesh, const Triangulation& other);

/// Most points that one call accepts: a triangle index and an edge number share 32 bits, and there are two triangle
/// slots a point.
[[nodiscard]] constexpr std::size_t max_points() noexcept { return (std::size_t{1} << 29) - 2; }

/// Triangulates the points, which are read only and need to live until the call returns. For repeated calls with many
/// points use a Triangulator, which keeps the device open. With up to 16,383 points on the host the calling thread
/// works alone and keeps up to 8 MiB of memory for its next call, until it ends. Expected O(n log n) work for the sort
/// and O(n) for the rest on well-spread points. Thread-safe; calls from `Options::progress` are allowed.
[[nodiscard]] CADT_API Triangulation triangulate(PointsView points, const Options& options = {});

}  // namespace cadt
