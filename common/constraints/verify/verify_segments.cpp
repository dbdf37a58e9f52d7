// SPDX-License-Identifier: Apache-2.0
// Verification of constrained edges: each segment is a chain of edges along it, and no other edge is constrained.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "common/constraints/verify/verify_checks.hpp"
#include "common/constraints/verify/verify_crossings.hpp"
#include "common/verify/host/mesh.hpp"

namespace cadt {
namespace {

using Place = MeshPlaces::Place;

class SegmentCheck {
 public:
  SegmentCheck(const MeshPlaces& places, std::span<const Segment> segments, const ConstrainedTriangulation& mesh)
      : places_(places), segments_(segments), mesh_(mesh), check_{"constraints", false, 0, -1, {}} {}

  Check run() {
    const auto offsets = mesh_.chain_offsets();
    if (offsets.size() != segments_.size() + 1) {
      fail(-1, "there are chains of " + std::to_string(offsets.size() - 1) + " segments, not of " +
                   std::to_string(segments_.size()));
    } else {
      for (std::size_t s = 0; s < segments_.size(); ++s) check_chain(s);
      check_degenerate();
      if (check_.failures == 0 && mesh_.mesh().number_of_triangles() == 0) check_line();
      check_flags();
    }
    check_.passed = check_.failures == 0;
    return check_;
  }

 private:
  void fail(std::int64_t first, const std::string& what) { add_failure(check_, first, what); }

  [[nodiscard]] std::span<const std::int32_t> chain(std::size_t s) const {
    const auto offsets = mesh_.chain_offsets();
    return mesh_.chain_vertices().subspan(static_cast<std::size_t>(offsets[s]),
                                          static_cast<std::size_t>(offsets[s + 1] - offsets[s]));
  }

  /// From end to end, straight on. What lies between two vertices of it is seen by check_flags: an edge of the mesh.
  void check_chain(std::size_t s) {
    const auto number = static_cast<std::int64_t>(s);
    const std::string name = "segment " + std::to_string(s);
    for (const std::int32_t end : segments_[s])
      if (end < 0 || static_cast<std::size_t>(end) >= places_.given()) return fail(number, name + " has no ends");
    const Place a = places_.at(segments_[s][0]), b = places_.at(segments_[s][1]);
    const auto vertices = chain(s);
    if (a == b) {
      if (!vertices.empty()) fail(number, name + " has no length, but a chain");
      return;
    }
    if (vertices.size() < 2) return fail(number, name + " has no chain");
    for (const std::int32_t v : vertices)
      if (v < 0 || static_cast<std::size_t>(v) >= places_.size())
        return fail(number, name + " has a vertex that is none");
    if (places_.at(vertices.front()) != a || places_.at(vertices.back()) != b)
      return fail(number, "the chain of " + name + " has other ends");
    if (places_.moved()) return;  // from cell to cell: check_grid
    Place before = a;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
      if (places_.is_added(vertices[i])) continue;  // rounded, somewhere beside it
      const Place here = places_.at(vertices[i]);
      if (before == here || (before < here) != (a < b) || exact_orientation(a, b, here) != 0)
        return fail(number, "the chain of " + name + " does not lie on it at vertex " + std::to_string(vertices[i]));
      before = here;
    }
  }

  /// \pre chains are right
  void check_degenerate() {
    std::vector<std::int32_t> expected;
    for (std::size_t s = 0; s < segments_.size(); ++s)
      if (chain(s).empty()) expected.push_back(static_cast<std::int32_t>(s));
    if (!std::ranges::equal(mesh_.degenerate_segments(), expected))
      fail(-1, "the degenerate segments are not those without a chain");
  }

  /// Of points that all lie on one line: each chain has all of its places, in order, each with its lowest point.
  /// \pre chains lie on their segments
  void check_line() {
    const auto less = [&](std::int32_t i, std::int32_t j) {
      const Place a = places_.at(i), b = places_.at(j);
      return a < b || (a == b && i < j);
    };
    std::vector<std::int32_t> line(places_.size());
    std::iota(line.begin(), line.end(), 0);
    std::ranges::sort(line, less);
    const auto same = [&](std::int32_t i, std::int32_t j) { return places_.at(i) == places_.at(j); };
    line.erase(std::unique(line.begin(), line.end(), same), line.end());
    for (std::size_t s = 0; s < segments_.size(); ++s) {
      std::vector<std::int32_t> along(chain(s).begin(), chain(s).end());
      if (along.empty()) continue;
      if (less(along.back(), along.front())) std::ranges::reverse(along);
      const auto first = std::ranges::lower_bound(line, along.front(), less);
      if (static_cast<std::size_t>(line.end() - first) < along.size() || !std::equal(along.begin(), along.end(), first))
        fail(static_cast<std::int64_t>(s), "the chain of segment " + std::to_string(s) +
                                               " leaves out a vertex on it, or has " + "one that equals another");
    }
  }

