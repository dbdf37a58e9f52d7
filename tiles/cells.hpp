// SPDX-License-Identifier: Apache-2.0
// Sets that are made tile by tile where they are needed (cadt/uniform_cells.hpp): no sample, no shuffle, no file.
#pragma once

#include "tiles/shuffle.hpp"
#include "tiles/source.hpp"
#include "tiles/tree.hpp"

#include <cadt/uniform_cells.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

namespace cadt::tiles {

/// \throws LimitError
[[nodiscard]] std::unique_ptr<PointSource> uniform_cells(std::uint64_t points, std::uint64_t seed);

/// The tree whose leaves are ranges of indices, in their order; none if tiles of so many points are smaller than cells:
/// then the set is one as any other. \throws LimitError if the tree would have more than most_nodes nodes
[[nodiscard]] std::optional<TileTree> tree_of_cells(const UniformCells& cells, std::uint64_t tile_points);

/// Whether the leaves of the source's tree are such ranges.
[[nodiscard]] bool in_cells(const PointSource& source, std::uint64_t tile_points);
/// The points of a leaf, which are made on the device. \pre in_cells
[[nodiscard]] std::function<LeafPoints(std::uint32_t leaf)> cells_of_leaves(const PointSource& source,
                                                                            const TileTree& tree,
                                                                            std::uint64_t first_id);

/// What stands for the hash of the content, which is not read.
[[nodiscard]] Hash128 content_of_cells(const UniformCells& cells) noexcept;

}  // namespace cadt::tiles
