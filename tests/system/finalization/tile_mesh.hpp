// SPDX-License-Identifier: Apache-2.0
// A whole mesh by tiles, in memory and as simply as possible: what the tests compare with one call for all points.
#pragma once

#include <cadt/finalization.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "tests/support/families.hpp"

namespace cadt::test {

/// A triangle, its smallest vertex first, and what is across its edges: the same three vertices of the neighbour, or
/// zeros.
struct LinkedTriangle {
  std::array<std::uint64_t, 3> vertices{};
  std::array<std::array<std::uint64_t, 3>, 3> across{};
  friend auto operator<=>(const LinkedTriangle&, const LinkedTriangle&) = default;
};

struct TiledMesh {
  std::vector<LinkedTriangle> triangles;  ///< sorted
  std::vector<DuplicateId> duplicates;    ///< sorted by point
  NodeSums sums;
  std::size_t nodes = 0, leaves = 0;
  std::vector<double> open_of_root_n;  ///< open vertices / sqrt(points) of each node but the root
};

struct TileOptions {
  std::size_t tile_points = 100;
  bool flat = false;                          ///< one join of all leaves
  std::uint64_t first_id = 0;                 ///< of the first point
  std::function<void(FinishedNode&)> tamper;  ///< what a planted fault does to a node before its parent sees it
};

/// Bisects the points by a k-d tree over half-open boxes, and runs its nodes.
[[nodiscard]] TiledMesh triangulate_by_tiles(Triangulator& triangulator, const Points& xy, const TileOptions& options);

/// The same form of a mesh in one call.
[[nodiscard]] std::vector<LinkedTriangle> linked_triangles(const Triangulation& mesh, std::uint64_t first_id = 0);

}  // namespace cadt::test
