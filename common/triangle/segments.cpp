// SPDX-License-Identifier: Apache-2.0
// What Triangle makes of points and segments: switch p.
#include <cadt/triangle.hpp>

#include "common/triangle/arrange.hpp"
#include "common/verify/host/exact_sign.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace cadt {
namespace {

/// The edges of the hull as segments, which switch c asks for.
void add_hull(const TriangleInput& input, const Options& options, std::vector<Segment>& segments) {
  const Triangulation mesh = triangulate(input.xy, options);
  const auto hull = mesh.hull();
  for (std::size_t i = 0; i < hull.size(); ++i) segments.push_back({hull[i], hull[i + 1 == hull.size() ? 0 : i + 1]});
}

/// The points of the input, and behind them those that were added.
void set_points(TriangleOutput& out, const TriangleInput& input, const ConstrainedTriangulation& mesh) {
  const auto added = mesh.added_points();
  const std::size_t n = input.attributes_per_point;
  out.attributes_per_point = n;
  out.markers.assign(input.markers.begin(), input.markers.end());
  out.markers.resize((input.xy.size() + added.size()) / 2, 0);
  if (added.empty()) {
    out.xy = input.xy;
    out.attributes = input.attributes;
    return;
  }
  out.kept_xy.assign(input.xy.begin(), input.xy.end());
  out.kept_xy.insert(out.kept_xy.end(), added.begin(), added.end());
  out.kept_attributes = values_at_crossings(input.xy, input.attributes, n, mesh);
  out.xy = out.kept_xy;
  out.attributes = out.kept_attributes;
}

/// The triangles inside, and how they meet.
void set_triangles(TriangleOutput& out, const ConstrainedTriangulation& mesh, bool attributes) {
  const auto triangles = mesh.mesh().triangles(), neighbors = mesh.mesh().neighbors();
  const auto inside = mesh.inside();
  std::vector<std::int32_t> number(inside.size(), -1);
  std::int32_t kept = 0;
  for (std::size_t t = 0; t < inside.size(); ++t) number[t] = inside[t] != 0 ? kept++ : -1;
  for (std::size_t t = 0; t < inside.size(); ++t) {
    if (number[t] < 0) continue;
    for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) {
      out.kept_triangles.push_back(triangles[k]);
      out.kept_neighbors.push_back(neighbors[k] < 0 ? -1 : number[static_cast<std::size_t>(neighbors[k])]);
    }
    if (attributes) {
      out.triangle_attributes.push_back(mesh.region_attribute()[static_cast<std::size_t>(mesh.region()[t])]);
    }
  }
  out.triangles = out.kept_triangles;
  out.neighbors = out.kept_neighbors;
}

/// The number of the edge between two corners of a triangle among the constrained ones, which ascend; -1 if it is none.
std::ptrdiff_t constrained_edge(std::span<const Segment> edges, std::int32_t a, std::int32_t b) {
  const Segment edge{std::min(a, b), std::max(a, b)};
  const auto found = std::lower_bound(edges.begin(), edges.end(), edge);
  return found != edges.end() && *found == edge ? found - edges.begin() : -1;
}

/// The first given segment along constrained edge e that has a marker; hull edges of switch c have none. The number of
/// markers if there is none.
std::size_t first_marked(const ConstrainedTriangulation& mesh, std::span<const int> markers, std::size_t e) {
  std::size_t first = markers.size();
  for (std::int64_t i = mesh.source_offsets()[e]; i < mesh.source_offsets()[e + 1]; ++i) {
    const std::int32_t source = mesh.edge_sources()[static_cast<std::size_t>(i)];
    const auto segment = static_cast<std::size_t>(source < 0 ? -1 - source : source);
    if (segment < first && markers[segment] != 0) first = segment;
  }
  return first;
}

/// The constrained edges that a triangle has, and the markers of these, of points and of edges.
void set_segments(TriangleOutput& out, const ConstrainedTriangulation& mesh, const TriangleSegments& segments) {
  const auto edges = mesh.constrained_edges();
  enum class Where : std::uint8_t { outside, between_triangles, on_boundary };
  std::vector<Where> where(edges.size(), Where::outside);
  std::vector<std::int32_t> boundary;  // points
  for (std::size_t i = 0; i < out.triangles.size(); ++i) {
    const std::size_t k = i % 3, first = i - k;
    const std::int32_t a = out.triangles[first + (k + 1) % 3], b = out.triangles[first + (k + 2) % 3];
    if (out.neighbors[i] < 0) boundary.insert(boundary.end(), {a, b});
    if (const std::ptrdiff_t e = constrained_edge(edges, a, b); e >= 0) {
      where[static_cast<std::size_t>(e)] = out.neighbors[i] < 0 ? Where::on_boundary : Where::between_triangles;
    }
  }
  const std::size_t none = segments.markers.size();
  const auto marker_of = [&](std::size_t segment) { return segment < none ? segments.markers[segment] : 0; };
  std::vector<std::size_t> through(out.markers.size(), none);  // each point: the first segment that has a marker
  std::vector<int> markers(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::size_t first = first_marked(mesh, segments.markers, e);
    for (const std::int32_t v : edges[e]) {
      std::size_t& lowest = through[static_cast<std::size_t>(v)];
      lowest = std::min(lowest, first);
    }
    const int given = marker_of(first);
    if (where[e] == Where::outside) continue;
    markers[e] = given != 0 ? given : where[e] == Where::on_boundary ? 1 : 0;
    out.segments.insert(out.segments.end(), edges[e].begin(), edges[e].end());
    out.segment_markers.push_back(markers[e]);
  }
  for (std::size_t v = 0; v < through.size(); ++v) {
    if (out.markers[v] == 0) out.markers[v] = marker_of(through[v]);
  }
  for (const std::int32_t v : boundary) {
    int& marker = out.markers[static_cast<std::size_t>(v)];
    if (marker == 0) marker = 1;
  }
  for (std::size_t i = 0; i < out.edge_markers.size(); ++i) {
    const std::ptrdiff_t e = constrained_edge(edges, out.edges[2 * i], out.edges[2 * i + 1]);
    if (e >= 0) out.edge_markers[i] = markers[static_cast<std::size_t>(e)];
  }
}

