// SPDX-License-Identifier: Apache-2.0
// Which triangles of a constrained mesh are inside (Domain), and which region each is in.
#pragma once

#include <cadt/constrained.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "common/driver/context.hpp"

namespace cadt {

/// CADT_DOMAIN_MESH_PARAMETERS, and the number of triangles. A finished mesh: vertices are points, triangles stand
/// across, CADT_NONE outside of the hull.
struct DomainMesh {
  const Allocation &vertices, &neighbors, &edge_flags;
  std::size_t triangles;
  [[nodiscard]] auto arguments() const { return std::tie(vertices, neighbors, edge_flags); }
};

/// The vertices along segment s of `count` are those from offsets[s] to offsets[s + 1] - 1; words.
struct DeviceChains {
  const Allocation &offsets, &vertices;
  std::size_t count, length;  ///< length: of the vertices
};
/// The same as ConstrainedTriangulation has them.
struct SegmentChains {
  std::span<const std::int64_t> offsets;
  std::span<const std::int32_t> vertices;
};

/// The triangles of ConstraintOptions::holes and regions, -1 outside of the hull.
struct DomainSeeds {
  std::vector<std::int32_t> holes, regions;
};
/// Of what added vertices of a mesh are the crossings; without pairs they are where their coordinates say.
struct AddedPlaces {
  std::span<const double> xy;  ///< rounded, x0 y0 x1 y1 ...
  std::span<const Segment> segments, pairs;
};
/// Exact. A seed on an edge or a vertex is in the lowest triangle there. Vertices from points.size() on are those of
/// `added`. O((triangles + seeds) log seeds) expected. Nothing to do but with Domain::seeds. \throws OptionError for a
/// seed that is not finite, Cancelled
[[nodiscard]] DomainSeeds locate_seeds(std::span<const std::int32_t> triangles, const PointsView& points,
                                       const AddedPlaces& added, const ConstraintOptions& options,
                                       const stop_token& stop = {});

/// Regions are numbered by their lowest triangles, from 0.
struct Domains {
  Allocation region;                  ///< of each triangle; null without triangles
  std::vector<std::int32_t> value;    ///< ConstrainedTriangulation::region_value
  std::vector<std::uint32_t> inside;  ///< 1 or 0 a region
  std::vector<double> attribute;
};
/// `points`: more than any vertex. O(triangles + edges + points), the graph of the regions on the host. Without
/// triangles there are no regions, and no errors. \throws DomainError with the lowest vertex at which the segments do
/// not close
[[nodiscard]] Domains find_domains(Context& ctx, const DomainMesh& mesh, std::size_t points, const DeviceChains& chains,
                                   const DomainSeeds& seeds, const ConstraintOptions& options);

/// Triangles inside, in the order of the mesh; a neighbour that is not inside is CADT_NONE.
struct InsideMesh {
  Allocation inside;                           ///< a word a triangle of the mesh, 1 or 0, and one more
  Allocation vertices, neighbors, edge_flags;  ///< null if there are none
  std::size_t triangles = 0;
};
[[nodiscard]] InsideMesh pack_inside(Context& ctx, const DomainMesh& mesh, const Domains& domains);

/// The same of a mesh in memory of the host.
struct HostDomains {
  std::vector<std::int32_t> region, region_value;
  std::vector<std::uint8_t> inside;
  std::size_t number_inside = 0;
  std::vector<double> region_attribute;
};
struct HostDomainMesh {
  std::span<const std::int32_t> triangles, neighbors;
  std::span<const std::uint32_t> edge_flags;
  PointsView points;
  AddedPlaces added;
};
[[nodiscard]] HostDomains find_domains(Context& ctx, const HostDomainMesh& mesh, const SegmentChains& chains,
                                       const ConstraintOptions& options);

}  // namespace cadt
