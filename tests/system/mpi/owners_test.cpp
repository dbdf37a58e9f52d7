// SPDX-License-Identifier: Apache-2.0
// Who makes what: pure functions of the engine for several ranks.
#include "tiles/mpi/owners.hpp"
#include "tiles/mpi/share.hpp"

#include <gtest/gtest.h>

#include <sched.h>
#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

namespace {
std::size_t cores_of_machine = 0;  // 0: nobody says
}  // namespace

/// As the system's on a machine of so many cores.
extern "C" int sched_getaffinity(pid_t /*process*/, std::size_t size, cpu_set_t* set) noexcept {
  if (8 * size < cores_of_machine || cores_of_machine == 0) {
    errno = EINVAL;
    return -1;
  }
  std::memset(set, 0, size);
  std::memset(set, 0xFF, cores_of_machine / 8);
  return 0;
}

namespace cadt::tiles::mpi {
namespace {

TileTree tree_of(std::uint64_t points, std::uint64_t tile) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> xy(2 * points);
  for (double& v : xy) v = uniform(random);
  TreeBuilder builder(points, tile);
  while (!builder.done()) {
    TreePass pass = builder.new_pass();
    builder.look_at(pass, 0, xy);
    builder.finish_pass(std::move(pass));
  }
  return builder.take();
}

TEST(MpiOwners, LeavesInRangesOfEqualPointsAndJoinsAtTheLowerRank) {
  const TileTree tree = tree_of(10000, 100);
  const std::vector<bool> none(tree.size(), false);
  for (const int ranks : {1, 2, 3, 7, 16}) {
    const std::vector<int> owner = owners(tree, none, ranks);
    std::vector<std::uint64_t> points(static_cast<std::size_t>(ranks));
    int last = 0;
    for (std::uint32_t i = 0; i < tree.size(); ++i) {
      const TreeNode& node = tree.node(i);
      ASSERT_GE(owner[i], 0);
      ASSERT_LT(owner[i], ranks);
      if (!node.is_leaf()) {
        EXPECT_EQ(owner[i], std::min(owner[node.left], owner[node.right]));
        continue;
      }
      EXPECT_GE(owner[i], last);
      last = owner[i];
      points[static_cast<std::size_t>(owner[i])] += node.points;
    }
    for (const std::uint64_t n : points) EXPECT_NEAR(static_cast<double>(n), 10000.0 / ranks, 101);
  }
}

TEST(MpiOwners, WhatIsThereAlreadyCountsNothing) {
  const TileTree tree = tree_of(10000, 100);
  std::vector<bool> valid(tree.size(), false);
  const auto leaves = tree.leaves();
  for (std::size_t i = 0; i < leaves.size() / 2; ++i) valid[leaves[i]] = true;
  const std::vector<int> owner = owners(tree, valid, 2);
  std::uint64_t points[2] = {};
  for (const std::uint32_t leaf : leaves)
    if (!valid[leaf]) points[owner[leaf]] += tree.node(leaf).points;
  EXPECT_NEAR(static_cast<double>(points[0]), static_cast<double>(points[1]), 202);
}

TEST(MpiOwners, FewerLeavesThanRanks) {
  const TileTree one(2);
  EXPECT_EQ(owners(one, {false}, 5), std::vector<int>{2});
  EXPECT_EQ(owners(TileTree(0), {false}, 5), std::vector<int>{0});
}

TEST(MpiOwners, SlicesAreWholeBlocksAndCoverAll) {
  for (const std::uint64_t points : {0U, 1U, 99U, 100U, 101U, 12345U}) {
    for (const int ranks : {1, 2, 3, 16}) {
      std::uint64_t at = 0;
      for (int r = 0; r < ranks; ++r) {
        const auto [begin, end] = slice(points, 100, r, ranks);
        EXPECT_EQ(begin, at);
        EXPECT_TRUE(begin % 100 == 0 || begin == points);
        at = end;
      }
      EXPECT_EQ(at, points);
    }
  }
}

DeviceInfo device(Backend backend, int index, bool gpu) {
  DeviceInfo info;
  info.backend = backend;
  info.index = index;
  info.gpu = gpu;
  info.usable = info.fp64 = true;
  return info;
}

TEST(MpiShare, RanksOfAMachineTakeItsGpusInTurn) {
  const std::vector<DeviceInfo> devices = {device(Backend::host, 0, false), device(Backend::opencl, 0, false),
                                           device(Backend::opencl, 1, true), device(Backend::cuda, 0, true),
                                           device(Backend::cuda, 1, true)};
  for (const int rank : {0, 1, 2, 5}) {
    const Options chosen = share_of_devices({}, rank, {}, devices);
    EXPECT_EQ(chosen.backend, Backend::cuda);
    EXPECT_EQ(chosen.device, std::to_string(rank % 2));
  }
  Options opencl;
  opencl.backend = Backend::opencl;
  EXPECT_EQ(share_of_devices(opencl, 3, {}, devices).device, "1") << "the processor is no match for a GPU";
  EXPECT_EQ(share_of_devices({}, 3, {}, std::span(devices).first(2)).backend, Backend::host);
  const std::vector<std::string> named = {"4", "7"};
  EXPECT_EQ(share_of_devices(opencl, 3, named, devices).device, "7");
}

TEST(MpiShare, MachinesOfManyCores) {
  const auto allowed = [] {
    std::size_t sum = 0;
    for (const std::uint64_t word : allowed_cores()) sum += static_cast<std::size_t>(std::popcount(word));
    return sum;
  };
  cores_of_machine = 2048;
  EXPECT_EQ(allowed(), 2048U);
  cores_of_machine = 0;
  EXPECT_EQ(allowed(), std::thread::hardware_concurrency());
}

}  // namespace
}  // namespace cadt::tiles::mpi
