// SPDX-License-Identifier: Apache-2.0
// OpenCL reads and writes the buffers of OpenGL, by cl_khr_gl_sharing. The loader is looked for at run time, as the
// library does.
#include "viewer/mesh/interop.hpp"

#include <epoxy/gl.h>

#include <epoxy/egl.h>
#if !defined(_WIN32) && !defined(__APPLE__)
#include <epoxy/glx.h>

#include <dlfcn.h>
#endif

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#include <CL/cl_gl.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace cadt::viewer {
namespace {

/// A function of the loader.
template <class F>
F find(const char* name) {
#if defined(_WIN32) || defined(__APPLE__)
  (void)name;
  return nullptr;
#else
  static void* const library = dlopen("libOpenCL.so.1", RTLD_NOW | RTLD_LOCAL);
  return library == nullptr ? nullptr : reinterpret_cast<F>(dlsym(library, name));
#endif
}
#define CADT_CL(name) const decltype(&::name) name = find<decltype(&::name)>(#name)

/// What is called of OpenCL.
struct Functions {
  CADT_CL(clGetPlatformIDs);
  CADT_CL(clGetPlatformInfo);
  CADT_CL(clGetDeviceIDs);
  CADT_CL(clGetDeviceInfo);
  CADT_CL(clGetExtensionFunctionAddressForPlatform);
  CADT_CL(clCreateContext);
  CADT_CL(clReleaseContext);
  CADT_CL(clCreateCommandQueue);
  CADT_CL(clReleaseCommandQueue);
  CADT_CL(clReleaseMemObject);
  CADT_CL(clEnqueueCopyBuffer);
  CADT_CL(clFinish);
  CADT_CL(clCreateFromGLBuffer);
  CADT_CL(clEnqueueAcquireGLObjects);
  CADT_CL(clEnqueueReleaseGLObjects);
  [[nodiscard]] bool complete() const { return clGetPlatformIDs != nullptr && clCreateFromGLBuffer != nullptr; }
};
#undef CADT_CL
const Functions& cl() {
  static const Functions functions;
  return functions;
}

void check(cl_int code, const char* call) {
  if (code != CL_SUCCESS) throw DeviceError(call, code, "OpenCL", "see the error codes of CL/cl.h");
}

std::string text_of(cl_platform_id platform, cl_platform_info what) {
  std::size_t size = 0;
  if (cl().clGetPlatformInfo(platform, what, 0, nullptr, &size) != CL_SUCCESS || size == 0) return {};
  std::string text(size, '\0');
  if (cl().clGetPlatformInfo(platform, what, size, text.data(), nullptr) != CL_SUCCESS) return {};
  text.pop_back();
  return text;
}

std::string text_of(cl_device_id device, cl_device_info what) {
  std::size_t size = 0;
  if (cl().clGetDeviceInfo(device, what, 0, nullptr, &size) != CL_SUCCESS || size == 0) return {};
  std::string text(size, '\0');
  if (cl().clGetDeviceInfo(device, what, size, text.data(), nullptr) != CL_SUCCESS) return {};
  text.pop_back();
  return text;
}

/// By the platform, or by a device of it.
bool has_sharing(cl_platform_id platform) {
  constexpr char name[] = "cl_khr_gl_sharing";
  if (text_of(platform, CL_PLATFORM_EXTENSIONS).find(name) != std::string::npos) return true;
  cl_uint count = 0;
  if (cl().clGetDeviceIDs(platform, CL_DEVICE_TYPE_GPU, 0, nullptr, &count) != CL_SUCCESS) return false;
  std::vector<cl_device_id> devices(count);
  if (cl().clGetDeviceIDs(platform, CL_DEVICE_TYPE_GPU, count, devices.data(), nullptr) != CL_SUCCESS) return false;
  for (cl_device_id device : devices)
    if (text_of(device, CL_DEVICE_EXTENSIONS).find(name) != std::string::npos) return true;
  return false;
}

/// The properties of a context that shares with the one of OpenGL that is current; empty if it is of another kind.
std::vector<cl_context_properties> sharing_properties(cl_platform_id platform) {
  std::vector<cl_context_properties> list;
  const auto share = [&](void* context, cl_context_properties kind, void* display) {
    list = {CL_CONTEXT_PLATFORM,
            reinterpret_cast<cl_context_properties>(platform),
            CL_GL_CONTEXT_KHR,
            reinterpret_cast<cl_context_properties>(context),
            kind,
            reinterpret_cast<cl_context_properties>(display),
            0};
  };
#if !defined(_WIN32) && !defined(__APPLE__)
  // epoxy ends the program if a library is not there.
  if (epoxy_has_egl() && eglGetCurrentContext() != EGL_NO_CONTEXT)
    share(eglGetCurrentContext(), CL_EGL_DISPLAY_KHR, eglGetCurrentDisplay());
  else if (GLXContext context = glXGetCurrentContext(); context != nullptr)
    share(context, CL_GLX_DISPLAY_KHR, glXGetCurrentDisplay());
#endif
  return list;
}

/// The device of a platform that draws the current context; null if none does.
cl_device_id device_of_display(cl_platform_id platform, const std::vector<cl_context_properties>& properties) {
  const auto query = reinterpret_cast<clGetGLContextInfoKHR_fn>(
      cl().clGetExtensionFunctionAddressForPlatform(platform, "clGetGLContextInfoKHR"));
  cl_device_id device = nullptr;
  if (query == nullptr ||
      query(properties.data(), CL_CURRENT_DEVICE_FOR_GL_CONTEXT_KHR, sizeof device, &device, nullptr) != CL_SUCCESS)
    return nullptr;
  return device;
}

/// A context with one in-order queue.
struct Queue {
  cl_context context = nullptr;
  cl_command_queue handle = nullptr;
  Queue(const std::vector<cl_context_properties>& properties, cl_device_id device) {
    cl_int code = CL_SUCCESS;
    context = cl().clCreateContext(properties.data(), 1, &device, nullptr, nullptr, &code);
    check(code, "clCreateContext");
    handle = cl().clCreateCommandQueue(context, device, 0, &code);
    if (code != CL_SUCCESS) cl().clReleaseContext(context);
    check(code, "clCreateCommandQueue");
  }
  ~Queue() {
    cl().clReleaseCommandQueue(handle);
    cl().clReleaseContext(context);
  }
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;
};

/// A buffer of OpenGL's that OpenCL knows.
class Shared {
 public:
  explicit Shared(cl_mem_flags flags) : flags_(flags) {}
  ~Shared() { forget(); }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;

