// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/driver/choose_strategy.hpp"
#include "common/mesh/mesh.hpp"
#include "common/points/import.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// The certified mesh by the star stage: local stars without locks, gift wrapping or insertion of the residual
/// vertices, and the stitch of both parts. If too few stars are proven, all points are wrapped or inserted.
[[nodiscard]] Mesh mesh_from_stars(Context& ctx, SortedPoints points, const InputPoints& input,
                                   const BuildStrategy& how, MeshUse use = MeshUse::whole);

/// The certified mesh by gift wrapping of all points, if they are few enough and it does not take too long; else by
/// insertion. `all`: of a part, how many points the mesh has, which is certified later.
[[nodiscard]] Mesh wrap_or_insert(Context& ctx, SortedPoints points, const BuildStrategy& how, MeshUse use,
                                  std::size_t all = 0);

}  // namespace cadt
