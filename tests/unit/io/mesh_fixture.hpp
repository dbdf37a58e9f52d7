// SPDX-License-Identifier: Apache-2.0
// A mesh that a hand can check: the unit square with its centre, and a second copy of the centre.
#pragma once

#include "io/mesh/mesh_parts.hpp"

#include <vector>

namespace cadt::io::test {

struct SquareMesh {
  std::vector<double> xy = {0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5, 0.5, 0.5};
  std::vector<double> height;
  std::vector<std::int32_t> triangles = {0, 1, 4, 0, 4, 3, 1, 2, 4, 2, 3, 4};
  std::vector<std::int32_t> neighbors = {2, 1, -1, 3, -1, 0, 3, 0, -1, 1, 2, -1};
  std::vector<std::int32_t> hull = {0, 1, 2, 3};
  std::vector<Duplicate> duplicates = {{5, 4}};

  [[nodiscard]] detail::MeshParts parts() const { return {xy, height, triangles, neighbors, hull, duplicates}; }
  [[nodiscard]] std::size_t points() const { return xy.size() / 2; }
};

}  // namespace cadt::io::test
