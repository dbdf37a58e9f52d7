// SPDX-License-Identifier: Apache-2.0
// Verification of seeds: the triangles that they lie in, whose corners are crossings where these are exactly.
#include <algorithm>
#include <cmath>
#include <utility>

#include "common/constraints/domains/seed_tree.hpp"
#include "common/constraints/exact/exact_number.hpp"
#include "common/constraints/verify/verify_checks.hpp"

namespace cadt {
namespace {

using exact::Arithmetic;
using exact::Number;
using Place = MeshPlaces::Place;

/// (x / w, y / w), with w > 0 unless the lines of a crossing are parallel.
struct Corner {
  Number x, y, w;
};

/// a, b: twice the areas of the triangles that the ends of one segment make with the other one. The crossing divides
/// it as a to -b.
Corner crossing_of(const Place& p, const Place& q, const Place& r, const Place& s, const Arithmetic& of) {
  const auto area = [&](const Place& at) {
    const Number x = of.number(r[0]), y = of.number(r[1]);
    return of.minor(of.subtract(of.number(s[0]), x), of.subtract(of.number(at[1]), y), of.subtract(of.number(s[1]), y),
                    of.subtract(of.number(at[0]), x));
  };
  const Number a = area(p), b = area(q);
  Corner corner = {of.minor(of.number(p[0]), b, of.number(q[0]), a), of.minor(of.number(p[1]), b, of.number(q[1]), a),
                   of.subtract(b, a)};
  if (corner.w.negative) corner = {-corner.x, -corner.y, -corner.w};
  return corner;
}

bool is_left(const Corner& p, const Corner& q, const Place& at, const Arithmetic& of) {
  const Number x = of.number(at[0]), y = of.number(at[1]);
  const auto from = [&](const Number& v, const Number& w, const Number& start) {
    return of.subtract(v, of.multiply(w, start));
  };
  return of.minor(from(p.x, p.w, x), from(q.y, q.w, y), from(p.y, p.w, y), from(q.x, q.w, x)).sign() >= 0;
}

}  // namespace

SeedTriangles::SeedTriangles(const MeshPlaces& places, std::span<const Segment> segments,
                             const ConstrainedTriangulation& mesh)
    : places_(places), segments_(segments), mesh_(mesh) {
  const auto parents = mesh.added_parents();
  const auto is_segment = [&](std::int32_t s) { return s >= 0 && static_cast<std::size_t>(s) < segments.size(); };
  exact_ = !places.moved() && places.given() + parents.size() == places.size() &&
           std::ranges::all_of(parents, [&](const auto& pair) { return is_segment(pair[0]) && is_segment(pair[1]); });
}

bool SeedTriangles::contains(std::size_t t, const Place& seed) const {
  const auto corners = mesh_.mesh().triangle(t);
  if (!exact_ || std::ranges::none_of(corners, [&](std::int32_t v) { return places_.is_added(v); })) {
    const Place a = places_.at(corners[0]), b = places_.at(corners[1]), c = places_.at(corners[2]);
    return exact_orientation(a, b, seed) >= 0 && exact_orientation(b, c, seed) >= 0 &&
           exact_orientation(c, a, seed) >= 0;
  }
  exact::Arena arena;
  const Arithmetic of(arena);
  std::array<Corner, 3> corner;
  for (std::size_t k = 0; k < 3; ++k) {
    const Place rounded = places_.at(corners[k]);
    corner[k] = {of.number(rounded[0]), of.number(rounded[1]), of.number(1)};
    if (!places_.is_added(corners[k])) continue;
    const auto& pair = mesh_.added_parents()[static_cast<std::size_t>(corners[k]) - places_.given()];
    const Segment &s = segments_[static_cast<std::size_t>(pair[0])], &u = segments_[static_cast<std::size_t>(pair[1])];
    corner[k] = crossing_of(places_.at(s[0]), places_.at(s[1]), places_.at(u[0]), places_.at(u[1]), of);
  }
  return is_left(corner[0], corner[1], seed, of) && is_left(corner[1], corner[2], seed, of) &&
         is_left(corner[2], corner[0], seed, of);
}

std::vector<std::int32_t> SeedTriangles::of(std::span<const Place> seeds) const {
  std::vector<std::int32_t> found(seeds.size(), -1);
  std::vector<Place> finite;
  std::vector<std::size_t> number;  // of each of these
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    if (!std::isfinite(seeds[i][0]) || !std::isfinite(seeds[i][1])) continue;
    finite.push_back(seeds[i]);
    number.push_back(i);
  }
  const SeedTree tree(finite);
  for (std::size_t t = 0; t < mesh_.mesh().number_of_triangles(); ++t) {
    const auto corners = mesh_.mesh().triangle(t);
    const Place a = places_.at(corners[0]), b = places_.at(corners[1]), c = places_.at(corners[2]);
    tree.each_in({a, b, c}, [&](std::size_t i) {
      if (found[number[i]] < 0 && contains(t, finite[i])) found[number[i]] = static_cast<std::int32_t>(t);
    });
  }
  return found;
}

}  // namespace cadt
