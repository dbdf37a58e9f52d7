// SPDX-License-Identifier: Apache-2.0
// Schedule noise, delays and failures, at every step of the lock protocol (common/overlay/schedule_noise.dev.h): no
// schedule changes the mesh, and the counters agree with each other.
#include "tests/robustness/concurrency/perturbed_table.hpp"
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace cadt::test {
namespace {

// The modes of common/overlay/schedule_noise.dev.h.
enum class Noise : unsigned { off, uniform, slow_items, slow_holders, failures, all };

// CADT_PERTURBED_SEEDS: seeds for each set and mode.
unsigned seeds() {
  const char* variable = std::getenv("CADT_PERTURBED_SEEDS");
  const int value = variable != nullptr ? std::atoi(variable) : 0;
  return value > 0 ? static_cast<unsigned>(value) : 4;
}

std::vector<BackendCase> perturbed_host_cases() {
  return {{"threads2", Backend::host, 2, 0}, {"threads3", Backend::host, 3, 0}, {"threads16", Backend::host, 16, 0}};
}

std::vector<BackendCase> perturbed_opencl_cases() {
  std::vector<BackendCase> cases;
  for (const unsigned size : {1U, 8U, 64U, 256U})
    cases.push_back({"groups" + std::to_string(size), Backend::opencl, 0, size});
  return cases;
}

std::vector<BackendCase> perturbed_cuda_cases() {
  std::vector<BackendCase> cases;
  if (cuda_cases().empty()) return cases;
  for (const unsigned size : {32U, 64U, 256U})
    cases.push_back({"blocks" + std::to_string(size), Backend::cuda, 0, size});
  return cases;
}

Points few_distinct(std::size_t n, int side) {
  Random random(4);
  Points xy;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = static_cast<double>(random.below(static_cast<std::size_t>(side)));
    const double y = static_cast<double>(random.below(static_cast<std::size_t>(side)));
    xy.insert(xy.end(), {x, y});
  }
  return xy;
}

std::uint64_t count_of(Site site) { return site_counts[index_of(site)].load(); }

void clear_counts() {
  for (auto& count : site_counts) count = 0;
  last_locked = {};
}

class Perturbed : public BackendTest {
 protected:
  void triangulate_with(Noise mode, const Points& xy, const ExpectedMesh& expected, unsigned seed, unsigned grain) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + std::to_string(xy.size() / 2) + " points");
    Options options = GetParam().options();
    options.tuning.strategy = Strategy::locks;
    options.tuning.grain = grain;
    options.tuning.quality_epsilon = 8.0 * seed + static_cast<unsigned>(mode);
    const bool host = GetParam().backend == Backend::host;
    if (host) clear_counts();
    const Triangulation mesh = triangulate(std::span<const double>(xy), options);
    ASSERT_TRUE(same_mesh(mesh, expected));
    ASSERT_TRUE(verified(xy, mesh));
    const Statistics& s = mesh.statistics();
    EXPECT_EQ(s.points, s.distinct + mesh.duplicates().size());
    EXPECT_EQ(s.splits + s.edge_splits + 3, s.distinct) << "three points are there from the start";
    EXPECT_EQ(mesh.number_of_triangles() + mesh.hull().size(), 2 * s.distinct - 2);
    EXPECT_EQ(s.lock_attempts, s.lock_failures + s.splits + s.edge_splits + s.flips);
    EXPECT_TRUE(s.certified);
    EXPECT_EQ(s.certified_edges, 3 * s.distinct - 3)
        << "the legality sweep counts edges between triangles that are free";
    lost_ += s.lock_failures;
    retries_ += s.insert_retries;
    deferred_ += s.deferred_points + s.deferred_edges;
    if (!host) return;
    EXPECT_GT(count_of(Site::claimed), 0U);
    EXPECT_EQ(count_of(Site::claimed), count_of(Site::released) + count_of(Site::abandoned));
    EXPECT_EQ(last_locked.live, 2 * s.distinct - 2);
    EXPECT_EQ(last_locked.held, 0U);
  }

  void run(Noise mode) {
    const Points sets[] = {uniform_points(1200, 5), shuffled(grid_points(30, 30), 6), hub_points(500),
                           few_distinct(1500, 25), axis_cross(40)};
    for (const Points& xy : sets) {
      const ExpectedMesh expected = expected_mesh(xy);
      for (unsigned seed = 1; seed <= seeds(); ++seed) {
        triangulate_with(mode, xy, expected, seed, 1);
        if (HasFatalFailure()) return;
      }
    }
    RecordProperty("lock_failures", std::to_string(lost_));
    RecordProperty("insert_retries", std::to_string(retries_));
    RecordProperty("deferred", std::to_string(deferred_));
  }

  std::uint64_t lost_ = 0, retries_ = 0, deferred_ = 0;
};

