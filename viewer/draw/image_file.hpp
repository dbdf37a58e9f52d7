// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "viewer/draw/renderer.hpp"

#include <string>

namespace cadt::viewer {

/// 8-bit RGB, by way of a temporary file. \throws io::FileError
void write_png(const std::string& path, const Image& image);

}  // namespace cadt::viewer
