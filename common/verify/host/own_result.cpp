// SPDX-License-Identifier: Apache-2.0
// Checks of the library's own result, which promises more than a bare mesh.
#include "mesh.hpp"

#include <string>

namespace cadt {
namespace {

/// Dimension implied by the report: the points of a mesh without triangles are collinear if the report is ok.
int implied_dimension(PointsView points, const VerifyReport& report, std::size_t duplicates) {
  if (report.triangles_examined != 0) return 2;
  const std::size_t distinct = points.size() - duplicates;
  return distinct == 0 ? -1 : (distinct == 1 ? 0 : 1);
}

}  // namespace

MeshView verifier::view_of(const Triangulation& mesh) {
  MeshView view;
  view.triangles = mesh.triangles();
  view.neighbors = mesh.neighbors();
  view.hull = mesh.hull();
  view.duplicates = mesh.duplicates();
  view.has_duplicates = true;
  return view;
}

void verifier::check_own_result(PointsView points, const Triangulation& mesh, VerifyReport& report) {
  const MeshView view = view_of(mesh);
  const auto refuse = [&](std::size_t index, const std::string& what) {
    Check& check = report.checks[index];
    check.passed = false;
    check.failures += 1;
    check.what = what;
    report.ok = false;
  };
  // 0 is "counts", 2 "neighbors", 7 "hull": an empty array counts as not given in a bare mesh, but not here.
  if (mesh.number_of_points() != points.size() || mesh.number_of_triangles() * 3 != view.triangles.size())
    refuse(0, "the triangulation is one of " + std::to_string(mesh.number_of_points()) + " points");
  if (view.neighbors.size() != view.triangles.size()) refuse(2, "neighbours are missing");
  if (view.hull.empty() && !view.triangles.empty()) refuse(7, "the hull is missing");
  if (report.ok && mesh.dimension() != implied_dimension(points, report, view.duplicates.size()))
    refuse(0, "the dimension is " + std::to_string(mesh.dimension()) + ", it should be " +
                  std::to_string(implied_dimension(points, report, view.duplicates.size())));
}

VerifyReport verify(PointsView points, const Triangulation& mesh, const VerifyOptions& options) {
  VerifyReport report = verify(points, verifier::view_of(mesh), options);
  verifier::check_own_result(points, mesh, report);
  return report;
}

}  // namespace cadt
