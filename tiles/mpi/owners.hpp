// SPDX-License-Identifier: Apache-2.0
// Which rank does what. The mesh does not depend on it.
#pragma once

#include "tiles/tree.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace cadt::tiles::mpi {

/// The rank that makes each node: leaves in contiguous ranges with about equally many points, joins at the rank of
/// their leftmost leaf, which is the lower one of those of its children. `valid`, by node: is there already; such
/// leaves count nothing.
[[nodiscard]] std::vector<int> owners(const TileTree& tree, const std::vector<bool>& valid, int ranks);

/// The slice of `points` that `rank` reads: whole blocks of `block` points, contiguous, in the order of ranks.
[[nodiscard]] std::pair<std::uint64_t, std::uint64_t> slice(std::uint64_t points, std::uint64_t block, int rank,
                                                            int ranks);

}  // namespace cadt::tiles::mpi
