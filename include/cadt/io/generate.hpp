// SPDX-License-Identifier: Apache-2.0
// Point sets for tests, benchmarks and first steps. Equal arguments give equal points on every machine whose C library
// computes the same sin, cos, exp and log.
#pragma once

#include <cadt/io/points_file.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::io {

struct GenerateOptions {
  std::size_t n = 10000;  ///< number of points; sets made of groups may round it, see the description
  std::uint64_t seed = 1;
  int k = 8;              ///< circles: points on each circle (paper, Eq. 7, 8)
  double radius = 0.35;   ///< circles: in cells of the grid of centres
  double epsilon = 1e-4;  ///< circles: largest offset of a coordinate, in cells
  /// The first point to be made: points first, ..., n - 1 of the set, for sets with `by_range` alone.
  std::size_t first = 0;
};

struct Distribution {
  std::string_view name;
  std::string_view description;
  bool by_range = false;  ///< each point is made by itself, so a part costs what it has (GenerateOptions::first)
};

/// All names that `generate` accepts, each with a one-line description.
[[nodiscard]] const std::vector<Distribution>& distributions();

/// Points of the named distribution, e.g. "uniform"; `terrain` has heights. O(n). \throws std::invalid_argument for an
/// unknown name, or for GenerateOptions::first in a set that is not made by range
[[nodiscard]] PointSet generate(std::string_view distribution, const GenerateOptions& options = {});

}  // namespace cadt::io
