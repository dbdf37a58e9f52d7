// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewer/draw/renderer.hpp"

#include <string>

namespace cadt::viewer {

/// "stem-1.png", or the first number that is free.
[[nodiscard]] std::string free_picture_name(const std::string& stem);
/// Of the window that is about to be shown: `width` columns from the left and all `height` rows.
[[nodiscard]] Image read_window(int width, int height);

}  // namespace cadt::viewer
