// SPDX-License-Identifier: Apache-2.0
// How a CPU's launches are divided: what is not worth waking a thread is one work-item.
#include "common/driver/launcher.hpp"

#include <gtest/gtest.h>

#include "tests/unit/driver/small_device.hpp"

namespace cadt::test {
namespace {

class LaunchGrids : public ::testing::Test {
 protected:
  SmallDevice device{1000};  // contiguous
  Memory memory{device, true};
  Launcher usual{device, memory, 0};
};

TEST_F(LaunchGrids, FewElementsAreOneWorkItem) {
  EXPECT_EQ(usual.grid(1).items, 1U);
  EXPECT_EQ(usual.grid(16384).items, 1U);
  EXPECT_EQ(usual.grid(16385).items, 5U);
  EXPECT_EQ(usual.grid_strided(16384).items, 1U);
  EXPECT_EQ(usual.chunks(8192).items, 1U);
  EXPECT_EQ(usual.parts(8192).items, 1U);
  EXPECT_EQ(usual.chunks(8193).items, 1U) << "as many chunks as are processed at a time";
}

TEST_F(LaunchGrids, PointsAreInsertedByOneThreadIfTheyAreVeryFew) {
  EXPECT_EQ(usual.grid_spread(64).items, 1U);
  EXPECT_EQ(usual.grid_spread(65).items, 2U);
  EXPECT_EQ(usual.grid_spread(1 << 20).grain, 256U) << "the most that the device takes";
}

TEST_F(LaunchGrids, WhatIsForTeamsElsewhereIsMuchWork) {
  EXPECT_EQ(usual.grid_of_teams(8, 32).items, 1U);
  EXPECT_EQ(usual.grid_of_teams(64, 32).items, 4U) << "four for each thread";
}

TEST_F(LaunchGrids, EveryElementHasAWorkItem) {
  for (const std::size_t count : {1U, 64U, 65U, 8192U, 8193U, 16384U, 16385U, 100'000U})
    for (const LaunchGrid& grid :
         {usual.grid(count), usual.grid_spread(count), usual.grid_of_teams(count, 32), usual.chunks(count)}) {
      EXPECT_EQ(grid.count, count);
      EXPECT_GE(std::size_t{grid.items} * grid.grain, count);
      EXPECT_LT((grid.items - std::size_t{1}) * grid.grain, count) << "a work-item has nothing to do";
    }
}

TEST_F(LaunchGrids, TheOptionDecides) {
  const Launcher told(device, memory, 1);
  EXPECT_EQ(told.grid(100).items, 100U);
  EXPECT_EQ(told.grid_spread(100).items, 100U);
}

}  // namespace
}  // namespace cadt::test
