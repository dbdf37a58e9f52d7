// SPDX-License-Identifier: Apache-2.0
// Edges, stars and half-edges of a mesh, as arrays on the host.
#pragma once

#include <cadt/export.hpp>
#include <cadt/triangulation.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt {

/// A list for each point, in compressed rows: that of point p is indices[indptr[p]] to indices[indptr[p + 1] - 1], as
/// in SciPy's `vertex_neighbor_vertices`. indptr has number_of_points() + 1 elements.
struct CADT_API CompressedRows {
  std::vector<std::size_t> indptr;
  std::vector<std::int32_t> indices;
  /// The list of point p; valid as long as this object is not changed. \pre p + 1 < indptr.size()
  [[nodiscard]] std::span<const std::int32_t> operator[](std::size_t p) const noexcept {
    return {indices.data() + indptr[p], indptr[p + 1] - indptr[p]};
  }
};

// All functions cost O(points + triangles) on one thread, are thread-safe, and return what the caller owns. Indices are
// 0-based. Points that are no vertices (duplicates, and all points if dimension() < 2) have no edge, neighbour or
// triangle.

/// The edges, each once: pairs with the lower index first, ascending. With v vertices and h of them on the hull there
/// are 3 v - 3 - h.
[[nodiscard]] CADT_API std::vector<std::array<std::int32_t, 2>> edges(const Triangulation& mesh);

/// The neighbours of each vertex, counterclockwise. An inner vertex begins with its lowest neighbour, one on the hull
/// with the next vertex of the hull (counterclockwise), and so ends with the one before.
[[nodiscard]] CADT_API CompressedRows vertex_neighbors(const Triangulation& mesh);

/// The triangles at each vertex, counterclockwise, in the order of vertex_neighbors: the i-th triangle of a vertex has
/// its i-th neighbour and the one after that; behind the last of an inner vertex comes the first.
[[nodiscard]] CADT_API CompressedRows incident_triangles(const Triangulation& mesh);

/// Half-edges as in delaunator: half-edge e is of triangle e / 3, and runs from triangles()[e] to the triangle's next
/// vertex, triangles()[e % 3 == 2 ? e - 2 : e + 1]. Element e is the half-edge in the opposite direction, or -1 on the
/// hull. (neighbors() has another order: half-edge e is opposite the vertex before its start.) 64 bits, as large meshes
/// have more than 2^31 half-edges.
[[nodiscard]] CADT_API std::vector<std::int64_t> half_edges(const Triangulation& mesh);

}  // namespace cadt
