// SPDX-License-Identifier: Apache-2.0
#include "common/points/key_grid.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "common/driver/device_text.hpp"

namespace cadt {
namespace {

constexpr std::size_t least_points_of_tiles = 400'000;  // fewer do not fill a GPU with tiles of that size
constexpr double points_of_tile = 600, fewest_of_tile = 450;

/// The largest squares of the grid with at most CADT_TILE_POINTS points are tiles (common/stars/tiles.dev.h), so with
/// evenly spread points a tile has between a quarter of that and all of it. Cells up to twice as long bring tiles close
/// to the size that is best for local stars, and make the last tiles along each axis wide enough: the neighbourhood
/// grid of a sliver has too many points. Returns the factor for the scale of the grid.
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
    // of two with equal remainders, the larger tiles
    const double price = (rows > 1 ? sliver : 0) + 0.5 * (1 - longer / tiles / most);
    if (price < cost) cost = price, best = longer / tiles;
  }
  return cost < 2 && best > side && best < 2 * side ? side / best * (1 - 0x1p-30) : 1;
}

}  // namespace

KeyGrid choose_grid(const Bounds& bounds, int bits) {
  // Halved: the width of the bounding box may exceed the largest double.
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
  grid.scale = std::numeric_limits<double>::max();  // any finite scale will do if all points are equal, or nearly so
  if (longer > 0) grid.scale = std::min(grid.scale, std::ldexp(1.0, longer_bits) / longer);
  // the shorter axis must not exceed its bits either, unless it has none
  if (shorter > 0 && shorter_bits > 0) grid.scale = std::min(grid.scale, std::ldexp(1.0, shorter_bits) / shorter);
  return grid;
}

KeyGrid grid_of_all(const Bounds& bounds, std::size_t n, bool finest) {
  // About sixteen square cells a point suit well-spread data: runs of equal keys are short.
  const int suitable = std::clamp(static_cast<int>(std::bit_width(n)) + 4, 4, most_key_bits);
  KeyGrid grid = choose_grid(bounds, finest ? most_key_bits : suitable);
  const double width = 0.5 * bounds.max_x - 0.5 * bounds.min_x, height = 0.5 * bounds.max_y - 0.5 * bounds.min_y;
  if (n >= least_points_of_tiles) grid.scale *= scale_for_tiles(grid, width, height, n);
  grid.most_x = width * grid.scale;
  grid.most_y = height * grid.scale;
  return grid;
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

void make_keys(Context& ctx, const Allocation& points, const Allocation& high, const Allocation& low, std::size_t n,
               const KeyGrid& grid) {
  const LaunchGrid all = ctx.launcher.grid(n);
  if (low)
    ctx.launcher.run<KernelId::cadt_fine_hilbert_keys>(points, high, low, 2 * grid.fine_levels, all, grid);
  else
    ctx.launcher.run<KernelId::cadt_hilbert_keys>(points, high, all, grid);
}

}  // namespace cadt
