// SPDX-License-Identifier: Apache-2.0
// The order of the checks, and their report.
#include "mesh.hpp"
#include "outcome.hpp"

#include <cmath>
#include <limits>

namespace cadt::verifier {

void refuse_point(std::int64_t index) {
  throw InputError("point " + std::to_string(index) + " has a coordinate that is NaN or infinite",
                   static_cast<std::size_t>(index));
}

std::string size_error(PointsView points, const MeshView& view) {
  constexpr auto limit = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  if (view.triangles.size() % 3 != 0)
    return "the number of triangle indices, " + std::to_string(view.triangles.size()) + ", is not a multiple of 3";
  if (!view.neighbors.empty() && view.neighbors.size() != view.triangles.size())
    return "there are " + std::to_string(view.neighbors.size()) + " neighbours for " +
           std::to_string(view.triangles.size()) + " edges";
  if (!view.edge_flags.empty() && 3 * view.edge_flags.size() != view.triangles.size())
    return "there are flags of the edges of " + std::to_string(view.edge_flags.size()) + " triangles, not of " +
           std::to_string(view.triangles.size() / 3);
  // 3 * triangles must fit into 32 bits; no mesh with 32-bit indices has more
  if (points.size() > limit || view.triangles.size() > 2 * limit)
    return "too many points or triangles for 32-bit indices";
  return {};
}

}  // namespace cadt::verifier

namespace cadt {
namespace {

using namespace verifier;

void require_finite(PointsView points, unsigned threads) {
  const Findings findings = reduce_each<Findings>(points.size(), threads, [&](std::size_t i, Findings& mine) {
    if (!std::isfinite(points.x(i)) || !std::isfinite(points.y(i))) mine.fail(i);
  });
  if (findings.failures != 0) refuse_point(findings.first);
}

class Context : private Outcome {
 public:
  Context(PointsView points, const MeshView& view, const VerifyOptions& options)
      : Outcome(points.size()), view_(view), options_(options) {
    mesh_.points = points;
    mesh_.threads = platform::threads_or_all(options.threads);
  }

  VerifyReport run() {
    require_ieee_arithmetic();
    require_finite(mesh_.points, mesh_.threads);
    examine();
    return finish();
  }

 private:
  void examine() {
    if (const std::string error = size_error(mesh_.points, view_); !error.empty()) {
      fail(begin(counts), -1, error);
      return skip({range, neighbors, orientations, vertices, boundary, euler, hull, delaunay, ties}, counts);
    }
    begin(counts).passed = true;
    mesh_.count = view_.triangles.size() / 3;
    mesh_.triangles = view_.triangles;
    mesh_.neighbors = view_.neighbors;
    mesh_.edge_flags = view_.edge_flags;
    if (mesh_.count == 0) return examine_no_triangles();

    check_range(mesh_, begin(range));
    if (!passed(range)) return skip({neighbors, orientations, vertices, boundary, euler, hull, delaunay, ties}, range);
    std::uint64_t half_edges = 0;
    if (view_.neighbors.empty()) {
      derive_neighbors(mesh_, begin(neighbors), half_edges);
    } else {
      check_neighbors(mesh_, begin(neighbors), half_edges);
    }
    check_orientation(mesh_, begin(orientations), report.triangles_examined);
    check_vertices(mesh_, view_, begin(vertices));
    if (half_edges != 3 * mesh_.count || report.triangles_examined != mesh_.count)
      fail(begin(counts), -1,
           std::to_string(report.triangles_examined) + " triangles and " + std::to_string(half_edges) +
               " of their edges were examined, there are " + std::to_string(mesh_.count) + " triangles");
    if (!passed(neighbors)) return skip({boundary, euler, hull, delaunay, ties}, neighbors);
    check_boundary(mesh_, begin(boundary));
    report.hull_vertices = mesh_.boundary.size();
    check_euler(mesh_, begin(euler));
    if (passed(boundary)) {
      check_hull(mesh_, view_.hull, begin(hull));
    } else {
      skip({hull}, boundary);
    }
    if (!passed(orientations)) return skip({delaunay, ties}, orientations);
    Check& circles = begin(delaunay);
    check_delaunay(mesh_, circles, begin(ties), options_, report);
    if (2 * report.edges_examined + mesh_.boundary.size() != 3 * mesh_.count)
      fail(begin(counts), -1,
           std::to_string(report.edges_examined) + " interior edges were examined, there are " +
               std::to_string((3 * mesh_.count - mesh_.boundary.size()) / 2));
  }

  void examine_no_triangles() {
    for (const Name name : {range, neighbors, orientations, boundary, euler, hull, delaunay, ties})
      begin(name).passed = true;
    check_collinear(mesh_, view_, begin(vertices));
    if (!view_.hull.empty()) fail(begin(hull), 0, "there is a hull but no triangle");
  }

  const MeshView& view_;
  const VerifyOptions& options_;
  Mesh mesh_;
};

}  // namespace

VerifyReport verify(PointsView points, const MeshView& mesh, const VerifyOptions& options) {
  return Context(points, mesh, options).run();
}

std::string VerifyReport::summary() const {
  for (const Check& check : checks)
    if (!check.passed)
      return check.name + " failed" +
             (check.failures > 1 ? " (" + std::to_string(check.failures) + " times)" : std::string()) + ": " +
             check.what;
  if (!ok) return "nothing was examined";
  std::string text = "ok: " + std::to_string(triangles_examined) + " triangles, " + std::to_string(points) +
                     " points, " + std::to_string(edges_examined) + " interior edges, " +
                     std::to_string(hull_vertices) + " points on the hull, " + std::to_string(ties) +
                     " cocircular edges";
  if (unusual_ties != 0) text += ", " + std::to_string(unusual_ties) + " of them decided in another way";
  return text;
}

}  // namespace cadt
