// SPDX-License-Identifier: Apache-2.0
// Families of point sets on which Delaunay codes break, written out as functions so that no data file is needed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace cadt::test {

using Points = std::vector<double>;  ///< x0 y0 x1 y1 ...

struct Family {
  std::string name;
  std::function<Points()> make;
};

/// Groups of families; each is one test per back end.
[[nodiscard]] std::vector<Family> tiny_families();
[[nodiscard]] std::vector<Family> size_families();  ///< every n from 3 to 64, and around work-group sizes
[[nodiscard]] std::vector<Family> grid_families();
[[nodiscard]] std::vector<Family> tilted_families();  ///< lattices at many angles
[[nodiscard]] std::vector<Family> scaled_families();  ///< towards both ends of the exponents, and far from the origin
[[nodiscard]] std::vector<Family> circle_families();
[[nodiscard]] std::vector<Family> line_families();
[[nodiscard]] std::vector<Family> duplicate_families();
[[nodiscard]] std::vector<Family> ulp_families();    ///< coordinates one unit in the last place apart
[[nodiscard]] std::vector<Family> order_families();  ///< one set in many orders
[[nodiscard]] std::vector<Family> curve_families();
[[nodiscard]] std::vector<Family> cluster_families();

struct FamilyGroup {
  std::string_view name;
  std::vector<Family> (*families)();
};
[[nodiscard]] const std::vector<FamilyGroup>& family_groups();

/// splitmix64: equal numbers on every machine.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  double uniform();  ///< [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double normal();
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(bits() % n); }

 private:
  std::uint64_t state_;
};

// Building blocks, also for tests that need one certain set.
[[nodiscard]] Points uniform_points(std::size_t n, std::uint64_t seed = 1);
[[nodiscard]] Points grid_points(int columns, int rows);
[[nodiscard]] Points scaled(Points xy, int exponent);  ///< times 2^exponent
[[nodiscard]] Points moved(Points xy, double dx, double dy);
[[nodiscard]] Points regular_polygon(int n, double cx, double cy, double r);
[[nodiscard]] Points parabola_points(std::size_t n);  ///< all on the hull, in no order
[[nodiscard]] Points hub_points(int n);               ///< a centre and n points around it
[[nodiscard]] Points skewed_points(std::size_t n);    ///< 99.9 % of the points in a cell of 1e-12
[[nodiscard]] Points cluster_points(std::size_t n);   ///< 100 Gaussian clusters of 1e-6
[[nodiscard]] Points two_clusters(std::size_t n);     ///< 1e12 apart, each of size 1
[[nodiscard]] Points axis_cross(int arm);             ///< about n^2 / 8 flips
[[nodiscard]] Points shuffled(const Points& xy, std::uint64_t seed);
/// order[i] is the index in `xy` of point i of the result.
[[nodiscard]] Points reordered(const Points& xy, const std::vector<std::size_t>& order);
[[nodiscard]] std::vector<std::size_t> random_order(std::size_t n, std::uint64_t seed);

}  // namespace cadt::test
