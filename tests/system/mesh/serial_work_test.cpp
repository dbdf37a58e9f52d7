// SPDX-License-Identifier: Apache-2.0
// One thread has no conflicts: after each point all edges that it made illegal are flipped, so the legality sweep has
// nothing to repair, and no try-lock fails. A mistake in what is put on the list of edges is seen only here: with many
// threads, repairs hide it.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"

#include <gtest/gtest.h>

namespace cadt::test {
namespace {

class SerialWork : public BackendTest {
 protected:
  static Statistics run(const Points& xy) {
    Options options = GetParam().options();
    options.tuning.strategy = Strategy::locks;
    const Triangulation mesh = triangulate(std::span<const double>(xy), options);
    const Statistics& s = mesh.statistics();
    EXPECT_EQ(s.sweep_repairs, 0u);
    EXPECT_EQ(s.legality_sweeps, 1u);
    EXPECT_EQ(s.lock_failures, 0u);
    EXPECT_EQ(s.deferred_edges, 0u);
    EXPECT_GT(s.flips, mesh.number_of_points() / 4);
    return s;
  }
};

TEST_P(SerialWork, LeavesNothingToTheLegalitySweep) {
  ASSERT_EQ(GetParam().threads, 1u);
  EXPECT_GT(run(uniform_points(5000)).splits, 4900u);
  EXPECT_GT(run(grid_points(60, 50)).edge_splits, 500u);  // points on edges, with four edges around them
  run(shuffled(grid_points(60, 50), 3));
  run(cluster_points(4000));
  run(hub_points(1500));
}

}  // namespace

std::vector<BackendCase> one_thread() { return {host_cases().front()}; }
CADT_ON(host, SerialWork, one_thread);

}  // namespace cadt::test