  cl_mem memory_of(const gl::Buffer& buffer, cl_context context) {
    if (serial_ != buffer.serial()) {
      forget();
      cl_int code = CL_SUCCESS;
      memory_ = cl().clCreateFromGLBuffer(context, flags_, buffer.id(), &code);
      check(code, "clCreateFromGLBuffer");
      serial_ = buffer.serial();
    }
    return memory_;
  }

 private:
  void forget() {
    if (memory_ != nullptr) cl().clReleaseMemObject(std::exchange(memory_, nullptr));
    serial_ = 0;
  }
  cl_mem memory_ = nullptr;
  cl_mem_flags flags_;
  std::uint64_t serial_ = 0;
};

/// OpenGL must not use the buffers while this lives.
class Acquired {
 public:
  Acquired(std::vector<cl_mem> memory, cl_command_queue queue) : memory_(std::move(memory)), queue_(queue) {
    glFinish();  // what OpenGL was told before; without cl_khr_gl_event there is no other way
    check(cl().clEnqueueAcquireGLObjects(queue_, static_cast<cl_uint>(memory_.size()), memory_.data(), 0, nullptr,
                                         nullptr),
          "clEnqueueAcquireGLObjects");
  }
  ~Acquired() {
    if (!memory_.empty()) (void)give_back();
  }
  Acquired(const Acquired&) = delete;
  Acquired& operator=(const Acquired&) = delete;
  void release() { check(give_back(), "clEnqueueReleaseGLObjects"); }

