// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cadt/triangulation.hpp>

#include <cstdint>
#include <span>
#include <vector>

#include "common/constraints/exact_mesh/exact_crossings.hpp"

namespace cadt {

/// The mesh with its triangles in canonical order, whatever the options say; `edge_flags` get those of its triangles.
/// Hull and duplicates are those of the input's points alone: crossings lie inside, or on the hull. `delaunay`: of
/// these points; if it has kept them, the result has a copy of them and of the crossings.
[[nodiscard]] Triangulation triangulation_of(const Triangulation& delaunay, const constraints::ExactMesh& mesh,
                                             std::span<const double> added_xy, std::vector<std::uint32_t>& edge_flags);

}  // namespace cadt
