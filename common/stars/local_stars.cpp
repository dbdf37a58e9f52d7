// SPDX-License-Identifier: Apache-2.0
#include "common/stars/local_stars.hpp"

#include <algorithm>

#include "common/driver/device_text.hpp"

namespace cadt {

using namespace device_text;

namespace {

/// A large GPU works on 900 tiles at a time: while it has the sample, it has begun others.
constexpr std::uint32_t sampled_tiles = 512;

}  // namespace

KeyGrid grid_for_stars(const KeyGrid& grid) noexcept {
  const int too_fine = static_cast<int>(std::max(grid.bits_x, grid.bits_y)) - static_cast<int>(most_key_bits_of_stars);
  return too_fine > 0 && grid.fine_levels != 0 ? grid.finer(-std::min(too_fine, static_cast<int>(grid.fine_levels)))
                                               : grid;
}

std::optional<TileList> make_tiles(Context& ctx, const SortKeys& keys, std::size_t n, unsigned levels,
                                   std::size_t least) {
  Launcher& launch = ctx.launcher;
  const LaunchGrid all = launch.grid(n);
  TileList list;
  Allocation ranks, before, overfull;  // before: the ranks of tiles some of which are divided again
  const Allocation found = launch.zeros(2);
  const auto flag = [&] {
    ranks = ctx.memory.transient((n + 1) * word);
    launch.run<KernelId::cadt_tile_flags>(all.items, keys, before, overfull, ranks, n, levels, all.grain, found);
  };
  const auto pack = [&] {
    launch.scan(ranks, n + 1);
    list.count = launch.read_word(ranks, n);
    list.tiles = ctx.memory.allocate((list.count + std::size_t{1}) * sizeof(cadt_tile));
    launch.run<KernelId::cadt_tile_pack>(all.items, keys, before, overfull, ranks, list.tiles, n, levels, all.grain);
  };
  flag();
  const auto counted = ctx.device.read_values(*found, 2);
  if (counted[0] != 0) return std::nullopt;
  pack();
  if (n / list.count < least) return std::nullopt;
  if (counted[1] != 0) {
    overfull = launch.zeros(list.count);
    launch.run<KernelId::cadt_tile_overfull>(all.items, keys, ranks, list.tiles, n, levels, all.grain, overfull);
    before = std::move(ranks);
    flag();
    pack();
  }
  ctx.statistics.tiles += list.count;
  return list;
}

Stars allocate_stars(Context& ctx, std::size_t n, const TileList& tiles) {
  // As cadt_pool_of_tile at the end, which fits into 32 bits for max_points(). Blocks of tiles have about 6 words a
  // vertex, so an eighth of a word a vertex is plenty for tiles that need more; a star without room is one without a
  // proof.
  constexpr std::size_t least = 4096, read_ahead = 16;
  const std::size_t overflow = CADT_STAR_LEAD + 6 * n + n / 8 + std::size_t{CADT_STAR_SPARE} * tiles.count,
                    room = overflow + n / 8 + least;
  Stars list;
  list.star_vertices = ctx.memory.allocate((room + read_ahead) * word);
  const std::size_t begins = (n + 1) * word;  // as many as buckets of renumber.cpp
  list.begins = ctx.plan.compact ? ctx.memory.allocate_unpooled(begins) : ctx.memory.allocate(begins);
  list.sizes = ctx.memory.transient_zeros(n * word);
  list.overflow = static_cast<std::uint32_t>(overflow);
  list.room = static_cast<std::uint32_t>(room);
  return list;
}

void add_exact_tests(Statistics& statistics, std::span<const std::uint32_t, 3> counts) noexcept {
  statistics.exact_orientations += counts[0];
  statistics.exact_incircles += counts[1];
  statistics.ties += counts[2];
}

StarCounters prove_stars(Context& ctx, const SortedPoints& order, const SortKeys& keys, const Allocation& sets,
                         const Allocation& states, const TileList& tiles, bool cautious, const Stars& stars) {
  const KeyGrid& grid = order.grid;
  const Allocation counts = ctx.launcher.zeros(CADT_STARS_WORDS);
  const LaunchGrid teams = ctx.launcher.grid_of_teams(tiles.count, CADT_STAR_LANES);
  const std::uint32_t sample = !sets && tiles.count >= 2 * sampled_tiles ? sampled_tiles : 0;
  ctx.launcher.run<KernelId::cadt_prove_stars>(teams.items, order.points, keys, order.distinct, grid, grid.most_x,
                                               grid.most_y, grid.clipped, sets, states, tiles, sample, cautious,
                                               teams.grain, stars, counts);
  const StarCounters found = ctx.device.read_values(*counts, CADT_STARS_WORDS);
  add_exact_tests(ctx.statistics, std::span(found).subspan<CADT_STARS_EXACT_ORIENTATIONS, 3>());
  return found;
}

}  // namespace cadt
