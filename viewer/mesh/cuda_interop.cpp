// SPDX-License-Identifier: Apache-2.0
// CUDA reads and writes the buffers of OpenGL: each is registered once and mapped for a call. Large ones are moved once
// to memory with large pages.
#include "viewer/mesh/interop.hpp"

#include "viewer/gl/context.hpp"
#include "viewer/gl/errors.hpp"

#ifdef CADT_VIEWER_CUDA

#include "viewer/mesh/large_pages.hpp"

#include <epoxy/gl.h>

#include <cadt/devices.hpp>

#include <cuda_gl_interop.h>
#include <cuda_runtime.h>

#include <optional>
#include <utility>
#include <vector>

namespace cadt::viewer {
namespace {

void check(cudaError_t code, const char* call) {
  if (code == cudaSuccess) return;
  (void)cudaGetLastError();
  throw DeviceError(call, static_cast<int>(code), "CUDA", cudaGetErrorString(code));
}

/// The CUDA device that draws the current context.
std::optional<int> device_of_display() {
  if (const auto device = gl::cuda_device_of_display()) return device;
  unsigned count = 0;
  int device = 0;
  if (cudaGLGetDevices(&count, &device, 1, cudaGLDeviceListAll) == cudaSuccess && count != 0) return device;
  (void)cudaGetLastError();
  return std::nullopt;
}

constexpr std::size_t large = 64u << 20;  // bytes; below, small pages are as good (docs/lab)

/// A buffer of OpenGL's that CUDA knows.
class Known {
 public:
  explicit Known(unsigned flags) : flags_(flags) {}
  ~Known() { forget(); }
  Known(const Known&) = delete;
  Known& operator=(const Known&) = delete;

  /// The first `used` bytes are kept. `note` becomes the reason if a large buffer has to stay in small pages.
  void know(gl::Buffer& buffer, std::size_t used, int device, std::string& note) {
    if (serial_ == buffer.serial()) return;
    forget();
    if (buffer.bytes() >= large && note.empty()) {
      try {
        move(buffer, used, device);
      } catch (const Error& error) {
        note = std::string("large buffers stay in small pages: ") + error.what();
      }
    }
    if (pages_.memory() == nullptr)
      check(cudaGraphicsGLRegisterBuffer(&resource_, buffer.id(), flags_), "cudaGraphicsGLRegisterBuffer");
    serial_ = buffer.serial();
  }
  /// Null for one in large pages: it needs no mapping.
  [[nodiscard]] cudaGraphicsResource_t resource() const noexcept { return resource_; }
  /// \pre mapped, if there is a resource
  [[nodiscard]] void* memory() const {
    if (resource_ == nullptr) return pages_.memory();
    void* found = nullptr;
    std::size_t bytes = 0;
    check(cudaGraphicsResourceGetMappedPointer(&found, &bytes, resource_), "cudaGraphicsResourceGetMappedPointer");
    return found;
  }

 private:
  void move(gl::Buffer& buffer, std::size_t used, int device) {
    if (!epoxy_has_gl_extension("GL_EXT_memory_object_fd"))
      throw DisplayError("the driver has no GL_EXT_memory_object_fd");
    LargePages pages(device, buffer.bytes());
    gl::Buffer moved(pages.bytes(), pages.take_file());
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    if (used != 0) glCopyNamedBufferSubData(buffer.id(), moved.id(), 0, 0, static_cast<GLsizeiptr>(used));
    glFinish();
    buffer = std::move(moved);
    pages_ = std::move(pages);
  }
  void forget() {
    if (resource_ != nullptr) cudaGraphicsUnregisterResource(std::exchange(resource_, nullptr));
    pages_ = LargePages();
    serial_ = 0;
  }
  cudaGraphicsResource_t resource_ = nullptr;
  LargePages pages_;
  unsigned flags_;
  std::uint64_t serial_ = 0;
};

/// OpenGL must not use the buffers while this lives. What it was told before comes first, what it is told after comes
/// last: that is what mapping and unmapping do; for memory that is not mapped both sides wait.
class Mapped {
 public:
  Mapped(const Known& a, const Known& b, cudaStream_t stream) : stream_(stream) {
    for (const Known* known : {&a, &b})
      if (known->resource() != nullptr) resources_.push_back(known->resource());
    waits_ = resources_.size() < 2;
    if (waits_) glFinish();
    if (!resources_.empty())
      check(cudaGraphicsMapResources(static_cast<int>(resources_.size()), resources_.data(), stream_),
            "cudaGraphicsMapResources");
  }
  ~Mapped() {
    if (open_) (void)give_back();
  }
  Mapped(const Mapped&) = delete;
  Mapped& operator=(const Mapped&) = delete;
  void unmap() { check(give_back(), "cudaGraphicsUnmapResources"); }

