// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "common/insertion/locked_mesh.hpp"

namespace cadt {

/// Long rows of flips, each of which makes the next edge illegal: what is in conflict with the vertex to which they
/// lead is triangulated at once instead (common/insertion/cavity.dev.h). Nothing else may run on the mesh meanwhile.
class CavityRetriangulation {
 public:
  explicit CavityRetriangulation(const LockedMesh& mesh);

  /// Notes the vertices to which the edges lead that are left: the vertex of a row is there again after more flips.
  void remember(const Allocation& edges, std::uint32_t count);
  /// Triangulates the conflict regions anew of such vertices, as far as they are large_regions, and returns of how
  /// many; 0 where no row is long, or memory is short: then flips do it, one after another. Costs one look at all
  /// records for the question and another for each of the vertices.
  std::size_t retriangulate(const Allocation& edges, std::uint32_t count);

 private:
  struct Region {
    std::uint32_t triangles, vertex;
    auto operator<=>(const Region&) const = default;
  };
  std::vector<std::uint32_t> read_quads(const Allocation& edges, std::uint32_t count);
  std::vector<std::uint32_t> candidates(const std::vector<std::uint32_t>& quads);
  void write_ends(const std::vector<std::uint32_t>& quads);
  std::vector<Region> large_regions(const std::vector<std::uint32_t>& vertices);
  bool retriangulate_region(const Region& region);

  const LockedMesh& mesh_;
  Context& ctx_;
  Launcher& launch_;
  std::uint32_t slots_;
  Allocation ends_;  // a set: of the edges that are left
  std::set<std::uint32_t> remembered_;
};

}  // namespace cadt
