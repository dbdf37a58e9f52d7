// SPDX-License-Identifier: Apache-2.0
// Texts of the programs in viewer/live/shaders, embedded by the build.
#pragma once

#include <string>

namespace cadt::viewer::shaders {

extern const std::string live;                                       // part of the others
extern const std::string spawn, move, push, keep, compact, nearest;  // programs

}  // namespace cadt::viewer::shaders
