// SPDX-License-Identifier: Apache-2.0
// Segments that cross, found on the device in the mesh of their ends, and the mesh that has the crossings as vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/driver/context.hpp"
#include "common/mesh/mesh.hpp"

namespace cadt {

/// A triangulation on the device, unfinished, and segments between its vertices.
struct SegmentsInMesh {
  const Mesh& mesh;
  const Allocation& ends;             ///< two vertices a segment; both CADT_NONE if it has no length
  const Allocation& vertex_triangle;  ///< a word for each of `vertices`; written
  const Allocation& segments;         ///< the same as pairs of input points
  const Allocation& vertex_of;        ///< the vertex of each of `points` input points
  std::size_t count, vertices, points;
};

/// What was found, on the device.
struct FoundCrossings {
  std::size_t count = 0;  ///< of crossings
  Allocation pairs;       ///< two segments each, the lower one first, in ascending order
  /// What follows is there if it was asked for, and if no two vertices of a chain have the same rounded place. A vertex
  /// is an input point or, from their number on, a crossing.
  Allocation places;  ///< of the input points, then of crossings, rounded to the nearest doubles
  Allocation chain_offsets, chains;
  std::size_t chain_length = 0;
  Allocation chain_edges;  ///< each vertex of a chain with the next one, the last one with itself
};

/// Nothing if this is no work for a device: it has no doubles, or so many pieces of segments run through the same
/// triangles that a sweep takes less (sweep.hpp). \throws InternalError
[[nodiscard]] std::optional<FoundCrossings> find_crossings(Context& ctx, const SegmentsInMesh& in, bool with_places);

/// What is not certainly right, for the exact places, of a mesh that is right for the rounded ones: CADT_SUSPECT of
/// exact_places.dev.h. Nothing if there is too much of it.
[[nodiscard]] std::optional<std::vector<std::uint32_t>> certify_places(Context& ctx, const Mesh& mesh,
                                                                       const Allocation& places, std::size_t points);

}  // namespace cadt
