// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/batch/sort_batch.hpp"
#include "common/mesh/mesh.hpp"

namespace cadt {

/// The meshes of sets as one of many components: two records a vertex, so those of a set begin at twice its first
/// position, and are not used if it is flat.
struct BatchMesh {
  Mesh mesh;
  std::vector<std::uint32_t> positions;  ///< first positions of the sets, and the end
  std::vector<bool> flat;                ///< sets without triangles
};

/// Stars of the vertices of all sets that are together (common/stars/local_star.dev.h, or by gift wrapping); the
/// others, and those with vertices of too many neighbours, one by one. Releases the keys.
[[nodiscard]] BatchMesh build_batch(Context& ctx, SortedBatch& sets);

}  // namespace cadt
