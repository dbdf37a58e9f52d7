// SPDX-License-Identifier: Apache-2.0
// A mountain landscape as a function of the plane.
#pragma once

#include <cstdint>

namespace cadt::io::generate_detail {

/// Height of the ground over the unit square, in the same unit as x and y: ridged gradient noise on the mountains,
/// smooth noise in the valleys. Continuous with its gradient except at the ridges.
class Relief {
 public:
  explicit Relief(std::uint64_t seed) noexcept : seed_(seed) {}
  [[nodiscard]] double operator()(double x, double y) const noexcept;

 private:
  [[nodiscard]] double noise(double x, double y, std::uint64_t octave) const noexcept;
  std::uint64_t seed_;
};

}  // namespace cadt::io::generate_detail
