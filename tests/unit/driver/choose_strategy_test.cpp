// SPDX-License-Identifier: Apache-2.0
// The decision how a mesh is made, as a table: a row for each rule, on both sides of each bound.
#include "common/driver/choose_strategy.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace cadt {
namespace {

using Method = BuildStrategy::Method;

constexpr DeviceTraits cpu{true, false, false}, gpu{false, true, false}, float_gpu{false, true, true},
    pocl_as_gpu{false, true, false}, one_thread{true, false, false, 1}, two_threads{true, false, false, 2};

Options options_of(Strategy strategy) {
  Options options;
  options.tuning.strategy = strategy;
  return options;
}

PointProfile points(std::size_t n, bool PointShapes::*shape = nullptr) {
  PointProfile profile;
  profile.distinct = n;
  profile.finest_bits = 16;
  if (shape != nullptr) profile.shapes.*shape = true;
  return profile;
}

struct Row {
  std::string name;
  DeviceTraits device;
  Options options;
  PointProfile profile;
  Method method;
  std::size_t most_wrapped;
  bool cautious;
};

std::vector<Row> rows() {
  const Options automatic, locks = options_of(Strategy::locks), stars = options_of(Strategy::stars);
  Options deferred, watched, timed, none;
  deferred.tuning.stabilize = Stabilize::defer;
  watched.tuning.watch = [](const Snapshot&) {};
  timed.statistics = StatisticsDetail::timing;
  none.statistics = StatisticsDetail::none;
  PointProfile wide = points(1000000), fine = points(1000000), finest = points(1000000), hull_exact = points(400),
               hull_more = points(401);
  wide.wide = true;
  fine.finest_bits = 26;
  finest.finest_bits = 27;
  hull_exact.shapes.on_circle = hull_more.shapes.on_circle = true;
  return {
      {"a CPU inserts", cpu, automatic, points(1000000), Method::insertion, 0, false},
      {"a CPU inserts few", cpu, automatic, points(100), Method::insertion, 0, false},
      {"a CPU makes stars when told", cpu, stars, points(1000000), Method::stars, 2048, false},
      {"a CPU makes stars of few when told", cpu, stars, points(100), Method::stars, 2048, false},
      {"a GPU makes stars", gpu, automatic, points(32769), Method::stars, 32768, true},
      {"a GPU wraps few", gpu, automatic, points(32768), Method::wrapping, 32768, true},
      {"a GPU inserts when told", gpu, locks, points(1000000), Method::insertion, 0, false},
      {"a GPU makes stars of few when told", gpu, stars, points(3), Method::stars, 32768, false},
      {"two points have no stars", gpu, stars, points(2), Method::wrapping, 32768, false},
      {"no doubles, no stars", float_gpu, automatic, points(1000000), Method::insertion, 0, false},
      {"stabilised flips are about insertion", gpu, deferred, points(1000000), Method::insertion, 0, false},
      {"so are snapshots", gpu, watched, points(1000000), Method::insertion, 0, false},
      {"so is the time of threads", gpu, timed, points(1000000), Method::insertion, 0, false},
      {"counters make no difference", gpu, none, points(1000000), Method::stars, 32768, true},
      {"exponents that span too much", gpu, automatic, wide, Method::insertion, 0, false},
      {"also when told", gpu, stars, wide, Method::insertion, 0, false},
      {"keys of 26 bits", gpu, automatic, fine, Method::stars, 32768, true},
      {"keys of 27 bits", gpu, automatic, finest, Method::insertion, 32768, true},
      {"on a line", gpu, automatic, points(1000, &PointShapes::on_line), Method::insertion, 0, false},
      {"on a line when told", gpu, stars, points(1000, &PointShapes::on_line), Method::stars, 32768, false},
      {"on rays", gpu, automatic, points(1000, &PointShapes::on_rays), Method::insertion, 0, false},
      {"400 on a circle", gpu, automatic, hull_exact, Method::wrapping, 32768, true},
      {"401 on a circle", gpu, automatic, hull_more, Method::insertion, 0, false},
      {"3,000 on the hull", gpu, automatic, points(3000, &PointShapes::on_hull), Method::wrapping, 32768, true},
      {"3,001 on the hull", gpu, automatic, points(3001, &PointShapes::on_hull), Method::insertion, 0, false},
      {"20,000 on circles", gpu, automatic, points(20000, &PointShapes::on_circles), Method::wrapping, 20000, true},
      {"20,001 on circles", gpu, automatic, points(20001, &PointShapes::on_circles), Method::stars, 20000, true},
      {"20,480 on a lattice", gpu, automatic, points(20480, &PointShapes::on_lattice), Method::wrapping, 20480, true},
      {"20,481 on a lattice", gpu, automatic, points(20481, &PointShapes::on_lattice), Method::stars, 20480, true},
      {"28,672 on a ring", gpu, automatic, points(28672, &PointShapes::on_ring), Method::wrapping, 28672, true},
      {"28,673 on a ring", gpu, automatic, points(28673, &PointShapes::on_ring), Method::stars, 28672, true},
      {"over-full cells", gpu, automatic, points(1000000, &PointShapes::overfull), Method::insertion, 32768, true},
      {"few in over-full cells", gpu, automatic, points(100, &PointShapes::overfull), Method::wrapping, 32768, true},
      {"over-full cells when told", gpu, stars, points(1000000, &PointShapes::overfull), Method::stars, 32768, false},
  };
}

TEST(ChooseStrategy, IsATable) {
  for (const Row& row : rows()) {
    const BuildStrategy how = choose_strategy(row.device, row.options, row.profile);
    EXPECT_EQ(how.method, row.method) << row.name;
    EXPECT_EQ(how.most_wrapped, row.most_wrapped) << row.name;
    EXPECT_EQ(how.cautious, row.cautious) << row.name;
    // Residual vertices are like none of the shapes; tiles may be small where nothing else was asked for.
    const bool stars = row.most_wrapped != 0;
    EXPECT_EQ(how.most_residual_wrapped, !stars ? 0U : row.device.contiguous ? 2048U : 65536U) << row.name;
    EXPECT_EQ(how.least_points_of_tile, row.cautious ? 48U : 0U) << row.name;
  }
}

TEST(ChooseStrategy, MemoryIsPlannedForStarsFromTheFirstPointsThatMayHaveThem) {
  EXPECT_EQ(fewest_for_stars(options_of(Strategy::automatic)), 20001U);
  EXPECT_EQ(fewest_for_stars(options_of(Strategy::stars)), 0U);
}

TEST(ChooseStrategy, PartitionsAreForThreadsWithPointsEnough) {
  Options options, grain, watched, deferred;
  grain.tuning.grain = 1;
  watched.tuning.watch = [](const Snapshot&) {};
  deferred.tuning.stabilize = Stabilize::defer;
  EXPECT_TRUE(inserts_partitions(cpu, options, 65536));
  EXPECT_FALSE(inserts_partitions(cpu, options, 65535));
  EXPECT_FALSE(inserts_partitions(gpu, options, 65536));
  EXPECT_FALSE(inserts_partitions(cpu, grain, 65536));
  EXPECT_FALSE(inserts_partitions(cpu, watched, 65536));
  EXPECT_FALSE(inserts_partitions(cpu, deferred, 65536));
  EXPECT_TRUE(inserts_partitions(two_threads, options, 16384));
  EXPECT_FALSE(inserts_partitions(two_threads, options, 16383));
  EXPECT_TRUE(inserts_partitions(one_thread, options, 65536));
  EXPECT_FALSE(inserts_partitions(one_thread, options, 65535));
}

TEST(ChooseStrategy, OneThreadInsertsSmallSetsAlone) {
  Options automatic, grain, watched, deferred;
  grain.tuning.grain = 1;
  watched.tuning.watch = [](const Snapshot&) {};
  deferred.tuning.stabilize = Stabilize::defer;
  EXPECT_TRUE(inserts_serially(two_threads, automatic, 3));
  EXPECT_TRUE(inserts_serially(two_threads, automatic, 16383));
  EXPECT_FALSE(inserts_serially(two_threads, automatic, 16384));
  EXPECT_TRUE(inserts_serially(one_thread, automatic, 65535));
  EXPECT_FALSE(inserts_serially(one_thread, automatic, 65536));
  EXPECT_FALSE(inserts_serially(cpu, automatic, 100)) << "OpenCL compiles that kernel for batches only";
  EXPECT_FALSE(inserts_serially(gpu, automatic, 100));
  EXPECT_FALSE(inserts_serially(two_threads, options_of(Strategy::locks), 100)) << "all threads, as asked for";
  EXPECT_FALSE(inserts_serially(two_threads, grain, 100));
  EXPECT_FALSE(inserts_serially(two_threads, watched, 100));
  EXPECT_FALSE(inserts_serially(two_threads, deferred, 100));
}

TEST(ChooseStrategy, SmallSetsAreBatched) {
  EXPECT_EQ(most_points_of_batched_set(cpu), 8192U);
  EXPECT_EQ(most_points_of_batched_set(gpu), 32768U);
  EXPECT_EQ(most_points_of_batched_set(float_gpu), 0U);
  const Options automatic, locks = options_of(Strategy::locks), stars = options_of(Strategy::stars);
  Options deferred;
  deferred.tuning.stabilize = Stabilize::defer;
  EXPECT_TRUE(batches_sets(cpu, automatic));
  EXPECT_TRUE(batches_sets(cpu, locks));
  EXPECT_TRUE(batches_sets(gpu, automatic));
  EXPECT_FALSE(batches_sets(gpu, locks));
  EXPECT_FALSE(batches_sets(cpu, deferred));
  EXPECT_TRUE(inserts_batched_sets(cpu, automatic));
  EXPECT_FALSE(inserts_batched_sets(cpu, stars));
  EXPECT_FALSE(inserts_batched_sets(pocl_as_gpu, automatic));
}

}  // namespace
}  // namespace cadt
