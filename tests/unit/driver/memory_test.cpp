// SPDX-License-Identifier: Apache-2.0
// The budget by itself: what is held and cached together is what the device has given, to the byte.
#include "common/driver/memory.hpp"

#include <gtest/gtest.h>

#include <cadt/errors.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "tests/unit/driver/small_device.hpp"

namespace cadt::test {
namespace {

constexpr std::size_t size = 100'000;  // large: not rounded up

class Budget : public ::testing::Test {
 protected:
  template <class Call>
  void expect_refused(const Call& call, std::size_t needed, std::size_t available) {
    try {
      call();
      ADD_FAILURE() << "not refused";
    } catch (const OutOfMemory& error) {
      EXPECT_EQ(error.needed(), needed);
      EXPECT_EQ(error.available(), available);
    }
  }
  SmallDevice device{10 * size};
  Memory memory{device, true};
};

TEST_F(Budget, LimitToTheByte) {
  memory.begin(3 * size, 0);
  memory.allocate(size).release();
  const Allocation first = memory.allocate(size);  // the same buffer
  EXPECT_TRUE(memory.allows(2 * size));
  EXPECT_FALSE(memory.allows(2 * size + 1));
  memory.require(2 * size);
  expect_refused([&] { memory.require(2 * size + 1); }, 3 * size + 1, 3 * size);
  expect_refused([&] { (void)memory.allocate(2 * size + 1); }, 3 * size + 1, 3 * size);
  const Allocation second = memory.allocate(2 * size);
  EXPECT_EQ(memory.peak(), 3 * size);
  expect_refused([&] { (void)memory.allocate(1); }, 3 * size + 64, 3 * size);
  EXPECT_EQ(device.usage->requests, 2U);
}

TEST_F(Budget, SizesThatWouldWrapAreRefused) {
  constexpr std::size_t most = std::numeric_limits<std::size_t>::max();
  memory.begin(0, 0);
  const Allocation held = memory.allocate(size);
  for (const std::size_t limit : {std::size_t{0}, 3 * size}) {
    memory.begin(limit, 0);
    for (const std::size_t bytes : {most, most - 63, most - size, most / 2 + 1})
      expect_refused([&] { (void)memory.allocate(bytes); }, bytes, 0);
  }
  EXPECT_EQ(device.usage->requests, 1U);
}

TEST_F(Budget, CachedBytesCount) {
  memory.begin(0, 0);
  memory.allocate(size).release();
  const Allocation other = memory.allocate(3 * size);
  EXPECT_EQ(device.usage->bytes, 4 * size);
  EXPECT_EQ(memory.peak(), 4 * size);
  memory.begin(0, 0);
  EXPECT_EQ(memory.peak(), 4 * size);  // it is cached from before
  memory.begin(4 * size, 0);
  EXPECT_FALSE(memory.dropped());
  EXPECT_EQ(device.usage->bytes, 4 * size);
  memory.begin(4 * size - 1, 0);
  EXPECT_TRUE(memory.dropped());
  EXPECT_FALSE(memory.dropped());
  EXPECT_EQ(device.usage->bytes, 3 * size);
  EXPECT_EQ(memory.peak(), 3 * size);
}

TEST_F(Budget, CachedBuffersGiveWayToTheLimit) {
  memory.begin(3 * size, 0);
  memory.allocate(size).release();
  {
    const Allocation fits = memory.allocate(2 * size);
    EXPECT_EQ(device.usage->bytes, 3 * size);
    EXPECT_FALSE(memory.dropped());
  }
  EXPECT_TRUE(memory.allows(3 * size));  // what is cached can be freed
  const Allocation more = memory.allocate(2 * size + 1);
  EXPECT_TRUE(memory.dropped());
  EXPECT_EQ(device.usage->bytes, 2 * size + 1);
  EXPECT_EQ(memory.peak(), 3 * size);
}

TEST_F(Budget, BuffersServeAgain) {
  memory.begin(0, 0);
  for (int call = 0; call < 3; ++call) {
    const Allocation small = memory.allocate(90), large = memory.allocate(size);
    EXPECT_EQ(memory.allocations(), 2U);
    EXPECT_EQ(device.usage->bytes, size + 128);
    EXPECT_EQ(memory.peak(), size + 128);
  }
  const std::size_t before = device.filled;
  const Allocation zeros = memory.allocate_zeros(size);
  EXPECT_EQ(memory.allocations(), 2U);
  EXPECT_EQ(device.filled, before + size);
}

TEST_F(Budget, AskedOnceMoreWhenTheCacheIsFreed) {
  memory.begin(0, 0);
  memory.allocate(4 * size).release();
  EXPECT_TRUE(memory.allows(10 * size));
  EXPECT_FALSE(memory.allows(10 * size + 1));
  expect_refused([&] { memory.require(10 * size + 1); }, 10 * size + 1, 10 * size);
  {
    const Allocation all = memory.allocate(10 * size);
    EXPECT_TRUE(memory.dropped());
    EXPECT_EQ(device.usage->refused, 1U);
    EXPECT_EQ(memory.peak(), 10 * size);
    // now there is nothing to free
    expect_refused([&] { (void)memory.allocate(size); }, size, 0);
    EXPECT_EQ(device.usage->refused, 2U);
    EXPECT_FALSE(memory.dropped());
  }
  memory.drop_cached();
  EXPECT_TRUE(memory.dropped());
  EXPECT_EQ(device.usage->bytes, 0U);
  memory.begin(0, 0);
  EXPECT_EQ(memory.peak(), 0U);
}

TEST_F(Budget, ReservedBuffersServeSmallerRequests) {
  memory.begin(0, 0);
  memory.allocate(4 * size).release();
  { const Allocation other = memory.allocate(size); }
  EXPECT_EQ(memory.allocations(), 2U);  // one of four times the size would be missed
  memory.drop_cached();
  memory.allocate(4 * size).release();
  memory.begin(0, size);
  const Allocation part_of_it = memory.allocate(size);
  EXPECT_EQ(memory.allocations(), 3U);
}

TEST_F(Budget, MemoryOfTheCallerIsInNoBudget) {
  memory.begin(size, 0);
  std::vector<std::byte> own(2 * size);
  { const Allocation wrapped = memory.wrap(own.data(), own.size()); }
  EXPECT_FALSE(memory.export_to(own.data(), own.size()));
  device.aliases = true;
  { const Allocation aliased = memory.import(own.data(), own.size()); }
  EXPECT_EQ(memory.peak(), 0U);
  memory.begin(0, 1);
  const Allocation next = memory.allocate(size);  // nothing of the caller's serves it
  EXPECT_EQ(device.usage->bytes, size);
}

TEST_F(Budget, WithoutACache) {
  Memory once(device, false);
  once.begin(size, 0);
  once.allocate(size).release();
  EXPECT_EQ(device.usage->bytes, 0U);
  const Allocation again = once.allocate(size);
  EXPECT_EQ(once.peak(), size);
  EXPECT_FALSE(once.caches());
  EXPECT_TRUE(memory.caches());
}

/// Only a pool looks at lifetimes (tests/unit/backends/opencl/buffer_pool_test.cpp).
TEST_F(Budget, TransientMemoryIsCachedLikeAllOther) {
  memory.begin(0, 0);
  EXPECT_FALSE(memory.pools(10 * size));
  { const Allocation transient = memory.transient(size), unpooled = memory.allocate_unpooled(size); }
  const Allocation first = memory.allocate(size), second = memory.transient(size, true);
  EXPECT_EQ(memory.allocations(), 2U);
}

}  // namespace
}  // namespace cadt::test
