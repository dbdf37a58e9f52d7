// SPDX-License-Identifier: Apache-2.0
// Triangulates the points of OpenGL's buffers, the triangles go into OpenGL's buffers: without the host where the
// device that computes is the one that draws.
#pragma once

#include <cadt/triangulator.hpp>

#include "viewer/draw/mesh_buffers.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace cadt::viewer {

class MeshInterop;

/// How the mesh gets from the device that computes to the one that draws.
enum class Interop {
  automatic,  ///< the first of the others that is possible
  cuda,       ///< CUDA writes the buffers of OpenGL
  opencl,     ///< OpenCL does, by cl_khr_gl_sharing
  copy        ///< through the host's memory
};
[[nodiscard]] std::string_view to_string(Interop interop) noexcept;

/// An open device beside an OpenGL context, which must be current for all calls. Not thread-safe.
class Mesher {
 public:
  /// \throws DisplayError if `interop` names one that is not possible here, with the reason; what Triangulator throws
  Mesher(const Options& options, Interop interop);
  ~Mesher();

  /// The one that was chosen, never Interop::automatic, and why it is not faster, known after the first triangulation;
  /// empty if there is nothing to say.
  [[nodiscard]] Interop interop() const noexcept { return interop_; }
  [[nodiscard]] std::string reason() const;
  [[nodiscard]] const DeviceInfo& device() const noexcept;

  /// Triangulates the points of `mesh` into its triangles. `mesh.triangle_count` and `bytes_through_host` are updated;
  /// the caller tells the Renderer. Large buffers may be replaced by others with the same contents. With `statistics`
  /// the library counts its work, which takes 2 to 3 % longer. \pre room for two triangles a point \throws what
  /// Triangulator::triangulate throws
  void triangulate(MeshBuffers& mesh, Statistics* statistics = nullptr);
  /// Order::fast unless changed; `statistics` is set by triangulate().
  [[nodiscard]] Options& options() noexcept;

 private:
  std::unique_ptr<MeshInterop> opened_;
  Interop interop_ = Interop::copy;
  std::string reason_;
};

}  // namespace cadt::viewer
