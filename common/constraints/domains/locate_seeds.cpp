// SPDX-License-Identifier: Apache-2.0
// Triangles of holes and regions. Seeds are few and triangles many, so each triangle looks for its seeds.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "common/constraints/domains/domains.hpp"
#include "common/constraints/domains/seed_tree.hpp"
#include "common/constraints/exact/crossing_places.hpp"
#include "common/constraints/stop_check.hpp"
#include "common/verify/host/exact_sign.hpp"

namespace cadt {
namespace {

using Place = SeedTree::Place;

void add_seed(std::vector<Place>& seeds, const char* option, std::size_t i, double x, double y) {
  if (!std::isfinite(x) || !std::isfinite(y))
    throw OptionError(option, "place " + std::to_string(i) + " is not finite: give x and y as finite numbers",
                      "ConstraintOptions::");
  seeds.push_back({x, y});
}

bool contains_exactly(const constraints::CrossingPlaces& vertices, std::span<const std::int32_t> triangle,
                      const verifier::Point& q) {
  std::array<exact::Line, 6> lines;
  const exact::ImplicitPoints exact(lines);
  std::array<exact::Place, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = vertices.place(static_cast<std::size_t>(triangle[k]), 2 * k, lines, exact);
  const exact::Place seed = exact::explicit_place(q);
  return exact.orientation(p[0], p[1], seed) >= 0 && exact.orientation(p[1], p[2], seed) >= 0 &&
         exact.orientation(p[2], p[0], seed) >= 0;
}

}  // namespace

DomainSeeds locate_seeds(std::span<const std::int32_t> triangles, const PointsView& points, const AddedPlaces& added,
                         const ConstraintOptions& options, const stop_token& stop) {
  DomainSeeds found;
  if (options.domain != Domain::seeds) return found;
  found.holes.assign(options.holes.size(), -1);
  found.regions.assign(options.regions.size(), -1);
  std::vector<Place> seeds;
  for (std::size_t i = 0; i < options.holes.size(); ++i)
    add_seed(seeds, "holes", i, options.holes[i][0], options.holes[i][1]);
  for (std::size_t i = 0; i < options.regions.size(); ++i)
    add_seed(seeds, "regions", i, options.regions[i].x, options.regions[i].y);
  if (seeds.empty()) return found;
  verifier::require_ieee_arithmetic();

  const auto is_added = [&](std::int32_t v) { return static_cast<std::size_t>(v) >= points.size(); };
  const auto point = [&](std::int32_t v) -> verifier::Point {
    const auto i = static_cast<std::size_t>(v);
    if (i < points.size()) return {points.x(i), points.y(i)};
    return {added.xy[2 * (i - points.size())], added.xy[2 * (i - points.size()) + 1]};
  };
  const constraints::CrossingPlaces crossings{points, added.segments, added.pairs};
  const SeedTree tree(seeds);
  for (std::size_t t = 0; t < triangles.size() / 3; ++t) {
    if (t % 4096 == 0) constraints::check(stop);
    const std::array<verifier::Point, 3> p = {point(triangles[3 * t]), point(triangles[3 * t + 1]),
                                              point(triangles[3 * t + 2])};
    tree.each_in({{{p[0].x, p[0].y}, {p[1].x, p[1].y}, {p[2].x, p[2].y}}}, [&](std::size_t i) {
      std::int32_t& triangle = i < found.holes.size() ? found.holes[i] : found.regions[i - found.holes.size()];
      if (triangle >= 0) return;
      const verifier::Point q = {seeds[i][0], seeds[i][1]};
      const bool has_crossing = !added.pairs.empty() && std::ranges::any_of(triangles.subspan(3 * t, 3), is_added);
      if (has_crossing ? contains_exactly(crossings, triangles.subspan(3 * t, 3), q)
                       : verifier::orientation(p[0], p[1], q) >= 0 && verifier::orientation(p[1], p[2], q) >= 0 &&
                             verifier::orientation(p[2], p[0], q) >= 0)
        triangle = static_cast<std::int32_t>(t);
    });
  }
  return found;
}

}  // namespace cadt
