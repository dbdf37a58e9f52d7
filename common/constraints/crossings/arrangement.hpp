// SPDX-License-Identifier: Apache-2.0
// The arrangement of segments between points: where they cross, exactly, and what lies along each of them.
#pragma once

#include <cadt/constrained.hpp>

#include "common/constraints/exact/implicit_point.hpp"
#include "common/constraints/stop_check.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace cadt::constraints {

/// Indices are 0-based. A vertex is the rank of a point, or the number of points plus the index of a crossing.
struct Arrangement {
  std::vector<exact::Point> points;          ///< distinct, in lexicographic order: a point's rank is its index here
  std::vector<std::int32_t> rank;            ///< of each input point
  std::vector<std::int32_t> representative;  ///< for each rank the lowest input point there

  std::vector<std::array<std::int32_t, 2>> segments;  ///< distinct ones, by their ranks, ascending; the lower end first
  std::vector<exact::Line> lines;                     ///< their coordinates
  std::vector<std::int32_t> segment_of;               ///< for each input segment; -1 if both ends are the same place
  std::vector<std::int64_t> source_offsets;           ///< segment s is the same as the input segments
  std::vector<std::int32_t> sources;  ///< from source_offsets[s] to source_offsets[s + 1] - 1, ascending

  /// Segments that overlap, one with the next, make a wall: a part of a line. Those of wall w are wall_segments from
  /// wall_offsets[w] to wall_offsets[w + 1] - 1, ascending. Walls are in the order of their first segments.
  std::vector<std::int32_t> wall_of;
  std::vector<std::int64_t> wall_offsets;
  std::vector<std::int32_t> wall_segments;
  /// The vertices along wall w, both ends included, are chain_vertices from chain_offsets[w] to chain_offsets[w + 1] -
  /// 1, in lexicographic order; those along segment s are from segment_first[s] to segment_last[s].
  std::vector<std::int64_t> chain_offsets;
  std::vector<std::int32_t> chain_vertices;
  std::vector<std::int64_t> segment_first, segment_last;

  std::vector<exact::Place> crossings;  ///< different places where no point lies, in lexicographic order
  /// A wall through a crossing, where in its chain, and the lowest input segment of the wall there.
  struct Member {
    std::int32_t wall, source;
    std::int64_t position;
  };
  std::vector<std::int64_t> member_offsets;  ///< of crossings; they have two members at least, on different lines
  std::vector<Member> members;
  std::vector<std::array<std::int32_t, 2>> parents;  ///< for each the lowest pair of input segments that cross there

  [[nodiscard]] exact::Place place(std::int32_t vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return v < points.size() ? exact::explicit_place(points[v]) : crossings[v - points.size()];
  }
};

/// Points and segments alone: neither walls nor crossings. O(n log n). \throws InputError for NaN or infinity,
/// with the point's index, or for an end that is no point, with the segment's index
[[nodiscard]] Arrangement sort_segments(PointsView points, std::span<const Segment> segments);

/// The whole. It does not depend on the number of threads, nor on the order and direction of the input but for its
/// numbers. O((n + length of chains) log n). \throws as sort_segments, Cancelled, LimitError, and Error if the thread's
/// arithmetic is not IEEE 754
[[nodiscard]] Arrangement arrange(PointsView points, std::span<const Segment> segments, unsigned threads,
                                  const StopCheck& check_stop = {});

}  // namespace cadt::constraints
