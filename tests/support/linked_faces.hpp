// SPDX-License-Identifier: Apache-2.0
// Locked triangles of a closed mesh from its faces, ghost triangles included (common/mesh/locked_mesh.dev.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace cadt::test {

using Face = std::array<std::uint32_t, 3>;

/// `LockedTriangle` is cadt_locked_triangle, which tests of the device text define as a type of their own.
template <class LockedTriangle>
std::vector<LockedTriangle> linked_faces(const std::vector<Face>& faces, std::size_t slots) {
  constexpr std::size_t lock = 3, half_edges = 4;                           // words of a locked triangle
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> across;  // edge -> half-edge
  for (std::uint32_t t = 0; t < faces.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) across[{faces[t][(k + 1) % 3], faces[t][(k + 2) % 3]}] = 4 * t + k;
  std::vector<LockedTriangle> triangles(slots);
  for (std::size_t t = 0; t < faces.size(); ++t) {
    triangles[t].word[lock] = 2;
    for (std::size_t k = 0; k < 3; ++k) {
      triangles[t].word[k] = faces[t][k];
      triangles[t].word[half_edges + k] = across.at({faces[t][(k + 2) % 3], faces[t][(k + 1) % 3]});
    }
  }
  return triangles;
}

}  // namespace cadt::test
