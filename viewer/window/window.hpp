// SPDX-License-Identifier: Apache-2.0
// A window of the system with OpenGL 4.5 and Dear ImGui.
#pragma once

#include "viewer/gl/context.hpp"

#include <array>
#include <functional>
#include <memory>
#include <string>

struct GLFWwindow;

namespace cadt::viewer {

/// What the user does, in pixels of the picture (framebuffer), x right and y down.
struct Events {
  std::function<void(char32_t)> character;
  std::function<void(int key, int modifiers, bool repeated)> key;
  std::function<void(int button, bool down, int modifiers, double x, double y)> button;
  std::function<void(double x, double y)> move;
  std::function<void(double dx, double dy, int modifiers, double x, double y)> scroll;
};

class Window {
 public:
  /// \throws DisplayError: no display, no OpenGL, one that is too old
  Window(const std::string& title, int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  void listen(Events events);
  [[nodiscard]] bool should_close() const;
  void set_title(const std::string& title);
  void hide();
  void close();
  void toggle_full_screen();
  /// Waits for events for so long at most; below 0: however long. True: there was one.
  bool wait(double seconds);
  /// Ends wait(); from any thread.
  static void wake();

  /// Pixels of the picture.
  [[nodiscard]] std::array<int, 2> size() const;
  [[nodiscard]] bool visible() const;
  /// Pixels for a 96th of an inch, as the system has them.
  [[nodiscard]] double content_scale() const;
  [[nodiscard]] std::array<double, 2> cursor() const;
  [[nodiscard]] int modifiers() const;
  [[nodiscard]] const gl::DriverInfo& driver() const noexcept { return driver_; }
  /// The driver was reset: nothing can be drawn any more.
  [[nodiscard]] bool lost() const;

  /// Fonts and colours of what ImGui draws. To be called between frames.
  void set_look(bool dark, double scale);
  void begin_frame();
  /// Draws what ImGui has. `before_show` is called when the picture is complete.
  void end_frame(const std::array<float, 3>& background, const std::function<void()>& before_show);

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
  gl::DriverInfo driver_;
};

}  // namespace cadt::viewer
