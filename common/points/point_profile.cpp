// SPDX-License-Identifier: Apache-2.0
#include "common/points/point_profile.hpp"

#include <algorithm>

#include "common/driver/device_text.hpp"

namespace cadt {

using namespace device_text;

PointShapes shapes_of(std::span<const std::uint32_t> counts, std::size_t n, std::uint32_t overfull_points) noexcept {
  PointShapes shapes;
  // The thresholds lie between the shares seen on such sets and on all others. Cocircular with their neighbours: 1/12
  // to 1/7 of a rotated lattice and 1/12 to 1/3 of sets of 12-gons, but less than 1/14 of most triangular lattices,
  // which gift wrapping handles better. On rays: 1/5 of a polar grid or more; on lines of other sets hardly any. On one
  // circle: all vertices of a polygon, none of other sets. Seemingly on the hull: 1/7 of a thin ring, 1/10 of evenly
  // spread points.
  constexpr std::uint32_t samples = CADT_POINT_SAMPLES;
  shapes.overfull = overfull_points > n - n / 4 && counts[CADT_EQUAL] < n / 4;
  shapes.on_line = counts[CADT_SHAPE_BESIDE] == 0;
  shapes.on_circle = 2 * counts[CADT_SHAPE_ONE_CIRCLE] > std::min<std::size_t>(n, samples);
  shapes.on_hull = 10 * counts[CADT_SHAPE_HULL] > 9 * std::min<std::size_t>(n, samples);
  shapes.on_ring = !shapes.overfull && 9 * counts[CADT_SHAPE_HULL] > std::min<std::size_t>(n, samples);
  shapes.on_rays = 8 * counts[CADT_SHAPE_LINE] > samples;
  shapes.on_circles = 14 * counts[CADT_SHAPE_CIRCLE] > samples;
  shapes.on_lattice = 4 * counts[CADT_SHAPE_MIRRORED] > samples;
  return shapes;
}

}  // namespace cadt
