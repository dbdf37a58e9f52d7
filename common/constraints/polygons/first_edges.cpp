// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/polygons/first_edges.hpp"

#include <algorithm>

#include "common/verify/host/exact_sign.hpp"

namespace cadt {
namespace {

using verifier::Point;

struct Edge {
  Point from, to;

  /// Whether boxes around both have a place in common.
  [[nodiscard]] bool is_near(const Edge& other) const {
    const auto overlap = [](double a, double b, double c, double d) {
      return std::max(a, b) >= std::min(c, d) && std::max(c, d) >= std::min(a, b);
    };
    return overlap(from.x, to.x, other.from.x, other.to.x) && overlap(from.y, to.y, other.from.y, other.to.y);
  }
  [[nodiscard]] int side_of(const Point& p) const { return verifier::orientation(from, to, p); }
  /// Whether its ends are on different sides of the line through the other one.
  [[nodiscard]] bool parts(const Edge& other) const { return side_of(other.from) * side_of(other.to) < 0; }
};

}  // namespace

std::optional<Segment> crossing_of_first_edges(const PointsView& points, std::span<const Segment> segments) {
  constexpr std::size_t first_edges = 4;
  verifier::require_ieee_arithmetic();
  const auto point = [&](std::size_t i) -> Point { return {points.x(i), points.y(i)}; };
  const auto edge = [&](std::size_t s) -> Edge {
    return {point(static_cast<std::size_t>(segments[s][0])), point(static_cast<std::size_t>(segments[s][1]))};
  };
  for (std::size_t i = 0; i < std::min(first_edges, segments.size()); ++i) {
    const Edge a = edge(i);
    for (std::size_t j = i + 1; j < segments.size(); ++j) {
      const Edge b = edge(j);
      if (!a.is_near(b) || !a.parts(b) || !b.parts(a)) continue;
      for (std::size_t k = 0; k < points.size(); ++k)
        if (a.side_of(point(k)) == 0 && b.side_of(point(k)) == 0) return std::nullopt;  // a point divides both there
      return Segment{static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)};
    }
  }
  return std::nullopt;
}

}  // namespace cadt
