// SPDX-License-Identifier: Apache-2.0
#include "common/host/spatial_order.hpp"

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

#include "common/host/device_constants.hpp"
#include "common/host/device_points.hpp"

namespace cadt {
namespace {

using namespace device_constants;

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
cadt_bounds_row merge_bounds(Run& run, const Allocation& input, std::size_t n, std::uint32_t group,
                             const Allocation& totals) {
  const Cut c = run.launcher.parts(n);
  const std::uint32_t room = (c.items - 1) / group + 1;
  const Allocation rows = run.memory.allocate(room * row_bytes(run.device));
  run.launcher.run(KernelId::cadt_bounds, c.items, input, static_cast<std::uint32_t>(n), c.grain, c.items, room, rows);
  const std::uint32_t team = run.device.shape().contiguous ? 1 : CADT_BOUNDS_LANES;
  run.launcher.run_in_groups(KernelId::cadt_merge_bounds, team, team, rows, room, totals);
  const cadt_bounds_row all = read_row(run.device, *rows);
  // Devices may make smaller groups than they were asked for.
  return all.rows > room ? merge_bounds(run, input, n, 1, totals) : all;
}

Bounds find_bounds(Run& run, const Allocation& input, std::size_t n, const Allocation& totals) {
  constexpr std::uint32_t usual_group = 128;  // the least that a GPU has unless the options say so
  const unsigned asked = run.options.work_group_size;
  const std::uint32_t group = run.device.shape().contiguous ? 1
                              : asked == 0                  ? usual_group
                                                            : std::min(asked, usual_group);
  const cadt_bounds_row all = merge_bounds(run, input, n, group, totals);
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

/// The largest squares of the grid with at most CADT_TILE_POINTS points are tiles (common/device/tiles.h), so evenly
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
std::vector<cadt_point> sample_of(Run& run, const Allocation& input, std::size_t n) {
  const std::size_t samples = n <= most_ahead ? 1024 : 4096;
  std::vector<std::uint32_t> places(samples);
  // In step with nothing that is in the data (D. E. Knuth's multiplicative hash).
  for (std::size_t i = 0; i < samples; ++i) places[i] = static_cast<std::uint32_t>(i * 0x9E3779B97F4A7C15U % n);
  const Allocation list = run.memory.allocate(samples * word),
                   chosen = run.memory.allocate(samples * sizeof(cadt_point));
  run.device.write(*list, 0, places.data(), samples * word);
  const Cut c = run.launcher.cut(samples);
  run.launcher.run(KernelId::cadt_gather_points, c.items, input, list, chosen, static_cast<std::uint32_t>(samples),
                   c.grain, 1.0, 1.0);
  std::vector<cadt_point> points(samples);
  run.device.read(*chosen, 0, points.data(), samples * sizeof points[0]);
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
void sort_finely(Run& run, const Allocation& input, Allocation& keys, Allocation& order, Allocation& spare,
                 std::size_t n, const KeyGrid& grid) {
  Launcher& launch = run.launcher;
  const auto count = static_cast<std::uint32_t>(n);
  const Cut c = launch.cut(n);
  const Allocation low = run.memory.borrow(n * word);
  make_fine_keys(run, input, keys, low, n, grid);
  Allocation sorted = run.memory.borrow(n * word), spare_order = run.memory.borrow(n * word);
  launch.run(KernelId::cadt_copy_words, c.items, low, sorted, std::uint32_t{0}, count, c.grain);
  launch.sort(sorted, order, spare, spare_order, n, 2 * grid.fine_levels, true);
  // stable
  launch.run(KernelId::cadt_gather_words, c.items, keys, order, sorted, count, c.grain);
  launch.sort(sorted, order, spare, spare_order, n, grid.bits() - 2 * grid.fine_levels, false);
  launch.run(KernelId::cadt_gather_words, c.items, low, order, spare, count, c.grain);
  launch.run(KernelId::cadt_run_tails, c.items, sorted, spare, keys, count, c.grain);
  launch.scan(keys, n);
}

/// The points that equal an earlier one, ascending, and those that they equal.
void find_duplicates(Run& run, SpatialOrder& result, const Allocation& order, const Allocation& ranks, std::size_t n) {
  const std::size_t count = n - result.distinct;
  result.duplicates = run.memory.allocate(count * word);
  result.representatives = run.memory.allocate(count * word);
  Allocation spare = run.memory.allocate(count * word), spare_values = run.memory.allocate(count * word);
  const Cut c = run.launcher.cut(n);
  run.launcher.run(KernelId::cadt_duplicate_pairs, c.items, order, ranks, result.labels, result.duplicates,
                   result.representatives, static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(result.distinct),
                   c.grain);
  run.launcher.sort(result.duplicates, result.representatives, spare, spare_values, count,
                    static_cast<unsigned>(std::bit_width(n - 1)), false);
}

}  // namespace

std::uint32_t flag_crowded(Run& run, const Allocation& keys, const Allocation& flags, std::size_t n) {
  const Cut c = run.launcher.cut(n);
  const Allocation totals = run.launcher.zeros(1);
  run.launcher.run(KernelId::cadt_crowded_flags, c.items, keys, flags, static_cast<std::uint32_t>(n), c.grain, totals);
  return run.launcher.read_word(totals, 0);
}

bool refine_crowd(Run& run, const Allocation& input, Allocation& keys, const Allocation& order, Allocation& spare,
                  std::size_t n, std::uint32_t crowd) {
  Launcher& launch = run.launcher;
  const auto count = static_cast<std::uint32_t>(n);
  const Cut c = launch.cut(n);
  constexpr std::uint32_t rounds = 4;
  for (std::uint32_t round = 0; round < rounds; ++round) {
    if (round != 0) crowd = flag_crowded(run, keys, spare, n);
    if (crowd == 0) return round != 0;
    run.statistics.refined_points = std::max<std::uint64_t>(run.statistics.refined_points, crowd);
    launch.scan(spare, n);
    const std::size_t bytes = crowd * word;
    Allocation places = run.memory.borrow(bytes), round_keys = run.memory.borrow(bytes);
    Allocation members = run.memory.borrow(bytes), runs = run.memory.borrow(bytes);
    const Cut few = launch.cut(crowd);
    launch.run(KernelId::cadt_crowded_pack, c.items, spare, places, count, crowd, c.grain);
    for (;; ++round) {  // rounds in which all members of each run agree change nothing
      Allocation fresh = launch.zeros(1);
      launch.run(KernelId::cadt_crowded_keys, few.items, input, order, keys, places, round_keys, members, runs, crowd,
                 round, few.grain, fresh);
      if (launch.read_word(fresh, 0) != 0) break;
      if (round + 1 == rounds) return true;
    }
    launch.scan(runs, crowd);
    const std::uint32_t last_run = launch.read_word(runs, crowd - 1);
    Allocation from = run.memory.borrow(bytes), sorted = run.memory.borrow(bytes);
    Allocation spare_from = run.memory.borrow(bytes), spare_sorted = run.memory.borrow(bytes);
    // Stable: first by the round's key, then by run. The sort permutes its keys, so it gets copies.
    launch.run(KernelId::cadt_copy_words, few.items, round_keys, sorted, std::uint32_t{0}, crowd, few.grain);
    launch.sort(sorted, from, spare_sorted, spare_from, crowd, 32, true);
    if (last_run != 0) {
      launch.run(KernelId::cadt_gather_words, few.items, runs, from, sorted, crowd, few.grain);
      launch.sort(sorted, from, spare_sorted, spare_from, crowd, static_cast<unsigned>(std::bit_width(last_run)),
                  false);
    }
    launch.run(KernelId::cadt_run_tails, c.items, keys, Allocation(), spare, count, c.grain);
    launch.run(KernelId::cadt_crowded_store, few.items, places, members, from, runs, round_keys, order, spare, crowd,
               few.grain);
    launch.scan(spare, n);
    std::swap(keys, spare);
    run.check("sort", 0.05 + 0.01 * round);
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

void make_fine_keys(Run& run, const Allocation& points, const Allocation& high, const Allocation& low, std::size_t n,
                    const KeyGrid& grid) {
  const Cut c = run.launcher.cut(n);
  run.launcher.run(KernelId::cadt_fine_keys, c.items, points, high, low, 2 * grid.fine_levels,
                   static_cast<std::uint32_t>(n), c.grain, grid.half_min_x, grid.half_min_y, grid.scale, grid.bits_x,
                   grid.bits_y);
}

void make_keys(Run& run, const Allocation& points, const Allocation& keys, std::size_t n, const KeyGrid& grid) {
  const Cut c = run.launcher.cut(n);
  run.launcher.run(KernelId::cadt_sort_keys, c.items, points, keys, static_cast<std::uint32_t>(n), c.grain,
                   grid.half_min_x, grid.half_min_y, grid.scale, grid.bits_x, grid.bits_y);
}

void flag_distinct(Run& run, const Allocation& keys, const Allocation& sorted, const Allocation& order,
                   const Allocation& flags, std::size_t n, bool neighbours, const Allocation& totals) {
  const Cut c = run.launcher.cut(n);
  const auto count = static_cast<std::uint32_t>(n);
  run.launcher.run(KernelId::cadt_sort_runs, c.items, keys, sorted, order, count, c.grain, totals);
  run.launcher.run(KernelId::cadt_unique_flags, c.items, sorted, keys, flags, count, c.grain, std::uint32_t{neighbours},
                   totals);
}

void close_order(Run& run, SpatialOrder& result, Allocation sorted, Allocation order, const Allocation& flags,
                 std::size_t n, std::uint32_t equal, SetStarts* sets) {
  Launcher& launch = run.launcher;
  const auto count = static_cast<std::uint32_t>(n), distinct = count - equal;
  result.distinct = distinct;
  if (equal == 0) {
    result.points = std::move(sorted);
    result.labels = std::move(order);
    return;
  }
  const Cut c = launch.cut(n);
  launch.scan(flags, n);
  result.points = run.memory.allocate(distinct * point_bytes(run.device));
  result.labels = run.memory.allocate(distinct * word);
  launch.run(KernelId::cadt_unique_pack, c.items, sorted, order, flags, result.points, result.labels, count, distinct,
             c.grain);
  find_duplicates(run, result, order, flags, n);
  if (sets != nullptr) {
    const Cut s = launch.cut(sets->count + 1);
    sets->positions = run.memory.allocate((sets->count + 1) * word);
    launch.run(KernelId::cadt_set_starts, s.items, flags, sets->points, static_cast<std::uint32_t>(sets->count), count,
               distinct, s.grain, sets->positions);
  }
}

SpatialOrder sort_points(Run& run, Allocation input, std::size_t n, bool keep_keys) {
  Launcher& launch = run.launcher;
  const auto count = static_cast<std::uint32_t>(n);
  const Cut c = launch.cut(n);
  SpatialOrder result;

  const Allocation totals = run.memory.allocate(CADT_ORDER_WORDS * word);
  const Bounds bounds = find_bounds(run, input, n, totals);
  // Kernels for floats take any float as it is.
  const bool floats = takes_floats_only(run.device);
  result.wide = !floats && bounds.high - bounds.low > narrow_span;
  launch.set_build(result.wide ? KernelBuild::wide : narrow_build(run.options.statistics));
  run.end_phase("bounds");
  run.check("sort", 0.01);

  // All coordinates become multiples of 2^-240 below 1, in two steps since one factor may be out of range.
  const int exponent = floats || result.wide || bounds.high < bounds.low ? 0 : -bounds.high;
  const double scale = std::ldexp(1.0, exponent / 2), scale_again = std::ldexp(1.0, exponent - exponent / 2);

  // To save memory there are two large buffers to borrow from: the sorted points and their keys shall be in the one
  // that is not of the stars.
  const bool tight = run.saves_memory && run.memory.lends(n * word);
  Allocation keys = run.memory.borrow(n * word, tight), spare = run.memory.borrow(n * word, tight);
  Allocation order = run.memory.borrow(n * word), sorted;
  const auto gather = [&] {
    const std::size_t bytes = n * point_bytes(run.device);
    // They are copied before the mesh takes their place, or made again after it.
    const bool brief = !run.device.shape().contiguous && (run.regathers || !keep_keys);
    sorted = brief ? run.memory.borrow(bytes) : run.memory.allocate(bytes);
    launch.run(KernelId::cadt_gather_points, c.items, input, order, sorted, count, c.grain, scale, scale_again);
    flag_distinct(run, keys, sorted, order, spare, n, keep_keys && n >= fewest_sampled, totals);
  };
  const auto sort = [&](const KeyGrid& grid) {
    Allocation spare_order = run.memory.borrow(n * word);
    result.grid = grid;
    make_keys(run, input, keys, n, grid);
    launch.sort(keys, order, spare, spare_order, n, grid.bits(), true);
  };
  sort(grid_of_all(bounds, n));
  bool sorted_by_keys = true;
  std::array<std::uint32_t, CADT_ORDER_WORDS> sums{};
  std::uint32_t crowd = 0;
  if (n <= most_ahead) {
    run.end_phase("sort");
    gather();
    run.device.read(*totals, 0, sums.data(), sizeof sums);
    if (sums[CADT_CROWDED] != 0) sorted.release();
  }
  // Flat sets have no use for keys.
  const bool for_stars = keep_keys && !(n <= most_ahead && sums[CADT_SHAPE_BESIDE] == 0);
  if (!sorted) {
    crowd = flag_crowded(run, keys, spare, n);
    bool hopeless = false;
    const auto finer = [&] {
      constexpr int most_levels = 31;  // of an axis
      return std::min(most_fine_levels,
                      most_levels - static_cast<int>(std::max(result.grid.bits_x, result.grid.bits_y)));
    };
    if (for_stars && crowd > n / 4 && n >= fewest_for_sample) {
      std::vector<cadt_point> sample = sample_of(run, input, n);
      if (const std::optional<KeyGrid> grid = grid_of_most(sample, bounds)) {
        sort(*grid);
        crowd = flag_crowded(run, keys, spare, n);
      }
      hopeless = run.options.strategy == Strategy::automatic && stays_crowded(sample, result.grid.finer(finer()));
    }
    const bool fine = for_stars && !hopeless && crowd > n / 4 && finer() >= fewest_fine_levels &&
                      result.grid.scale < std::ldexp(1.0, 1000);  // else it is of points that are nearly all equal
    if (fine) {
      result.grid = result.grid.finer(finer());
      sort_finely(run, input, keys, order, spare, n, result.grid);
      crowd = flag_crowded(run, keys, spare, n);
    }
    run.end_phase("sort");
    run.check("sort", 0.05);
    sorted_by_keys = !refine_crowd(run, input, keys, order, spare, n, crowd) && !fine;
    run.end_phase("refine");
    run.device.fill(*totals, 0, sums.size() * word, 0);
    gather();
    run.device.read(*totals, 0, sums.data(), sizeof sums);
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
  result.shapes.crowded = crowd > n - n / 4 && sums[CADT_EQUAL] < n / 4;
  result.shapes.on_line = sums[CADT_SHAPE_BESIDE] == 0;
  result.shapes.on_circle = 2 * sums[CADT_SHAPE_ONE_CIRCLE] > std::min<std::size_t>(n, samples);
  result.shapes.on_hull = 10 * sums[CADT_SHAPE_HULL] > 9 * std::min<std::size_t>(n, samples);
  result.shapes.on_ring = !result.shapes.crowded && 9 * sums[CADT_SHAPE_HULL] > std::min<std::size_t>(n, samples);
  result.shapes.on_rays = 8 * sums[CADT_SHAPE_LINE] > samples;
  result.shapes.on_circles = 14 * sums[CADT_SHAPE_CIRCLE] > samples;
  result.shapes.on_lattice = 4 * sums[CADT_SHAPE_MIRRORED] > samples;
  input.release();
  const auto move_to = [&](Allocation& values, Allocation place) {
    launch.run(KernelId::cadt_copy_words, c.items, values, place, std::uint32_t{0}, count, c.grain);
    values = std::move(place);
  };
  if (keep_keys && sorted_by_keys && sums[CADT_EQUAL] == 0) {
    if (tight) move_to(keys, run.memory.borrow(n * word));
    result.keys = std::move(keys);
  }
  keys.release();
  // Labels are for long, and what was sorted is borrowed; buckets take their place (collect.cpp), one more.
  if (sums[CADT_EQUAL] == 0 && run.memory.lends(n * word)) move_to(order, run.memory.allocate((n + 1) * word));
  close_order(run, result, std::move(sorted), std::move(order), spare, n, sums[CADT_EQUAL]);
  run.end_phase("gather");
  return result;
}

}  // namespace cadt
