// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/window.hpp"

#include "viewer/gl/errors.hpp"
#include "viewer/window/look.hpp"

#include <epoxy/gl.h>
// epoxy's names first
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

namespace cadt::viewer {
namespace {

/// The last thing that GLFW said, until it is asked.
std::string& last_error() {
  static std::string text;
  return text;
}

std::string no_window(const std::string& reason) {
  return "no window can be opened (" + reason +
         "). On a machine without a display make a picture with `cadt render`; over ssh use `ssh -X` (OpenGL 4.5 is "
         "needed here then) or run it there under `xvfb-run`";
}

}  // namespace

struct Window::Handles {
  GLFWwindow* window = nullptr;
  bool glfw = false, imgui = false, backends = false, events = false;
  Events listener;
  std::array<int, 4> before_full_screen{};
  std::optional<std::array<double, 2>> pointer;  ///< where it was at the event: it may have moved on since

  ~Handles() {
    if (backends) {
      ImGui_ImplOpenGL3_Shutdown();
      ImGui_ImplGlfw_Shutdown();
    }
    if (imgui) ImGui::DestroyContext();
    if (window != nullptr) glfwDestroyWindow(window);
    if (glfw) glfwTerminate();
  }

  static Handles& of(GLFWwindow* window) { return *static_cast<Handles*>(glfwGetWindowUserPointer(window)); }

  [[nodiscard]] std::array<double, 2> in_picture(double x, double y) const {
    int ww = 1, wh = 1, pw = 1, ph = 1;
    glfwGetWindowSize(window, &ww, &wh);
    glfwGetFramebufferSize(window, &pw, &ph);
    return {x * pw / std::max(1, ww), y * ph / std::max(1, wh)};
  }
  [[nodiscard]] std::array<double, 2> cursor() const {
    double x = 0, y = 0;
    glfwGetCursorPos(window, &x, &y);
    return in_picture(x, y);
  }
  [[nodiscard]] std::array<double, 2> place_of_event() const { return pointer ? *pointer : cursor(); }
  [[nodiscard]] int modifiers() const {
    const auto down = [&](int key) { return glfwGetKey(window, key) == GLFW_PRESS; };
    return (down(GLFW_KEY_LEFT_SHIFT) || down(GLFW_KEY_RIGHT_SHIFT) ? GLFW_MOD_SHIFT : 0) |
           (down(GLFW_KEY_LEFT_CONTROL) || down(GLFW_KEY_RIGHT_CONTROL) ? GLFW_MOD_CONTROL : 0);
  }

  void install_callbacks() {
    glfwSetWindowUserPointer(window, this);
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned c) {
      of(w).events = true;
      if (of(w).listener.character) of(w).listener.character(c);
    });
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int modifiers) {
      of(w).events = true;
      if (action != GLFW_RELEASE && of(w).listener.key)
        of(w).listener.key(key, modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL), action == GLFW_REPEAT);
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int modifiers) {
      of(w).events = true;
      const auto [x, y] = of(w).place_of_event();
      if (of(w).listener.button) of(w).listener.button(button, action == GLFW_PRESS, modifiers, x, y);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
      of(w).events = true;
      of(w).pointer = of(w).in_picture(x, y);
      const auto [px, py] = *of(w).pointer;
      if (of(w).listener.move) of(w).listener.move(px, py);
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double dx, double dy) {
      of(w).events = true;
      const auto [x, y] = of(w).place_of_event();
      if (of(w).listener.scroll) of(w).listener.scroll(dx, dy, of(w).modifiers(), x, y);
    });
    const auto touched = [](GLFWwindow* w, int) { of(w).events = true; };
    glfwSetCursorEnterCallback(window, touched);
    glfwSetWindowFocusCallback(window, touched);
    glfwSetWindowIconifyCallback(window, touched);
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).events = true; });
    // The window moves under a pointer that rests: no event says where in the window that is now.
    const auto moved = [](GLFWwindow* w, int, int) {
      of(w).events = true;
      of(w).pointer.reset();
    };
    glfwSetFramebufferSizeCallback(window, moved);
    glfwSetWindowPosCallback(window, moved);
    glfwSetWindowContentScaleCallback(window, [](GLFWwindow* w, float, float) { of(w).events = true; });
    glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { of(w).events = true; });
  }
};

