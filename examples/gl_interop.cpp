// SPDX-License-Identifier: Apache-2.0
// A kernel moves points in a vertex buffer of OpenGL, cadt writes their triangles into an index buffer, OpenGL draws
// both: each frame anew, and nothing goes through the host but the number of triangles. Compiled by nvcc.
//
// usage: example-gl-interop [points]               a window, until it is closed
//        example-gl-interop --headless [points]    60 frames without a window, and a look at the last one
// Ends with 77 where no display belongs to a CUDA device.
#include <cadt/cadt.hpp>

#include <epoxy/gl.h>

#define EGL_NO_X11
#include <epoxy/egl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <cuda_gl_interop.h>
#include <cuda_runtime.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr int width = 960, height = 960, not_here = 77;
constexpr double pi = 3.14159265358979323846;

struct NotHere : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void check(cudaError_t code) {
  if (code != cudaSuccess) throw std::runtime_error(cudaGetErrorString(code));
}

/// The seeds of a sunflower, twisted by waves that run outwards.
__global__ void grow(double2* points, std::size_t n, double time) {
  const std::size_t i = blockIdx.x * std::size_t{blockDim.x} + threadIdx.x;
  if (i >= n) return;
  const double r = sqrt((static_cast<double>(i) + 0.5) / static_cast<double>(n));
  const double angle = 2.39996322972865332 * static_cast<double>(i) + 0.4 * sin(12.0 * r - 2.0 * time);
  points[i] = make_double2(r * cos(angle), r * sin(angle));
}

/// OpenGL without a window, on the device that CUDA uses.
void open_headless() {
  if (!epoxy_has_egl()) throw NotHere("no libEGL");
  EGLDeviceEXT devices[16];
  EGLint count = 0;
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base") || !eglQueryDevicesEXT(16, devices, &count))
    throw NotHere("EGL lists no devices");
  for (EGLint i = 0; i < count; ++i) {
    EGLAttrib cuda = -1;
    const std::string extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
    if (extensions.find("EGL_NV_device_cuda") == std::string::npos) continue;
    if (!eglQueryDeviceAttribEXT(devices[i], EGL_CUDA_DEVICE_NV, &cuda) || cuda < 0) continue;
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
    if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API)) continue;
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
    const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
    if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) continue;
    check(cudaSetDevice(static_cast<int>(cuda)));
    GLuint image = 0, frame = 0;  // what is drawn into in place of a window
    glCreateRenderbuffers(1, &image);
    glNamedRenderbufferStorage(image, GL_RGBA8, width, height);
    glCreateFramebuffers(1, &frame);
    glNamedFramebufferRenderbuffer(frame, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, image);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    return;
  }
  throw NotHere("no display of EGL belongs to a CUDA device");
}

GLFWwindow* open_window() {
  if (!glfwInit()) throw NotHere("no display for a window");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  GLFWwindow* const window = glfwCreateWindow(width, height, "cadt", nullptr, nullptr);
  if (window == nullptr) throw NotHere("no window with OpenGL 4.5");
  glfwMakeContextCurrent(window);
  unsigned count = 0;
  int device = 0;
  if (cudaGLGetDevices(&count, &device, 1, cudaGLDeviceListAll) != cudaSuccess || count == 0)
    throw NotHere("the window belongs to no CUDA device");
  check(cudaSetDevice(device));
  return window;
}

void attach(GLuint program, GLenum kind, const char* text) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  glAttachShader(program, shader);
}

/// Points of the unit disc, one colour for each triangle.
GLuint make_program() {
  const GLuint program = glCreateProgram();
  attach(program, GL_VERTEX_SHADER, R"(#version 450 core
    layout(location = 0) in dvec2 at;
    void main() { gl_Position = vec4(0.95 * vec2(at), 0.0, 1.0); })");
  attach(program, GL_FRAGMENT_SHADER, R"(#version 450 core
    out vec4 colour;
    void main() { colour = vec4(0.55 + 0.4 * cos(float(gl_PrimitiveID) * 0.618 + vec3(0.0, 1.0, 2.0)), 1.0); })");
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) throw std::runtime_error("the OpenGL driver cannot compile the shaders");
  return program;
}

