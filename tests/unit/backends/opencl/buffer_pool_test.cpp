// SPDX-License-Identifier: Apache-2.0
// Pooled buffers and their parts, and what they are in the budget. No OpenCL device is needed.
#include "backends/opencl/buffer_pool.hpp"

#include <gtest/gtest.h>

#include <cadt/errors.hpp>
#include <utility>

#include "common/driver/memory.hpp"
#include "tests/unit/driver/small_device.hpp"

namespace cadt::test {
namespace {

constexpr std::size_t mib = std::size_t{1} << 20, step = 4096, slack = 4 * step;
constexpr std::size_t least = mib / 4;

class BufferPool : public ::testing::Test {
 protected:
  BufferPool() { pool.begin(false, 0); }
  std::unique_ptr<Buffer> buffer(std::size_t bytes) { return device.allocate(bytes); }
  /// Caches a buffer and returns it.
  const Buffer* cached(std::size_t bytes) {
    auto made = buffer(bytes);
    const Buffer* const address = made.get();
    EXPECT_EQ(pool.put(std::move(made), Lifetime::kept), 0U);
    return address;
  }
  std::unique_ptr<Buffer> transient(std::size_t bytes, Lifetime lifetime = Lifetime::transient) {
    return pool.take(bytes, lifetime);
  }
  static std::size_t offset(const std::unique_ptr<Buffer>& part) {
    return dynamic_cast<const PartBuffer&>(*part).offset();
  }
  void give(std::unique_ptr<Buffer> part) { EXPECT_EQ(pool.put(std::move(part), Lifetime::transient), 0U); }

