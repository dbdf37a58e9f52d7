// SPDX-License-Identifier: Apache-2.0
#include "io/generate/relief.hpp"

#include "io/generate/random.hpp"

#include <cmath>
#include <cstdint>

namespace cadt::io::generate_detail {

namespace {

/// Contribution of an integer corner: a random slope times the offset (u, v) from the corner.
double corner(std::int64_t i, std::int64_t j, std::uint64_t key, double u, double v) noexcept {
  const auto a = static_cast<std::uint64_t>(i) * 0xD6E8FEB86659FD93ull;
  const auto b = static_cast<std::uint64_t>(j) * 0xA0761D6478BD642Full;
  const std::uint64_t h = mix64((a ^ key) + b);
  const double gx = static_cast<double>(h >> 32) * 0x1p-31 - 1.0;
  const double gy = static_cast<double>(h & 0xFFFFFFFFull) * 0x1p-31 - 1.0;
  return gx * u + gy * v;
}

/// Quintic with vanishing first and second derivative at both ends, so that the lattice does not show in shading.
double ease(double t) noexcept { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); }

}  // namespace

double Relief::noise(double x, double y, std::uint64_t octave) const noexcept {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const auto i = static_cast<std::int64_t>(fx);
  const auto j = static_cast<std::int64_t>(fy);
  const double s = ease(x - fx);
  const double t = ease(y - fy);
  const std::uint64_t key = mix64(seed_ + 0x9E3779B97F4A7C15ull * (octave + 1));
  const double u = x - fx;
  const double v = y - fy;
  const double a = corner(i, j, key, u, v);
  const double b = corner(i + 1, j, key, u - 1.0, v);
  const double c = corner(i, j + 1, key, u, v - 1.0);
  const double d = corner(i + 1, j + 1, key, u - 1.0, v - 1.0);
  const double low = a + s * (b - a);
  const double high = c + s * (d - c);
  return 1.6 * (low + t * (high - low));  // to about [-1, 1]
}

double Relief::operator()(double x, double y) const noexcept {
  // Each octave is turned by an angle with irrational tangent: the axes of the noise lattice would otherwise line up.
  constexpr double c = 0.8, s = 0.6;
  constexpr int octaves = 8;
  double px = 3.4 * x + 17.3;
  double py = 3.4 * y - 5.9;

  // Domain warp: ridges bend instead of following lattice cells.
  const double wx = noise(px + 31.0, py, 40);
  const double wy = noise(px, py - 57.0, 41);
  const double base = std::fmin(
      1.0, std::fmax(0.0, 0.55 + 0.8 * noise(0.5 * px, 0.5 * py, 42)));  // mountains where high, plains where low
  px += 0.22 * wx;
  py += 0.22 * wy;

  double smooth = 0.0;
  double ridged = 0.0;
  double amplitude = 0.5;
  double carry = 1.0;  // ridges branch only from ridges: fine octaves count where the coarse ones are high
  for (int octave = 0; octave < octaves; ++octave) {
    const double value = noise(px, py, static_cast<std::uint64_t>(octave));
    smooth += amplitude * value;
    const double crest = 1.0 - std::fabs(value);
    ridged += amplitude * crest * crest * carry;
    carry = std::fmin(1.0, 1.6 * crest * crest * carry);
    const double turned = 2.03 * (c * px - s * py);
    py = 2.03 * (s * px + c * py) + 7.7;
    px = turned;
    amplitude *= 0.48;
  }
  const double mountains = base * base * (3.0 - 2.0 * base);
  return 0.16 * (mountains * ridged * 1.3 + (0.25 + 0.3 * mountains) * (0.5 + smooth));
}

}  // namespace cadt::io::generate_detail
