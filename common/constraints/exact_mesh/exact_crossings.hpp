// SPDX-License-Identifier: Apache-2.0
// The constrained Delaunay triangulation of points and of the exact places where segments cross.
#pragma once

#include <cadt/constrained.hpp>

#include "common/constraints/crossings/arrangement.hpp"
#include "common/constraints/stop_check.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt::constraints {

/// The vertices that crossings become, and those along each segment. Indices are 0-based; a vertex is an input point
/// or, from their number on, an added one.
struct DividedSegments {
  std::vector<double> added_xy;  ///< crossings to the nearest doubles, ties to even
  std::vector<std::array<std::int32_t, 2>>
      parents;                         ///< for each the lowest pair of segments that cross there, ascending
  std::vector<std::int64_t> offsets;   ///< the vertices along segment s, in its direction, are
  std::vector<std::int32_t> vertices;  ///< from offsets[s] to offsets[s + 1] - 1; none if its ends are equal
  std::vector<std::int32_t> number;    ///< of each vertex of the arrangement
};
/// O(n log n + length of chains). \throws LimitError if these have too many vertices
[[nodiscard]] DividedSegments divide_segments(const Arrangement& in, std::span<const Segment> segments);

struct ExactMesh {
  std::vector<std::int32_t> triangles;    ///< 3 vertices each, counterclockwise as exact places
  std::vector<std::int32_t> neighbors;    ///< the k-th is opposite vertex k; -1 outside
  std::vector<std::uint32_t> edge_flags;  ///< a word a triangle; bit k: edge k is constrained
  bool rounded_valid = true;              ///< triangles are counterclockwise with the rounded places, too
};

/// The unique triangulation that has the divided segments as edges and whose other edges are legal, decided with exact
/// places; ties are broken in their lexicographic order. So it is that of CGAL's Constrained_triangulation_plus_2 over
/// an exact kernel. `number`: of its vertices (DividedSegments). `delaunay`: of the same points. Triangles are in no
/// particular order.
///
/// O((n + length of chains) log n) expected for well-spread input; vertices and edges are inserted by one thread. Takes
/// about 100 bytes a vertex more than the result. \throws InputError as find_crossings, LimitError, Cancelled
[[nodiscard]] ExactMesh triangulate_with_crossings(const Arrangement& in, std::span<const std::int32_t> number,
                                                   const Triangulation& delaunay, unsigned threads,
                                                   const StopCheck& check_stop = {});

}  // namespace cadt::constraints
