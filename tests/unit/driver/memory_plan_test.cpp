// SPDX-License-Identifier: Apache-2.0
// The memory of a call before any work: formulas by themselves. That calls keep to them is shown by tests of limits
// (tests/robustness/faults, tests/system/mesh).
#include "common/driver/memory_plan.hpp"

#include <gtest/gtest.h>

#include <cadt/errors.hpp>
#include <vector>

#include "common/driver/device.hpp"
#include "common/driver/registry.hpp"

namespace cadt {
namespace {

constexpr std::size_t fixed = std::size_t{1} << 16;

CallShape call(std::size_t n, bool result_elsewhere, bool input_stays, std::size_t scalar = sizeof(double)) {
  return {n, result_elsewhere, input_stays, scalar};
}

TEST(MemoryPlan, BytesAPoint) {
  const std::size_t n = 1000;
  EXPECT_EQ(plan_memory(call(n, false, false), false, false).bytes, fixed + 124 * n);
  EXPECT_EQ(plan_memory(call(n, true, false), false, false).bytes, fixed + 97 * n);
  EXPECT_EQ(plan_memory(call(n, false, true), true, false).bytes, 2 * fixed + 85 * n);
  EXPECT_EQ(plan_memory(call(n, false, false), true, false).bytes, 2 * fixed + 101 * n);
  EXPECT_EQ(plan_memory(call(n, false, true), true, true).bytes, 2 * fixed + 71 * n);
  EXPECT_EQ(plan_memory(call(n, false, false), true, true).bytes, 2 * fixed + 83 * n);
  EXPECT_EQ(plan_memory(call(n, false, false), false, false).largest_buffer, 64 * n);
  EXPECT_EQ(plan_memory(call(n, false, false), true, false).largest_buffer, fixed + 26 * n);
}

TEST(MemoryPlan, NoCompactWayWithoutStars) {
  EXPECT_FALSE(plan_memory(call(10, false, false), false, true).compact);
  EXPECT_TRUE(plan_memory(call(10, false, false), true, true).compact);
}

/// Without a cache the public figure is what a call asks for before any work, whichever plan it has.
TEST(MemoryPlan, NoCallAsksForMoreThanThePublicFigure) {
  const std::unique_ptr<Device> device = open_device({});
  const Memory memory(*device, false);
  for (const std::size_t n : {0UL, 1UL, 1000UL, 2849UL, 2850UL, 1000000UL}) {
    for (const bool stars : {false, true})
      EXPECT_GE(most_bytes(memory, n, stars), plan_memory(call(n, false, false), stars, false).bytes) << n;
    EXPECT_EQ(most_bytes(memory, n, false), fixed + 124 * n);
  }
}

/// A device of the host with a limit of memory.
class Chosen : public ::testing::Test {
 protected:
  MemoryPlan choose(std::size_t limit, const CallShape& shape, bool stars) {
    options_.max_memory = limit;
    memory_.begin(limit, 0);
    return choose_memory_plan(memory_, options_, info_, shape, stars, known_);
  }
  std::unique_ptr<Device> device_ = open_device({});
  Memory memory_{*device_, true};
  DeviceInfo info_ = device_->info();
  Options options_;
  KnownSizes known_;
};

TEST_F(Chosen, FastWhereItJustFitsElseCompactElseRefused) {
  const std::size_t n = 1000, fast = 2 * fixed + 85 * n, compact = 2 * fixed + 71 * n;
  EXPECT_FALSE(choose(fast, call(n, false, true), true).compact);
  EXPECT_TRUE(choose(fast - 1, call(n, false, true), true).compact);
  EXPECT_TRUE(choose(compact, call(n, false, true), true).compact);
  try {
    (void)choose(compact - 1, call(n, false, true), true);
    ADD_FAILURE() << "one byte too few";
  } catch (const OutOfMemory& error) {
    EXPECT_EQ(error.needed(), compact);
    EXPECT_EQ(error.available(), compact - 1);
  }
}

TEST_F(Chosen, FloatsAreCompact) {
  EXPECT_TRUE(choose(0, call(1000, false, true, sizeof(float)), true).compact);
  EXPECT_FALSE(choose(0, call(1000, false, true), true).compact);
}

TEST_F(Chosen, LargestBufferToTheByte) {
  info_.largest_buffer_bytes = 64 * 1000;
  EXPECT_NO_THROW((void)choose(0, call(1000, true, false), false));
  EXPECT_THROW((void)choose(0, call(1001, true, false), false), OutOfMemory);
  info_.largest_buffer_bytes = fixed + 26 * 1000;
  EXPECT_NO_THROW((void)choose(0, call(1000, false, true), true));
  EXPECT_THROW((void)choose(0, call(1001, false, true), true), OutOfMemory);
}

TEST_F(Chosen, BatchesGetSmallerUntilTheyFit) {
  const std::vector<std::size_t> offsets = {0, 1 << 20, 1 << 21};  // two sets of 2^20
  const auto most = [&](std::size_t limit) {
    options_.max_memory = limit;
    memory_.begin(limit, 0);
    return plan_batch(memory_, options_, info_, offsets, std::size_t{1} << 21, 1000, known_);
  };
  const auto bytes = [](std::size_t points) { return 1000 + fixed + 176 * points + 2 * 1300; };
  EXPECT_EQ(most(0), most_points_batched);
  EXPECT_EQ(most(bytes(std::size_t{1} << 21)), most_points_batched);
  EXPECT_EQ(most(bytes(std::size_t{1} << 21) - 1), std::size_t{1} << 20);
  EXPECT_EQ(most(bytes(std::size_t{1} << 16)), std::size_t{1} << 16);
  EXPECT_THROW((void)most(bytes(std::size_t{1} << 16) - 1), OutOfMemory);
}

/// What the message asks for is enough, whether the largest set or a batch of the others needs more.
TEST_F(Chosen, BatchesSayAtOnceWhatTheyNeed) {
  const auto needed = [&](const std::vector<std::size_t>& offsets, std::size_t limit) {
    options_.max_memory = limit;
    memory_.begin(limit, 0);
    try {
      (void)plan_batch(memory_, options_, info_, offsets, 30000, 1000, known_);
    } catch (const OutOfMemory& error) {
      return error.needed();
    }
    return std::size_t{0};
  };
  for (const std::size_t largest : {std::size_t{40000}, std::size_t{400000}}) {
    std::vector<std::size_t> offsets = {0, largest};
    for (int set = 0; set < 100; ++set) offsets.push_back(offsets.back() + 1000);
    const std::size_t bytes = needed(offsets, 1000);
    EXPECT_GT(bytes, 0U);
    EXPECT_EQ(needed(offsets, bytes), 0U) << largest;
    EXPECT_EQ(needed(offsets, bytes - 1), bytes) << largest;
  }
}

}  // namespace
}  // namespace cadt