  void check_flags() {
    const auto expected = mesh_.constrained_edges();
    const auto triangles = mesh_.mesh().triangles();
    const auto neighbors = mesh_.mesh().neighbors();
    const auto flags = mesh_.edge_flags();
    std::vector<Segment> flagged, open;  // all from both sides; those of the hull have one
    for (std::size_t t = 0; t < flags.size(); ++t) {
      if (flags[t] > 7U)
        fail(static_cast<std::int64_t>(t), "triangle " + std::to_string(t) + " has more than three flags");
      for (std::size_t k = 0; k < 3; ++k) {
        if ((flags[t] >> k & 1U) == 0) continue;
        const auto [low, high] = std::minmax(triangles[3 * t + (k + 1) % 3], triangles[3 * t + (k + 2) % 3]);
        flagged.push_back({low, high});
        if (neighbors[3 * t + k] < 0) open.push_back({low, high});
      }
    }
    flagged.insert(flagged.end(), open.begin(), open.end());
    std::ranges::sort(flagged);
    for (std::size_t i = 0; i < flagged.size(); i += 2)
      if (i + 1 == flagged.size() || flagged[i] != flagged[i + 1])
        return fail(-1, "the edge from " + std::to_string(flagged[i][0]) + " to " + std::to_string(flagged[i][1]) +
                            " is constrained on one side alone");
    flagged.erase(std::unique(flagged.begin(), flagged.end()), flagged.end());
    if (triangles.empty() || std::ranges::equal(flagged, expected)) return;
    const auto [a, b] = std::ranges::mismatch(flagged, expected);
    const bool more = b == expected.end() || (a != flagged.end() && *a < *b);
    const Segment edge = more ? *a : *b;
    fail(-1,
         "the edge from " + std::to_string(edge[0]) + " to " + std::to_string(edge[1]) +
             (more ? " is constrained, but part of no segment" : " is part of a segment, but not a constrained edge"));
  }

  const MeshPlaces& places_;
  const std::span<const Segment> segments_;
  const ConstrainedTriangulation& mesh_;
  Check check_;
};

/// Rounded, the crossings beside an edge say nothing of its circles: it is exempt as constrained edges are.
std::vector<std::uint32_t> exempt_edges(const MeshPlaces& places, const ConstrainedTriangulation& mesh) {
  const auto flags = mesh.edge_flags();
  std::vector<std::uint32_t> exempt(flags.begin(), flags.end());
  const Triangulation& of = mesh.mesh();
  for (std::size_t t = 0; t < exempt.size(); ++t) {
    const auto has_added = [&](std::size_t u) {
      return std::ranges::any_of(of.triangle(u), [&](std::int32_t v) { return places.is_added(v); });
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t other = of.neighbors()[3 * t + k];
      if (other < 0 || static_cast<std::size_t>(other) >= exempt.size()) continue;
      if (has_added(t) || has_added(static_cast<std::size_t>(other))) exempt[t] |= 1U << k;
    }
  }
  return exempt;
}

void require_finite(PointsView points) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!std::isfinite(points.x(i)) || !std::isfinite(points.y(i)))
      verifier::refuse_point(static_cast<std::int64_t>(i));
}

}  // namespace

Check check_segments(const MeshPlaces& places, std::span<const Segment> segments,
                     const ConstrainedTriangulation& mesh) {
  return SegmentCheck(places, segments, mesh).run();
}

VerifyReport verify(PointsView points, std::span<const Segment> segments, const ConstrainedTriangulation& mesh,
                    const ConstraintOptions& constraints, const VerifyOptions& options) {
  const Triangulation& of = mesh.mesh();
  const MeshPlaces places(points, mesh);
  if (places.given() != points.size())
    throw InputError(
        "the mesh has " + std::to_string(places.given()) + " moved points, not " + std::to_string(points.size()),
        points.size());
  require_finite(points);  // below they are those that have moved
  std::vector<double> all;
  if (places.size() != points.size() || places.moved())
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Place place = places.at(static_cast<std::int32_t>(i));
      all.insert(all.end(), place.begin(), place.end());
    }
  const bool rounded = !places.moved() && places.size() != points.size();
  const std::vector<std::uint32_t> exempt = rounded ? exempt_edges(places, mesh) : std::vector<std::uint32_t>();
  MeshView view = verifier::view_of(of);
  view.edge_flags = rounded ? std::span<const std::uint32_t>(exempt) : mesh.edge_flags();
  VerifyReport report = verify(all.empty() ? points : PointsView(all), view, options);
  Check chains = check_segments(places, segments, mesh);
  if (chains.passed) check_grid(points, places, segments, mesh, constraints, chains);
  chains.passed = chains.failures == 0;
  if (rounded && chains.passed) check_crossings(places, segments, mesh, chains);
  const auto turns = std::ranges::find(report.checks, std::string("orientation"), &Check::name);
  if (turns != report.checks.end() && turns->passed && !mesh.rounded_valid())
    add_failure(chains, -1, "all triangles are counterclockwise with rounded coordinates, but rounded_valid is false");
  chains.passed = chains.failures == 0;
  report.ok = report.ok && chains.passed;
  report.checks.push_back(std::move(chains));
  if (report.ok) {  // else there is no mesh to walk through
    report.checks.push_back(check_regions(places, segments, mesh, constraints));
    report.ok = report.checks.back().passed;
  }
  return report;
}

}  // namespace cadt
