// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/batch/sort_batch.hpp"
#include "common/mesh/mesh.hpp"

namespace cadt {

/// The meshes of a batch as one mesh with many components, set after set, without ghost triangles.
struct BatchMesh {
  Mesh mesh;
  Allocation set_starts;                 ///< the first triangle of each set, and the number of all
  std::vector<std::uint32_t> positions;  ///< first positions of the sets, and the end of the last
};

/// Builds the meshes: of the batched sets from the stars of all vertices (common/stars/local_star.dev.h, and gift
/// wrapping) or, on CPUs, by insertion; of the others, and of sets with high-degree vertices, individually by
/// insertion. Takes keys, points and input ids.
[[nodiscard]] BatchMesh build_batch(Context& ctx, SortedBatch& sets);

}  // namespace cadt
