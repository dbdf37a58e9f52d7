// SPDX-License-Identifier: Apache-2.0
#include "viewer/draw/palette.hpp"

#include <algorithm>

namespace cadt::viewer {

using io::picture::Ramp;
using io::picture::Rgb;

const Ramp& ramp_for(ColourBy colour) {
  static const Ramp angle{{0.0f, 0xa8323e}, {0.3f, 0xe08e5b}, {0.55f, 0xf1e2b3}, {1.0f, 0x7fb3a6}};
  static const Ramp order{{0.0f, 0x3b3a7a}, {0.3f, 0x3f86a8}, {0.6f, 0x9ec97f}, {0.85f, 0xf0d36b}, {1.0f, 0xd9694a}};
  static const Ramp level{{0.0f, 0xf4e6c4}, {0.3f, 0xe3e8c4}, {0.55f, 0xb4d8bd}, {0.8f, 0x74b7bf}, {1.0f, 0x4a8cb8}};
  static const Ramp heat{{0.0f, 0xeef0ea}, {0.25f, 0xf2d9a0}, {0.55f, 0xe68a4f}, {0.8f, 0xb83a3f}, {1.0f, 0x5a1744}};
  switch (colour) {
    case ColourBy::angle:
      return angle;
    case ColourBy::height:
      return io::picture::terrain_ramp();
    case ColourBy::level:
      return level;
    case ColourBy::order:
      return order;
    case ColourBy::degree:
    case ColourBy::conflicts:
    case ColourBy::flips:
      return heat;
    case ColourBy::nothing:
    case ColourBy::area:
    case ColourBy::region:
      break;
  }
  return io::picture::size_ramp();
}

std::array<float, 4> linear(std::uint32_t srgb, float alpha) {
  const Rgb c = io::picture::from_srgb(srgb);
  return {c.r, c.g, c.b, alpha};
}

const Palette& palette(bool dark) {
  static const Palette light{io::picture::paper,       0xe6ecee,
                             io::picture::line_colour, 0x1d2a3a,
                             io::picture::hull_colour, io::picture::segment_colour};
  static const Palette night{0x15181d, 0x2a313b, 0xc9d6e2, 0xf0f4f8, 0xe8866a, 0xd9a2f2};
  return dark ? night : light;
}

const std::vector<std::string>& names_of_colours() {
  static const std::vector<std::string> names{"nothing", "angle", "area",      "order", "height",
                                              "degree",  "level", "conflicts", "flips", "region"};
  return names;
}

std::optional<ColourBy> colour_from_string(std::string_view name) noexcept {
  const auto found = std::ranges::find(names_of_colours(), name);
  if (found == names_of_colours().end()) return std::nullopt;
  return static_cast<ColourBy>(found - names_of_colours().begin());
}

std::string_view to_string(ColourBy by) noexcept { return names_of_colours()[static_cast<std::size_t>(by)]; }

}  // namespace cadt::viewer
