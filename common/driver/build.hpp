// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/mesh/mesh.hpp"
#include "common/points/import.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// The certified mesh of sorted points. `input` has them once more, for plans that read them again; `plan` is that of
/// the context.
[[nodiscard]] Mesh build(Context& ctx, SortedPoints points, const InputPoints& input);

}  // namespace cadt
