// SPDX-License-Identifier: Apache-2.0
// Order of the checks, and what they amount to.
#include "mesh.hpp"

#include <array>
#include <cfenv>
#include <cmath>
#include <limits>

namespace cadt {
namespace {

using namespace verifier;

enum Name : std::size_t {
  counts,
  range,
  neighbors,
  orientations,
  vertices,
  boundary,
  euler,
  hull,
  delaunay,
  ties,
  number_of_checks
};
constexpr std::array<const char*, number_of_checks> names{"counts",   "range", "neighbors", "orientation", "vertices",
                                                          "boundary", "euler", "hull",      "delaunay",    "ties"};

/// The predicates rest on IEEE 754 arithmetic. A process may have changed it, e.g. by loading code made for fast
/// arithmetic; then no verdict is better than a wrong one. Threads inherit the mode of the one that starts them.
void require_ieee_arithmetic() {
  volatile double smallest_normal = std::numeric_limits<double>::min(), half = 0.5;
  volatile const double subnormal = smallest_normal * half;
  if (std::fegetround() != FE_TONEAREST || subnormal == 0 || subnormal + subnormal != smallest_normal)
    throw Error(
        "verify needs IEEE arithmetic: rounding to nearest, and subnormal numbers that are not flushed to zero");
}

void require_finite(PointsView points, unsigned threads) {
  const Tally tally =
      reduce_blocks<Tally>(points.size(), threads, [&](std::size_t begin, std::size_t end, Tally& mine) {
        for (std::size_t i = begin; i < end; ++i)
          if (!std::isfinite(points.x(i)) || !std::isfinite(points.y(i))) mine.fail(i);
      });
  if (tally.failures != 0)
    throw InputError("point " + std::to_string(tally.first) + " has a coordinate that is NaN or infinite",
                     static_cast<std::size_t>(tally.first));
}

/// Empty if the arrays fit together.
std::string size_error(PointsView points, const MeshView& view) {
  constexpr auto limit = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  if (view.triangles.size() % 3 != 0)
    return "the number of triangle indices, " + std::to_string(view.triangles.size()) + ", is not a multiple of 3";
  if (!view.neighbors.empty() && view.neighbors.size() != view.triangles.size())
    return "there are " + std::to_string(view.neighbors.size()) + " neighbours for " +
           std::to_string(view.triangles.size()) + " edges";
  // 3 * triangles has to fit 32 bits; no mesh of 32-bit records has more.
  if (points.size() > limit || view.triangles.size() > 2 * limit)
    return "too many points or triangles for 32-bit indices";
  return {};
}

/// The order of dependence: a check whose ground has failed is not run and says so.
class Run {
 public:
  Run(PointsView points, const MeshView& view, const VerifyOptions& options) : view_(view), options_(options) {
    mesh_.points = points;
    mesh_.threads = options.threads != 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
    report_.points = points.size();
    report_.checks.resize(number_of_checks);
    for (std::size_t i = 0; i < number_of_checks; ++i) {
      report_.checks[i].name = names[i];
      report_.checks[i].what = "not examined";
    }
  }

  VerifyReport run() {
    require_ieee_arithmetic();
    require_finite(mesh_.points, mesh_.threads);
    examine();
    report_.ok = true;
    for (const Check& check : report_.checks) report_.ok = report_.ok && check.passed;
    return std::move(report_);
  }

 private:
  Check& begin(Name name) {
    Check& check = report_.checks[name];
    check.what.clear();
    return check;
  }
  [[nodiscard]] bool passed(Name name) const { return report_.checks[name].passed; }
  void skip(std::initializer_list<Name> skipped, Name because) {
    for (const Name name : skipped)
      report_.checks[name].what = std::string("not examined: the check '") + names[because] + "' failed";
  }

  void examine() {
    if (const std::string error = size_error(mesh_.points, view_); !error.empty()) {
      fail(begin(counts), -1, error);
      return skip({range, neighbors, orientations, vertices, boundary, euler, hull, delaunay, ties}, counts);
    }
    begin(counts).passed = true;
    mesh_.count = view_.triangles.size() / 3;
    mesh_.triangles = view_.triangles;
    mesh_.neighbors = view_.neighbors;
    if (mesh_.count == 0) return examine_no_triangles();

    check_range(mesh_, begin(range));
    if (!passed(range)) return skip({neighbors, orientations, vertices, boundary, euler, hull, delaunay, ties}, range);
    std::uint64_t half_edges = 0;
    if (view_.neighbors.empty()) {
      derive_neighbors(mesh_, begin(neighbors), half_edges);
    } else {
      check_neighbors(mesh_, begin(neighbors), half_edges);
    }
    check_orientation(mesh_, begin(orientations), report_.triangles_examined);
    check_vertices(mesh_, view_, begin(vertices));
    if (half_edges != 3 * mesh_.count || report_.triangles_examined != mesh_.count)
      fail(begin(counts), -1,
           std::to_string(report_.triangles_examined) + " triangles and " + std::to_string(half_edges) +
               " of their edges were examined, there are " + std::to_string(mesh_.count) + " triangles");
    if (!passed(neighbors)) return skip({boundary, euler, hull, delaunay, ties}, neighbors);
    check_boundary(mesh_, begin(boundary));
    report_.hull_vertices = mesh_.boundary.size();
    check_euler(mesh_, begin(euler));
    if (passed(boundary)) {
      check_hull(mesh_, view_.hull, begin(hull));
    } else {
      skip({hull}, boundary);
    }
    if (!passed(orientations)) return skip({delaunay, ties}, orientations);
    Check& circles = begin(delaunay);
    check_delaunay(mesh_, circles, begin(ties), options_, report_);
    if (2 * report_.edges_examined + mesh_.boundary.size() != 3 * mesh_.count)
      fail(begin(counts), -1,
           std::to_string(report_.edges_examined) + " interior edges were examined, there are " +
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
  VerifyReport report_;
};

}  // namespace

VerifyReport verify(PointsView points, const MeshView& mesh, const VerifyOptions& options) {
  return Run(points, mesh, options).run();
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