 private:
  cudaError_t give_back() {
    open_ = false;
    cudaError_t code = cudaSuccess;
    if (!resources_.empty())
      code = cudaGraphicsUnmapResources(static_cast<int>(resources_.size()), resources_.data(), stream_);
    if (code == cudaSuccess && waits_) code = cudaStreamSynchronize(stream_);
    return code;
  }
  std::vector<cudaGraphicsResource_t> resources_;
  cudaStream_t stream_;
  bool open_ = true, waits_ = false;
};

struct Stream {
  cudaStream_t handle = nullptr;
  explicit Stream(int device) {
    check(cudaSetDevice(device), "cudaSetDevice");
    check(cudaStreamCreateWithFlags(&handle, cudaStreamNonBlocking), "cudaStreamCreateWithFlags");
  }
  ~Stream() { (void)cudaStreamDestroy(handle); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
};

class CudaInterop final : public MeshInterop {
 public:
  CudaInterop(const Options& options, int device)
      : device_(device), stream_(device), triangulator_(on_stream(options, stream_.handle)) {}
  Triangulator& triangulator() noexcept override { return triangulator_; }

  std::size_t triangulate(MeshBuffers& mesh, Statistics* statistics) override {
    check(cudaSetDevice(device_), "cudaSetDevice");
    points_.know(mesh.points, mesh.point_count * 2 * sizeof(double), device_, note_);
    triangles_.know(mesh.triangles, 0, device_, note_);
    Mapped mapped(points_, triangles_, stream_.handle);
    const DevicePoints points{.x = points_.memory(), .size = mesh.point_count};
    const DeviceArray triangles{triangles_.memory(), mesh.triangles.bytes() / sizeof(std::int32_t)};
    const Detail detail(triangulator_.options(), statistics != nullptr);
    std::size_t count = 0;
    if (statistics != nullptr) {
      const DeviceTriangulation result = triangulator_.triangulate(points);
      count = result.number_of_triangles();
      if (count != 0)
        check(cudaMemcpyAsync(triangles.memory, result.triangles(), count * 3 * sizeof(std::int32_t),
                              cudaMemcpyDeviceToDevice, stream_.handle),
              "cudaMemcpyAsync");
      *statistics = result.statistics();
    } else {
      count = triangulator_.triangulate(points, triangles, {});
    }
    mapped.unmap();
    return count;
  }
  std::string note() const override { return note_; }

 private:
  static Options on_stream(Options options, cudaStream_t stream) {
    options.backend = Backend::cuda;
    options.device.clear();  // the stream has one
    options.queue = stream;
    return options;
  }

  int device_;
  Stream stream_;
  Triangulator triangulator_;
  Known points_{cudaGraphicsRegisterFlagsReadOnly}, triangles_{cudaGraphicsRegisterFlagsWriteDiscard};
  std::string note_;
};

}  // namespace

std::unique_ptr<MeshInterop> open_cuda(const Options& options, std::string& reason) {
  const std::optional<int> display = device_of_display();
  const DeviceInfo* computes = nullptr;
  const std::vector<DeviceInfo> devices = list_devices();
  for (const DeviceInfo& info : devices) {
    if (info.backend != Backend::cuda) continue;
    if (!info.usable) {
      reason = info.reason;
    } else if (is_named(info, options.device) && (computes == nullptr || info.index == display)) {
      computes = &info;
    }
  }
  if (computes == nullptr) {
    if (reason.empty()) reason = "no CUDA device is called '" + options.device + "'";
    return nullptr;
  }
  if (display != computes->index) {
    reason = "the display belongs to '" + name_of_display() + "', CUDA to '" + computes->name + "' (device " +
             std::to_string(computes->index) + ")";
    return nullptr;
  }
  return std::make_unique<CudaInterop>(options, *display);
}

}  // namespace cadt::viewer

#else

namespace cadt::viewer {

std::unique_ptr<MeshInterop> open_cuda(const Options&, std::string& reason) {
  reason = "this build is without CUDA";
  return nullptr;
}

}  // namespace cadt::viewer

#endif
