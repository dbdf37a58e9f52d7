// SPDX-License-Identifier: Apache-2.0
// Meshes for the tests, made without the library.
#pragma once

#include <cadt/verify.hpp>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

struct TestMesh {
  std::vector<double> xy;
  std::vector<std::int32_t> triangles, neighbors, hull;
  std::vector<cadt::Duplicate> duplicates;

  /// Neighbours and hull from the triangles, which must be a valid mesh; duplicates from the points.
  void complete();
  [[nodiscard]] cadt::MeshView view() const { return {triangles, neighbors, hull, duplicates, true}; }
  [[nodiscard]] cadt::MeshView bare() const { return {triangles, {}, {}, {}, false}; }
  [[nodiscard]] cadt::PointsView points() const { return std::span<const double>(xy); }
  [[nodiscard]] std::size_t size() const { return triangles.size() / 3; }
};

/// Every triple whose circle is empty after the symbolic perturbation, in GMP: O(n^4), for up to about 60 points.
TestMesh brute_force_delaunay(std::vector<double> xy);
/// Unit lattice, columns x rows, with the diagonals that the perturbation chooses: those that fall to the right.
TestMesh lattice(int columns, int rows, double step = 1);
/// Point 0 in the middle of n points on a circle.
TestMesh hub(int n);
std::vector<double> random_points(int n, std::uint64_t seed);
