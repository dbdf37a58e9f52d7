// SPDX-License-Identifier: Apache-2.0
// Answers by looking at every triangle and every vertex, with integers of any length. Nothing here is shared with the
// device text.
#pragma once

#include <cadt/cadt.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/families.hpp"

namespace cadt::test {

/// A set of points, its mesh, and queries that are hard for it: its own points, middles of edges, centroids and
/// circumcentres, points near the hull on both sides, far away, and anywhere.
struct Asked {
  Asked(std::string n, Points p);
  std::string name;
  Points xy;
  Triangulation mesh;
  Points queries;
  [[nodiscard]] std::size_t size() const { return queries.size() / 2; }
};

/// Sets of up to `most` points from every group of hostile families, and lattices. Each is made once a process.
void for_each_set(std::size_t most, const std::function<void(const Asked&)>& test);

/// The lowest triangle that contains (x, y); -1 if none does.
[[nodiscard]] std::int32_t containing(const Asked& set, double x, double y);
/// Vertices by distance from (x, y), equally near ones by index; at most `count`.
[[nodiscard]] std::vector<std::int32_t> nearest(const Asked& set, double x, double y, std::size_t count);
/// Sign of |a - p|^2 - |b - p|^2 for points a and b of the set.
[[nodiscard]] int compare_distances(const Asked& set, double x, double y, std::int32_t a, std::int32_t b);

/// The queries that are not far away.
[[nodiscard]] Points near_queries(const Asked& set);
/// Whether all coordinates of the set and of its near queries lie within 240 binades.
[[nodiscard]] bool narrow(const Asked& set);

/// Centres of the cells, row by row.
inline Points centers(const Grid& grid) {
  Points result;
  for (std::size_t j = 0; j < grid.rows; ++j)
    for (std::size_t i = 0; i < grid.columns; ++i) {
      result.push_back(grid.x0 + (static_cast<double>(grid.first_column + i) + 0.5) * grid.dx);
      result.push_back(grid.y0 + (static_cast<double>(grid.first_row + j) + 0.5) * grid.dy);
    }
  return result;
}

}  // namespace cadt::test
