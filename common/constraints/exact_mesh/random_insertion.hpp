// SPDX-License-Identifier: Apache-2.0
// The triangulation of one side of an inserted edge, where it does not divide well.
#pragma once

#include "common/constraints/exact/implicit_point.hpp"
#include "common/constraints/stop_check.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cadt::constraints {

/// Vertices are numbered along the chain, from 0. Triangles are counterclockwise; edge k is opposite vertex k.
struct ChainMesh {
  std::vector<std::array<std::int32_t, 3>> triangles;
  /// Across edge k of triangle t is edge j of triangle u, 3u + j, or, -1, what is outside: beyond an edge of the chain,
  /// or the base from the first vertex to the last.
  std::vector<std::int32_t> across;
};

/// The triangulation of the polygon of a chain and its base, left of which all other vertices are, whose edges are
/// legal; as in random_insertion.dev.h, for vertices that may be crossings. Near linear expected time. None, if the
/// rounded distances from the base are too close to each other. \pre at least three vertices; each is visible from the
/// base. \throws what check_stop throws
[[nodiscard]] std::optional<ChainMesh> insert_at_random(const exact::ImplicitPoints& exact,
                                                        std::span<const exact::Place> chain,
                                                        const StopCheck& check_stop);

}  // namespace cadt::constraints
