// SPDX-License-Identifier: Apache-2.0
// Texts of the programs in viewer/draw/shaders, embedded by the build.
#pragma once

#include <string>

namespace cadt::viewer::shaders {

extern const std::string common, shade, raster;                                         // parts of others
extern const std::string bounds, cull, blocks, large, resolve, strokes, discs, sample;  // programs

}  // namespace cadt::viewer::shaders
