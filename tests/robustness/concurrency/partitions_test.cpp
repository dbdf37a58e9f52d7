// SPDX-License-Identifier: Apache-2.0
// Sets so large that CPUs insert most points in partitions without locks (common/insertion/partitioned.dev.h): ordinary
// ones, ties everywhere, and sets with hardly a triangle within one partition.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace cadt::test {
namespace {

constexpr std::size_t enough = 80000;  // one thread, and OpenCL, begin at 65,536 points, several threads at 16,384

class Partitions : public BackendTest {
 protected:
  static Statistics check(const Points& xy) {
    Options options = GetParam().options();
    options.tuning.strategy = Strategy::locks;
    const Triangulation mesh = triangulate(std::span<const double>(xy), options);
    EXPECT_TRUE(same_mesh(mesh, expected_mesh(xy)));
    EXPECT_TRUE(mesh.statistics().certified);
    return mesh.statistics();
  }
};

TEST_P(Partitions, Uniform) {
  const Statistics s = check(uniform_points(enough, 21));
  EXPECT_EQ(s.splits + s.edge_splits, s.distinct - 3);
  EXPECT_EQ(s.lock_attempts, s.lock_failures + s.splits + s.edge_splits + s.flips);
}
// With one, two and more points in the last block, and with the least set.
TEST_P(Partitions, Sizes) {
  for (const std::size_t n :
       {std::size_t{65536}, std::size_t{65537}, std::size_t{65569}, enough - 1, std::size_t{16384}, std::size_t{16385}})
    check(uniform_points(n, n));
}
TEST_P(Partitions, Lattice) { check(shuffled(grid_points(300, 290), 5)); }
TEST_P(Partitions, Clusters) { check(cluster_points(enough)); }
TEST_P(Partitions, Skewed) { check(skewed_points(enough)); }
TEST_P(Partitions, TwoClusters) { check(two_clusters(enough)); }
TEST_P(Partitions, AllOnTheHull) {
  const Statistics s = check(parabola_points(enough));
  if (GetParam().backend == Backend::host && GetParam().threads > 1) {
    EXPECT_GT(s.deferred_points, enough / 2);
  }
}
TEST_P(Partitions, Hub) { check(hub_points(static_cast<int>(enough))); }
TEST_P(Partitions, WideExponents) {
  Points xy = uniform_points(enough, 3);
  xy[0] = std::ldexp(1.0, -400);
  check(xy);
}
CADT_ON_EVERY_BACKEND(Partitions);

}  // namespace
}  // namespace cadt::test
