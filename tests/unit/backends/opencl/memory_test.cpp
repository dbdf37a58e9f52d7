// SPDX-License-Identifier: Apache-2.0
// What counts as held: buffers once, parts and memory of the caller's not at all.
#include <limits>

#include "common/driver/buffer_cache.hpp"
#include "tests/unit/backends/opencl/support.hpp"

namespace cadt::test {
namespace {

using OpenClMemory = OpenClTest;

constexpr std::size_t size = std::size_t{1} << 20;

TEST_F(OpenClMemory, BuffersAreHeldAsLongAsTheyLive) {
  const auto device = open_small();
  const std::size_t before = device->free_bytes();
  EXPECT_GT(before, 3 * size);
  auto first = device->allocate(size);
  EXPECT_EQ(device->free_bytes(), before - size);
  const auto second = device->allocate(2 * size);
  EXPECT_EQ(device->free_bytes(), before - 3 * size);
  first.reset();
  EXPECT_EQ(device->free_bytes(), before - 2 * size);
}

TEST_F(OpenClMemory, PartsTakeNothing) {
  const auto device = open_small();
  const std::size_t before = device->free_bytes();
  {
    auto whole = device->allocate(size);
    const std::size_t held = before - size;
    ASSERT_EQ(device->free_bytes(), held);
    auto lower = whole->part(0, size / 2);
    EXPECT_EQ(lower->bytes(), size / 2);
    EXPECT_EQ(device->free_bytes(), held);
    const auto upper = whole->part(size / 2, size / 2);
    EXPECT_EQ(device->free_bytes(), held);
    lower.reset();
    EXPECT_EQ(device->free_bytes(), held);
    // The memory goes with the last of them, what is counted with the whole.
    whole.reset();
    EXPECT_EQ(device->free_bytes(), before);
    device->fill(*upper, 0, size / 2, 5);
  }
  EXPECT_EQ(device->free_bytes(), before);
  auto whole = device->allocate(64);
  EXPECT_THROW(static_cast<void>(whole->part(32, 33)), InternalError);
}

TEST_F(OpenClMemory, MemoryOfTheCallerTakesNothing) {
  const auto device = open_small();
  const std::size_t before = device->free_bytes();
  const auto whole = device->allocate(size);
  const std::size_t held = before - size;
  const auto wrapped = device->wrap(device->handle(*whole), size);
  EXPECT_EQ(wrapped->bytes(), size);
  EXPECT_EQ(device->free_bytes(), held);
  const std::vector<double> own(size / sizeof(double), 1.0);
  const auto alias = device->alias(own.data(), size);
  EXPECT_EQ(device->free_bytes(), held);
}

/// GPUs pool, CPUs cache.
TEST_F(OpenClMemory, CacheOfTheDevice) {
  const auto device = open_small();
  const auto made = device->make_cache();
  ASSERT_NE(made, nullptr);
  EXPECT_EQ(made->pools(size), device->info().gpu);
}

/// Takes what it gives from another device of the same context.
class Pool final : public DeviceAllocator {
 public:
  explicit Pool(Device& from) : from_(from) {}
  void* allocate(std::size_t bytes, void*) noexcept override {
    given_.push_back(from_.allocate(bytes));
    return from_.handle(*given_.back());
  }
  void deallocate(void*, std::size_t bytes, void*) noexcept override { returned += bytes; }

  std::size_t returned = 0;

 private:
  Device& from_;
  std::vector<std::unique_ptr<Buffer>> given_;
};

TEST_F(OpenClMemory, AnAllocatorHasNoLimitOfOurs) {
  opencl::OpenRequest request = small();
  request.fresh = false;
  const auto source = opencl::open_device(request);
  const auto pool = std::make_shared<Pool>(*source);
  request.allocator = pool;
  const auto device = opencl::open_device(request);
  const std::size_t before = source->free_bytes(), returned = pool->returned;
  EXPECT_EQ(device->free_bytes(), std::numeric_limits<std::size_t>::max());
  EXPECT_EQ(device->make_cache(), nullptr);
  {
    const auto buffer = device->allocate(size);
    EXPECT_EQ(buffer->bytes(), size);
    EXPECT_EQ(source->free_bytes(), before - size) << "counted by the one that gave it, once";
    EXPECT_EQ(pool->returned, returned);
  }
  EXPECT_EQ(pool->returned, returned + size);
}

}  // namespace
}  // namespace cadt::test
