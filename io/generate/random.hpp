// SPDX-License-Identifier: Apache-2.0
// The random numbers of all generated sets: splitmix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number
// generators", OOPSLA 2014; public domain). State s starts at the seed; each draw adds 0x9E3779B97F4A7C15 to s and
// returns s mixed by
//   z ^= z >> 30;  z *= 0xBF58476D1CE4E5B9;  z ^= z >> 27;  z *= 0x94D049BB133111EB;  z ^= z >> 31.
// A uniform double is the upper 53 bits times 2^-53, hence in [0, 1). A normal deviate is sqrt(-2 ln(1-u)) cos(2 pi v)
// of two draws u, v (Box and Muller), a fixed number of draws each, so that sets can be reproduced in any language.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace cadt::io::generate_detail {

[[nodiscard]] constexpr std::uint64_t mix64(std::uint64_t z) noexcept {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

class SplitMix64 {
 public:
  /// The state after `draws` draws.
  explicit constexpr SplitMix64(std::uint64_t seed, std::uint64_t draws = 0) noexcept
      : state_(seed + draws * 0x9E3779B97F4A7C15ull) {}

  constexpr std::uint64_t next() noexcept { return mix64(state_ += 0x9E3779B97F4A7C15ull); }
  /// Uniform in [0, 1), a multiple of 2^-53.
  constexpr double uniform() noexcept { return static_cast<double>(next() >> 11) * 0x1p-53; }
  /// Uniform in [-a, a).
  constexpr double symmetric(double a) noexcept { return a * (2.0 * uniform() - 1.0); }
  /// Standard normal; always two draws.
  double normal() noexcept {
    const double u = 1.0 - uniform();
    const double v = uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
  }

 private:
  std::uint64_t state_;
};

}  // namespace cadt::io::generate_detail
