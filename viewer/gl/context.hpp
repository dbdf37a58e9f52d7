// SPDX-License-Identifier: Apache-2.0
// OpenGL without a window, by EGL.
#pragma once

#include <memory>
#include <optional>
#include <string>

namespace cadt::viewer::gl {

/// What the driver says of itself.
struct DriverInfo {
  std::string renderer, version;
  bool software = false;  ///< the CPU draws
};

/// Reads the strings of the context that is current, and throws DisplayError if it lacks what the viewer needs: OpenGL
/// 4.5 with compute shaders and doubles.
[[nodiscard]] DriverInfo check_driver();

/// Counts errors that the driver reports for the context that is current, and prints each to standard error if
/// CADT_GL_DEBUG is set. The context must have been created with the debug flag.
void watch_errors();
/// Errors since watch_errors(), and those that glGetError still holds.
[[nodiscard]] int errors_seen();

/// A context that draws into memory. Current on the thread that created it until it is destroyed.
class HeadlessContext {
 public:
  /// Takes the EGL device of this CUDA device if one is named (EGL_CUDA_DEVICE_NV), else the first GPU, else software.
  /// \throws DisplayError
  explicit HeadlessContext(std::optional<int> cuda_device = std::nullopt);
  ~HeadlessContext();
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

  [[nodiscard]] const DriverInfo& driver() const noexcept { return driver_; }

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
  DriverInfo driver_;
};

/// Number of the CUDA device that draws the context that is current on this thread, by EGL; empty if that is none, or
/// the driver does not say.
[[nodiscard]] std::optional<int> cuda_device_of_display();

}  // namespace cadt::viewer::gl
