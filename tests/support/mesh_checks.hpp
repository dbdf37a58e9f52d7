// SPDX-License-Identifier: Apache-2.0
// Every array of a mesh against what CGAL's set of triangles implies.
#pragma once

#include "tests/support/families.hpp"
#include "tests/support/oracle.hpp"

#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cadt::test {

/// All arrays that a Triangulation in canonical order must have.
struct ExpectedMesh {
  int dimension = -1;
  std::vector<std::int32_t> representative;
  std::vector<std::int32_t> triangles;
  std::vector<std::int32_t> neighbors;
  std::vector<std::int32_t> hull;
  std::vector<std::int32_t> vertex_triangle;
  std::vector<Duplicate> duplicates;
};

/// From CGAL's triangles; where CGAL is not installed, from those of the serial host after verify() accepted them.
[[nodiscard]] ExpectedMesh expected_mesh(const Points& xy);

/// Neighbour of each triangle opposite each of its vertices, -1 at the boundary.
[[nodiscard]] std::vector<std::int32_t> neighbors_of(std::span<const std::int32_t> triangles);

/// Byte for byte: dimension, triangles, neighbours, hull, duplicates, vertex_triangle.
[[nodiscard]] testing::AssertionResult same_mesh(const Triangulation& mesh, const ExpectedMesh& expected);

/// The same for the mesh of the points in another order, point i of which is point order[i] of `expected`: dimension,
/// number of duplicates, set of triangles.
[[nodiscard]] testing::AssertionResult same_but_for_order(const Triangulation& mesh, const ExpectedMesh& expected,
                                                          std::span<const std::size_t> order);

/// The triangles as a canonical set, after index i was replaced by `index[i]` (empty: kept).
[[nodiscard]] std::vector<std::int32_t> canonical_set(std::span<const std::int32_t> triangles,
                                                      std::span<const std::int32_t> index = {});

/// verify() passes, with the counts that the mesh reports.
[[nodiscard]] testing::AssertionResult verified(const Points& xy, const Triangulation& mesh);

/// Triangulates and compares everything; sets up to 5,000 points also in a random order.
[[nodiscard]] testing::AssertionResult triangulates_as_cgal(const Points& xy, const Options& options);

}  // namespace cadt::test
