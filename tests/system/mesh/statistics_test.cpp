// SPDX-License-Identifier: Apache-2.0
// The counters agree with each other and with the mesh; they can be left out; snapshots show the growing mesh.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"
#include "tests/support/same_math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace cadt::test {
namespace {

using Reals = std::span<const double>;

std::set<std::string> names(const std::vector<std::pair<std::string, double>>& values) {
  std::set<std::string> result;
  for (const auto& [name, value] : values) result.insert(name);
  return result;
}

/// Twice the area of a triangle, positive if it is counterclockwise; good enough for points that are not nearly on a
/// line.
double area(const Points& xy, std::span<const std::int32_t> t) {
  const auto x = [&](int k) { return xy[2 * static_cast<std::size_t>(t[static_cast<std::size_t>(k)])]; };
  const auto y = [&](int k) { return xy[2 * static_cast<std::size_t>(t[static_cast<std::size_t>(k)]) + 1]; };
  return (x(1) - x(0)) * (y(2) - y(0)) - (x(2) - x(0)) * (y(1) - y(0));
}

/// That of insertion.
class CountedWork : public BackendTest {
 protected:
  static Options options() {
    Options options = GetParam().options();
    options.tuning.strategy = Strategy::locks;
    return options;
  }
};

TEST_P(CountedWork, AddsUp) {
  for (const Points& xy : {uniform_points(20000, 3), grid_points(100, 90)}) {
    const Triangulation mesh = triangulate(Reals(xy), options());
    const Statistics& s = mesh.statistics();
    const std::uint64_t n = s.distinct, hull = mesh.hull().size();
    EXPECT_EQ(n, xy.size() / 2);
    EXPECT_EQ(s.splits + s.edge_splits, n - 3);
    EXPECT_EQ(s.certified_edges, 3 * n - 3);
    EXPECT_EQ(std::accumulate(s.flips_per_edge.begin(), s.flips_per_edge.end(), std::uint64_t{0}), 3 * n - 3 - hull);
    EXPECT_GE(s.incircle_tests, s.certified_edges + s.flips);
    EXPECT_GE(s.orientation_tests, s.exact_orientations + s.walk_steps);
    EXPECT_GE(s.exact_incircles, s.ties);
    EXPECT_EQ(s.lock_attempts, s.lock_failures + s.splits + s.edge_splits + s.flips);
    EXPECT_LE(s.invalid_restarts, s.lock_failures);
    EXPECT_TRUE(s.thread_time.empty());
    for (const char* phase : {"sort", "gather", "insert", "certify", "output", "copy"})
      EXPECT_TRUE(names(s.milliseconds).count(phase)) << phase;
  }
}

// Edges that are split away take their flips with them; with one point behind the first triangle none is.
TEST_P(CountedWork, FlipsAreThoseOfTheEdges) {
  const auto counted = [](const Statistics& s) {
    std::uint64_t sum = 0;
    for (std::size_t k = 0; k < s.flips_per_edge.size(); ++k) sum += k * s.flips_per_edge[k];
    return sum;
  };
  std::uint64_t flips = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Triangulation mesh = triangulate(Reals(uniform_points(4, seed)), options());
    ASSERT_EQ(counted(mesh.statistics()), mesh.statistics().flips) << "seed " << seed;
    flips += mesh.statistics().flips;
  }
  EXPECT_GT(flips, 100u);
  const Triangulation mesh = triangulate(Reals(uniform_points(5000, 4)), options());
  EXPECT_LE(counted(mesh.statistics()), mesh.statistics().flips);
  EXPECT_GT(counted(mesh.statistics()), mesh.statistics().flips / 3);
}

