// SPDX-License-Identifier: Apache-2.0
// A mesh in OpenGL's buffers, as the library's arrays: what draws reads what the device wrote.
#pragma once

#include <cadt/constrained.hpp>

#include "viewer/draw/camera.hpp"
#include "viewer/gl/objects.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace cadt::viewer {

struct MeshBuffers {
  gl::Buffer points;     ///< two doubles a point
  gl::Buffer triangles;  ///< three int32 a triangle, counterclockwise
  gl::Buffer edges;      ///< two int32 a constrained edge
  std::size_t point_count = 0, triangle_count = 0, edge_count = 0;
  Extent box;
  std::size_t bytes_through_host = 0;  ///< of points and triangles since the buffers were made

  /// Room for so many points, and for twice as many triangles: there are no more. \throws OutOfMemory
  static MeshBuffers with_room(std::size_t points);
  /// A copy of arrays of the host's.
  static MeshBuffers copy(std::span<const double> xy, std::span<const std::int32_t> triangles);

  void write_points(std::span<const double> xy);
  void write_triangles(std::span<const std::int32_t> triangles);
  /// Those that are drawn over the triangles.
  void write_edges(std::span<const Segment> edges);
};

}  // namespace cadt::viewer
