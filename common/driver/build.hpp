// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/mesh/mesh.hpp"
#include "common/points/import.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// The certified mesh of sorted points. `input` is where they came from, for memory plans that read them again. One
/// whose edges are to be constrained has its points, and is certified after that.
[[nodiscard]] Mesh build(Context& ctx, SortedPoints points, const InputPoints& input, MeshUse use = MeshUse::whole);

}  // namespace cadt