TEST_P(CountedWork, NoneCountsNothingAndChangesNothing) {
  const Points xy = uniform_points(20000, 8);
  Options options = CountedWork::options();
  const Hash128 hash = triangulate(Reals(xy), options).hash();
  options.statistics = StatisticsDetail::none;
  const Triangulation mesh = triangulate(Reals(xy), options);
  const Statistics& s = mesh.statistics();
  EXPECT_EQ(mesh.hash(), hash);
  EXPECT_EQ(s.walk_steps + s.lock_attempts + s.flips + s.incircle_tests + s.orientation_tests, 0u);
  EXPECT_EQ(std::accumulate(s.flips_per_edge.begin(), s.flips_per_edge.end(), std::uint64_t{0}), 0u);
  EXPECT_TRUE(s.milliseconds.empty());
  EXPECT_TRUE(s.certified);
  EXPECT_EQ(s.certified_edges, 3 * s.distinct - 3);
  EXPECT_GT(s.launches, 0u);
  EXPECT_GT(s.bytes_device_peak, 0u);
}

TEST_P(CountedWork, TimingTellsShares) {
  const Points xy = uniform_points(30000, 9);
  Options options = CountedWork::options();
  const Hash128 hash = triangulate(Reals(xy), options).hash();
  options.statistics = StatisticsDetail::timing;
  const Triangulation mesh = triangulate(Reals(xy), options);
  const Statistics& s = mesh.statistics();
  EXPECT_EQ(mesh.hash(), hash);
  EXPECT_GT(s.flips, 0u);
  EXPECT_EQ(names(s.thread_time),
            (std::set<std::string>{"locate", "lock", "split", "test", "flip", "neighbors", "other", "wait"}));
  double sum = 0;
  for (const auto& [name, share] : s.thread_time) {
    if (name == "locate" || name == "test" || name == "lock") {
      EXPECT_GT(share, 0.0) << name;
    }
    sum += share;
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

class KernelTimes : public BackendTest {};

TEST_P(KernelTimes, AreThoseOfTheLaunches) {
  const Points xy = uniform_points(20000, 11);
  Options options = GetParam().options();
  options.order = Order::fast;
  for (const Strategy strategy : {Strategy::locks, Strategy::stars}) {
    options.tuning.strategy = strategy;
    options.tuning.kernel_times = false;
    const Triangulation without = triangulate(Reals(xy), options);
    EXPECT_TRUE(without.statistics().kernels.empty());
    options.tuning.kernel_times = true;
    Triangulator triangulator(options);
    for (int run = 0; run < 2; ++run) {
      const Triangulation mesh = triangulator.triangulate(Reals(xy));
      EXPECT_EQ(mesh.hash(), without.hash());
      const Statistics& s = mesh.statistics();
      std::map<std::string, KernelTime> kernels;
      std::uint64_t launches = 0;
      double sum = 0, phases = 0, last = std::numeric_limits<double>::infinity();
      for (const KernelTime& kernel : s.kernels) {
        EXPECT_TRUE(kernels.emplace(kernel.name, kernel).second) << kernel.name;
        EXPECT_GE(kernel.milliseconds, 0) << kernel.name;
        EXPECT_LE(kernel.milliseconds, last) << kernel.name;
        last = kernel.milliseconds;
        if (kernel.name != "sort" && kernel.name != "scan") launches += kernel.launches;
        sum += kernel.milliseconds;
      }
      EXPECT_EQ(launches, s.launches);
      if (strategy == Strategy::locks) {
        EXPECT_GT(kernels["cadt_insert"].milliseconds, 0);
      }
      EXPECT_EQ(kernels["cadt_prove_stars"].launches, strategy == Strategy::stars ? 1U : 0U);
      EXPECT_EQ(kernels["cadt_insert"].launches == 0, strategy == Strategy::stars);
      EXPECT_EQ(kernels["cadt_drop_locks"].launches, strategy == Strategy::stars ? 0U : 1U);
      EXPECT_EQ(kernels["cadt_write_triangles"].launches, strategy == Strategy::stars ? 1U : 0U);
      // The keys are sorted by the device's own sort or by that of common/device.
      EXPECT_NE(kernels.count("sort"), kernels.count("cadt_radix_scatter"));
      for (const auto& [name, milliseconds] : s.milliseconds) phases += milliseconds;
      EXPECT_LE(sum, phases);
    }
  }
}

// What a cancelled run has launched is no part of the next one.
TEST_P(KernelTimes, BeginAnewAfterACancelledRun) {
  const Points xy = uniform_points(20000, 12);
  Options options = GetParam().options();
  options.tuning.kernel_times = true;
  options.tuning.strategy = Strategy::locks;  // the others may have no phase of insertion
  Triangulator triangulator(options);
  cadt::stop_source source;
  triangulator.options().stop = source.get_token();
  triangulator.options().progress = [&](const Progress& progress) {
    if (progress.phase == "insert") source.request_stop();
  };
  EXPECT_THROW(static_cast<void>(triangulator.triangulate(Reals(xy))), Cancelled);
  triangulator.options().stop = {};
  triangulator.options().progress = nullptr;
  const Statistics s = triangulator.triangulate(Reals(xy)).statistics();
  std::uint64_t launches = 0;
  for (const KernelTime& kernel : s.kernels)
    if (kernel.name != "sort" && kernel.name != "scan") launches += kernel.launches;
  EXPECT_EQ(launches, s.launches);
}

using Triangle = std::array<std::int32_t, 3>;

std::set<Triangle> triangles_of(std::span<const std::int32_t> indices) {
  std::set<Triangle> result;
  for (std::size_t t = 0; t < indices.size(); t += 3) {
    Triangle v{indices[t], indices[t + 1], indices[t + 2]};
    std::rotate(v.begin(), std::ranges::min_element(v), v.end());
    result.insert(v);
  }
  return result;
}

std::uint64_t sum(std::span<const std::uint32_t> counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

class Snapshots : public BackendTest {};

TEST_P(Snapshots, ShowTheGrowingMesh) {
  const Points xy = uniform_points(2048, 10);
  Options options = GetParam().options();
  std::vector<std::size_t> points, triangles;
  std::set<Triangle> last;
  options.tuning.watch = [&](const Snapshot& snapshot) {
    points.push_back(snapshot.points);
    triangles.push_back(snapshot.triangles.size() / 3);
    last = triangles_of(snapshot.triangles);
    ASSERT_EQ(snapshot.triangles.size() % 3, 0u);
    std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
    for (std::size_t t = 0; t < snapshot.triangles.size(); t += 3) {
      EXPECT_GT(area(xy, snapshot.triangles.subspan(t, 3)), 0.0) << "not the indices of the input";
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int32_t a = snapshot.triangles[t + k], b = snapshot.triangles[t + (k + 1) % 3];
        ASSERT_GE(a, 0);
        ASSERT_LT(a, 2048);
        ASSERT_EQ(++edges[std::make_pair(a, b)], 1) << "an edge has two triangles on one side";
      }
    }
  };
  const Triangulation mesh = triangulate(Reals(xy), options);
  ASSERT_GT(points.size(), 4u);
  EXPECT_TRUE(std::ranges::is_sorted(points));
  EXPECT_GE(points.front(), 3u);
  EXPECT_EQ(points.back(), 2048u);
  EXPECT_EQ(triangles.back(), mesh.number_of_triangles());
  EXPECT_EQ(last, triangles_of(mesh.triangles()));
  EXPECT_TRUE(verified(xy, mesh));
}

TEST_P(Snapshots, CountAsTheyGo) {
  const Points xy = uniform_points(5000, 12);
  Options options = GetParam().options();
  Statistics before;
  unsigned level = 0;
  std::size_t seen = 0, complete = 0;
  options.tuning.watch = [&](const Snapshot& snapshot) {
    const Statistics& s = snapshot.statistics;
    ++seen;
    EXPECT_EQ(complete, 0u) << "a snapshot after the last";
    complete += snapshot.complete ? 1 : 0;
    EXPECT_GE(snapshot.level, std::max(1u, level));
    EXPECT_GE(s.flips, before.flips);
    EXPECT_GE(s.lock_attempts, before.lock_attempts);
    EXPECT_GE(s.lock_failures, before.lock_failures);
    EXPECT_GE(s.deferred_points, before.deferred_points);
    EXPECT_EQ(s.splits + s.edge_splits + 3, snapshot.points) << "counters of another moment";
    EXPECT_EQ(s.lock_attempts, s.lock_failures + s.splits + s.edge_splits + s.flips);
    EXPECT_EQ(s.certified, snapshot.complete);
    EXPECT_LE(snapshot.points + snapshot.waiting_points, 5000u);
    if (snapshot.complete) {
      EXPECT_EQ(snapshot.waiting_points + snapshot.waiting_edges, 0u);
    }
    ASSERT_EQ(snapshot.flips.size(), snapshot.triangles.size() / 3);
    ASSERT_EQ(snapshot.changes.size(), snapshot.triangles.size() / 3);
    EXPECT_TRUE(snapshot.lost_locks.empty());
    // A flip changes four triangles and adds one to the counter of an edge, which two triangles share.
    EXPECT_LE(sum(snapshot.flips), 2 * s.flips);
    EXPECT_LE(sum(snapshot.changes), 4 * (s.flips + s.edge_splits) + 3 * s.splits);
    if (snapshot.complete) {
      EXPECT_GT(sum(snapshot.flips), s.flips / 2);
      EXPECT_GT(sum(snapshot.changes), 3 * s.flips);
    }
    before = s;
    level = snapshot.level;
  };
  const Triangulation mesh = triangulate(Reals(xy), options);
  EXPECT_EQ(complete, 1u);
  EXPECT_EQ(level, 13u);  // 2^13 is the first power of two above 5000
  EXPECT_EQ(before.flips, mesh.statistics().flips);
  EXPECT_EQ(before.lock_failures, mesh.statistics().lock_failures);

  const std::size_t levels_alone = seen;
  seen = complete = 0;
  level = 0;
  before = {};
  options.tuning.watch_points = 100;
  const Hash128 hash = triangulate(Reals(xy), options).hash();
  EXPECT_EQ(hash, mesh.hash());
  EXPECT_GE(seen, levels_alone + 5000 / 100 - 10);
}

TEST_P(Snapshots, TellWhereLocksAreLost) {
  // All triangles meet at one point.
  Points xy{0.0, 0.0};
  for (int i = 0; i < 6000; ++i) {
    const double angle = 6.283185307179586 * i / 6000;
    xy.insert(xy.end(), {same_cos(angle), same_sin(angle)});
  }
  Options options = GetParam().options();
  options.statistics = StatisticsDetail::timing;
  options.tuning.strategy = Strategy::locks;
  options.tuning.grain = 1;
  std::uint64_t lost = 0;
  options.tuning.watch = [&](const Snapshot& snapshot) {
    ASSERT_EQ(snapshot.lost_locks.size(), snapshot.triangles.size() / 3);
    EXPECT_LE(sum(snapshot.lost_locks), snapshot.statistics.lock_failures);
    if (snapshot.complete) lost += sum(snapshot.lost_locks);
  };
  EXPECT_TRUE(triangulate(Reals(xy), options).statistics().certified);  // PoCL compiles kernels
  // On a busy machine threads hardly ever meet.
  const auto start = std::chrono::steady_clock::now();
  while (lost == 0 && std::chrono::steady_clock::now() - start < std::chrono::seconds(40))
    EXPECT_TRUE(triangulate(Reals(xy), options).statistics().certified);
  EXPECT_GT(lost, 0u);
}

CADT_ON_MAIN_BACKENDS(CountedWork);
CADT_ON_MAIN_BACKENDS(KernelTimes);
CADT_ON_MAIN_BACKENDS(Snapshots);

TEST(CountDiffering, CountsTrianglesOfOneMeshOnly) {
  Options options;
  options.backend = Backend::host;
  const Points xy = uniform_points(1000, 11);
  const Triangulation mesh = triangulate(Reals(xy), options);
  options.order = Order::fast;
  EXPECT_EQ(count_differing(mesh, triangulate(Reals(xy), options)), 0u);
  const Points less(xy.begin(), xy.end() - 2);
  const Triangulation other = triangulate(Reals(less), options);
  const std::size_t differing = count_differing(mesh, other);
  EXPECT_GT(differing, 2u);  // the star of the last point
  EXPECT_LT(differing, 20u);
  EXPECT_EQ(count_differing(mesh, Triangulation()), mesh.number_of_triangles());
}

}  // namespace
}  // namespace cadt::test
