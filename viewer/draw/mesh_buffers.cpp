// SPDX-License-Identifier: Apache-2.0
#include "viewer/draw/mesh_buffers.hpp"

namespace cadt::viewer {

MeshBuffers MeshBuffers::with_room(std::size_t points) {
  MeshBuffers mesh;
  mesh.points = gl::Buffer(points * 2 * sizeof(double));
  mesh.triangles = gl::Buffer(points * 2 * 3 * sizeof(std::int32_t));
  return mesh;
}

MeshBuffers MeshBuffers::copy(std::span<const double> xy, std::span<const std::int32_t> triangles) {
  MeshBuffers mesh;
  mesh.points = gl::Buffer(xy.size_bytes());
  mesh.triangles = gl::Buffer(triangles.size_bytes());
  mesh.write_points(xy);
  mesh.write_triangles(triangles);
  return mesh;
}

void MeshBuffers::write_points(std::span<const double> xy) {
  point_count = xy.size() / 2;
  box = box_of(xy);
  points.write_values(xy);
  bytes_through_host += xy.size_bytes();
}

void MeshBuffers::write_triangles(std::span<const std::int32_t> all) {
  triangle_count = all.size() / 3;
  triangles.write_values(all);
  bytes_through_host += all.size_bytes();
}

void MeshBuffers::write_edges(std::span<const Segment> all) {
  if (edges.bytes() < all.size_bytes()) edges = gl::Buffer(all.size_bytes());
  edge_count = all.size();
  edges.write_values(all);
}

}  // namespace cadt::viewer
