// SPDX-License-Identifier: Apache-2.0
// Sets made so that threads conflict, run again and again: conflicts must happen and must not change the mesh.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <thread>
#include <vector>

namespace cadt::test {
namespace {

// Runs in total; CADT_CONFLICT_RUNS makes it shorter under a sanitizer.
int runs() {
  const char* variable = std::getenv("CADT_CONFLICT_RUNS");
  const int value = variable ? std::atoi(variable) : 0;
  return value > 0 ? value : 50;
}

// All points in a tiny cluster, a second one beside it, and a frame: in each level all threads work on few triangles.
Points tiny_cluster(std::size_t n) {
  Points xy = uniform_points(n, 101);
  for (double& value : xy) value = 0.5 + std::ldexp(value, -30);
  xy.insert(xy.end(), {0, 0, 1, 0, 1, 1, 0, 1});
  return xy;
}

Points few_distinct(std::size_t n) {
  constexpr int side = 100;
  Points xy = shuffled(grid_points(side, side), 6);
  Random random(4);
  while (xy.size() < 2 * n) {
    const double x = static_cast<double>(random.below(side)), y = static_cast<double>(random.below(side));
    xy.insert(xy.end(), {x, y});
  }
  return xy;
}

class Conflicts : public BackendTest {
 protected:
  // Large work-groups may leave a processor with a single one, whose work-items run one after the other.
  static bool runs_in_parallel() {
    return std::thread::hardware_concurrency() > 1 && GetParam().threads != 1 && GetParam().work_group_size == 0;
  }

  void repeat(const Points& xy, bool must_conflict) {
    const ExpectedMesh expected = expected_mesh(xy);
    std::uint64_t conflicts = 0;
    Options options = GetParam().options();
    options.tuning.strategy = Strategy::locks;
    options.tuning.grain = 1;  // neighbouring points go to different threads
    // On a busy machine threads may take turns for a while: then more runs are made, but not for ever.
    const bool needs_conflict = must_conflict && runs_in_parallel();
    const auto start = std::chrono::steady_clock::now();
    const auto missing = [&] {
      return needs_conflict && conflicts == 0 && std::chrono::steady_clock::now() - start < std::chrono::seconds(90);
    };
    for (int run = 0; run < runs() || missing(); ++run) {
      const Triangulation mesh = triangulate(std::span<const double>(xy), options);
      ASSERT_TRUE(same_mesh(mesh, expected)) << "run " << run;
      const Statistics& s = mesh.statistics();
      conflicts += s.lock_failures + s.insert_retries + s.deferred_points + s.deferred_edges;
    }
    if (needs_conflict) {
      EXPECT_GT(conflicts, 0u) << "no two threads ever met: the test shows nothing";
    }
    RecordProperty("conflicts", std::to_string(conflicts));
  }
};

TEST_P(Conflicts, TinyCluster) { repeat(tiny_cluster(20000), true); }
TEST_P(Conflicts, Hub) { repeat(hub_points(10000), true); }
TEST_P(Conflicts, ManyEqualPoints) { repeat(few_distinct(20000), true); }
TEST_P(Conflicts, AxisCross) { repeat(axis_cross(60), false); }
CADT_ON_EVERY_BACKEND(Conflicts);

}  // namespace
}  // namespace cadt::test
