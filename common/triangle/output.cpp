// SPDX-License-Identifier: Apache-2.0
// A mesh as Triangle writes it: markers, edges, hull, Voronoi diagram.
#include <cadt/triangle.hpp>

#include "common/triangle/arrange.hpp"
#include "common/triangle/circumcenter.hpp"

#include <cmath>
#include <utility>

namespace cadt {
namespace {

Corner corner(std::span<const double> xy, std::int32_t v) {
  const auto at = 2 * static_cast<std::size_t>(v);
  return {xy[at], xy[at + 1]};
}

std::vector<int> markers(const TriangleInput& input, const Triangulation& mesh) {
  std::vector<int> result(input.markers.begin(), input.markers.end());
  result.resize(input.xy.size() / 2, 0);
  for (const std::int32_t v : mesh.hull()) {
    int& marker = result[static_cast<std::size_t>(v)];
    if (marker == 0) marker = 1;
  }
  return result;
}

std::vector<std::int32_t> hull_edges(std::span<const std::int32_t> hull) {
  std::vector<std::int32_t> result;
  result.reserve(2 * hull.size());
  for (std::size_t i = 0; i < hull.size(); ++i) {
    result.push_back(hull[i]);
    result.push_back(hull[i + 1 == hull.size() ? 0 : i + 1]);
  }
  return result;
}

/// The direction to the right of the edge from a to b.
Corner outward(const Corner& a, const Corner& b) {
  const Corner ray{b[1] - a[1], a[0] - b[0]};
  if (std::isfinite(ray[0]) && std::isfinite(ray[1])) return ray;
  return {b[1] / 2 - a[1] / 2, a[0] / 2 - b[0] / 2};
}

}  // namespace

namespace triangle_detail {

void require_sizes(const TriangleInput& input, std::size_t mesh_points) {
  const std::size_t points = input.xy.size() / 2;
  if (input.xy.size() % 2 != 0) throw InputError("the coordinates are no pairs: their number is odd", points);
  if (mesh_points != points) {
    throw InputError("the triangulation is not that of the points: it has " + std::to_string(mesh_points) +
                         " points, not " + std::to_string(points),
                     points);
  }
  if (input.attributes.size() != points * input.attributes_per_point) {
    throw InputError("there are " + std::to_string(input.attributes.size()) + " attributes for " +
                         std::to_string(points) + " points with " + std::to_string(input.attributes_per_point) +
                         " each",
                     points);
  }
  if (!input.markers.empty() && input.markers.size() != points) {
    throw InputError(
        "there are " + std::to_string(input.markers.size()) + " markers for " + std::to_string(points) + " points",
        points);
  }
}

/// Each edge once, from the triangle with the lower number.
void set_edges(TriangleOutput& out) {
  out.edges.reserve(2 * out.number_of_edges);
  out.edge_triangles.reserve(2 * out.number_of_edges);
  out.edge_markers.reserve(out.number_of_edges);
  for (std::size_t i = 0; i < out.triangles.size(); ++i) {
    const auto triangle = static_cast<std::int32_t>(i / 3);
    const std::int32_t other = out.neighbors[i];
    if (other >= 0 && other < triangle) continue;
    const std::size_t k = i % 3, first = i - k;
    out.edges.push_back(out.triangles[first + (k + 1) % 3]);
    out.edges.push_back(out.triangles[first + (k + 2) % 3]);
    out.edge_triangles.push_back(triangle);
    out.edge_triangles.push_back(other);
    out.edge_markers.push_back(other < 0 ? 1 : 0);
  }
}

void set_voronoi(TriangleOutput& out) {
  const std::size_t n = out.attributes_per_point;
  out.centers.reserve(2 * out.triangles.size() / 3);
  out.center_attributes.reserve(n * out.triangles.size() / 3);
  for (std::size_t t = 0; t < out.triangles.size(); t += 3) {
    const std::int32_t* v = &out.triangles[t];
    const Circumcenter center = circumcenter(corner(out.xy, v[0]), corner(out.xy, v[1]), corner(out.xy, v[2]));
    out.centers.push_back(center.x);
    out.centers.push_back(center.y);
    for (std::size_t i = 0; i < n; ++i) {
      const auto value = [&](std::size_t k) { return out.attributes[static_cast<std::size_t>(v[k]) * n + i]; };
      out.center_attributes.push_back(center.value({value(0), value(1), value(2)}));
    }
  }
  out.rays.resize(out.edges.size(), 0.0);
  for (std::size_t e = 0; e < out.edges.size(); e += 2) {
    if (out.edge_triangles[e + 1] >= 0) continue;
    const Corner ray = outward(corner(out.xy, out.edges[e]), corner(out.xy, out.edges[e + 1]));
    out.rays[e] = ray[0];
    out.rays[e + 1] = ray[1];
  }
}

void jettison(TriangleOutput& out, const std::vector<bool>& gone) {
  const std::size_t points = out.xy.size() / 2, n = out.attributes_per_point;
  std::vector<std::int32_t> number(points, -1);
  std::vector<double> xy, attributes;
  std::int32_t kept = 0;
  for (std::size_t i = 0; i < points; ++i) {
    if (gone[i]) continue;
    xy.insert(xy.end(), {out.xy[2 * i], out.xy[2 * i + 1]});
    for (std::size_t j = 0; j < n; ++j) attributes.push_back(out.attributes[i * n + j]);
    out.markers[static_cast<std::size_t>(kept)] = out.markers[i];
    number[i] = kept++;
  }
  out.markers.resize(static_cast<std::size_t>(kept));
  out.kept_triangles = std::vector<std::int32_t>(out.triangles.begin(), out.triangles.end());
  for (auto* indices : {&out.kept_triangles, &out.segments, &out.edges}) {
    for (std::int32_t& v : *indices) v = number[static_cast<std::size_t>(v)];
  }
  out.kept_xy = std::move(xy);
  out.kept_attributes = std::move(attributes);
  out.xy = out.kept_xy;
  out.attributes = out.kept_attributes;
  out.triangles = out.kept_triangles;
}

}  // namespace triangle_detail

TriangleOutput triangle_output(const TriangleInput& input, const Triangulation& mesh,
                               const TriangleSwitches& switches) {
  triangle_detail::require_sizes(input, mesh.number_of_points());
  TriangleOutput out;
  out.xy = input.xy;
  out.attributes = input.attributes;
  out.attributes_per_point = input.attributes_per_point;
  out.markers = markers(input, mesh);
  out.triangles = mesh.triangles();
  out.neighbors = mesh.neighbors();
  out.segments = hull_edges(mesh.hull());
  out.segment_markers.assign(out.segments.size() / 2, 1);
  out.number_of_edges = (3 * mesh.number_of_triangles() + mesh.hull().size()) / 2;
  if (switches.edges || switches.voronoi) triangle_detail::set_edges(out);
  if (switches.voronoi) triangle_detail::set_voronoi(out);
  if (switches.jettison) {
    std::vector<bool> gone(input.xy.size() / 2, false);
    for (const Duplicate& d : mesh.duplicates()) gone[static_cast<std::size_t>(d.point)] = true;
    triangle_detail::jettison(out, gone);
  }
  return out;
}

}  // namespace cadt
