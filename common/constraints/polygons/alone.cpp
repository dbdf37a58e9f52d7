// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/polygons/alone.hpp"

#include <cadt/constrained.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/constraints/constraints.hpp"
#include "common/constraints/polygons/first_edges.hpp"
#include "common/driver/counters.hpp"
#include "common/driver/session.hpp"

namespace cadt {
namespace {

PolygonAlone with_problem(std::size_t p, PolygonStatus status, std::int32_t first, std::int32_t second) {
  return {p, status, first, second, {}};
}

/// `rings` and the ends of `segments` count from the polygon's first point, `begin`; `pair`: two of the segments.
PolygonAlone with_crossing(std::size_t p, std::int32_t begin, std::span<const std::int64_t> rings,
                           std::span<const Segment> segments, const Segment& pair) {
  // A ring of one point has no segment: they are not numbered as the points are.
  const auto start_of = [&](std::int32_t segment) { return segments[static_cast<std::size_t>(segment)][0]; };
  const std::int32_t first = start_of(pair[0]), second = start_of(pair[1]);
  const auto ring_of = [&](std::int32_t point) { return std::ranges::upper_bound(rings, std::int64_t{point}); };
  const bool one = ring_of(first) == ring_of(second);
  return with_problem(p, one ? PolygonStatus::self_crossing : PolygonStatus::ring_crossing, first + begin,
                      second + begin);
}

/// Whether a ring has three different points.
bool has_three(const Polygons& polygons, std::size_t ring) {
  const std::size_t begin = polygons.ring(ring), end = polygons.ring(ring + 1);
  const PointsView& points = polygons.points;
  const auto same = [&](std::size_t i, std::size_t j) {
    return points.x(i) == points.x(j) && points.y(i) == points.y(j);
  };
  std::size_t second = begin;
  while (second < end && same(begin, second)) ++second;
  std::size_t third = second;
  while (third < end && (same(begin, third) || same(second, third))) ++third;
  return third < end;
}

/// For a call of its own. That of the host within one of another device takes nothing of its memory, queue or limit.
Options options_of(const Context& ctx, bool leaves_device) {
  Options options = ctx.options;
  if (leaves_device) {
    options = {};
    options.backend = Backend::host;
    options.threads = 1;
    options.statistics = ctx.options.statistics;
    options.stop = ctx.options.stop;
  }
  options.keep_points = KeepPoints::no;
  options.order = Order::canonical;
  options.progress = nullptr;
  return options;
}

}  // namespace

bool has_outline(const Polygons& polygons, std::size_t p) {
  const std::size_t ring = polygons.first_ring(p);
  return ring != polygons.first_ring(p + 1) && has_three(polygons, ring);
}

bool has_small_hole(const Polygons& polygons, std::size_t p) {
  for (std::size_t ring = polygons.first_ring(p) + 1; ring < polygons.first_ring(p + 1); ++ring)
    if (polygons.ring(ring) != polygons.ring(ring + 1) && !has_three(polygons, ring)) return true;
  return false;
}

PolygonAlone triangulate_alone(Context& ctx, const Polygons& polygons, std::size_t p, Statistics& statistics) {
  const std::size_t begin = polygons.first_point(p), count = polygons.points_of(p, p + 1);
  const auto at = static_cast<std::int32_t>(begin);
  const PointsView points = polygons.points.subview(begin, count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t here = at + static_cast<std::int32_t>(i);
    if (!std::isfinite(points.x(i)) || !std::isfinite(points.y(i)))
      return with_problem(p, PolygonStatus::not_finite, here, here);
  }
  std::vector<std::int64_t> rings;
  for (std::size_t r = polygons.first_ring(p); r <= polygons.first_ring(p + 1); ++r)
    rings.push_back(polygons.rings[r] - static_cast<std::int64_t>(begin));
  if (!has_outline(polygons, p)) {
    const std::int32_t begins = rings.size() > 1 && rings[1] != 0 ? at : -1;
    return with_problem(p, PolygonStatus::too_few_points, begins, begins);
  }
  const std::vector<Segment> segments = ring_segments(rings);
  if (const auto pair = crossing_of_first_edges(points, segments)) return with_crossing(p, at, rings, segments, *pair);
  ConstraintOptions constraints;
  constraints.domain = Domain::even_odd;
  const bool leaves_device = count <= most_swept && !is_host(ctx.device);
  Options options = options_of(ctx, leaves_device);
  const std::size_t limit = options.max_memory, taken = ctx.memory.taken();
  if (limit != 0) options.max_memory = limit > taken ? limit - taken : 1;
  try {
    const ConstrainedTriangulation mesh = triangulate_constrained(points, segments, constraints, options);
    std::vector<std::int32_t> inside = mesh.triangles_inside();
    for (std::int32_t& v : inside) v += at;
    add_counters(statistics, mesh.statistics());
    if (!leaves_device)
      statistics.bytes_device_peak =
          std::max(statistics.bytes_device_peak, taken + mesh.statistics().bytes_device_peak);
    return {p, inside.empty() ? PolygonStatus::zero_area : PolygonStatus::ok, at, at, std::move(inside)};
  } catch (const CrossingError& error) {
    return with_crossing(p, at, rings, segments, error.pairs().front());
  } catch (const OutOfMemory& error) {
    if (limit != 0) ctx.memory.require(error.needed());  // says what all need together
    throw;
  }
}

}  // namespace cadt
