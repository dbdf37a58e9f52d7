// SPDX-License-Identifier: Apache-2.0
#include "common/points/spatial_sort.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/driver/device_text.hpp"
#include "common/points/device_points.hpp"

namespace cadt {
namespace {

using namespace device_text;

constexpr std::size_t word = sizeof(std::uint32_t);
constexpr int most_key_bits = 32;
/// With so few points a wait for the device costs more than work that is done in vain where cells are crowded.
constexpr std::size_t most_ahead = std::size_t{1} << 17;

struct Bounds {
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
  int low = 4096, high = -4096;  // exponents of the lowest set bit and above the highest; low > high: all zero
};

/// cadt_bounds_row of a device without doubles.
struct FloatRow {
  float min_x, max_x, min_y, max_y;
  std::uint32_t low, high, bad, rows;
};

std::size_t row_bytes(const Device& device) noexcept {
  return takes_floats_only(device) ? sizeof(FloatRow) : sizeof(cadt_bounds_row);
}

cadt_bounds_row read_row(Device& device, const Buffer& from) {
  cadt_bounds_row row;
  if (!takes_floats_only(device)) {
    device.read(from, 0, &row, sizeof row);
    return row;
  }
  FloatRow f;
  device.read(from, 0, &f, sizeof f);
  return {static_cast<double>(f.min_x),
          static_cast<double>(f.max_x),
          static_cast<double>(f.min_y),
          static_cast<double>(f.max_y),
          f.low,
          f.high,
          f.bad,
          f.rows};
}

/// The row of all points; `totals` become 0. `group`: work-items that share a row on this device.
cadt_bounds_row merge_bounds(Context& ctx, const Allocation& input, std::size_t n, std::uint32_t group,
                             const Allocation& totals) {
  const LaunchGrid c = ctx.launcher.parts(n);
  const std::uint32_t room = (c.items - 1) / group + 1;
  const Allocation rows = ctx.memory.allocate(room * row_bytes(ctx.device));
  ctx.launcher.run<KernelId::cadt_bounds>(c.items, input, static_cast<std::uint32_t>(n), c.grain, c.items, room, rows);
  const std::uint32_t team = ctx.device.shape().contiguous ? 1 : CADT_BOUNDS_LANES;
  ctx.launcher.run_in_groups<KernelId::cadt_merge_bounds>(team, team, rows, room, totals);
  const cadt_bounds_row all = read_row(ctx.device, *rows);
  // Devices may make smaller groups than they were asked for.
  return all.rows > room ? merge_bounds(ctx, input, n, 1, totals) : all;
}

Bounds find_bounds(Context& ctx, const Allocation& input, std::size_t n, const Allocation& totals) {
  constexpr std::uint32_t usual_group = 128;  // the least that a GPU has unless the options say so
  const unsigned asked = ctx.options.work_group_size;
  const std::uint32_t group = ctx.device.shape().contiguous ? 1
                              : asked == 0                  ? usual_group
                                                            : std::min(asked, usual_group);
  const cadt_bounds_row all = merge_bounds(ctx, input, n, group, totals);
  if (all.bad != CADT_NONE) {
    throw InputError("point " + std::to_string(all.bad) +
                         " (counted from 0) has a coordinate that is NaN or infinite: "
                         "remove or repair it",
                     all.bad);
  }
  return {
      all.min_x, all.max_x, all.min_y, all.max_y, static_cast<int>(all.low) - 4096, static_cast<int>(all.high) - 4096};
}

constexpr std::size_t least_points_of_tiles = 400'000;  // fewer do not fill a card with tiles of that size
constexpr double points_of_tile = 600, fewest_of_tile = 450;

/// The largest squares of the grid with at most CADT_TILE_POINTS points are tiles (common/stars/tiles.dev.h), so evenly
/// spread points have between a quarter of that in each and all of it. With cells up to twice as long they have about
/// what is best for the star stage, and the last tiles along each axis are not slivers, whose windows have too many
/// points. Returns the factor for the scale of the grid.
double scale_for_tiles(const KeyGrid& grid, double width, double height, std::size_t n) {
  const double cells_x = std::max(1.0, grid.scale * width), cells_y = std::max(1.0, grid.scale * height);
  const double longer = std::max(cells_x, cells_y), shorter = std::min(cells_x, cells_y);
  const double density = static_cast<double>(n) / (cells_x * cells_y);
  double side = 1;  // of a tile, in cells
  while (4 * density * side * side <= points_of_tile && 2 * side <= longer) side *= 2;
  const double most = std::sqrt(points_of_tile / density), least = std::sqrt(fewest_of_tile / density);
  double best = side, cost = 2;
  for (double tiles = std::ceil(longer / most); tiles <= longer / least && tiles <= 4096; ++tiles) {
    const double rows = shorter * tiles / longer, sliver = std::ceil(rows - 1e-9) - rows;
    // between two that leave the same, the larger tiles
    const double price = (rows > 1 ? sliver : 0) + 0.5 * (1 - longer / tiles / most);
    if (price < cost) cost = price, best = longer / tiles;
  }
  return cost < 2 && best > side && best < 2 * side ? side / best * (1 - 0x1p-30) : 1;
}

/// A grid of at most 2^bits square cells over the box.
KeyGrid choose_grid(const Bounds& bounds, int bits) {
  // Halved: the width of the box may exceed the largest double.
  const double width = 0.5 * bounds.max_x - 0.5 * bounds.min_x, height = 0.5 * bounds.max_y - 0.5 * bounds.min_y;
  const double longer = std::max(width, height), shorter = std::min(width, height);
  int surplus = bits;
  if (shorter > 0) surplus = std::min(bits, std::max(0, std::ilogb(longer) - std::ilogb(shorter)));
  int longer_bits = std::min((bits + surplus + 1) / 2, 31);
  int shorter_bits = std::clamp(longer_bits - surplus, 0, 16);
  if (longer_bits + shorter_bits > 32) --longer_bits, --shorter_bits;
  KeyGrid grid;
  grid.half_min_x = 0.5 * bounds.min_x;
  grid.half_min_y = 0.5 * bounds.min_y;
  grid.bits_x = static_cast<unsigned>(width >= height ? longer_bits : shorter_bits);
  grid.bits_y = static_cast<unsigned>(width >= height ? shorter_bits : longer_bits);
  grid.scale = std::numeric_limits<double>::max();  // if all points are equal, or nearly so: any finite scale does
  if (longer > 0) grid.scale = std::min(grid.scale, std::ldexp(1.0, longer_bits) / longer);
  // the shorter axis must not leave its bits either, unless it has none
  if (shorter > 0 && shorter_bits > 0) grid.scale = std::min(grid.scale, std::ldexp(1.0, shorter_bits) / shorter);
  return grid;
}

/// The grid for all points.
KeyGrid grid_of_all(const Bounds& bounds, std::size_t n) {
  // About sixteen square cells a point keep runs of equal keys short on well-spread data.
  KeyGrid grid = choose_grid(bounds, std::clamp(static_cast<int>(std::bit_width(n)) + 4, 4, most_key_bits));
  const double width = 0.5 * bounds.max_x - 0.5 * bounds.min_x, height = 0.5 * bounds.max_y - 0.5 * bounds.min_y;
  if (n >= least_points_of_tiles) grid.scale *= scale_for_tiles(grid, width, height, n);
  grid.most_x = width * grid.scale;
  grid.most_y = height * grid.scale;
  return grid;
}

constexpr std::size_t fewest_for_sample = 16384;

/// Some of the points, the same in every run.
std::vector<cadt_point> sample_of(Context& ctx, const Allocation& input, std::size_t n) {
  const std::size_t samples = n <= most_ahead ? 1024 : 4096;
  std::vector<std::uint32_t> places(samples);
  // In step with nothing that is in the data (D. E. Knuth's multiplicative hash).
  for (std::size_t i = 0; i < samples; ++i) places[i] = static_cast<std::uint32_t>(i * 0x9E3779B97F4A7C15U % n);
  const Allocation list = ctx.memory.allocate(samples * word),
                   chosen = ctx.memory.allocate(samples * sizeof(cadt_point));
  ctx.device.write(*list, 0, places.data(), samples * word);
  const LaunchGrid c = ctx.launcher.grid(samples);
  ctx.launcher.run<KernelId::cadt_gather_points>(c.items, input, list, chosen, static_cast<std::uint32_t>(samples),
                                                 c.grain, 1.0, 1.0);
  std::vector<cadt_point> points(samples);
  ctx.device.read(*chosen, 0, points.data(), samples * sizeof points[0]);
  return points;
}

/// A grid without the outermost points, where that is a much smaller box: heavy tails, or a few points far away from
/// all others, leave most points in one cell else.
std::optional<KeyGrid> grid_of_most(std::vector<cadt_point>& points, Bounds bounds) {
  const std::size_t samples = points.size(), tail = samples / 340;  // on either side along each axis
  constexpr double much_smaller = 16;
  const auto cut = [&](double cadt_point::*axis, double& low, double& high) {
    const double width = 0.5 * high - 0.5 * low;
    const auto value = [&](std::size_t rank) {
      const auto at = points.begin() + static_cast<std::ptrdiff_t>(rank);
      std::ranges::nth_element(points, at, {}, axis);
      return (*at).*axis;
    };
    low = value(tail);
    high = value(samples - 1 - tail);
    return (0.5 * high - 0.5 * low) * much_smaller < width;
  };
  const bool narrower = cut(&cadt_point::x, bounds.min_x, bounds.max_x);
  const bool lower = cut(&cadt_point::y, bounds.min_y, bounds.max_y);
  if (!narrower && !lower) return std::nullopt;
  KeyGrid grid = choose_grid(bounds, most_key_bits);
  grid.most_x = std::ldexp(1.0, static_cast<int>(grid.bits_x));
  grid.most_y = std::ldexp(1.0, static_cast<int>(grid.bits_y));
  grid.clipped = true;
  return grid;
}

/// Whether most points would share cells of a grid with hundreds of others: hardly one of a few is alone in its cell.
bool stays_crowded(std::span<const cadt_point> sample, const KeyGrid& grid) {
  constexpr std::size_t few = 256;
  std::vector<std::pair<double, double>> cells;
  for (std::size_t i = 0; i < sample.size(); i += sample.size() / few) {  // grid_of_most has moved them about
    const cadt_point& p = sample[i];
    cells.emplace_back(std::floor((0.5 * p.x - grid.half_min_x) * grid.scale),
                       std::floor((0.5 * p.y - grid.half_min_y) * grid.scale));
  }
  std::ranges::sort(cells);
  const auto others = std::ranges::unique(cells);
  return 8 * (cells.size() - others.size()) < cells.size();
}

constexpr int most_fine_levels = 15, fewest_fine_levels = 4;

/// Sorts by keys of two words, of a grid with so many more levels that few cells are crowded; `keys` become the numbers
/// of the runs of equal ones.
void sort_finely(Context& ctx, const Allocation& input, Allocation& keys, Allocation& order, Allocation& spare,
                 std::size_t n, const KeyGrid& grid) {
  Launcher& launch = ctx.launcher;
  const auto count = static_cast<std::uint32_t>(n);
  const LaunchGrid c = launch.grid(n);
  const Allocation low = ctx.memory.transient(n * word);
  make_fine_keys(ctx, input, keys, low, n, grid);
  Allocation sorted = ctx.memory.transient(n * word), spare_order = ctx.memory.transient(n * word);
  launch.run<KernelId::cadt_copy_words>(c.items, low, sorted, std::uint32_t{0}, count, c.grain);
  launch.sort(sorted, order, spare, spare_order, n, 2 * grid.fine_levels, true);
  // stable
  launch.run<KernelId::cadt_gather_words>(c.items, keys, order, sorted, count, c.grain);
  launch.sort(sorted, order, spare, spare_order, n, grid.bits() - 2 * grid.fine_levels, false);
  launch.run<KernelId::cadt_gather_words>(c.items, low, order, spare, count, c.grain);
  launch.run<KernelId::cadt_run_tails>(c.items, sorted, spare, keys, count, c.grain);
  launch.scan(keys, n);
}

/// The points that equal an earlier one, ascending, and those that they equal.
void find_duplicates(Context& ctx, SortedPoints& result, const Allocation& order, const Allocation& ranks,
                     std::size_t n) {
  const std::size_t count = n - result.distinct;
  result.duplicates = ctx.memory.allocate(count * word);
  result.representatives = ctx.memory.allocate(count * word);
  Allocation spare = ctx.memory.allocate(count * word), spare_values = ctx.memory.allocate(count * word);
  const LaunchGrid c = ctx.launcher.grid(n);
  ctx.launcher.run<KernelId::cadt_duplicate_pairs>(c.items, order, ranks, result.input_ids, result.duplicates,
                                                   result.representatives, static_cast<std::uint32_t>(n),
                                                   static_cast<std::uint32_t>(result.distinct), c.grain);
  ctx.launcher.sort(result.duplicates, result.representatives, spare, spare_values, count,
                    static_cast<unsigned>(std::bit_width(n - 1)), false);
}

}  // namespace

std::uint32_t flag_overfull(Context& ctx, const Allocation& keys, const Allocation& flags, std::size_t n) {
  const LaunchGrid c = ctx.launcher.grid(n);
  const Allocation totals = ctx.launcher.zeros(1);
  ctx.launcher.run<KernelId::cadt_flag_overfull>(c.items, keys, flags, static_cast<std::uint32_t>(n), c.grain, totals);
  return ctx.launcher.read_word(totals, 0);
}

bool refine_overfull(Context& ctx, const Allocation& input, Allocation& keys, const Allocation& order,
                     Allocation& spare, std::size_t n, std::uint32_t overfull_points) {
  Launcher& launch = ctx.launcher;
  const auto count = static_cast<std::uint32_t>(n);
  const LaunchGrid c = launch.grid(n);
  constexpr std::uint32_t rounds = 4;
  for (std::uint32_t round = 0; round < rounds; ++round) {
    if (round != 0) overfull_points = flag_overfull(ctx, keys, spare, n);
    if (overfull_points == 0) return round != 0;
    ctx.statistics.refined_points = std::max<std::uint64_t>(ctx.statistics.refined_points, overfull_points);
    launch.scan(spare, n);
    const std::size_t bytes = overfull_points * word;
    Allocation places = ctx.memory.transient(bytes), round_keys = ctx.memory.transient(bytes);
    Allocation members = ctx.memory.transient(bytes), runs = ctx.memory.transient(bytes);
    const LaunchGrid few = launch.grid(overfull_points);
    launch.run<KernelId::cadt_pack_overfull>(c.items, spare, places, count, overfull_points, c.grain);
    for (;; ++round) {  // rounds in which all members of each run agree change nothing
      Allocation fresh = launch.zeros(1);
      launch.run<KernelId::cadt_refined_keys>(few.items, input, order, keys, places, round_keys, members, runs,
                                              overfull_points, round, few.grain, fresh);
      if (launch.read_word(fresh, 0) != 0) break;
      if (round + 1 == rounds) return true;
    }
    launch.scan(runs, overfull_points);
    const std::uint32_t last_run = launch.read_word(runs, overfull_points - 1);
    Allocation from = ctx.memory.transient(bytes), sorted = ctx.memory.transient(bytes);
    Allocation spare_from = ctx.memory.transient(bytes), spare_sorted = ctx.memory.transient(bytes);
    // Stable: first by the round's key, then by run. The sort permutes its keys, so it gets copies.
    launch.run<KernelId::cadt_copy_words>(few.items, round_keys, sorted, std::uint32_t{0}, overfull_points, few.grain);
    launch.sort(sorted, from, spare_sorted, spare_from, overfull_points, 32, true);
    if (last_run != 0) {
      launch.run<KernelId::cadt_gather_words>(few.items, runs, from, sorted, overfull_points, few.grain);
      launch.sort(sorted, from, spare_sorted, spare_from, overfull_points,
                  static_cast<unsigned>(std::bit_width(last_run)), false);
    }
    launch.run<KernelId::cadt_run_tails>(c.items, keys, Allocation(), spare, count, c.grain);
    launch.run<KernelId::cadt_store_refined>(few.items, places, members, from, runs, round_keys, order, spare,
                                             overfull_points, few.grain);
    launch.scan(spare, n);
    std::swap(keys, spare);
    ctx.check("sort", 0.05 + 0.01 * round);
  }
  return true;
}

KeyGrid KeyGrid::finer(int levels) const noexcept {
  KeyGrid grid = *this;
  grid.bits_x += static_cast<unsigned>(levels);
  grid.bits_y += static_cast<unsigned>(levels);
  grid.fine_levels += static_cast<unsigned>(levels);
  grid.scale = std::ldexp(scale, levels);
  grid.most_x = std::ldexp(most_x, levels);
  grid.most_y = std::ldexp(most_y, levels);
  return grid;
}

void make_fine_keys(Context& ctx, const Allocation& points, const Allocation& high, const Allocation& low,
                    std::size_t n, const KeyGrid& grid) {
  const LaunchGrid c = ctx.launcher.grid(n);
  ctx.launcher.run<KernelId::cadt_fine_hilbert_keys>(c.items, points, high, low, 2 * grid.fine_levels,
                                                     static_cast<std::uint32_t>(n), c.grain, grid.half_min_x,
                                                     grid.half_min_y, grid.scale, grid.bits_x, grid.bits_y);
}

void make_keys(Context& ctx, const Allocation& points, const Allocation& keys, std::size_t n, const KeyGrid& grid) {
  const LaunchGrid c = ctx.launcher.grid(n);
  ctx.launcher.run<KernelId::cadt_hilbert_keys>(c.items, points, keys, static_cast<std::uint32_t>(n), c.grain,
                                                grid.half_min_x, grid.half_min_y, grid.scale, grid.bits_x, grid.bits_y);
}

void flag_distinct(Context& ctx, const Allocation& keys, const Allocation& sorted, const Allocation& order,
                   const Allocation& flags, std::size_t n, bool neighbours, const Allocation& totals) {
  const LaunchGrid c = ctx.launcher.grid(n);
  const auto count = static_cast<std::uint32_t>(n);
  ctx.launcher.run<KernelId::cadt_sort_runs>(c.items, keys, sorted, order, count, c.grain, totals);
  ctx.launcher.run<KernelId::cadt_unique_flags>(c.items, sorted, keys, flags, count, c.grain, std::uint32_t{neighbours},
                                                totals);
}

void compact_distinct(Context& ctx, SortedPoints& result, Allocation sorted, Allocation order, const Allocation& flags,
                      std::size_t n, std::uint32_t equal, SetStarts* sets) {
  Launcher& launch = ctx.launcher;
  const auto count = static_cast<std::uint32_t>(n), distinct = count - equal;
  result.distinct = distinct;
  if (equal == 0) {
    result.points = std::move(sorted);
    result.input_ids = std::move(order);
    return;
  }
  const LaunchGrid c = launch.grid(n);
  launch.scan(flags, n);
  result.points = ctx.memory.allocate(distinct * point_bytes(ctx.device));
  result.input_ids = ctx.memory.allocate(distinct * word);
  launch.run<KernelId::cadt_unique_pack>(c.items, sorted, order, flags, result.points, result.input_ids, count,
                                         distinct, c.grain);
  find_duplicates(ctx, result, order, flags, n);
  if (sets != nullptr) {
    const LaunchGrid s = launch.grid(sets->count + 1);
    sets->positions = ctx.memory.allocate((sets->count + 1) * word);
    launch.run<KernelId::cadt_batch_starts>(s.items, flags, sets->points, static_cast<std::uint32_t>(sets->count),
                                            count, distinct, s.grain, sets->positions);
  }
}

SortedPoints sort_spatially(Context& ctx, Allocation input, std::size_t n, bool keep_keys) {
  Launcher& launch = ctx.launcher;
  const auto count = static_cast<std::uint32_t>(n);
  const LaunchGrid c = launch.grid(n);
  SortedPoints result;

  const Allocation totals = ctx.memory.allocate(CADT_ORDER_WORDS * word);
  const Bounds bounds = find_bounds(ctx, input, n, totals);
  // Kernels for floats take any float as it is.
  const bool floats = takes_floats_only(ctx.device);
  result.wide = !floats && bounds.high - bounds.low > narrow_span;
  launch.set_variant(result.wide ? KernelVariant::wide : narrow_variant(ctx.options.statistics));
  ctx.end_phase("bounds");
  ctx.check("sort", 0.01);

  // All coordinates become multiples of 2^-240 below 1, in two steps since one factor may be out of range.
  const int exponent = floats || result.wide || bounds.high < bounds.low ? 0 : -bounds.high;
  const double scale = std::ldexp(1.0, exponent / 2), scale_again = std::ldexp(1.0, exponent - exponent / 2);

  // To save memory there are two large buffers to borrow from: the sorted points and their keys shall be in the one
  // that is not of the stars.
  const bool tight = ctx.plan.compact && ctx.memory.pools(n * word);
  Allocation keys = ctx.memory.transient(n * word, tight), spare = ctx.memory.transient(n * word, tight);
  Allocation order = ctx.memory.transient(n * word), sorted;
  const auto gather = [&] {
    const std::size_t bytes = n * point_bytes(ctx.device);
    // They are copied before the mesh takes their place, or made again after it.
    const bool brief = !ctx.device.shape().contiguous && (ctx.plan.regathers || !keep_keys);
    sorted = brief ? ctx.memory.transient(bytes) : ctx.memory.allocate(bytes);
    launch.run<KernelId::cadt_gather_points>(c.items, input, order, sorted, count, c.grain, scale, scale_again);
    flag_distinct(ctx, keys, sorted, order, spare, n, keep_keys && n >= fewest_sampled, totals);
  };
  const auto sort = [&](const KeyGrid& grid) {
    Allocation spare_order = ctx.memory.transient(n * word);
    result.grid = grid;
    make_keys(ctx, input, keys, n, grid);
    launch.sort(keys, order, spare, spare_order, n, grid.bits(), true);
  };
  sort(grid_of_all(bounds, n));
  bool sorted_by_keys = true;
  std::array<std::uint32_t, CADT_ORDER_WORDS> sums{};
  std::uint32_t overfull_points = 0;
  if (n <= most_ahead) {
    ctx.end_phase("sort");
    gather();
    ctx.device.read(*totals, 0, sums.data(), sizeof sums);
    if (sums[CADT_OVERFULL] != 0) sorted.release();
  }
  // Flat sets have no use for keys.
  const bool for_stars = keep_keys && !(n <= most_ahead && sums[CADT_SHAPE_BESIDE] == 0);
  if (!sorted) {
    overfull_points = flag_overfull(ctx, keys, spare, n);
    bool few_provable = false;
    const auto finer = [&] {
      constexpr int most_levels = 31;  // of an axis
      return std::min(most_fine_levels,
                      most_levels - static_cast<int>(std::max(result.grid.bits_x, result.grid.bits_y)));
    };
    if (for_stars && overfull_points > n / 4 && n >= fewest_for_sample) {
      std::vector<cadt_point> sample = sample_of(ctx, input, n);
      if (const std::optional<KeyGrid> grid = grid_of_most(sample, bounds)) {
        sort(*grid);
        overfull_points = flag_overfull(ctx, keys, spare, n);
      }
      few_provable = ctx.options.strategy == Strategy::automatic && stays_crowded(sample, result.grid.finer(finer()));
    }
    const bool fine = for_stars && !few_provable && overfull_points > n / 4 && finer() >= fewest_fine_levels &&
                      result.grid.scale < std::ldexp(1.0, 1000);  // else it is of points that are nearly all equal
    if (fine) {
      result.grid = result.grid.finer(finer());
      sort_finely(ctx, input, keys, order, spare, n, result.grid);
      overfull_points = flag_overfull(ctx, keys, spare, n);
    }
    ctx.end_phase("sort");
    ctx.check("sort", 0.05);
    sorted_by_keys = !refine_overfull(ctx, input, keys, order, spare, n, overfull_points) && !fine;
    ctx.end_phase("refine");
    ctx.device.fill(*totals, 0, sums.size() * word, 0);
    gather();
    ctx.device.read(*totals, 0, sums.data(), sizeof sums);
  }
  for (const double factor : {scale, scale_again}) {
    result.grid.half_min_x *= factor;
    result.grid.half_min_y *= factor;
    result.grid.scale /= factor;
  }
  result.scale = scale;
  result.scale_again = scale_again;
  // On circles are a twelfth to a seventh of a turned lattice and a twelfth to a third of 12-gons, but less than a
  // fourteenth of most lattices of triangles, which are better wrapped. On rays is a fifth of a polar grid or more, on
  // lines hardly a point of other sets; on one circle are all corners of a polygon, and none of other sets. On the hull
  // seem to be a seventh of a thin ring, but a tenth of evenly spread points.
  constexpr std::uint32_t samples = CADT_POINT_SAMPLES;
  result.shapes.overfull = overfull_points > n - n / 4 && sums[CADT_EQUAL] < n / 4;
  result.shapes.on_line = sums[CADT_SHAPE_BESIDE] == 0;
  result.shapes.on_circle = 2 * sums[CADT_SHAPE_ONE_CIRCLE] > std::min<std::size_t>(n, samples);
  result.shapes.on_hull = 10 * sums[CADT_SHAPE_HULL] > 9 * std::min<std::size_t>(n, samples);
  result.shapes.on_ring = !result.shapes.overfull && 9 * sums[CADT_SHAPE_HULL] > std::min<std::size_t>(n, samples);
  result.shapes.on_rays = 8 * sums[CADT_SHAPE_LINE] > samples;
  result.shapes.on_circles = 14 * sums[CADT_SHAPE_CIRCLE] > samples;
  result.shapes.on_lattice = 4 * sums[CADT_SHAPE_MIRRORED] > samples;
  input.release();
  const auto move_to = [&](Allocation& values, Allocation place) {
    launch.run<KernelId::cadt_copy_words>(c.items, values, place, std::uint32_t{0}, count, c.grain);
    values = std::move(place);
  };
  if (keep_keys && sorted_by_keys && sums[CADT_EQUAL] == 0) {
    if (tight) move_to(keys, ctx.memory.transient(n * word));
    result.keys = std::move(keys);
  }
  keys.release();
  // Labels are for long, and what was sorted is borrowed; buckets take their place (renumber.cpp), one more.
  if (sums[CADT_EQUAL] == 0 && ctx.memory.pools(n * word)) move_to(order, ctx.memory.allocate((n + 1) * word));
  compact_distinct(ctx, result, std::move(sorted), std::move(order), spare, n, sums[CADT_EQUAL]);
  ctx.end_phase("gather");
  return result;
}

}  // namespace cadt
