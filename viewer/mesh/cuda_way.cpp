// SPDX-License-Identifier: Apache-2.0
// CUDA reads and writes the buffers of OpenGL: each is registered once and mapped for a call.
#include "viewer/mesh/way.hpp"

#include "viewer/gl/context.hpp"

#ifdef CADT_VIEWER_CUDA

#include <epoxy/gl.h>

#include <cadt/devices.hpp>

#include <cuda_gl_interop.h>
#include <cuda_runtime.h>

#include <array>
#include <optional>
#include <utility>

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

/// A buffer of OpenGL's that CUDA knows.
class Registered {
 public:
  explicit Registered(unsigned flags) : flags_(flags) {}
  ~Registered() { forget(); }
  Registered(const Registered&) = delete;
  Registered& operator=(const Registered&) = delete;

  cudaGraphicsResource_t resource_of(const gl::Buffer& buffer) {
    if (serial_ != buffer.serial()) {
      forget();
      check(cudaGraphicsGLRegisterBuffer(&resource_, buffer.id(), flags_), "cudaGraphicsGLRegisterBuffer");
      serial_ = buffer.serial();
    }
    return resource_;
  }

 private:
  void forget() {
    if (resource_ != nullptr) cudaGraphicsUnregisterResource(std::exchange(resource_, nullptr));
    serial_ = 0;
  }
  cudaGraphicsResource_t resource_ = nullptr;
  unsigned flags_;
  std::uint64_t serial_ = 0;
};

/// OpenGL must not use the buffers while this lives. What it was told before comes first, what it is told after comes
/// last: that is what mapping and unmapping do.
class Mapped {
 public:
  Mapped(std::array<cudaGraphicsResource_t, 2> resources, cudaStream_t stream)
      : resources_(resources), stream_(stream) {
    check(cudaGraphicsMapResources(2, resources_.data(), stream_), "cudaGraphicsMapResources");
  }
  ~Mapped() {
    if (open_) (void)cudaGraphicsUnmapResources(2, resources_.data(), stream_);
  }
  Mapped(const Mapped&) = delete;
  Mapped& operator=(const Mapped&) = delete;
  void unmap() {
    open_ = false;
    check(cudaGraphicsUnmapResources(2, resources_.data(), stream_), "cudaGraphicsUnmapResources");
  }
  [[nodiscard]] void* memory(std::size_t k) const {
    void* found = nullptr;
    std::size_t bytes = 0;
    check(cudaGraphicsResourceGetMappedPointer(&found, &bytes, resources_[k]), "cudaGraphicsResourceGetMappedPointer");
    return found;
  }

 private:
  std::array<cudaGraphicsResource_t, 2> resources_;
  cudaStream_t stream_;
  bool open_ = true;
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

class CudaWay final : public Way {
 public:
  CudaWay(const Options& options, int device)
      : device_(device), stream_(device), triangulator_(on_stream(options, stream_.handle)) {}
  Triangulator& triangulator() noexcept override { return triangulator_; }

  std::size_t triangulate(MeshBuffers& mesh, Statistics* statistics) override {
    check(cudaSetDevice(device_), "cudaSetDevice");
    Mapped mapped({points_.resource_of(mesh.points), triangles_.resource_of(mesh.triangles)}, stream_.handle);
    const DevicePoints points{.x = mapped.memory(0), .size = mesh.point_count};
    const DeviceArray triangles{mapped.memory(1), mesh.triangles.bytes() / sizeof(std::int32_t)};
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
  Registered points_{cudaGraphicsRegisterFlagsReadOnly}, triangles_{cudaGraphicsRegisterFlagsWriteDiscard};
};

}  // namespace

std::unique_ptr<Way> open_cuda(const Options& options, std::string& reason) {
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
  return std::make_unique<CudaWay>(options, *display);
}

}  // namespace cadt::viewer

#else

namespace cadt::viewer {

std::unique_ptr<Way> open_cuda(const Options&, std::string& reason) {
  reason = "this build is without CUDA";
  return nullptr;
}

}  // namespace cadt::viewer

#endif