  SmallDevice device{100 * mib};
  opencl::BufferPool pool{64, 0};
};

TEST_F(BufferPool, LargeRequestsArePooledUnlessBounded) {
  EXPECT_TRUE(pool.pools(least));
  EXPECT_FALSE(pool.pools(least - 1));
  EXPECT_EQ(pool.new_size(least, Lifetime::kept), least + slack);
  EXPECT_EQ(pool.new_size(least, Lifetime::transient), least);
  EXPECT_EQ(pool.new_size(least, Lifetime::unpooled), least);
  EXPECT_EQ(pool.new_size(least - 1, Lifetime::kept), least - 1);
  EXPECT_EQ(pool.new_size(100, Lifetime::kept), 128U);
  pool.begin(true, 0);
  EXPECT_FALSE(pool.pools(100 * mib));
  EXPECT_EQ(pool.new_size(least, Lifetime::kept), least);
}

TEST_F(BufferPool, SlackEndsAtTheLargestBuffer) {
  opencl::BufferPool of_largest(64, 2 * mib);
  of_largest.begin(false, 0);
  EXPECT_EQ(of_largest.new_size(2 * mib - slack, Lifetime::kept), 2 * mib);
  EXPECT_EQ(of_largest.new_size(2 * mib - 1, Lifetime::kept), 2 * mib);
  EXPECT_EQ(of_largest.new_size(2 * mib + 1, Lifetime::kept), 2 * mib + 1);  // the device refuses it
}

TEST_F(BufferPool, PartsAreDisjointAndAligned) {
  cached(4 * mib);
  auto first = transient(mib + 1), second = transient(mib), third = transient(mib);
  EXPECT_EQ(offset(first), 0U);
  EXPECT_EQ(offset(second), mib + step);
  EXPECT_EQ(offset(third), 2 * mib + step);
  EXPECT_EQ(transient(mib), nullptr) << "there is less left";
  auto fourth = transient(mib - step);
  EXPECT_EQ(offset(fourth), 3 * mib + step);
  give(std::move(second));
  EXPECT_EQ(transient(mib + 1), nullptr);
  auto gap = transient(mib);
  EXPECT_EQ(offset(gap), mib + step);
  EXPECT_EQ(pool.bytes(), 4 * mib);

  opencl::BufferPool coarse(3 * step, 0);
  coarse.begin(false, 0);
  EXPECT_EQ(coarse.put(buffer(4 * mib), Lifetime::kept), 0U);
  const auto one = coarse.take(mib, Lifetime::transient), other = coarse.take(mib, Lifetime::transient);
  EXPECT_EQ(offset(other), (mib + 3 * step - 1) / (3 * step) * (3 * step));
}

TEST_F(BufferPool, AsAWholeOnlyWithoutParts) {
  const Buffer* const whole = cached(mib + slack);
  auto first = transient(least), second = transient(least);
  EXPECT_EQ(pool.take(mib, Lifetime::kept), nullptr);
  EXPECT_EQ(pool.drop(), 0U);
  give(std::move(first));
  EXPECT_EQ(pool.take(mib, Lifetime::kept), nullptr);
  give(std::move(second));
  EXPECT_EQ(pool.bytes(), mib + slack);
  const auto taken = pool.take(mib, Lifetime::kept);
  EXPECT_EQ(taken.get(), whole);
  EXPECT_EQ(pool.bytes(), 0U);
}

TEST_F(BufferPool, PartOfWhichBuffer) {
  const Buffer *const middle = cached(2 * mib), *const large = cached(3 * mib), *const small = cached(mib);
  auto part = transient(mib / 2), last = transient(mib / 2, Lifetime::ends_first);
  cached(mib);  // as large as the one in use, which is preferred
  auto next = transient(mib / 2);
  EXPECT_EQ(offset(next), mib / 2);
  EXPECT_EQ(pool.take(2 * mib - slack, Lifetime::kept).get(), middle);
  EXPECT_EQ(pool.take(3 * mib - slack, Lifetime::kept), nullptr);
  give(std::move(last));
  EXPECT_EQ(pool.take(3 * mib - slack, Lifetime::kept).get(), large);
  give(std::move(part));
  give(std::move(next));
  EXPECT_EQ(pool.bytes(), 2 * mib);
  EXPECT_NE(small, nullptr);
}

/// It will be asked for as a whole.
TEST_F(BufferPool, NoPartOfWhatJustFits) {
  cached(5 * mib);
  EXPECT_EQ(transient(4 * mib + 1), nullptr);
  EXPECT_NE(transient(4 * mib), nullptr);
}

TEST_F(BufferPool, OwnMemoryIsNotCached) {
  EXPECT_EQ(transient(mib), nullptr);
  EXPECT_EQ(pool.put(buffer(mib), Lifetime::transient), mib);
  cached(4 * mib);
  EXPECT_EQ(transient(mib, Lifetime::unpooled), nullptr);
  EXPECT_EQ(pool.put(buffer(mib), Lifetime::unpooled), mib);
  EXPECT_EQ(pool.bytes(), 4 * mib);
  EXPECT_EQ(device.usage->bytes, 4 * mib);
  EXPECT_EQ(pool.drop(), 4 * mib);
  EXPECT_EQ(device.usage->bytes, 0U);
}

TEST_F(BufferPool, PartThatFailsChangesNothing) {
  cached(4 * mib);
  for (const bool has_parts : {false, true}) {
    const auto part = has_parts ? transient(mib) : nullptr;
    device.usage->no_parts = true;
    EXPECT_THROW((void)transient(mib), DeviceError);
    EXPECT_EQ(pool.bytes(), 4 * mib);
    EXPECT_EQ(pool.take(4 * mib - slack, Lifetime::kept) == nullptr, has_parts);
    device.usage->no_parts = false;
    if (!has_parts) {
      cached(4 * mib);
    } else {
      EXPECT_EQ(offset(transient(mib)), mib);
    }
  }
}

/// Reserved buffers that are pooled serve requests of their own size only.
TEST_F(BufferPool, ReservedSizes) {
  cached(4 * mib);
  pool.begin(false, least);
  EXPECT_EQ(pool.take(mib, Lifetime::kept), nullptr);
  pool.begin(false, least - 1);
  EXPECT_NE(pool.take(mib, Lifetime::kept), nullptr);
}

/// What is pooled counts once: as cached, as long as parts of it are in use.
TEST_F(BufferPool, InTheBudget) {
  device.cache = std::make_unique<opencl::BufferPool>(64, 0);
  Memory memory(device, true);
  memory.begin(0, 0);
  const std::size_t before = device.usage->bytes;
  const auto taken = [&] { return device.usage->bytes - before; };
  { const Allocation kept = memory.allocate(4 * mib); }
  {
    const Allocation part = memory.transient(mib), zeros = memory.transient_zeros(mib);
    EXPECT_EQ(memory.allocations(), 1U);
    EXPECT_EQ(memory.peak(), 4 * mib + slack);
    const Allocation own = memory.allocate_unpooled(mib);
    EXPECT_EQ(memory.peak(), 5 * mib + slack);
    EXPECT_EQ(memory.peak(), taken());
    memory.drop_cached();  // all of it is in use
    EXPECT_EQ(memory.peak(), taken());
  }
  EXPECT_EQ(taken(), 4 * mib + slack);
  memory.begin(0, 0);
  EXPECT_EQ(memory.peak(), 4 * mib + slack);
  {
    const Memory::TransientScope all(memory, true);
    const Allocation part = memory.allocate(mib);
    EXPECT_EQ(memory.allocations(), 2U);
    EXPECT_EQ(memory.peak(), taken());
  }
  { const Allocation small = memory.transient(least - 1), other = memory.allocate_unpooled(least - 1); }
  EXPECT_EQ(taken(), 4 * mib + slack + 2 * (least - 1));  // these are cached
  memory.begin(mib, 0);
  EXPECT_EQ(memory.peak(), 0U);
  EXPECT_EQ(taken(), 0U);
}

}  // namespace
}  // namespace cadt::test
