// SPDX-License-Identifier: Apache-2.0
// Orientation of every triangle, and the empty circle of every interior edge. By Delaunay's lemma the latter, a local
// property, implies that the circle of every triangle contains no point.
#include "mesh.hpp"

namespace cadt::verifier {

void check_orientation(const Mesh& mesh, Check& check, std::uint64_t& examined) {
  const Findings findings = reduce_each<Findings>(mesh.count, mesh.threads, [&](std::size_t t, Findings& mine) {
    ++mine.examined;
    if (orientation(mesh.point(mesh.vertex(t, 0)), mesh.point(mesh.vertex(t, 1)), mesh.point(mesh.vertex(t, 2))) <= 0)
      mine.fail(t);
  });
  examined = findings.examined;
  conclude_orientation(mesh, findings, check);
}

void conclude_orientation(const Mesh& mesh, const Findings& findings, Check& check) {
  conclude(check, findings, [&] { return mesh.describe_triangle(findings.first) + " is clockwise or flat"; });
}

namespace {

void examine_edge(const Mesh& mesh, std::size_t t, std::size_t k, Circles& mine) {
  const auto other = static_cast<std::size_t>(mesh.neighbors[3 * t + k]);
  // The apex across is the vertex that is neither end of the shared edge.
  const std::int32_t from = mesh.vertex(t, next3(k)), to = mesh.vertex(t, previous3(k));
  std::int32_t across = mesh.vertex(other, 0);
  for (std::size_t j = 1; j < 3 && (across == from || across == to); ++j) across = mesh.vertex(other, j);
  const Point a = mesh.point(mesh.vertex(t, 0)), b = mesh.point(mesh.vertex(t, 1)), c = mesh.point(mesh.vertex(t, 2));
  const Point d = mesh.point(across);
  ++mine.illegal.examined;
  if (mesh.constrained(t, k)) return;
  mine.examine(3 * t + k, a, b, c, d);
}

}  // namespace

void Circles::examine(std::size_t edge, const Point& a, const Point& b, const Point& c, const Point& d) {
  const int side = incircle(a, b, c, d);
  if (side > 0) illegal.fail(edge);
  if (side != 0) return;
  ++ties;
  if (incircle_perturbed(a, b, c, d) > 0) unusual.fail(edge);
}

void check_delaunay(const Mesh& mesh, Check& delaunay, Check& ties, const VerifyOptions& options,
                    VerifyReport& report) {
  const Circles circles = reduce_each<Circles>(mesh.count, mesh.threads, [&](std::size_t t, Circles& mine) {
    for (std::size_t k = 0; k < 3; ++k)
      // The predicates are the same from both sides: the lower triangle of the two examines the edge.
      if (mesh.neighbors[3 * t + k] > static_cast<std::int32_t>(t)) examine_edge(mesh, t, k, mine);
  });
  conclude_delaunay(mesh, circles, delaunay, ties, options, report);
}

void conclude_delaunay(const Mesh& mesh, const Circles& circles, Check& delaunay, Check& ties,
                       const VerifyOptions& options, VerifyReport& report) {
  report.edges_examined = circles.illegal.examined;
  report.ties = circles.ties;
  report.unusual_ties = circles.unusual.failures;
  conclude(delaunay, circles.illegal, [&] {
    return mesh.describe_edge(circles.illegal.first) + ", has the vertex across inside the triangle's circle";
  });
  conclude(ties, circles.unusual, [&] {
    return mesh.describe_edge(circles.unusual.first) + ", is not the one that the symbolic perturbation chooses";
  });
  if (!options.canonical_ties && !ties.passed) {
    ties.passed = true;
    ties.what = std::to_string(report.unusual_ties) + " of " + std::to_string(report.ties) +
                " cocircular edges are decided in another way, which was allowed";
  }
}

}  // namespace cadt::verifier
