// SPDX-License-Identifier: Apache-2.0
// Points that are not spread evenly must not make the work explode. The bound is loose, as tests share the machine;
// cadt-bench compare measures the same with large sets.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <limits>

namespace cadt::test {
namespace {

constexpr std::size_t count = 100000;
constexpr double allowed = 6.0;

class Skewed : public BackendTest {
 protected:
  double seconds(const Points& xy) {
    double best = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 4; ++run) {  // the first one may compile kernels
      const auto start = std::chrono::steady_clock::now();
      const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
      best = std::min(best, taken.count());
      EXPECT_GT(mesh.number_of_triangles(), 0u);
    }
    return best;
  }
  void check(const Points& xy) {
    const double uniform = seconds(uniform_points(count)), skewed = seconds(xy);
    EXPECT_LT(skewed, allowed * uniform) << "uniform took " << uniform << " s, this " << skewed << " s";
    RecordProperty("ratio", std::to_string(skewed / uniform));
    EXPECT_TRUE(triangulates_as_cgal(xy, GetParam().options()));
  }
};

TEST_P(Skewed, AllButOneOfAThousandInOneCell) { check(skewed_points(count)); }
TEST_P(Skewed, GaussianClusters) { check(cluster_points(count)); }
TEST_P(Skewed, TwoClustersFarApart) { check(two_clusters(count)); }
CADT_ON_MAIN_BACKENDS(Skewed);

}  // namespace
}  // namespace cadt::test
