// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>

#include "common/insertion/locked_mesh.hpp"

namespace cadt {

/// Ends long flip cascades, in which each flip makes the next edge illegal: retriangulates the conflict region of the
/// vertex to which they lead (common/insertion/cavity.dev.h). No other kernel may run on the mesh meanwhile.
class CavityRetriangulation {
 public:
  explicit CavityRetriangulation(const LockedMesh& mesh) : mesh_(mesh) {}

  /// Remembers the vertices opposite the deferred edges: the vertex of a cascade is among them again after more flips.
  void remember(const Allocation& edges, std::uint32_t count);
  /// Retriangulates the large conflict regions of remembered vertices and returns of how many; 0 where there is no long
  /// cascade, or memory is short: then flips do it, one after another. Reads all triangles once for the sizes and once
  /// more for each of the vertices.
  std::size_t retriangulate(const Allocation& edges, std::uint32_t count);

 private:
  const LockedMesh& mesh_;
  Allocation ends_;  // a set of vertices: the ends of the deferred edges
  std::set<std::uint32_t> remembered_;
};

}  // namespace cadt
