// SPDX-License-Identifier: Apache-2.0
// Colours of the viewer.
#pragma once

#include "io/picture/colour.hpp"
#include "viewer/draw/style.hpp"

#include <array>
#include <cstdint>

namespace cadt::viewer {

[[nodiscard]] const io::picture::Ramp& ramp_for(ColourBy colour);
/// Linear light.
[[nodiscard]] std::array<float, 4> linear(std::uint32_t srgb, float alpha = 1);

struct Palette {
  std::uint32_t background, fill, line, point, hull, edge;  ///< 0xRRGGBB
};
[[nodiscard]] const Palette& palette(bool dark);

}  // namespace cadt::viewer
