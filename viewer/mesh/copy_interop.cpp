// SPDX-License-Identifier: Apache-2.0
// Through the host: points are copied to host memory that the display's device can reach (pinned, mapped as long as it
// lives), the library reads them there and writes triangles beside, which are copied back.
#include "viewer/mesh/interop.hpp"

#include "viewer/gl/objects.hpp"

#include <algorithm>

namespace cadt::viewer {
namespace {

/// Memory of the host that is an OpenGL buffer.
template <class T>
class Staging {
 public:
  /// Room for so many values; what was there is lost. The display's device must not be using it.
  void reserve(std::size_t count) {
    if (count <= values_.size()) return;
    values_ = {};
    GLuint id = 0;
    glCreateBuffers(1, &id);
    name_ = gl::Name<gl::delete_buffer>(id);
    // Read as well as write: memory that is only written is not cached.
    constexpr GLbitfield access = GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const auto bytes = static_cast<GLsizeiptr>(count * sizeof(T));
    glNamedBufferStorage(id, bytes, nullptr, access | GL_CLIENT_STORAGE_BIT);
    void* const memory = glMapNamedBufferRange(id, 0, bytes, access);
    if (memory == nullptr) {
      while (glGetError() == GL_OUT_OF_MEMORY) {
      }
      throw OutOfMemory("no pinned memory for a copy of " + std::to_string(bytes) +
                            " bytes: take fewer points, or compute on the device that draws (--interop)",
                        static_cast<std::size_t>(bytes), 0);
    }
    values_ = {static_cast<T*>(memory), count};
  }
  [[nodiscard]] GLuint id() const noexcept { return name_.id(); }
  [[nodiscard]] std::span<T> values() const noexcept { return values_; }

 private:
  gl::Name<gl::delete_buffer> name_;
  std::span<T> values_;
};

class CopyInterop final : public MeshInterop {
 public:
  explicit CopyInterop(const Options& options) : triangulator_(options) {}
  Triangulator& triangulator() noexcept override { return triangulator_; }

  std::size_t triangulate(MeshBuffers& mesh, Statistics* statistics) override {
    const std::size_t n = mesh.point_count, bytes_of_points = n * 2 * sizeof(double);
    glFinish();  // the last copy of triangles
    points_.reserve(2 * n);
    triangles_.reserve(std::max<std::size_t>(16, 6 * n));
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glCopyNamedBufferSubData(mesh.points.id(), points_.id(), 0, 0, static_cast<GLsizeiptr>(bytes_of_points));
    glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    glFinish();
    const Detail detail(triangulator_.options(), statistics != nullptr);
    const std::span<const double> xy = points_.values().first(2 * n);
    std::size_t count = 0;
    if (statistics != nullptr) {
      const Triangulation result = triangulator_.triangulate(PointsView(xy));
      std::ranges::copy(result.triangles(), triangles_.values().begin());
      count = result.number_of_triangles();
      *statistics = result.statistics();
    } else {
      count = triangulator_.triangulate(PointsView(xy), triangles_.values(), {});
    }
    const std::size_t bytes_of_triangles = count * 3 * sizeof(std::int32_t);
    if (count != 0)
      glCopyNamedBufferSubData(triangles_.id(), mesh.triangles.id(), 0, 0, static_cast<GLsizeiptr>(bytes_of_triangles));
    mesh.bytes_through_host += bytes_of_points + bytes_of_triangles;
    return count;
  }

 private:
  Triangulator triangulator_;
  Staging<double> points_;
  Staging<std::int32_t> triangles_;
};

}  // namespace

std::unique_ptr<MeshInterop> open_copy(const Options& options) { return std::make_unique<CopyInterop>(options); }

}  // namespace cadt::viewer
