// SPDX-License-Identifier: Apache-2.0
// Tiles of the plane (common/stars/tiles.dev.h) and the stars of their vertices (common/stars/tile_stars.dev.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/driver/context.hpp"
#include "common/points/spatial_sort.hpp"

namespace cadt {

/// Points of a tile on average at least: it keeps 128 lanes of a card.
constexpr std::size_t least_points_of_tile = 48;

/// Bits of the keys along an axis at most: cells of a neighbourhood are counted in 32 bits, see CADT_NEIGHBORHOOD_ERROR
/// too.
constexpr unsigned most_key_bits_of_stars = 26;
/// The grid without those of its fine levels that stars have no bits for.
[[nodiscard]] KeyGrid grid_for_stars(const KeyGrid& grid) noexcept;

struct TileList {
  Allocation tiles;
  std::uint32_t count = 0;
};

/// Keys of sorted points in a grid; the low words are null if there is one word.
struct SortKeys {
  const Allocation &high, &low;
  unsigned low_bits = 0;
};

/// Nothing if the keys are not in order, or there are fewer than `least` points for a tile on average. \pre they are
/// those of n points in a grid of so many levels
[[nodiscard]] std::optional<TileList> make_tiles(Context& ctx, const SortKeys& keys, std::size_t n, unsigned levels,
                                                 std::size_t least);

/// Proven stars: neighbours in `links`, from `begins` on, how many in `sizes`, 0 where there is no proof. Without
/// `begins` each vertex has CADT_STAR_DEGREE words.
struct Stars {
  Allocation star_vertices, begins, sizes;
  std::uint32_t overflow = 0, room = 0;  ///< words before those that no tile has for itself, and of all
};
/// Room for stars close together: about 25 bytes a vertex.
[[nodiscard]] Stars allocate_stars(Context& ctx, std::size_t n, const TileList& tiles);

/// What cadt_prove_stars counts.
struct StarCounters {
  std::uint32_t points = 0, unproven = 0, exact_orientations = 0, exact_incircles = 0, ties = 0, again = 0,
                overflowed = 0;
  std::uint32_t sampled_tiles = 0, sampled_points = 0, sampled_unproven = 0, sampled_crowded = 0;
  std::uint32_t left_tiles = 0;  ///< for the sample's sake: all of their points are unproven
  void add_to(Statistics& statistics) const noexcept;
};

/// Stars of all tiles. `sets` and `states` of a call with several sets (batch.dev.h), null else. `cautious`: where the
/// first points have no star, or hardly any tile of a sample has, no more are tried.
StarCounters prove_stars(Context& ctx, const SortedPoints& order, const SortKeys& keys, const Allocation& sets,
                         const Allocation& states, const TileList& tiles, bool cautious, const Stars& stars);

}  // namespace cadt
