// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/mesh/mesh.hpp"
#include "common/points/import.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// The certified mesh of sorted points. `input` is where they came from, for memory plans that read them again.
[[nodiscard]] Mesh build(Context& ctx, SortedPoints points, const InputPoints& input);

}  // namespace cadt
