// SPDX-License-Identifier: Apache-2.0
// The checks of a constrained mesh that `verify` adds to those of its triangles. Of what made it they share
// the exact orientation alone, which exact crossings and seeds take from the verifier, and whole numbers of any size.
#pragma once

#include <cadt/constrained.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace cadt {

/// Points of a mesh: those of the input, where they are now, and those behind them that crossings have made.
class MeshPlaces {
 public:
  using Place = std::array<double, 2>;
  MeshPlaces(PointsView points, const ConstrainedTriangulation& mesh)
      : points_(mesh.moved_points().empty() ? points : PointsView(mesh.moved_points())),
        added_(mesh.added_points()),
        moved_(!mesh.moved_points().empty()) {}
  [[nodiscard]] Place at(std::int32_t i) const {
    const auto k = static_cast<std::size_t>(i);
    if (k < points_.size()) return {points_.x(k), points_.y(k)};
    return {added_[2 * (k - points_.size())], added_[2 * (k - points_.size()) + 1]};
  }
  [[nodiscard]] std::size_t size() const { return points_.size() + added_.size() / 2; }
  [[nodiscard]] std::size_t given() const { return points_.size(); }
  [[nodiscard]] bool moved() const { return moved_; }
  [[nodiscard]] bool is_added(std::int32_t i) const { return static_cast<std::size_t>(i) >= points_.size(); }

 private:
  PointsView points_;
  std::span<const double> added_;
  bool moved_;
};

/// Adds a failure to a check, which keeps the first one.
inline void add_failure(Check& check, std::int64_t first, const std::string& what) {
  if (check.failures++ != 0) return;
  check.first = first;
  check.what = what;
}

/// "constraints": each segment is a chain of edges along it, and no other edge is constrained.
[[nodiscard]] Check check_segments(const MeshPlaces& places, std::span<const Segment> segments,
                                   const ConstrainedTriangulation& mesh);
/// Where a mesh on a grid has its points, and the cells of its chains: failures are those of "constraints". Exact.
/// \pre `check` has passed
void check_grid(PointsView points, const MeshPlaces& places, std::span<const Segment> segments,
                const ConstrainedTriangulation& mesh, const ConstraintOptions& constraints, Check& check);

/// The triangles that seeds lie in. Exact: vertices made for crossings are where their segments cross.
class SeedTriangles {
 public:
  SeedTriangles(const MeshPlaces& places, std::span<const Segment> segments, const ConstrainedTriangulation& mesh);
  /// The lowest one of each; -1: none.
  [[nodiscard]] std::vector<std::int32_t> of(std::span<const MeshPlaces::Place> seeds) const;

 private:
  [[nodiscard]] bool contains(std::size_t t, const MeshPlaces::Place& seed) const;
  const MeshPlaces& places_;
  const std::span<const Segment> segments_;
  const ConstrainedTriangulation& mesh_;
  bool exact_;
};

/// "regions": regions are what constrained edges separate, numbered in order, and their values, what is inside and the
/// attributes are those of the rule. By a search from triangle to triangle. \pre the mesh has passed all other checks
[[nodiscard]] Check check_regions(const MeshPlaces& places, std::span<const Segment> segments,
                                  const ConstrainedTriangulation& mesh, const ConstraintOptions& constraints);

}  // namespace cadt