/// The share of the picture that the disc covers.
double covered() {
  std::vector<unsigned char> pixels(std::size_t{4} * width * height);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  std::size_t drawn = 0;
  for (std::size_t i = 3; i < pixels.size(); i += 4) drawn += pixels[i] != 0 ? 1 : 0;
  return static_cast<double>(drawn) / (width * height);
}

void run(std::size_t n, bool headless) {
  GLFWwindow* window = nullptr;
  if (headless) {
    open_headless();
  } else {
    window = open_window();
  }
  // Room for n points, and for two triangles a point: there are no more.
  GLuint buffers[2] = {}, array = 0;
  glCreateBuffers(2, buffers);
  glNamedBufferStorage(buffers[0], static_cast<GLsizeiptr>(n * sizeof(double2)), nullptr, 0);
  glNamedBufferStorage(buffers[1], static_cast<GLsizeiptr>(2 * n * 3 * sizeof(int)), nullptr, 0);
  glCreateVertexArrays(1, &array);
  glVertexArrayVertexBuffer(array, 0, buffers[0], 0, sizeof(double2));
  glVertexArrayElementBuffer(array, buffers[1]);
  glVertexArrayAttribLFormat(array, 0, 2, GL_DOUBLE, 0);
  glEnableVertexArrayAttrib(array, 0);
  glBindVertexArray(array);
  glUseProgram(make_program());
  glViewport(0, 0, width, height);

  cudaGraphicsResource_t shared[2] = {};
  for (int k = 0; k < 2; ++k)
    check(cudaGraphicsGLRegisterBuffer(&shared[k], buffers[k], cudaGraphicsRegisterFlagsWriteDiscard));
  cudaStream_t stream = nullptr;
  check(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking));
  cadt::Options options;
  options.backend = cadt::Backend::cuda;
  options.queue = stream;  // all work of the library is put here, behind the kernel
  options.order = cadt::Order::fast;
  options.statistics = cadt::StatisticsDetail::none;  // no waiting
  cadt::Triangulator triangulator(options);

  const auto start = std::chrono::steady_clock::now();
  std::size_t count = 0;
  int frame = 0;
  for (; headless ? frame < 60 : !glfwWindowShouldClose(window); ++frame) {
    check(cudaGraphicsMapResources(2, shared, stream));  // OpenGL must not use them until they are unmapped
    void* memory[2] = {};
    std::size_t bytes = 0;
    for (int k = 0; k < 2; ++k) check(cudaGraphicsResourceGetMappedPointer(&memory[k], &bytes, shared[k]));
    grow<<<static_cast<unsigned>((n + 255) / 256), 256, 0, stream>>>(static_cast<double2*>(memory[0]), n, frame / 60.0);
    check(cudaGetLastError());
    count = triangulator.triangulate(cadt::DevicePoints{.x = memory[0], .size = n}, cadt::DeviceArray{memory[1], 6 * n},
                                     {});
    check(cudaGraphicsUnmapResources(2, shared, stream));  // what OpenGL does now comes after the work of the stream

    glClear(GL_COLOR_BUFFER_BIT);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * count), GL_UNSIGNED_INT, nullptr);
    if (headless) continue;
    glfwSwapBuffers(window);
    glfwPollEvents();
  }
  glFinish();
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  std::printf("points     %zu\ntriangles  %zu\nframe      %.2f ms\ndevice     %s\n", n, count, time.count() / frame,
              triangulator.device().name.c_str());
  for (cudaGraphicsResource_t resource : shared) check(cudaGraphicsUnregisterResource(resource));
  if (headless && std::abs(covered() - pi * 0.95 * 0.95 / 4) > 0.01)
    throw std::runtime_error("the picture is not the disc");
}

}  // namespace

int main(int count, char** values) {
  try {
    const bool headless = count > 1 && std::string(values[1]) == "--headless";
    const char* const number = count > 1 + headless ? values[1 + headless] : "200000";
    run(std::strtoul(number, nullptr, 10), headless);
    return EXIT_SUCCESS;
  } catch (const NotHere& reason) {
    std::fprintf(stderr, "example-gl-interop: %s\n", reason.what());
    return not_here;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "example-gl-interop: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
