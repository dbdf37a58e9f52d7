// SPDX-License-Identifier: Apache-2.0
#include "common/host/tiles.hpp"

#include "common/host/device_constants.hpp"

namespace cadt {

using namespace device_constants;

namespace {

constexpr std::size_t word = sizeof(std::uint32_t);
/// A large card works on 900 tiles at a time: while it has the sample, it has begun with others.
constexpr std::uint32_t sampled_tiles = 512;

}  // namespace

std::optional<TileList> make_tiles(Run& run, const SortKeys& keys, std::size_t n, unsigned levels) {
  Launcher& launch = run.launcher;
  const auto count = static_cast<std::uint32_t>(n), level_count = static_cast<std::uint32_t>(levels);
  const Cut c = launch.cut(n);
  const Allocation ranks = run.memory.allocate((n + 1) * word), descents = launch.zeros(1);
  launch.run(KernelId::cadt_tile_flags, c.items, keys.high, keys.low, keys.low_bits, ranks, count, level_count, c.grain,
             descents);
  if (launch.read_word(descents, 0) != 0) return std::nullopt;
  launch.scan(ranks, n + 1);
  TileList list;
  list.count = launch.read_word(ranks, n);
  list.tiles = run.memory.allocate((list.count + std::size_t{1}) * sizeof(cadt_tile));
  launch.run(KernelId::cadt_tile_pack, c.items, keys.high, keys.low, keys.low_bits, ranks, list.tiles, count,
             level_count, c.grain);
  run.statistics.tiles += list.count;
  return list;
}

StarList make_star_list(Run& run, std::size_t n, const TileList& tiles) {
  // As cadt_pool_of_tile of the end, which is within 32 bits for max_points(). Tiles have about 6 words a vertex, so an
  // eighth of a word for all is plenty where some have more; a star without room is one without a proof.
  constexpr std::size_t least = 4096, read_ahead = 16;
  const std::size_t overflow = CADT_STAR_LEAD + 6 * n + n / 8 + std::size_t{CADT_STAR_SPARE} * tiles.count,
                    room = overflow + n / 8 + least;
  StarList list;
  list.links = run.memory.allocate((room + read_ahead) * word);
  list.begins = run.memory.allocate(n * word);
  list.sizes = run.memory.allocate_zeros(n * word);
  list.overflow = static_cast<std::uint32_t>(overflow);
  list.room = static_cast<std::uint32_t>(room);
  return list;
}

void StarCounts::add_to(Statistics& statistics) const noexcept {
  statistics.exact_orientations += exact_orientations;
  statistics.exact_incircles += exact_incircles;
  statistics.ties += ties;
}

StarCounts run_stars(Run& run, const SpatialOrder& order, const SortKeys& keys, const Allocation& sets,
                     const Allocation& states, const TileList& tiles, bool cautious, const StarList& stars) {
  const KeyGrid& grid = order.grid;
  const Allocation found = run.launcher.zeros(CADT_STARS_FOUND);
  const Cut teams = run.launcher.cut_teams(tiles.count, CADT_STAR_LANES);
  const std::uint32_t sample = !sets && tiles.count >= 2 * sampled_tiles ? sampled_tiles : 0;
  run.launcher.run(KernelId::cadt_stars, teams.items, order.points, keys.high, keys.low, keys.low_bits,
                   static_cast<std::uint32_t>(order.distinct), grid.half_min_x, grid.half_min_y, grid.scale,
                   grid.bits_x, grid.bits_y, grid.most_x, grid.most_y, grid.clipped ? 1U : 0U, sets, states,
                   tiles.tiles, tiles.count, sample, cautious ? 1U : 0U, teams.grain, stars.links, stars.begins,
                   stars.sizes, stars.overflow, stars.room, found);
  StarCounts counts;
  static_assert(sizeof counts == CADT_STARS_FOUND * word);
  run.device.read(*found, 0, &counts, sizeof counts);
  return counts;
}

}  // namespace cadt
