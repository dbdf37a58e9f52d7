// SPDX-License-Identifier: Apache-2.0
#include "viewer/gl/context.hpp"

#include "viewer/gl/errors.hpp"

#include <epoxy/gl.h>

#include <epoxy/egl.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace cadt::viewer::gl {
namespace {

constexpr char advice[] =
    "install a driver with OpenGL 4.5: for NVIDIA's cards libegl1 beside their driver, for others and for drawing "
    "without a card libegl1, libegl-mesa0 and libgl1-mesa-dri (Debian, Ubuntu)";

/// A number of EGL errors that users meet, in words.
std::string egl_error() {
  switch (const EGLint code = eglGetError()) {
    case EGL_NOT_INITIALIZED:
      return "EGL could not be initialised";
    case EGL_BAD_ALLOC:
      return "EGL ran out of memory";
    case EGL_CONTEXT_LOST:
      return "the context is lost: the driver was reset, or the machine slept";
    case EGL_BAD_MATCH:
    case EGL_BAD_ATTRIBUTE:
    case EGL_BAD_CONFIG:
      return "the driver has no OpenGL 4.5";
    default:
      return "EGL error " + std::to_string(code);
  }
}

/// Whether a list of words, separated by spaces, has this one.
bool has(const char* extensions, std::string_view name) {
  for (std::string_view rest = extensions == nullptr ? "" : extensions; !rest.empty();) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    if (word == name) return true;
    rest.remove_prefix(std::min(rest.size(), word.size() + 1));
  }
  return false;
}

std::vector<EGLDeviceEXT> egl_devices() {
  if (!has(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_EXT_device_enumeration") &&
      !has(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_EXT_device_base"))
    return {};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(0, nullptr, &count)) return {};
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  if (!eglQueryDevicesEXT(count, devices.data(), &count)) return {};
  devices.resize(static_cast<std::size_t>(count));
  return devices;
}

bool is_software(EGLDeviceEXT device) {
  return has(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

std::optional<int> cuda_device(EGLDeviceEXT device) {
  EGLAttrib number = 0;
  if (!has(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_NV_device_cuda") ||
      !eglQueryDeviceAttribEXT(device, EGL_CUDA_DEVICE_NV, &number))
    return std::nullopt;
  return static_cast<int>(number);
}

/// Displays to try, the best first.
std::vector<EGLDisplay> displays(std::optional<int> cuda) {
  std::vector<EGLDisplay> gpu, software;
  for (EGLDeviceEXT device : egl_devices()) {
    if (cuda && cuda_device(device) != cuda) continue;
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
    if (display == EGL_NO_DISPLAY) continue;
    (is_software(device) ? software : gpu).push_back(display);
  }
  if (!cuda && has(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless")) {
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    if (display != EGL_NO_DISPLAY) software.push_back(display);
  }
  gpu.insert(gpu.end(), software.begin(), software.end());
  return gpu;
}

std::atomic<int> errors{0};

void GLAPIENTRY on_message(GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* text, const void*) {
  if (type != GL_DEBUG_TYPE_ERROR) return;
  ++errors;
  if (std::getenv("CADT_GL_DEBUG") != nullptr) std::fprintf(stderr, "OpenGL: %s\n", text);
}

}  // namespace

DriverInfo check_driver() {
  const auto text = [](GLenum name) {
    const GLubyte* found = glGetString(name);
    return found == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(found));
  };
  DriverInfo info{text(GL_RENDERER), text(GL_VERSION), false};
  info.software =
      info.renderer.find("llvmpipe") != std::string::npos || info.renderer.find("softpipe") != std::string::npos;
  if (epoxy_gl_version() < 45) {
    throw DisplayError("the OpenGL of '" + info.renderer + "' is too old (" + info.version +
                       "), 4.5 is needed: " + advice);
  }
  return info;
}

void watch_errors() {
  errors = 0;
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(on_message, nullptr);
}

int errors_seen() {
  for (GLenum code = glGetError(); code != GL_NO_ERROR; code = glGetError()) {
    ++errors;
    if (code == GL_CONTEXT_LOST) break;  // it would be returned for ever
  }
  return errors;
}

struct HeadlessContext::Handles {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  ~Handles() {
    if (context != EGL_NO_CONTEXT) {
      eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      eglDestroyContext(display, context);
    }
    if (display != EGL_NO_DISPLAY) eglTerminate(display);
  }
};

HeadlessContext::HeadlessContext(std::optional<int> cuda) {
  // epoxy ends the program if there is no library to load.
  if (!epoxy_has_egl()) throw DisplayError(std::string("there is no libEGL.so.1: ") + advice);
  std::string reason = cuda ? "no display belongs to CUDA device " + std::to_string(*cuda) : "EGL has no device";
  for (const EGLDisplay display : displays(cuda)) {
    auto handles = std::make_unique<Handles>();
    if (!eglInitialize(display, nullptr, nullptr)) {
      reason = egl_error();
      continue;
    }
    handles->display = display;
    eglBindAPI(EGL_OPENGL_API);
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                             4,
                             EGL_CONTEXT_MINOR_VERSION,
                             5,
                             EGL_CONTEXT_OPENGL_PROFILE_MASK,
                             EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                             EGL_CONTEXT_OPENGL_DEBUG,
                             EGL_TRUE,
                             EGL_NONE};
    handles->context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
    if (handles->context == EGL_NO_CONTEXT ||
        !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, handles->context)) {
      reason = egl_error();
      continue;
    }
    handles_ = std::move(handles);
    driver_ = check_driver();
    watch_errors();
    return;
  }
  throw DisplayError("no OpenGL without a window: " + reason + "; " + advice);
}

HeadlessContext::~HeadlessContext() = default;

std::optional<int> cuda_device_of_display() {
  if (!epoxy_has_egl()) return std::nullopt;
  const EGLDisplay display = eglGetCurrentDisplay();
  EGLAttrib device = 0;
  if (display == EGL_NO_DISPLAY || !has(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_EXT_device_query") ||
      !eglQueryDisplayAttribEXT(display, EGL_DEVICE_EXT, &device))
    return std::nullopt;
  return cuda_device(reinterpret_cast<EGLDeviceEXT>(device));
}

}  // namespace cadt::viewer::gl
