// SPDX-License-Identifier: Apache-2.0
#include "common/stars/local_stars.hpp"

#include <algorithm>

#include "common/driver/device_text.hpp"

namespace cadt {

using namespace device_text;

namespace {

/// A large GPU works on 900 tiles at a time: while it has the sample, it has begun others.
constexpr std::uint32_t sampled_tiles = 512;

/// The quadtree over the sort keys.
class TileMaker {
 public:
  TileMaker(Context& ctx, const SortKeys& keys, std::size_t n, unsigned levels)
      : ctx_(ctx),
        launch_(ctx.launcher),
        keys_(keys),
        n_(n),
        count_(static_cast<std::uint32_t>(n)),
        levels_(static_cast<std::uint32_t>(levels)),
        grid_(launch_.grid(n)) {}

  /// Returns false if the keys are not in order.
  [[nodiscard]] bool make() {
    const Allocation descents = launch_.zeros(1);
    flag(descents);
    if (launch_.read_word(descents, 0) != 0) return false;
    pack();
    return true;
  }

  /// Divides over-full tiles again.
  void divide() {
    overfull_ = launch_.zeros(list_.count);
    const Allocation any = launch_.zeros(1);
    launch_.run<KernelId::cadt_tile_overfull>(grid_.items, keys_, ranks_, list_.tiles, count_, levels_, grid_.grain,
                                              overfull_, any);
    if (launch_.read_word(any, 0) == 0) return;
    before_ = std::move(ranks_);
    flag(any);  // `any` is not read again: the keys are in order
    pack();
  }

  [[nodiscard]] TileList& list() noexcept { return list_; }

 private:
  void flag(const Allocation& descents) {
    ranks_ = ctx_.memory.transient((n_ + 1) * word);
    launch_.run<KernelId::cadt_tile_flags>(grid_.items, keys_, before_, overfull_, ranks_, count_, levels_, grid_.grain,
                                           descents);
  }

  void pack() {
    launch_.scan(ranks_, n_ + 1);
    list_.count = launch_.read_word(ranks_, n_);
    list_.tiles = ctx_.memory.allocate((list_.count + std::size_t{1}) * sizeof(cadt_tile));
    launch_.run<KernelId::cadt_tile_pack>(grid_.items, keys_, before_, overfull_, ranks_, list_.tiles, count_, levels_,
                                          grid_.grain);
  }

  Context& ctx_;
  Launcher& launch_;
  const SortKeys& keys_;
  std::size_t n_;
  std::uint32_t count_, levels_;
  LaunchGrid grid_;
  TileList list_;
  Allocation ranks_, before_, overfull_;
};

}  // namespace

KeyGrid grid_for_stars(const KeyGrid& grid) noexcept {
  const int too_fine = static_cast<int>(std::max(grid.bits_x, grid.bits_y)) - static_cast<int>(most_key_bits_of_stars);
  return too_fine > 0 && grid.fine_levels != 0 ? grid.finer(-std::min(too_fine, static_cast<int>(grid.fine_levels)))
                                               : grid;
}

std::optional<TileList> make_tiles(Context& ctx, const SortKeys& keys, std::size_t n, unsigned levels,
                                   std::size_t least) {
  TileMaker maker(ctx, keys, n, levels);
  if (!maker.make() || n / maker.list().count < least) return std::nullopt;
  // Keys of one word are kept only where hardly any cell is over-full.
  if (keys.low_bits != 0) maker.divide();
  ctx.statistics.tiles += maker.list().count;
  return std::move(maker.list());
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

void StarCounters::add_to(Statistics& statistics) const noexcept {
  statistics.exact_orientations += exact_orientations;
  statistics.exact_incircles += exact_incircles;
  statistics.ties += ties;
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
  StarCounters result;
  static_assert(sizeof result == CADT_STARS_WORDS * word);
  ctx.device.read(*counts, 0, &result, sizeof result);
  return result;
}

}  // namespace cadt
