// SPDX-License-Identifier: Apache-2.0
#include "common/constraints/crossings/arrangement.hpp"

#include "common/constraints/chains.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace cadt::constraints {
namespace {

struct Numbered {
  exact::Point point;
  std::int32_t index;
};

void sort_points(PointsView points, Arrangement& out) {
  if (points.size() > max_points())
    throw LimitError("there are more points than 32-bit indices allow", points.size(), max_points());
  std::vector<Numbered> sorted(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    sorted[i] = {{points.x(i), points.y(i)}, static_cast<std::int32_t>(i)};
    if (!std::isfinite(sorted[i].point.x) || !std::isfinite(sorted[i].point.y))
      throw InputError("point " + std::to_string(i) + " has a coordinate that is NaN or infinite", i);
  }
  std::sort(sorted.begin(), sorted.end(), [](const Numbered& a, const Numbered& b) {
    if (a.point.x != b.point.x) return a.point.x < b.point.x;
    if (a.point.y != b.point.y) return a.point.y < b.point.y;
    return a.index < b.index;
  });
  out.rank.resize(points.size());
  for (const Numbered& p : sorted) {
    if (out.points.empty() || !verifier::equal(out.points.back(), p.point)) {
      out.points.push_back(p.point);
      out.representative.push_back(p.index);
    }
    out.rank[static_cast<std::size_t>(p.index)] = static_cast<std::int32_t>(out.points.size() - 1);
  }
}

struct Ranked {
  std::int32_t low, high, source;
};

}  // namespace

Arrangement sort_segments(PointsView points, std::span<const Segment> segments) {
  Arrangement out;
  sort_points(points, out);
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  if (segments.size() > most)
    throw LimitError("there are more segments than 32-bit indices allow", segments.size(), most);
  std::vector<Ranked> sorted;
  sorted.reserve(segments.size());
  for (std::size_t s = 0; s < segments.size(); ++s) {
    for (const std::int32_t end : segments[s])
      if (end < 0 || static_cast<std::size_t>(end) >= points.size()) refuse_segment(s, segments[s], points.size());
    const auto [a, b] = std::minmax(out.rank[static_cast<std::size_t>(segments[s][0])],
                                    out.rank[static_cast<std::size_t>(segments[s][1])]);
    if (a != b) sorted.push_back({a, b, static_cast<std::int32_t>(s)});
  }
  std::sort(sorted.begin(), sorted.end(), [](const Ranked& s, const Ranked& t) {
    if (s.low != t.low) return s.low < t.low;
    return s.high != t.high ? s.high < t.high : s.source < t.source;
  });
  out.segment_of.assign(segments.size(), -1);
  out.sources.reserve(sorted.size());
  for (const Ranked& s : sorted) {
    if (out.segments.empty() || out.segments.back() != std::array{s.low, s.high}) {
      out.segments.push_back({s.low, s.high});
      out.lines.push_back({out.points[static_cast<std::size_t>(s.low)], out.points[static_cast<std::size_t>(s.high)]});
      out.source_offsets.push_back(static_cast<std::int64_t>(out.sources.size()));
    }
    out.segment_of[static_cast<std::size_t>(s.source)] = static_cast<std::int32_t>(out.segments.size() - 1);
    out.sources.push_back(s.source);
  }
  out.source_offsets.push_back(static_cast<std::int64_t>(out.sources.size()));
  return out;
}

}  // namespace cadt::constraints
