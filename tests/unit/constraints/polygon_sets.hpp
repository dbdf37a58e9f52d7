// SPDX-License-Identifier: Apache-2.0
// Polygons for tests, and what they should become.
#pragma once

#include <cadt/cadt.hpp>
#include <cadt/constrained.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace cadt::test {

using Ring = std::vector<std::array<double, 2>>;

/// Rings and polygons as the call takes them.
struct PolygonSet {
  std::vector<std::array<double, 2>> points;
  std::vector<std::int64_t> rings = {0}, polygons = {0};

  void add(const std::vector<Ring>& polygon) {
    for (const Ring& ring : polygon) {
      points.insert(points.end(), ring.begin(), ring.end());
      rings.push_back(static_cast<std::int64_t>(points.size()));
    }
    polygons.push_back(static_cast<std::int64_t>(rings.size()) - 1);
  }
  [[nodiscard]] std::size_t size() const { return polygons.size() - 1; }
  [[nodiscard]] std::span<const std::int64_t> rings_of(std::size_t p) const {
    const auto first = static_cast<std::size_t>(polygons[p]), end = static_cast<std::size_t>(polygons[p + 1]);
    return std::span(rings).subspan(first, end - first + 1);
  }
  [[nodiscard]] PolygonsResult triangulate(const Options& options) const {
    return triangulate_polygons(points, rings, polygons, options);
  }
};

using Triple = std::array<std::int32_t, 3>;

/// Triangles as a set: each from its lowest vertex on, ascending, with the lowest of equal points.
inline std::vector<Triple> as_set(const PolygonSet& set, std::span<const std::int32_t> triangles) {
  const auto lowest = [&](std::int32_t v, std::span<const std::int64_t> rings) {
    for (auto i = static_cast<std::int32_t>(rings.front()); i < v; ++i)
      if (set.points[static_cast<std::size_t>(i)] == set.points[static_cast<std::size_t>(v)]) return i;
    return v;
  };
  std::vector<Triple> result;
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const auto ring = std::ranges::upper_bound(set.rings, std::int64_t{triangles[i]}) - set.rings.begin() - 1;
    const auto polygon = std::ranges::upper_bound(set.polygons, std::int64_t{ring}) - set.polygons.begin() - 1;
    const auto rings = set.rings_of(static_cast<std::size_t>(polygon));
    Triple t = {lowest(triangles[i], rings), lowest(triangles[i + 1], rings), lowest(triangles[i + 2], rings)};
    std::ranges::rotate(t, std::ranges::min_element(t));
    result.push_back(t);
  }
  std::ranges::sort(result);
  return result;
}

/// What becomes of a polygon by the constrained triangulation of its points and edges.
struct Expected {
  PolygonStatus status = PolygonStatus::ok;
  std::int32_t first = 0, second = 0;
  std::vector<Triple> triangles;
};
inline Expected expected_of(const PolygonSet& set, std::size_t p) {
  const auto rings = set.rings_of(p);
  const auto begin = static_cast<std::int32_t>(rings.front());
  const auto point = [&](std::int64_t i) { return set.points[static_cast<std::size_t>(i)]; };
  for (std::int64_t i = rings.front(); i < rings.back(); ++i)
    if (!std::isfinite(point(i)[0]) || !std::isfinite(point(i)[1])) {
      const auto at = static_cast<std::int32_t>(i);
      return {PolygonStatus::not_finite, at, at, {}};
    }
  if (rings.size() == 1) return {PolygonStatus::too_few_points, -1, -1, {}};
  std::set<std::array<double, 2>> outline;
  for (std::int64_t i = rings[0]; i < rings[1]; ++i) outline.insert(point(i));
  if (outline.size() < 3) {
    const std::int32_t at = outline.empty() ? -1 : begin;
    return {PolygonStatus::too_few_points, at, at, {}};
  }
  std::vector<std::int64_t> offsets;
  for (const std::int64_t r : rings) offsets.push_back(r - rings.front());
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  ConstraintOptions constraints;
  constraints.domain = Domain::even_odd;
  const std::vector<Segment> segments = ring_segments(offsets);
  try {
    const std::span all =
        std::span(set.points)
            .subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(rings.back() - rings.front()));
    std::vector<std::int32_t> triangles =
        triangulate_constrained(all, segments, constraints, options).triangles_inside();
    for (std::int32_t& v : triangles) v += begin;
    if (triangles.empty()) return {PolygonStatus::zero_area, begin, begin, {}};
    return {PolygonStatus::ok, 0, 0, as_set(set, triangles)};
  } catch (const CrossingError& error) {
    const auto [k, l] = error.pairs().front();
    const std::int32_t i = segments[static_cast<std::size_t>(k)][0], j = segments[static_cast<std::size_t>(l)][0];
    const auto ring = [&](std::int32_t point) { return std::ranges::upper_bound(offsets, std::int64_t{point}); };
    return {ring(i) == ring(j) ? PolygonStatus::self_crossing : PolygonStatus::ring_crossing, begin + i, begin + j, {}};
  }
}

/// A ring around a place, of n corners on a lattice; its sides do not cross.
inline Ring star(std::mt19937_64& random, std::size_t n, double x, double y, double inner, double outer) {
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Ring ring;
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * (static_cast<double>(i) + 0.8 * unit()) / static_cast<double>(n),
                 radius = inner + (outer - inner) * unit();
    ring.push_back({std::round(x + radius * std::cos(angle)), std::round(y + radius * std::sin(angle))});
  }
  return ring;
}

/// Twice the area that a ring encloses, counterclockwise; exact for whole numbers.
inline double twice_area(std::span<const std::array<double, 2>> ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
    sum += a[0] * b[1] - a[1] * b[0];
  }
  return sum;
}
inline double twice_area(const PolygonSet& set, std::span<const std::int32_t> triangles) {
  double sum = 0;
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const auto at = [&](std::size_t k) { return set.points[static_cast<std::size_t>(triangles[i + k])]; };
    sum += twice_area(Ring{at(0), at(1), at(2)});
  }
  return sum;
}

}  // namespace cadt::test