/// The pairs whose crossings, once rounded, turn triangles over.
std::vector<std::array<std::int32_t, 2>> turning_pairs(std::span<const double> xy,
                                                       const ConstrainedTriangulation& mesh) {
  const auto added = mesh.added_points();
  const auto triangles = mesh.mesh().triangles();
  const auto place = [&](std::int32_t v) {
    const std::size_t at = 2 * static_cast<std::size_t>(v);
    const auto of = at < xy.size() ? xy.subspan(at, 2) : added.subspan(at - xy.size(), 2);
    return verifier::Point{of[0], of[1]};
  };
  std::vector<bool> turning(added.size() / 2);
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const auto corners = triangles.subspan(t, 3);
    if (verifier::orientation(place(corners[0]), place(corners[1]), place(corners[2])) > 0) continue;
    for (const std::int32_t v : corners) {
      const std::size_t i = static_cast<std::size_t>(v);
      if (i >= xy.size() / 2) turning[i - xy.size() / 2] = true;
    }
  }
  std::vector<std::array<std::int32_t, 2>> result;
  for (std::size_t i = 0; i < turning.size(); ++i) {
    if (turning[i]) result.push_back(mesh.added_parents()[i]);
  }
  return result;
}

/// Of two places in a region the first one names it; in Triangle the last one does.
std::vector<Region> regions_last_first(std::span<const Region> regions) {
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (!std::isfinite(regions[i].x) || !std::isfinite(regions[i].y))
      throw OptionError("regions", "place " + std::to_string(i) + " is not finite: give x and y as finite numbers");
  }
  return {regions.rbegin(), regions.rend()};
}

}  // namespace

ConstrainedTriangulation triangulate_as_triangle(const TriangleInput& input, const TriangleSegments& segments,
                                                 const TriangleSwitches& switches, const Options& options) {
  if (!segments.markers.empty() && segments.markers.size() != segments.segments.size()) {
    throw InputError("there are " + std::to_string(segments.markers.size()) + " markers for " +
                         std::to_string(segments.segments.size()) + " segments",
                     segments.segments.size());
  }
  ConstraintOptions constraints;
  constraints.crossing = Crossing::exact;
  constraints.domain = Domain::seeds;
  if (!switches.ignore_holes) constraints.holes.assign(segments.holes.begin(), segments.holes.end());
  constraints.regions = regions_last_first(segments.regions);
  std::vector<Segment> all(segments.segments.begin(), segments.segments.end());
  if (switches.hull_segments) add_hull(input, options, all);
  ConstrainedTriangulation mesh = triangulate_constrained(input.xy, all, constraints, options);
  if (!mesh.rounded_valid()) {
    auto pairs = turning_pairs(input.xy, mesh);
    const auto [first, second] = pairs.at(0);
    throw CrossingError("segments " + std::to_string(first) + " and " + std::to_string(second) +
                            ", counted from 0, cross so close to others that rounding the crossing turns triangles "
                            "over: move them apart",
                        std::move(pairs));
  }
  return mesh;
}

TriangleOutput triangle_output(const TriangleInput& input, const TriangleSegments& segments,
                               const ConstrainedTriangulation& mesh, const TriangleSwitches& switches) {
  triangle_detail::require_sizes(input, mesh.mesh().number_of_points() - mesh.added_points().size() / 2);
  TriangleOutput out;
  set_points(out, input, mesh);
  set_triangles(out, mesh, switches.region_attributes);
  const auto boundary = static_cast<std::size_t>(std::count(out.neighbors.begin(), out.neighbors.end(), -1));
  out.number_of_edges = (out.triangles.size() + boundary) / 2;
  if (switches.edges || switches.voronoi) triangle_detail::set_edges(out);
  set_segments(out, mesh, segments);
  out.holes = segments.holes;
  out.regions = segments.regions;
  if (switches.voronoi) triangle_detail::set_voronoi(out);
  if (switches.jettison) {
    std::vector<bool> gone(out.xy.size() / 2, true);
    for (const std::int32_t v : out.triangles) gone[static_cast<std::size_t>(v)] = false;
    triangle_detail::jettison(out, gone);
  }
  return out;
}

}  // namespace cadt
