// SPDX-License-Identifier: Apache-2.0
// Points of a mesh that move and are edited on the display's device. After a change the mesh is triangulated again
// (Mesher), which is fast enough for each frame.
#pragma once

#include "viewer/draw/mesh_buffers.hpp"
#include "viewer/gl/fill.hpp"
#include "viewer/gl/objects.hpp"
#include "viewer/gl/scan.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::viewer {

/// How all points move.
enum class Motion {
  flow,      ///< with a velocity field without sources, forth and back
  bounce,    ///< each straight on; the sides of the box are mirrors
  orbit,     ///< around the middle of the box
  particles  ///< Brownian particles with a diameter: those that overlap push each other apart
};
[[nodiscard]] std::string_view to_string(Motion motion) noexcept;
/// All names, in the order of the enumerators.
[[nodiscard]] const std::vector<std::string>& names_of_motions();

/// For the mesh that it was made for, and the context that is current. Not thread-safe. Nothing is copied to the host
/// but the number of a point, or of those that are left.
class LivePoints {
 public:
  /// The points of `mesh`, which must outlive this object, or n points at random in its box. The box stays: it is where
  /// points move. \throws InputError if the box is empty or too wide, DisplayError, OutOfMemory
  explicit LivePoints(MeshBuffers& mesh);
  LivePoints(MeshBuffers& mesh, std::size_t n, std::uint32_t seed);

  /// Moves all points by `dt` seconds; nothing moves faster than about a box a second. Motion::particles looks at the
  /// triangles, which must be of these points.
  void step(double dt, Motion motion);
  /// The point that is nearest to a place, if there is any. Distances are compared as floats.
  [[nodiscard]] std::optional<std::size_t> nearest(double x, double y);
  void drag(std::size_t point, double x, double y);
  /// Adds n points at random in a disc, behind all others. \throws OutOfMemory
  void paint(double x, double y, double radius, std::size_t n);
  /// Removes the points of a disc, and returns how many; the others keep their order.
  std::size_t erase(double x, double y, double radius);

 private:
  struct Frame {
    double low[2], limit[2], scale;
  };
  void spawn(std::size_t first, std::size_t n, int where, double x, double y, double radius);
  void use(const gl::Program& program, std::size_t count) const;
  void make_room(std::size_t points);

  MeshBuffers& mesh_;
  Frame frame_;
  gl::Program spawn_, move_, push_, keep_, compact_, nearest_;
  gl::Fill fill_;
  gl::Scan scan_;
  gl::Buffer velocities_, pushes_, places_, best_;
  double time_ = 0;
  std::uint32_t seed_ = 1;
};

}  // namespace cadt::viewer
