// SPDX-License-Identifier: Apache-2.0
// The triangulations of many sets of points from one call.
#pragma once

#include <cadt/triangulation.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace cadt {

/// The meshes of many sets, one after another in the same arrays. Set s, of size() sets, has the triangles from
/// triangle_offsets()[s] on, below triangle_offsets()[s + 1]. Vertices are numbered from the first point of their own
/// set on, neighbours from its first triangle on: what belongs to a set is exactly what `triangulate` gives for it
/// alone. Functions of a set throw InputError where there is no such set.
class TriangulationBatch {
 public:
  TriangulationBatch();
  ~TriangulationBatch();
  TriangulationBatch(TriangulationBatch&&) noexcept;
  TriangulationBatch& operator=(TriangulationBatch&&) noexcept;

  /// Number of sets.
  [[nodiscard]] std::size_t size() const noexcept;
  /// size() + 1 numbers: the first triangle of each set, and the number of all.
  [[nodiscard]] std::span<const std::size_t> triangle_offsets() const noexcept;
  /// Vertices and neighbours of all sets, n x 3 each, as in Triangulation.
  [[nodiscard]] std::span<const std::int32_t> triangles() const noexcept;
  [[nodiscard]] std::span<const std::int32_t> neighbors() const noexcept;

  /// The same of one set.
  [[nodiscard]] std::span<const std::int32_t> triangles(std::size_t set) const;
  [[nodiscard]] std::span<const std::int32_t> neighbors(std::size_t set) const;
  [[nodiscard]] std::size_t number_of_points(std::size_t set) const;
  /// As Triangulation::dimension() and duplicates(), with the numbers of the set's own points.
  [[nodiscard]] int dimension(std::size_t set) const;
  [[nodiscard]] std::span<const Duplicate> duplicates(std::size_t set) const;
  /// A copy of one set's mesh with all that a Triangulation has, the hull too; statistics are those of the whole call.
  /// O(points of the set).
  [[nodiscard]] Triangulation triangulation(std::size_t set) const;

  /// Of the whole call.
  [[nodiscard]] const Statistics& statistics() const noexcept;

  struct Data;  // internal
  explicit TriangulationBatch(std::unique_ptr<Data> data);

 private:
  std::unique_ptr<Data> data_;
};

/// The same with the arrays in device memory. Its handles are valid as those of a DeviceTriangulation.
class DeviceTriangulationBatch {
 public:
  DeviceTriangulationBatch();
  ~DeviceTriangulationBatch();
  DeviceTriangulationBatch(DeviceTriangulationBatch&&) noexcept;
  DeviceTriangulationBatch& operator=(DeviceTriangulationBatch&&) noexcept;

  [[nodiscard]] std::size_t size() const noexcept;
  /// On the host.
  [[nodiscard]] std::span<const std::size_t> triangle_offsets() const noexcept;
  /// Handle of the same as size() + 1 words of 32 bits on the device.
  [[nodiscard]] void* device_triangle_offsets() const noexcept;
  /// Handles of the vertices and neighbours of all sets, n x 3 words each; null if there are none.
  [[nodiscard]] void* triangles() const noexcept;
  [[nodiscard]] void* neighbors() const noexcept;
  /// On the host, as in TriangulationBatch.
  [[nodiscard]] int dimension(std::size_t set) const;
  [[nodiscard]] std::span<const Duplicate> duplicates(std::size_t set) const;
  [[nodiscard]] const Statistics& statistics() const noexcept;

  /// A copy on the host. O(triangles). \throws DeviceError
  [[nodiscard]] TriangulationBatch download() const;

  struct Data;  // internal
  explicit DeviceTriangulationBatch(std::unique_ptr<Data> data);

 private:
  std::unique_ptr<Data> data_;
};

/// Triangulates many sets in one call. Set s has the points from offsets[s] on, below offsets[s + 1]: one number more
/// than there are sets, the first 0, none below the one before, the last points.size(). Sets may be empty.
///
/// Throws as `triangulate`; InputError too for other offsets, with the place of the first wrong one as index. The index
/// of a bad point counts from the first point of all, the text names set and point.
[[nodiscard]] TriangulationBatch triangulate_batch(PointsView points, std::span<const std::size_t> offsets,
                                                   const Options& options = {});

}  // namespace cadt
