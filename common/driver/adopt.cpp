// SPDX-License-Identifier: Apache-2.0
// Meshes of other programs.
#include <cadt/triangulation.hpp>
#include <cadt/verify.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "common/driver/triangulation_data.hpp"
#include "common/platform/parallel.hpp"
#include "common/verify/host/mesh.hpp"

namespace cadt {
namespace {

void require_passed(const Check& check) {
  if (!check.passed) throw InvalidMesh(check.name, check.first, check.what);
}

void require_delaunay(PointsView points, const MeshView& view) {
  const VerifyReport report = verify(points, view, {.threads = 0, .canonical_ties = false});
  for (const Check& check : report.checks) require_passed(check);
}

void require_finite(PointsView points) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!std::isfinite(points.x(i)) || !std::isfinite(points.y(i)))
      verifier::refuse_point(static_cast<std::int64_t>(i));
}

/// Fills neighbours and boundary. \throws InvalidMesh unless each edge has one triangle on each side, or is part of the
/// one boundary
void require_structure(verifier::Mesh& mesh) {
  std::uint64_t examined = 0;
  const auto passes = [](const char* name, const auto& examine) {
    Check check;
    check.name = name;
    examine(check);
    require_passed(check);
  };
  passes("range", [&](Check& check) { verifier::check_range(mesh, check); });
  passes("neighbors", [&](Check& check) {
    if (mesh.neighbors.empty())
      verifier::derive_neighbors(mesh, check, examined);
    else
      verifier::check_neighbors(mesh, check, examined);
  });
  passes("boundary", [&](Check& check) { verifier::check_boundary(mesh, check); });
  passes("euler", [&](Check& check) { verifier::check_euler(mesh, check); });
}

/// Points that are no vertices, and the vertex that each equals; without triangles the lowest index that each equals.
std::vector<Duplicate> find_duplicates(const verifier::Mesh& mesh) {
  const std::size_t n = mesh.points.size();
  std::vector<Duplicate> list;
  if (mesh.vertices == n) return list;
  const auto used = [&](std::int32_t i) { return mesh.count != 0 && mesh.used[static_cast<std::size_t>(i)] != 0; };
  const auto same = [&](std::int32_t a, std::int32_t b) {
    const verifier::Point p = mesh.point(a), q = mesh.point(b);
    return p.x == q.x && p.y == q.y;
  };
  std::vector<std::int32_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    const verifier::Point p = mesh.point(a), q = mesh.point(b);
    if (p.x != q.x) return p.x < q.x;
    if (p.y != q.y) return p.y < q.y;
    return used(a) != used(b) ? used(a) : a < b;  // the vertex is the first of those that are equal
  });
  std::int32_t first = -1;
  for (const std::int32_t i : order) {
    if (first < 0 || !same(first, i)) {
      first = i;
      if (mesh.count != 0 && !used(i))
        throw InvalidMesh("vertices", i, "point " + std::to_string(i) + " is not a vertex and equals none");
    } else if (!used(i)) {
      list.push_back({i, first});
    }
  }
  std::ranges::sort(list, {}, &Duplicate::point);
  return list;
}

Words copy_words(std::span<const std::int32_t> from) {
  Words to = make_words(from.size());
  std::ranges::copy(from, to.get());
  return to;
}

}  // namespace

Triangulation Triangulation::adopt(PointsView points, std::span<const std::int32_t> triangles,
                                   std::span<const std::int32_t> neighbors, Trust trust, KeepPoints keep_points) {
  MeshView view;
  view.triangles = triangles;
  view.neighbors = neighbors;
  if (const std::string error = verifier::size_error(points, view); !error.empty())
    throw InvalidMesh("counts", -1, error);
  verifier::require_ieee_arithmetic();
  require_finite(points);
  if (trust == Trust::verify) require_delaunay(points, view);
  verifier::Mesh mesh;
  mesh.points = points;
  mesh.count = triangles.size() / 3;
  mesh.triangles = triangles;
  mesh.neighbors = neighbors;
  mesh.threads = platform::threads_or_all(0);
  if (mesh.count != 0) require_structure(mesh);
  auto data = std::make_unique<Data>();
  data->points = points.size();
  data->triangle_count = mesh.count;
  data->triangles = copy_words(triangles);
  data->neighbors = copy_words(mesh.neighbors);
  data->hull = std::move(mesh.loop);
  data->duplicates = find_duplicates(mesh);
  const std::size_t distinct = points.size() - data->duplicates.size();
  data->dimension = mesh.count != 0 ? 2 : static_cast<int>(std::min<std::size_t>(distinct, 2)) - 1;
  data->statistics.points = points.size();
  data->statistics.distinct = distinct;
  give_points(*data, points, keep_points);
  return Triangulation(std::move(data));
}

}  // namespace cadt
