// SPDX-License-Identifier: Apache-2.0
// Colours of the pictures: ramps interpolated in OKLab, light added in linear RGB.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>

namespace cadt::io::picture {

/// Linear light, 0 to 1 each.
struct Rgb {
  float r = 0, g = 0, b = 0;
};

[[nodiscard]] Rgb from_srgb(std::uint32_t rrggbb);
/// 0xRRGGBB, clamped.
[[nodiscard]] std::uint32_t to_srgb(Rgb colour);
/// a at t = 0, b at t = 1, in linear light.
[[nodiscard]] Rgb mix(Rgb a, Rgb b, float t);

/// A continuous colour scale over [0, 1]; even steps look even, because OKLab is (nearly) perceptually uniform.
class Ramp {
 public:
  struct Stop {
    float at;
    std::uint32_t srgb;
  };
  Ramp(std::initializer_list<Stop> stops);
  [[nodiscard]] Rgb operator()(float t) const;

 private:
  std::array<Rgb, 512> table_;
};

[[nodiscard]] const Ramp& terrain_ramp();  ///< valley green, sand, rock, snow
[[nodiscard]] const Ramp& size_ramp();     ///< small triangles blue, large ones almost paper

/// Colours that can be told apart, for the n-th of several regions; far apart for those that follow each other.
[[nodiscard]] Rgb region_colour(std::size_t n);

inline constexpr std::uint32_t paper = 0xfbfaf6;
inline constexpr std::uint32_t line_colour = 0x27364a;
inline constexpr std::uint32_t hull_colour = 0xb3472f;
inline constexpr std::uint32_t segment_colour = 0x6b1f8a;

/// Light from the upper left for a surface with the gradient (gx, gy), y down in the picture: factor of the colour,
/// 1 for level ground.
[[nodiscard]] float hill_shade(float gx, float gy);

}  // namespace cadt::io::picture
