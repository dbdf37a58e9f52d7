// SPDX-License-Identifier: Apache-2.0
// What CGAL makes of a point set. Plain types only: CGAL is seen by oracle.cpp and nothing else, and never by the
// library. Where CGAL is not installed, the functions whose names start with cgal_ do not exist (CADT_TEST_CGAL is 0).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt::test {

using Triangle = std::array<std::int32_t, 3>;

/// Representative of each point: the lowest index among the points equal to it (-0.0 equals 0.0).
[[nodiscard]] std::vector<std::int32_t> representatives(std::span<const double> xy);

struct OracleMesh {
  int dimension = -1;                        ///< as Triangulation::dimension()
  std::vector<std::int32_t> representative;  ///< per input point
  std::vector<Triangle> triangles;           ///< counterclockwise, smallest index first, ascending
};

/// Delaunay_triangulation_2 over Exact_predicates_inexact_constructions_kernel of the distinct points.
[[nodiscard]] OracleMesh cgal_delaunay(std::span<const double> xy);

struct InsertionTime {
  std::size_t triangles = 0;
  double seconds = 0.0;
};
/// Inserts the range of points into an empty triangulation, as a user of CGAL would write it. The time is that of
/// `insert`, without the conversion to CGAL's points. For benchmarks.
[[nodiscard]] InsertionTime cgal_insertion(std::span<const double> xy);

struct LocatedFaces {
  std::vector<Triangle> faces;  ///< canonical; -1 for a query that is not strictly inside of a face
  double seconds = 0.0;         ///< of the calls of `locate` alone
};
/// Locates queries that are sorted along CGAL's space filling curve, each from the face of the one before.
[[nodiscard]] LocatedFaces cgal_locate(std::span<const double> xy, std::span<const double> queries);

/// Rotates each triangle to start with its smallest index and sorts them.
void make_canonical(std::vector<Triangle>& triangles);

}  // namespace cadt::test