 private:
  cl_int give_back() {
    const cl_int code = cl().clEnqueueReleaseGLObjects(queue_, static_cast<cl_uint>(memory_.size()), memory_.data(), 0,
                                                       nullptr, nullptr);
    memory_.clear();
    const cl_int finished = cl().clFinish(queue_);
    return code != CL_SUCCESS ? code : finished;
  }
  std::vector<cl_mem> memory_;
  cl_command_queue queue_;
};

class OpenClInterop final : public MeshInterop {
 public:
  OpenClInterop(const Options& options, const std::vector<cl_context_properties>& properties, cl_device_id device)
      : queue_(properties, device), triangulator_(on_queue(options, queue_.handle)) {}
  Triangulator& triangulator() noexcept override { return triangulator_; }

  std::size_t triangulate(MeshBuffers& mesh, Statistics* statistics) override {
    const cl_mem points = points_.memory_of(mesh.points, queue_.context);
    const cl_mem triangles = triangles_.memory_of(mesh.triangles, queue_.context);
    Acquired acquired({points, triangles}, queue_.handle);
    const DevicePoints input{.x = points, .size = mesh.point_count};
    const Detail detail(triangulator_.options(), statistics != nullptr);
    std::size_t count = 0;
    if (statistics != nullptr) {
      const DeviceTriangulation result = triangulator_.triangulate(input);
      count = result.number_of_triangles();
      if (count != 0)
        check(cl().clEnqueueCopyBuffer(queue_.handle, static_cast<cl_mem>(result.triangles()), triangles, 0, 0,
                                       count * 3 * sizeof(std::int32_t), 0, nullptr, nullptr),
              "clEnqueueCopyBuffer");
      *statistics = result.statistics();
    } else {
      count =
          triangulator_.triangulate(input, DeviceArray{triangles, mesh.triangles.bytes() / sizeof(std::int32_t)}, {});
    }
    acquired.release();
    return count;
  }

 private:
  static Options on_queue(Options options, cl_command_queue queue) {
    options.backend = Backend::opencl;
    options.device.clear();  // the queue has one
    options.queue = queue;
    return options;
  }

  Queue queue_;
  Triangulator triangulator_;
  Shared points_{CL_MEM_READ_ONLY}, triangles_{CL_MEM_READ_WRITE};
};

}  // namespace

std::unique_ptr<MeshInterop> open_opencl(const Options& options, std::string& reason) {
  if (!cl().complete()) {
    reason = "there is no OpenCL loader with the functions for OpenGL (libOpenCL.so.1)";
    return nullptr;
  }
  cl_uint count = 0;
  if (cl().clGetPlatformIDs(0, nullptr, &count) != CL_SUCCESS || count == 0) {
    reason = "there is no OpenCL platform";
    return nullptr;
  }
  std::vector<cl_platform_id> platforms(count);
  check(cl().clGetPlatformIDs(count, platforms.data(), nullptr), "clGetPlatformIDs");
  for (cl_platform_id platform : platforms) {
    const std::string name = text_of(platform, CL_PLATFORM_NAME);
    if (!has_sharing(platform)) {
      reason += (reason.empty() ? "" : ", ") + ("'" + name + "' has no cl_khr_gl_sharing");
      continue;
    }
    const std::vector<cl_context_properties> properties = sharing_properties(platform);
    cl_device_id const device = properties.empty() ? nullptr : device_of_display(platform, properties);
    if (device == nullptr) {
      reason += (reason.empty() ? "" : ", ") + ("no device of '" + name + "' draws for '" + name_of_display() + "'");
      continue;
    }
    DeviceInfo info;
    info.name = text_of(device, CL_DEVICE_NAME);
    info.platform = name;
    if (!is_named(info, options.device)) {
      reason += (reason.empty() ? "" : ", ") +
                ("the display belongs to '" + info.name + "', not to '" + options.device + "'");
      continue;
    }
    return std::make_unique<OpenClInterop>(options, properties, device);
  }
  return nullptr;
}

}  // namespace cadt::viewer
