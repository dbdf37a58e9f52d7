// SPDX-License-Identifier: Apache-2.0
// CGAL's constrained Delaunay triangulation, behind plain types as oracle.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tests/support/oracle.hpp"

namespace cadt::test {

struct ConstrainedOracleMesh {
  OracleMesh mesh;
  std::vector<std::array<std::int32_t, 2>> edges;  ///< constrained ones, the lower vertex first, ascending
  double seconds = 0;                              ///< of the insertion of points and segments
};

/// Constrained_Delaunay_triangulation_2 over Exact_predicates_inexact_constructions_kernel. Segments must not cross;
/// those of no length are left out.
[[nodiscard]] ConstrainedOracleMesh cgal_constrained(std::span<const double> xy,
                                                     std::span<const std::array<std::int32_t, 2>> segments);

}  // namespace cadt::test