TEST_P(Perturbed, RandomDelays) { run(Noise::uniform); }
TEST_P(Perturbed, SlowItems) { run(Noise::slow_items); }
TEST_P(Perturbed, SlowHolders) { run(Noise::slow_holders); }
TEST_P(Perturbed, FailingTryLocks) {
  run(Noise::failures);
  EXPECT_GT(lost_, 0U);
  EXPECT_GT(retries_, 0U);
  EXPECT_GT(deferred_, 0U);
}
TEST_P(Perturbed, AllAtOnce) {
  run(Noise::all);
  EXPECT_GT(lost_, 0U);
}
CADT_ON(host, Perturbed, perturbed_host_cases);
CADT_ON(opencl, Perturbed, perturbed_opencl_cases);
CADT_ON(cuda, Perturbed, perturbed_cuda_cases);

// One set again and again, in each mode in turn, each time with other delays. CADT_PERTURBED_REPEATS: how often.
class PerturbedRepeats : public Perturbed {};

TEST_P(PerturbedRepeats, TwentyThousandPoints) {
  const char* variable = std::getenv("CADT_PERTURBED_REPEATS");
  const int repeats = variable != nullptr ? std::atoi(variable) : 5;
  ASSERT_GT(repeats, 0);
  const Points xy = uniform_points(20000, 20);
  Options serial;
  serial.backend = Backend::host;
  serial.threads = 1;
  Triangulator reference(serial);
  const Triangulation first = reference.triangulate(std::span<const double>(xy));
  ASSERT_TRUE(verified(xy, first));
  Options options = GetParam().options();
  options.tuning.strategy = Strategy::locks;
  options.tuning.grain = 1;
  Triangulator triangulator(options);
  for (unsigned repeat = 0; repeat < static_cast<unsigned>(repeats); ++repeat) {
    const unsigned mode = 1 + repeat % static_cast<unsigned>(Noise::all);
    triangulator.options().tuning.quality_epsilon = 8.0 * (repeat + 1) + mode;
    const Triangulation mesh = triangulator.triangulate(std::span<const double>(xy));
    ASSERT_EQ(mesh.hash(), first.hash()) << "repeat " << repeat << ", mode " << mode;
    const Statistics& s = mesh.statistics();
    ASSERT_TRUE(s.certified);
    ASSERT_EQ(s.lock_attempts, s.lock_failures + s.splits + s.edge_splits + s.flips) << "repeat " << repeat;
    lost_ += s.lock_failures;
  }
  EXPECT_GT(lost_, 0U);
  RecordProperty("lock_failures", std::to_string(lost_));
}
std::vector<BackendCase> repeated_opencl_case() { return {{"groups64", Backend::opencl, 0, 64}}; }
std::vector<BackendCase> repeated_cuda_case() {
  return cuda_cases().empty() ? std::vector<BackendCase>{}
                              : std::vector<BackendCase>{{"blocks64", Backend::cuda, 0, 64}};
}
CADT_ON(host, PerturbedRepeats, main_host_case);
CADT_ON(opencl, PerturbedRepeats, repeated_opencl_case);
CADT_ON(cuda, PerturbedRepeats, repeated_cuda_case);

// Within a partition the owner takes no locks; at its border it does.
class PerturbedPartitions : public Perturbed {};

TEST_P(PerturbedPartitions, EverySiteIsPassed) {
  const Points large = uniform_points(70000, 9), small = few_distinct(1500, 25);
  std::vector<std::uint64_t> passed(number_of_sites());
  const auto add = [&] {
    for (std::size_t site = 0; site < passed.size(); ++site) passed[site] += site_counts[site];
  };
  triangulate_with(Noise::uniform, large, expected_mesh(large), 1, 0);
  add();
  triangulate_with(Noise::failures, small, expected_mesh(small), 1, 1);
  add();
  EXPECT_GE(passed.size(), 12U);
  for (std::size_t site = 0; site < passed.size(); ++site) EXPECT_GT(passed[site], 0U) << "site " << site;
}
CADT_ON(host, PerturbedPartitions, main_host_case);

}  // namespace
}  // namespace cadt::test
