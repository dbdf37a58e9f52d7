// SPDX-License-Identifier: Apache-2.0
// What CGAL makes of points and segments. Plain types only, as in oracle.hpp; without CGAL the functions do not exist.
#pragma once

#include "tests/support/oracle.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt::test {

struct CrossedOracleMesh {
  std::vector<Triangle> triangles;                       ///< canonical (make_canonical)
  std::vector<std::array<std::int32_t, 2>> constrained;  ///< edges, the lower vertex first, ascending
  std::vector<double> added_xy;                          ///< the places of `pairs`, to nearest, ties to even
  std::size_t unknown = 0;                               ///< vertices that are neither points nor places of `pairs`
};

/// Constrained_triangulation_plus_2 of Constrained_Delaunay_triangulation_2 over
/// Exact_predicates_exact_constructions_kernel with Exact_intersections_tag: segments that cross are divided there.
/// Vertices are the lowest indices of points; a vertex that is none is the number of points plus the index of the first
/// of `pairs` whose segments cross there.
[[nodiscard]] CrossedOracleMesh cgal_constrained_plus(std::span<const double> xy,
                                                      std::span<const std::array<std::int32_t, 2>> segments,
                                                      std::span<const std::array<std::int32_t, 2>> pairs);

}  // namespace cadt::test
