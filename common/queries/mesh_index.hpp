// SPDX-License-Identifier: Apache-2.0
// A finished mesh prepared for queries (locate_queries.dev.h), and queries prepared for it.
#pragma once

#include <cstddef>
#include <tuple>

#include "common/driver/context.hpp"
#include "common/mesh/mesh.hpp"
#include "common/points/bounds.hpp"
#include "common/points/key_grid.hpp"

namespace cadt {

/// Elements along Hilbert's curve.
struct CurveOrder {
  Allocation order;      ///< which element is at each place
  Allocation high, low;  ///< its key; `low` is null for keys of one word
};

/// The mesh of the caller: points as they are, triangles across, and what is needed to find a triangle near a query.
struct MeshIndex {
  Allocation points, vertices, across;
  Allocation edge_flags;  ///< a word a triangle, of constrained edges; null without segments
  bool any_edge = false;  ///< others may not be Delaunay either: beside rounded crossings, or it is unknown which are
  std::size_t point_count = 0, triangles = 0;
  Allocation lowest;  ///< the lowest triangle of each point; CADT_NONE if it is no vertex
  Bounds bounds;
  // The vertices along the curve, made for the first queries: rasters of triangles and Voronoi diagrams need none.
  KeyGrid grid;
  Allocation curve_high, curve_low, start;  ///< CADT_CURVE_PARAMETERS; `curve_low` is null for keys of one word
  std::size_t curve_size = 0;               ///< 0: not made yet

  [[nodiscard]] DeviceMeshView view() const {
    const auto count = static_cast<std::uint32_t>(triangles);
    return {points, vertices, across, edge_flags, count, count, 0};
  }
};

/// The factors by which a call scales points and queries, and the kernels that take them.
struct QueryScale {
  double scale = 1, scale_again = 1;
  bool wide = false;
};

/// CADT_QUERY_MESH_PARAMETERS
struct QueryMesh {
  DeviceMeshView view;
  QueryScale by;
  [[nodiscard]] auto arguments() const { return std::tuple_cat(view.arguments(), std::tie(by.scale, by.scale_again)); }
};

/// Queries along the curve of the mesh.
struct QueryBatch {
  Allocation points;  ///< in the caller's order
  std::size_t count = 0;
  QueryScale by;
  CurveOrder curve;
};

/// Checks the arrays of a mesh of another program. \throws InputError with the first triangle that is wrong
void check_mesh(Context& ctx, const MeshIndex& mesh);

/// Completes an index that has points, vertices, across and their sizes. Without triangles it stays empty.
/// \throws InputError for the first point that is not finite
void index_mesh(Context& ctx, MeshIndex& mesh);

/// The scale for the mesh and for coordinates with these bounds, and the variant of the kernels from here on.
[[nodiscard]] QueryScale scale_for(Context& ctx, const MeshIndex& mesh, const Bounds& queries);

/// Makes the index of the curve if it is not there. \throws InputError for the first query that is not finite
[[nodiscard]] QueryBatch prepare_queries(Context& ctx, MeshIndex& mesh, Allocation points, std::size_t count);

/// Where each query lies, as cadt_locate_queries says. Null results are left out. \throws InputError if a walk did not
/// end
void locate_queries(Context& ctx, const MeshIndex& mesh, const QueryBatch& queries, const Allocation& located,
                    const Allocation& reached);

/// The `wanted` nearest vertices of each query. `reached`: by locate_queries.
void find_nearest(Context& ctx, const MeshIndex& mesh, const QueryBatch& queries, const Allocation& reached,
                  std::size_t wanted, const Allocation& nearest);

}  // namespace cadt
