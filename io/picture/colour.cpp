// SPDX-License-Identifier: Apache-2.0
#include "io/picture/colour.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace cadt::io::picture {

namespace {

float decode(std::uint32_t byte) {
  const float v = static_cast<float>(byte) / 255.0f;
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

/// sRGB byte of a linear value by table: a pow for every channel of every pixel would cost more than the mesh.
/// Its steps are below half a byte at the dark end, where sRGB is steepest.
std::uint32_t encode(float linear) {
  static const auto table = [] {
    std::array<std::uint8_t, 8193> t{};
    for (std::size_t i = 0; i < t.size(); ++i) {
      const float v = static_cast<float>(i) / 8192.0f;
      const float s = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
      t[i] = static_cast<std::uint8_t>(std::lround(255.0f * s));
    }
    return t;
  }();
  return table[static_cast<std::size_t>(std::clamp(linear, 0.0f, 1.0f) * 8192.0f + 0.5f)];
}

struct Lab {
  float l, a, b;
};

// Matrices of OKLab as published by Bjorn Ottosson, "A perceptual color space for image processing" (2020).
Lab to_lab(Rgb c) {
  const float l = std::cbrt(0.4122214708f * c.r + 0.5363325363f * c.g + 0.0514459929f * c.b);
  const float m = std::cbrt(0.2119034982f * c.r + 0.6806995451f * c.g + 0.1073969566f * c.b);
  const float s = std::cbrt(0.0883024619f * c.r + 0.2817188376f * c.g + 0.6299787005f * c.b);
  return {0.2104542553f * l + 0.7936177850f * m - 0.0040720468f * s,
          1.9779984951f * l - 2.4285922050f * m + 0.4505937099f * s,
          0.0259040371f * l + 0.7827717662f * m - 0.8086757660f * s};
}

Rgb from_lab(Lab c) {
  const float l = c.l + 0.3963377774f * c.a + 0.2158037573f * c.b;
  const float m = c.l - 0.1055613458f * c.a - 0.0638541728f * c.b;
  const float s = c.l - 0.0894841775f * c.a - 1.2914855480f * c.b;
  const float l3 = l * l * l;
  const float m3 = m * m * m;
  const float s3 = s * s * s;
  return {4.0767416621f * l3 - 3.3077115913f * m3 + 0.2309699292f * s3,
          -1.2684380046f * l3 + 2.6097574011f * m3 - 0.3413193965f * s3,
          -0.0041960863f * l3 - 0.7034186147f * m3 + 1.7076147010f * s3};
}

}  // namespace

Rgb from_srgb(std::uint32_t rrggbb) {
  return {decode((rrggbb >> 16) & 255u), decode((rrggbb >> 8) & 255u), decode(rrggbb & 255u)};
}

std::uint32_t to_srgb(Rgb colour) { return (encode(colour.r) << 16) | (encode(colour.g) << 8) | encode(colour.b); }

Rgb mix(Rgb a, Rgb b, float t) { return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)}; }

Rgb region_colour(std::size_t n) {
  // Hues by the golden angle; lightness and chroma in turn, so that near hues differ in them.
  constexpr float golden_angle = 2.39996323f, first = 0.9f;
  constexpr float lightness[] = {0.80f, 0.70f, 0.87f}, chroma[] = {0.09f, 0.11f, 0.06f};
  const float hue = first + golden_angle * static_cast<float>(n % 1024);
  return from_lab({lightness[n % 3], chroma[n % 3] * std::cos(hue), chroma[n % 3] * std::sin(hue)});
}

Ramp::Ramp(std::initializer_list<Stop> stops) {
  const std::vector<Stop> list(stops);
  std::size_t k = 0;
  for (std::size_t i = 0; i < table_.size(); ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(table_.size() - 1);
    while (k + 2 < list.size() && t > list[k + 1].at) ++k;
    const Lab a = to_lab(from_srgb(list[k].srgb));
    const Lab b = to_lab(from_srgb(list[k + 1].srgb));
    const float s = std::clamp((t - list[k].at) / (list[k + 1].at - list[k].at), 0.0f, 1.0f);
    table_[i] = from_lab({a.l + s * (b.l - a.l), a.a + s * (b.a - a.a), a.b + s * (b.b - a.b)});
  }
}

Rgb Ramp::operator()(float t) const {
  if (!(t > 0.0f)) return table_.front();
  const auto i = static_cast<std::size_t>(std::min(t, 1.0f) * static_cast<float>(table_.size() - 1) + 0.5f);
  return table_[i];
}

const Ramp& terrain_ramp() {
  static const Ramp ramp{{0.00f, 0x4f7f62}, {0.18f, 0x86a568}, {0.38f, 0xd3cd92}, {0.56f, 0xcaa877},
                         {0.73f, 0xa07d66}, {0.87f, 0xbfb4ae}, {1.00f, 0xfaf9f7}};
  return ramp;
}

const Ramp& size_ramp() {
  static const Ramp ramp{{0.0f, 0x6f9fc0}, {0.35f, 0xa5cbd2}, {0.7f, 0xd9e8dc}, {1.0f, 0xf6f1e1}};
  return ramp;
}

float hill_shade(float gx, float gy) {
  // Towards the light: left, up (negative y of the picture), out of the paper.
  constexpr float lx = -0.50f, ly = -0.50f, lz = 0.7071f;
  const float norm = 1.0f / std::sqrt(gx * gx + gy * gy + 1.0f);
  const float lambert = std::max(0.0f, (-gx * lx - gy * ly + lz) * norm) / lz;
  return 0.28f + 0.72f * lambert;
}

}  // namespace cadt::io::picture
