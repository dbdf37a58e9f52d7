// SPDX-License-Identifier: Apache-2.0
// The triangulation of a monotone mountain, on one side of an inserted edge.
#pragma once

#include "common/constraints/exact/implicit_point.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt::constraints {

/// Vertices are numbered along the chain, from 0. Triangles are counterclockwise; across edge k, opposite vertex k, is
/// a triangle or, -1, what is outside: beyond an edge of the chain, or the base from the first vertex to the last.
struct MountainMesh {
  std::vector<std::array<std::int32_t, 3>> triangles, neighbors;
};

/// Whether the chain certainly ascends in one direction all along (segment_mountain.dev.h).
[[nodiscard]] bool is_mountain(std::span<const exact::Place> chain);

/// The triangulation of the polygon of a chain and its base, left of which all other vertices are, whose edges are
/// legal. O(n) for a first one, whose ears are cut one after the other (A. Fournier and D. Y. Montuno, "Triangulating
/// simple polygons and equivalent problems", 1984); then edges are flipped (Lawson). \pre is_mountain(chain)
/// \throws InternalError
[[nodiscard]] MountainMesh triangulate_mountain(const exact::ImplicitPoints& exact,
                                                std::span<const exact::Place> chain);

}  // namespace cadt::constraints
