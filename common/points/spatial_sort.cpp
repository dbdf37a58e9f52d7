// SPDX-License-Identifier: Apache-2.0
#include "common/points/spatial_sort.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/driver/device_text.hpp"
#include "common/points/device_points.hpp"
#include "common/points/duplicates.hpp"
#include "common/points/key_refinement.hpp"

namespace cadt {
namespace {

using namespace device_text;

/// Up to here, waiting for the device costs more than speculative work that over-full cells make useless.
constexpr std::size_t most_ahead = std::size_t{1} << 17;

constexpr std::size_t fewest_for_sample = 16384;

/// A sample of the points, the same in every run.
std::vector<cadt_point> sample_of(Context& ctx, const Allocation& input, std::size_t n) {
  const std::size_t samples = n <= most_ahead ? 1024 : 4096;
  std::vector<std::uint32_t> places(samples);
  // Knuth's multiplicative hash: the places keep step with no pattern in the data.
  for (std::size_t i = 0; i < samples; ++i) places[i] = static_cast<std::uint32_t>(i * 0x9E3779B97F4A7C15U % n);
  const Allocation list = ctx.memory.allocate(samples * word),
                   chosen = ctx.memory.allocate(samples * sizeof(cadt_point));
  ctx.device.write(*list, 0, places.data(), samples * word);
  ctx.launcher.run<KernelId::cadt_gather_points>(input, list, chosen, ctx.launcher.grid(samples), 1.0, 1.0);
  return ctx.device.read_values<cadt_point>(*chosen, samples);
}

/// A grid without the outermost points, where their absence makes the bounding box much smaller: with heavy tails, or a
/// few points far away from all others, most points would share one cell.
std::optional<KeyGrid> grid_of_most(std::vector<cadt_point>& points, Bounds bounds) {
  const std::size_t samples = points.size(), tail = samples / 340;  // points cut off at either end of each axis
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

/// Whether most points would share their cell of `grid` with hundreds of others: then hardly any point of a sample is
/// alone in its cell.
bool stays_crowded(std::span<const cadt_point> sample, const KeyGrid& grid) {
  constexpr std::size_t few = 256;
  std::vector<std::pair<double, double>> cells;
  for (std::size_t i = 0; i < sample.size(); i += sample.size() / few) {  // grid_of_most has permuted them
    const cadt_point& p = sample[i];
    cells.emplace_back(std::floor((0.5 * p.x - grid.half_min_x) * grid.scale),
                       std::floor((0.5 * p.y - grid.half_min_y) * grid.scale));
  }
  std::ranges::sort(cells);
  const auto distinct = std::unique(cells.begin(), cells.end()) - cells.begin();
  return 8 * distinct < static_cast<std::ptrdiff_t>(cells.size());
}

constexpr int most_fine_levels = 15, fewest_fine_levels = 4;

/// Sorts by two-word keys, of a grid with so many more levels that few cells are over-full; `keys` become the numbers
/// of the runs of equal keys.
void sort_finely(Context& ctx, const Allocation& input, Allocation& keys, Allocation& order, Allocation& spare,
                 std::size_t n, const KeyGrid& grid) {
  Launcher& launch = ctx.launcher;
  const LaunchGrid all = launch.grid(n);
  const Allocation low = ctx.memory.transient(n * word);
  make_keys(ctx, input, keys, low, n, grid);
  Allocation sorted = ctx.memory.transient(n * word), spare_order = ctx.memory.transient(n * word);
  launch.run<KernelId::cadt_copy_words>(low, sorted, 0U, all);
  launch.sort(sorted, order, spare, spare_order, n, 2 * grid.fine_levels, true);
  // the second of two stable sorts
  launch.run<KernelId::cadt_gather_words>(keys, order, sorted, all);
  launch.sort(sorted, order, spare, spare_order, n, grid.bits() - 2 * grid.fine_levels, false);
  launch.run<KernelId::cadt_gather_words>(low, order, spare, all);
  launch.run<KernelId::cadt_run_tails>(sorted, spare, keys, all);
  launch.scan(keys, n);
}

}  // namespace

SortedPoints sort_spatially(Context& ctx, Allocation input, std::size_t n, bool keep_keys) {
  Launcher& launch = ctx.launcher;
  const LaunchGrid all = launch.grid(n);
  SortedPoints result;

  const Allocation totals = ctx.memory.allocate(CADT_ORDER_WORDS * word);
  const Bounds bounds = find_bounds(ctx, input, n, totals);
  // The float kernels take any exponent.
  const bool floats = takes_floats_only(ctx.device);
  result.wide = !floats && bounds.high - bounds.low > narrow_span;
  launch.set_variant(result.wide ? KernelVariant::wide : narrow_variant(ctx.options.statistics));
  ctx.end_phase("bounds");
  ctx.check("sort", 0.01);

  // All coordinates become multiples of 2^-240 below 1; in two steps, since one factor may be out of range.
  const int exponent = floats || result.wide || bounds.high < bounds.low ? 0 : -bounds.high;
  const double scale = std::ldexp(1.0, exponent / 2), scale_again = std::ldexp(1.0, exponent - exponent / 2);

  // To save memory there are two large pooled buffers: the sorted points and their keys shall be in the one that the
  // stars do not use.
  const bool tight = ctx.plan.compact && ctx.memory.pools(n * word);
  Allocation keys = ctx.memory.transient(n * word, tight), spare = ctx.memory.transient(n * word, tight);
  Allocation order = ctx.memory.transient(n * word), sorted;
  const auto gather = [&] {
    const std::size_t bytes = n * point_bytes(ctx.device);
    // Transient if they are copied before the mesh takes their place, or gathered again after it.
    const bool brief = !ctx.device.shape().contiguous && (ctx.plan.regathers || !keep_keys);
    sorted = brief ? ctx.memory.transient(bytes) : ctx.memory.allocate(bytes);
    launch.run<KernelId::cadt_gather_points>(input, order, sorted, all, scale, scale_again);
    flag_distinct(ctx, keys, sorted, order, spare, n, keep_keys && n >= fewest_sampled, totals);
  };
  const auto sort = [&](const KeyGrid& grid) {
    Allocation spare_order = ctx.memory.transient(n * word);
    result.grid = grid;
    make_keys(ctx, input, keys, {}, n, grid);
    launch.sort(keys, order, spare, spare_order, n, grid.bits(), true);
  };
  // Graphics cards sort eight more bits of all keys in less time than they refine a few over-full cells.
  sort(grid_of_all(bounds, n, !ctx.device.shape().contiguous && n > most_ahead));
  bool sorted_by_keys = true;
  std::vector<std::uint32_t> sums(CADT_ORDER_WORDS);
  std::uint32_t overfull_points = 0;
  if (n <= most_ahead) {
    ctx.end_phase("sort");
    gather();
    sums = ctx.device.read_values(*totals, CADT_ORDER_WORDS);
    if (sums[CADT_OVERFULL] != 0) sorted.release();
  }
  // Flat sets need no keys.
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
      few_provable =
          ctx.options.tuning.strategy == Strategy::automatic && stays_crowded(sample, result.grid.finer(finer()));
    }
    const bool fine = for_stars && !few_provable && overfull_points > n / 4 && finer() >= fewest_fine_levels &&
                      result.grid.scale < std::ldexp(1.0, 1000);  // else nearly all points are equal
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
    sums = ctx.device.read_values(*totals, CADT_ORDER_WORDS);
  }
  for (const double factor : {scale, scale_again}) {
    result.grid.half_min_x *= factor;
    result.grid.half_min_y *= factor;
    result.grid.scale /= factor;
  }
  result.scale = scale;
  result.scale_again = scale_again;
  result.shapes = shapes_of(sums, n, overfull_points);
  input.release();
  const auto move_to = [&](Allocation& values, Allocation place) {
    launch.run<KernelId::cadt_copy_words>(values, place, 0U, all);
    values = std::move(place);
  };
  if (keep_keys && sorted_by_keys && sums[CADT_EQUAL] == 0) {
    if (tight) move_to(keys, ctx.memory.transient(n * word));
    result.keys = std::move(keys);
  }
  keys.release();
  // The input ids live long, but the sorted order lies in a transient buffer; buckets will take their place
  // (renumber.cpp), one more.
  if (sums[CADT_EQUAL] == 0 && ctx.memory.pools(n * word)) move_to(order, ctx.memory.allocate((n + 1) * word));
  compact_distinct(ctx, result, std::move(sorted), std::move(order), spare, n, sums[CADT_EQUAL]);
  ctx.end_phase("gather");
  return result;
}

}  // namespace cadt