Window::Window(const std::string& title, int width, int height) : handles_(std::make_unique<Handles>()) {
  Handles& h = *handles_;
  glfwSetErrorCallback([](int, const char* text) { last_error() = text; });
  if (glfwInit() != GLFW_TRUE) throw DisplayError(no_window(last_error()));
  h.glfw = true;
  // EGL first: it says which CUDA device draws.
  for (const int api : {GLFW_EGL_CONTEXT_API, GLFW_NATIVE_CONTEXT_API}) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, api);
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, std::getenv("CADT_GL_DEBUG") != nullptr ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    h.window = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (h.window != nullptr) break;
  }
  if (h.window == nullptr)
    throw DisplayError(
        "this display has no OpenGL 4.5 (" + last_error() +
        "): install or update the driver of its card (without a card: libgl1-mesa-dri); `cadt render` makes "
        "pictures without a display");
  glfwSetWindowSizeLimits(h.window, 320, 240, GLFW_DONT_CARE, GLFW_DONT_CARE);
  glfwMakeContextCurrent(h.window);
  driver_ = gl::check_driver();
  gl::watch_errors();
  glfwSwapInterval(1);
  h.install_callbacks();

  ImGui::CreateContext();
  h.imgui = true;
  ImGui::GetIO().IniFilename = nullptr;  // nothing is remembered
  ImGui::GetIO().LogFilename = nullptr;
  h.backends = ImGui_ImplGlfw_InitForOpenGL(h.window, true) && ImGui_ImplOpenGL3_Init("#version 150");
}

Window::~Window() = default;

void Window::listen(Events events) { handles_->listener = std::move(events); }
bool Window::should_close() const { return glfwWindowShouldClose(handles_->window) == GLFW_TRUE; }
void Window::set_title(const std::string& title) { glfwSetWindowTitle(handles_->window, title.c_str()); }
void Window::close() { glfwSetWindowShouldClose(handles_->window, GLFW_TRUE); }
void Window::hide() { glfwHideWindow(handles_->window); }

void Window::toggle_full_screen() {
  GLFWwindow* const window = handles_->window;
  auto& [x, y, w, h] = handles_->before_full_screen;
  if (glfwGetWindowMonitor(window) != nullptr) {
    glfwSetWindowMonitor(window, nullptr, x, y, w, h, GLFW_DONT_CARE);
    return;
  }
  glfwGetWindowPos(window, &x, &y);
  glfwGetWindowSize(window, &w, &h);
  // The monitor that shows the middle of the window.
  int count = 0;
  GLFWmonitor** const monitors = glfwGetMonitors(&count);
  GLFWmonitor* chosen = glfwGetPrimaryMonitor();
  for (int i = 0; i < count; ++i) {
    int mx = 0, my = 0;
    glfwGetMonitorPos(monitors[i], &mx, &my);
    const GLFWvidmode* const mode = glfwGetVideoMode(monitors[i]);
    const int cx = x + w / 2, cy = y + h / 2;
    if (cx >= mx && cy >= my && cx < mx + mode->width && cy < my + mode->height) chosen = monitors[i];
  }
  if (chosen == nullptr) return;
  const GLFWvidmode* const mode = glfwGetVideoMode(chosen);
  glfwSetWindowMonitor(window, chosen, 0, 0, mode->width, mode->height, mode->refreshRate);
}

bool Window::wait(double seconds) {
  handles_->events = false;
  if (seconds < 0)
    glfwWaitEvents();
  else if (seconds == 0)
    glfwPollEvents();
  else
    glfwWaitEventsTimeout(seconds);
  return handles_->events;
}

void Window::wake() { glfwPostEmptyEvent(); }

std::array<int, 2> Window::size() const {
  std::array<int, 2> size{};
  glfwGetFramebufferSize(handles_->window, &size[0], &size[1]);
  return size;
}

bool Window::visible() const {
  const auto [w, h] = size();
  return w > 0 && h > 0 && glfwGetWindowAttrib(handles_->window, GLFW_ICONIFIED) == GLFW_FALSE;
}

double Window::content_scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(handles_->window, &x, &y);
  return std::clamp(static_cast<double>(std::max(x, y)), 0.5, 8.0);
}

std::array<double, 2> Window::cursor() const { return handles_->cursor(); }
int Window::modifiers() const { return handles_->modifiers(); }
bool Window::lost() const { return glGetGraphicsResetStatus() != GL_NO_ERROR; }

void Window::set_look(bool dark, double scale) {
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  load_fonts(scale);
  set_colours(dark, scale);
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Window::begin_frame() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Window::end_frame(const std::array<float, 3>& background, const std::function<void()>& before_show) {
  ImGui::Render();
  const auto [w, h] = size();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, w, h);
  glClearColor(background[0], background[1], background[2], 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (before_show) before_show();
  glfwSwapBuffers(handles_->window);
}

}  // namespace cadt::viewer
