// SPDX-License-Identifier: Apache-2.0
// The constrained Delaunay triangulation of points and of the exact places where segments cross.
#pragma once

#include <cadt/constrained.hpp>

#include "common/constraints/stop_check.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt::constraints {

/// Indices are 0-based; a vertex is an input point or, from their number on, an added one.
struct ExactMesh {
  std::vector<std::int32_t> triangles;    ///< 3 vertices each, counterclockwise as exact places
  std::vector<std::int32_t> neighbors;    ///< the k-th is opposite vertex k; -1 outside
  std::vector<std::uint32_t> edge_flags;  ///< a word a triangle; bit k: edge k is constrained
  std::vector<double> added_xy;           ///< crossings to the nearest doubles, ties to even
  std::vector<std::array<std::int32_t, 2>>
      parents;                         ///< for each the lowest pair of segments that cross there, ascending
  std::vector<std::int64_t> offsets;   ///< the vertices along segment s, in its direction, are
  std::vector<std::int32_t> vertices;  ///< from offsets[s] to offsets[s + 1] - 1; none if its ends are equal
  bool rounded_valid = true;           ///< triangles are counterclockwise with the rounded places, too
};

/// The unique triangulation that has the divided segments as edges and whose other edges are legal, decided with exact
/// places; ties are broken in their lexicographic order. So it is that of CGAL's Constrained_triangulation_plus_2 over
/// an exact kernel. `delaunay`: of the same points. Segments may be given in any order and direction, repeat and
/// overlap; several that cross at one place make one vertex. Triangles are in no particular order.
///
/// O((n + length of chains) log n) expected for well-spread input; vertices and edges are inserted by one thread. Takes
/// about 100 bytes a vertex more than the result. \throws InputError as find_crossings, LimitError, Cancelled
[[nodiscard]] ExactMesh triangulate_with_crossings(PointsView points, std::span<const Segment> segments,
                                                   const Triangulation& delaunay, unsigned threads,
                                                   const StopCheck& check_stop = {});

}  // namespace cadt::constraints
