// SPDX-License-Identifier: Apache-2.0
// Triangulations of many point sets from one call.
#pragma once

#include <cadt/export.hpp>
#include <cadt/triangulation.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace cadt {

/// The meshes of many sets, one after another in the same arrays. Set s, of size() sets, has the triangles
/// triangle_offsets()[s] to triangle_offsets()[s + 1] - 1. Its vertices are indices into its own points, its neighbours
/// indices into its own triangles, both 0-based: the part of a set is exactly what `triangulate` returns for that set.
/// Functions that take a set throw InputError if there is no such set. Spans are valid as long as this object lives and
/// is not moved from. const functions may run concurrently.
class CADT_API TriangulationBatch {
 public:
  TriangulationBatch();
  ~TriangulationBatch();
  TriangulationBatch(TriangulationBatch&&) noexcept;
  TriangulationBatch& operator=(TriangulationBatch&&) noexcept;

  /// Number of sets.
  [[nodiscard]] std::size_t size() const noexcept;
  /// size() + 1 numbers: the first triangle of each set, then the number of all triangles.
  [[nodiscard]] std::span<const std::size_t> triangle_offsets() const noexcept;
  /// Vertices (counterclockwise) and neighbours (-1 outside) of all sets: n x 3 each, as in Triangulation.
  [[nodiscard]] std::span<const std::int32_t> triangles() const noexcept;
  [[nodiscard]] std::span<const std::int32_t> neighbors() const noexcept;

  /// The same for one set.
  [[nodiscard]] std::span<const std::int32_t> triangles(std::size_t set) const;
  [[nodiscard]] std::span<const std::int32_t> neighbors(std::size_t set) const;
  [[nodiscard]] std::size_t number_of_points(std::size_t set) const;
  /// As Triangulation::dimension() and duplicates(); indices are those of the set's own points.
  [[nodiscard]] int dimension(std::size_t set) const;
  [[nodiscard]] std::span<const Duplicate> duplicates(std::size_t set) const;
  /// A copy of one set's mesh as a Triangulation, with its hull; the statistics are those of the whole call. O(points
  /// of the set).
  [[nodiscard]] Triangulation triangulation(std::size_t set) const;

  /// Statistics of the whole call.
  [[nodiscard]] const Statistics& statistics() const noexcept;

  struct Data;  // internal
  explicit TriangulationBatch(std::unique_ptr<Data> data);

 private:
  std::unique_ptr<Data> data_;
};

/// The same with the arrays in device memory. The handles are valid as those of DeviceTriangulation.
class CADT_API DeviceTriangulationBatch {
 public:
  DeviceTriangulationBatch();
  ~DeviceTriangulationBatch();
  DeviceTriangulationBatch(DeviceTriangulationBatch&&) noexcept;
  DeviceTriangulationBatch& operator=(DeviceTriangulationBatch&&) noexcept;

  [[nodiscard]] std::size_t size() const noexcept;
  /// triangle_offsets() as in TriangulationBatch, on the host.
  [[nodiscard]] std::span<const std::size_t> triangle_offsets() const noexcept;
  /// Handle of triangle_offsets() as size() + 1 32-bit words on the device.
  [[nodiscard]] void* device_triangle_offsets() const noexcept;
  /// Handles of the vertices and neighbours of all sets: n x 3 32-bit words each; null if there are no triangles.
  [[nodiscard]] void* triangles() const noexcept;
  [[nodiscard]] void* neighbors() const noexcept;
  /// As in TriangulationBatch, on the host.
  [[nodiscard]] int dimension(std::size_t set) const;
  [[nodiscard]] std::span<const Duplicate> duplicates(std::size_t set) const;
  [[nodiscard]] const Statistics& statistics() const noexcept;

  /// A copy on the host; waits for the device. O(triangles). \throws DeviceError
  [[nodiscard]] TriangulationBatch download() const;

  struct Data;  // internal
  explicit DeviceTriangulationBatch(std::unique_ptr<Data> data);

 private:
  std::unique_ptr<Data> data_;
};

/// Triangulates many sets in one call. Set s has the points offsets[s] to offsets[s + 1] - 1: one offset more than
/// there are sets, the first 0, none below the one before, the last points.size(). Sets may be empty. `points` and
/// `offsets` are read only and need to live until the call returns.
///
/// Throws as `triangulate`; also InputError for invalid offsets, with the position of the first invalid one as index.
/// The index of a point that is NaN or infinite counts from the first point of all sets; the message names set and
/// point.
[[nodiscard]] CADT_API TriangulationBatch triangulate_batch(PointsView points, std::span<const std::size_t> offsets,
                                                            const Options& options = {});

}  // namespace cadt
