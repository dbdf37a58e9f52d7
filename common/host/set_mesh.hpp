// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/host/build_mesh.hpp"
#include "common/host/set_order.hpp"

namespace cadt {

/// The meshes of sets as one of many components: two records a vertex, so those of a set begin at twice its first
/// position, and are not used if it is flat.
struct SetMesh {
  DeviceMesh mesh;
  std::vector<std::uint32_t> positions;  ///< first positions of the sets, and the end
  std::vector<bool> flat;                ///< sets without triangles
};

/// Stars of the vertices of all sets that are together (common/device/star.h, or by gift wrapping); the others, and
/// those with vertices of too many neighbours, one by one. Releases the keys.
[[nodiscard]] SetMesh build_sets(Run& run, SetOrder& sets);

}  // namespace cadt
