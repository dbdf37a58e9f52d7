// SPDX-License-Identifier: Apache-2.0
#include "viewer/window/screenshot.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <filesystem>

namespace cadt::viewer {

std::string free_picture_name(const std::string& stem) {
  for (std::size_t number = 1;; ++number) {
    std::string name = stem + "-" + std::to_string(number) + ".png";
    std::error_code ignored;
    if (!std::filesystem::exists(std::filesystem::symlink_status(name, ignored))) return name;
  }
}

Image read_window(int width, int height) {
  Image image{width, height, {}};
  const std::size_t row = 4 * static_cast<std::size_t>(width);
  image.rgba.resize(row * static_cast<std::size_t>(height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  glReadBuffer(GL_BACK);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  for (std::size_t low = 0, high = static_cast<std::size_t>(height) - 1; low < high; ++low, --high) {
    const auto at = [&](std::size_t y) { return image.rgba.begin() + static_cast<std::ptrdiff_t>(y * row); };
    std::swap_ranges(at(low), at(low) + static_cast<std::ptrdiff_t>(row), at(high));
  }
  return image;
}

}  // namespace cadt::viewer
