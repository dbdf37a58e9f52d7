// SPDX-License-Identifier: Apache-2.0
// Calls of the star stage with every option: sizes of groups, stop, a bound on memory, statistics, what it refuses.
#include "tests/system/stars/stars.hpp"

#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace cadt::test {
namespace {

TEST_P(Stars, GroupsOfEverySize) {
  if (GetParam().backend == Backend::host) GTEST_SKIP() << "the host has no groups";
  const Points xy = uniform_points(12000, 51), lattice = grid_points(60, 50);
  const Triangulation expected = with_locks(Reals(xy)), expected_lattice = with_locks(Reals(lattice));
  std::set<std::uint64_t> proven;
  // Where lanes work independently the size hardly matters, and kernels are compiled for each size.
  const std::string name = stars().triangulate(Reals(lattice)).statistics().device;
  const bool gpu = std::ranges::any_of(list_devices(), [&](const DeviceInfo& device) {
    return device.backend == GetParam().backend && device.gpu && device.name == name;
  });
  for (const unsigned size : gpu ? std::vector{32u, 64u, 128u, 256u} : std::vector{64u}) {
    SCOPED_TRACE(size);
    Options options = GetParam().options();
    options.tuning.strategy = Strategy::stars;
    options.tuning.work_group_size = size;
    const Triangulation mesh = triangulate(Reals(xy), options);
    EXPECT_TRUE(same_arrays(mesh, expected));
    EXPECT_TRUE(same_arrays(triangulate(Reals(lattice), options), expected_lattice));
    proven.insert(mesh.statistics().proven_stars);
  }
  EXPECT_EQ(proven.size(), 1u) << "what is proven depends on the group";
  EXPECT_GT(*proven.begin(), 10000u);
}

TEST_P(Stars, Stop) {
  const Points xy = uniform_points(9000, 52);
  const Triangulation expected = with_locks(Reals(xy));
  int reports = 0;
  double last = 0;
  stars().options().progress = [&](const Progress& progress) {
    ++reports;
    EXPECT_GE(progress.fraction, last);
    last = progress.fraction;
  };
  EXPECT_TRUE(same_arrays(stars().triangulate(Reals(xy)), expected));
  EXPECT_EQ(last, 1);
  const int all = reports;
  EXPECT_GT(all, 5);
  for (int stop_at = 0; stop_at <= all; ++stop_at) {
    cadt::stop_source source;
    stars().options().stop = source.get_token();
    reports = 0;
    stars().options().progress = [&](const Progress&) {
      if (++reports == stop_at) source.request_stop();
    };
    if (stop_at == 0) source.request_stop();
    EXPECT_THROW((void)stars().triangulate(Reals(xy)), Cancelled) << "at report " << stop_at << " of " << all;
  }
  stars().options().stop = {};
  stars().options().progress = nullptr;
  EXPECT_TRUE(same_arrays(stars().triangulate(Reals(xy)), expected)) << "after calls that were stopped";
}

/// Every bound holds: the call runs below it or throws OutOfMemory.
TEST_P(Stars, MaxMemoryIsABound) {
  const Points xy = uniform_points(20000, 53);
  Options options = GetParam().options();
  options.tuning.strategy = Strategy::stars;
  const Triangulation unbounded = triangulate(Reals(xy), options);
  const auto peak = static_cast<double>(unbounded.statistics().bytes_device_peak);
  int refused = 0, ran = 0;
  for (const double share : {0.02, 0.25, 0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.5}) {
    options.max_memory = static_cast<std::size_t>(share * peak);
    try {
      const Triangulation mesh = triangulate(Reals(xy), options);
      EXPECT_EQ(mesh.hash(), unbounded.hash());
      EXPECT_LE(mesh.statistics().bytes_device_peak, options.max_memory);
      ++ran;
    } catch (const OutOfMemory& error) {
      EXPECT_GT(error.needed(), 0u);
      EXPECT_LE(error.available(), options.max_memory);
      ++refused;
    }
  }
  EXPECT_GT(refused, 1);
  EXPECT_GT(ran, 0);
}

TEST_P(Stars, EveryDetailOfStatistics) {
  const Points xy = uniform_points(9000, 54);
  const Triangulation expected = with_locks(Reals(xy));
  const std::uint64_t n = xy.size() / 2;
  for (const StatisticsDetail detail : {StatisticsDetail::none, StatisticsDetail::counters, StatisticsDetail::timing}) {
    SCOPED_TRACE(to_string(detail));
    stars().options().statistics = detail;
    const Triangulation mesh = stars().triangulate(Reals(xy));
    const Statistics& s = mesh.statistics();
    EXPECT_TRUE(same_arrays(mesh, expected));
    EXPECT_GT(s.proven_stars, n / 2);
    EXPECT_GT(s.tiles, 10u);
    std::set<std::string> accounts;
    double shares = 0;
    for (const auto& [name, share] : s.thread_time) {
      EXPECT_TRUE(accounts.insert(name).second) << name << " twice";
      shares += share;
    }
    if (!accounts.empty()) {
      EXPECT_NEAR(shares, 1, 1e-9);
    }
    std::uint64_t edges = 0;
    for (const std::uint64_t count : s.flips_per_edge) edges += count;
    if (detail == StatisticsDetail::none) {
      EXPECT_TRUE(s.milliseconds.empty());
      EXPECT_EQ(s.lock_attempts + s.flips + s.incircle_tests + edges, 0u);
      continue;
    }
    EXPECT_EQ(edges, 0u);  // only meshes of insertion alone are counted
    EXPECT_LT(s.splits + s.edge_splits, n - s.proven_stars);
    EXPECT_EQ(s.lock_attempts, s.lock_failures + s.splits + s.edge_splits + s.flips);
    std::set<std::string> phases;
    for (const auto& [name, ms] : s.milliseconds) phases.insert(name);
    for (const char* phase : {"sort", "tiles", "stars", "assemble", "stitch", "certify"})
      EXPECT_TRUE(phases.contains(phase)) << phase;
  }
}

std::string refused_option(const Points& xy, const Options& options) {
  try {
    (void)triangulate(Reals(xy), options);
  } catch (const OptionError& error) {
    return error.option();
  }
  return "none";
}

TEST_P(Stars, RefusesWhatShowsInsertion) {
  const Points xy = uniform_points(50);
  for (const Strategy strategy : {Strategy::automatic, Strategy::locks, Strategy::stars}) {
    const std::string expected = strategy == Strategy::stars ? "tuning.strategy" : "none";
    Options options = GetParam().options();
    options.tuning.strategy = strategy;
    EXPECT_EQ(refused_option(xy, options), "none");
    for (const Stabilize mode : {Stabilize::defer, Stabilize::paper}) {
      options.tuning.stabilize = mode;
      EXPECT_EQ(refused_option(xy, options), expected) << to_string(strategy) << ", " << to_string(mode);
    }
    options.tuning.stabilize = Stabilize::off;
    options.tuning.watch = [](const Snapshot&) {};
    EXPECT_EQ(refused_option(xy, options), expected) << to_string(strategy) << ", watch";
  }
}

}  // namespace
}  // namespace cadt::test
