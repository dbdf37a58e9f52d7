// SPDX-License-Identifier: Apache-2.0
#include "common/points/point_profile.hpp"

#include <algorithm>

#include "common/driver/device_text.hpp"

namespace cadt {

using namespace device_text;

PointShapes shapes_of(std::span<const std::uint32_t> counts, std::size_t n, std::uint32_t overfull_points) noexcept {
  PointShapes shapes;
  // On circles are a twelfth to a seventh of a turned lattice and a twelfth to a third of 12-gons, but less than a
  // fourteenth of most lattices of triangles, which are better wrapped. On rays is a fifth of a polar grid or more, on
  // lines hardly a point of other sets; on one circle are all corners of a polygon, and none of other sets. On the hull
  // seem to be a seventh of a thin ring, but a tenth of evenly spread points.
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
