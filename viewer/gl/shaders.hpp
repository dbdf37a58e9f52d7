// SPDX-License-Identifier: Apache-2.0
// Texts of the programs in viewer/gl/shaders, embedded by the build.
#pragma once

#include <string>

namespace cadt::viewer::shaders {

extern const std::string fill, scan;

}  // namespace cadt::viewer::shaders
