// SPDX-License-Identifier: Apache-2.0
// Meshes that are made by hand, and pictures read back.
#pragma once

#include "io/picture/scene.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace cadt::test {

struct Mesh {
  std::vector<double> xy, height;
  std::vector<std::int32_t> triangles, hull;
  [[nodiscard]] io::picture::Scene scene() const { return {xy, height, triangles, hull}; }
};

/// m x m points with unit spacing, two triangles a cell, all diagonals from lower left to upper right.
[[nodiscard]] Mesh lattice(int m);
/// n points close to each other on the left, one apex far to the right: n - 1 long slivers.
[[nodiscard]] Mesh fan(int n, double left_height);
/// The points v -> v * scale + shift.
[[nodiscard]] Mesh moved(Mesh mesh, double scale, double shift);

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  /// Sum of the channels, 0 black to 765 white.
  [[nodiscard]] int light(int x, int y) const;
  [[nodiscard]] bool is_paper(int x, int y) const;
};
/// Decodes with libpng; a malformed file fails the running test.
[[nodiscard]] Image decode(const std::string& png);

}  // namespace cadt::test
