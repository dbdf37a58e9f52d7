// SPDX-License-Identifier: Apache-2.0
// Verification of constrained edges: each segment is a chain of edges along it, and no other edge is constrained.
#include <algorithm>
#include <cmath>
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

  void check_flags() {
    const auto expected = mesh_.constrained_edges();
    const auto triangles = mesh_.mesh().triangles();
    const auto flags = mesh_.edge_flags();
    std::vector<Segment> flagged;
    for (std::size_t t = 0; t < flags.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        if ((flags[t] >> k & 1U) == 0) continue;
        const auto [low, high] = std::minmax(triangles[3 * t + (k + 1) % 3], triangles[3 * t + (k + 2) % 3]);
        flagged.push_back({low, high});
      }
    }
    std::ranges::sort(flagged);
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
  report.ok = report.ok && chains.passed;
  report.checks.push_back(std::move(chains));
  if (report.ok) {  // else there is no mesh to walk through
    report.checks.push_back(check_regions(places, segments, mesh, constraints));
    report.ok = report.checks.back().passed;
  }
  return report;
}

}  // namespace cadt
