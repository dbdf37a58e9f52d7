// SPDX-License-Identifier: Apache-2.0
// Tiles (common/stars/tiles.dev.h) and the stars of their vertices (common/stars/tile_stars.dev.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "common/driver/context.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// Least average number of points a tile: it keeps 128 lanes of a GPU busy.
constexpr std::size_t least_points_of_tile = 48;

/// Bits of the keys along an axis at most: cells of a neighbourhood are counted in 32 bits, see CADT_NEIGHBORHOOD_ERROR
/// too.
constexpr unsigned most_key_bits_of_stars = 26;
/// The grid without those of its fine levels that stars have no bits for.
[[nodiscard]] KeyGrid grid_for_stars(const KeyGrid& grid) noexcept;

struct TileList {
  Allocation tiles;
  std::uint32_t count = 0;
  [[nodiscard]] auto arguments() const { return std::tie(tiles, count); }
};

/// Keys of sorted points in a key grid; the low words are null for keys of one word.
struct SortKeys {
  const Allocation &high, &low;
  unsigned low_bits = 0;
  [[nodiscard]] auto arguments() const { return std::tie(high, low, low_bits); }
};

/// Nothing if the keys are not in order, or if there are fewer than `least` points a tile on average. \pre the keys are
/// those of n points in a grid with so many levels
[[nodiscard]] std::optional<TileList> make_tiles(Context& ctx, const SortKeys& keys, std::size_t n, unsigned levels,
                                                 std::size_t least);

/// Proven stars: star vertices counterclockwise from `begins` on, their number in `sizes`, 0 without a proof. Without
/// `begins` each vertex has CADT_STAR_DEGREE words.
struct Stars {
  Allocation star_vertices, begins, sizes;
  std::uint32_t overflow = 0, room = 0;  ///< words in the blocks of the tiles, and in all
  [[nodiscard]] auto arguments() const { return std::tie(star_vertices, begins, sizes, overflow, room); }
};
/// Memory for packed stars: about 25 bytes a vertex.
[[nodiscard]] Stars allocate_stars(Context& ctx, std::size_t n, const TileList& tiles);

/// Exact orientation tests, incircle tests and ties.
void add_exact_tests(Statistics& statistics, std::span<const std::uint32_t, 3> counts) noexcept;

/// The counts of cadt_prove_stars (CADT_STARS_... of layout.dev.h).
using StarCounters = std::vector<std::uint32_t>;

/// Proves the stars of all tiles; the statistics get the exact tests. `sets` and `states`: of a batch (batch.dev.h),
/// else null. `cautious`: give up where the first points of a tile have no star, or hardly any tile of a sample has.
StarCounters prove_stars(Context& ctx, const SortedPoints& order, const SortKeys& keys, const Allocation& sets,
                         const Allocation& states, const TileList& tiles, bool cautious, const Stars& stars);

}  // namespace cadt
