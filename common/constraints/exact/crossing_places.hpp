// SPDX-License-Identifier: Apache-2.0
// The vertices of a mesh with crossings, where they are exactly.
#pragma once

#include <cadt/constrained.hpp>

#include "common/constraints/exact/implicit_point.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace cadt::constraints {

/// Input points and, behind them, the crossings of pairs of segments.
struct CrossingPlaces {
  PointsView points;
  std::span<const Segment> segments, pairs;

  /// Vertex v. The segments of a crossing become the lines `first` and the one behind it; `exact` is of `lines`.
  [[nodiscard]] exact::Place place(std::size_t v, std::size_t first, std::span<exact::Line> lines,
                                   const exact::ImplicitPoints& exact) const {
    if (v < points.size()) return exact::explicit_place({points.x(v), points.y(v)});
    for (std::size_t i = 0; i < 2; ++i) {
      const Segment& s = segments[static_cast<std::size_t>(pairs[v - points.size()][i])];
      lines[first + i] = {point(s[0]), point(s[1])};
    }
    return exact.crossing(static_cast<std::int32_t>(first), static_cast<std::int32_t>(first + 1));
  }

 private:
  [[nodiscard]] exact::Point point(std::int32_t i) const {
    return {points.x(static_cast<std::size_t>(i)), points.y(static_cast<std::size_t>(i))};
  }
};

}  // namespace cadt::constraints
