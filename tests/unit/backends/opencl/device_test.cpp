// SPDX-License-Identifier: Apache-2.0
// Memory and launches of one device.
#include <sys/mman.h>

#include <array>
#include <cstring>
#include <numeric>

#include "tests/unit/backends/opencl/support.hpp"

namespace cadt::test {
namespace {

using OpenClDevice = OpenClTest;

TEST_F(OpenClDevice, BuffersRoundTripAtOffsets) {
  const auto device = open_small();
  std::vector<std::uint32_t> data(10007), back(data.size());
  std::iota(data.begin(), data.end(), 5u);
  const std::size_t bytes = data.size() * 4;
  const auto buffer = device->allocate(bytes);
  EXPECT_EQ(buffer->bytes(), bytes);
  device->write(*buffer, 0, data.data(), bytes);
  device->read(*buffer, 0, back.data(), bytes);
  EXPECT_EQ(back, data);

  const std::array<std::uint32_t, 3> patch = {1, 2, 3};
  device->write(*buffer, 4 * 100, patch.data(), sizeof patch);
  std::copy(patch.begin(), patch.end(), data.begin() + 100);
  std::array<std::uint32_t, 5> window{};
  device->read(*buffer, 4 * 99, window.data(), sizeof window);
  EXPECT_TRUE(std::equal(window.begin(), window.end(), data.begin() + 99));
}

TEST_F(OpenClDevice, FillTouchesItsRangeOnly) {
  const auto device = open_small();
  std::vector<std::uint32_t> data(1000, 7u);
  const auto buffer = device->allocate(data.size() * 4);
  device->write(*buffer, 0, data.data(), buffer->bytes());
  device->fill(*buffer, 4 * 3, 4 * 500, 0xDEADBEEFu);
  std::fill_n(data.begin() + 3, 500, 0xDEADBEEFu);
  std::vector<std::uint32_t> back(data.size());
  device->read(*buffer, 0, back.data(), buffer->bytes());
  EXPECT_EQ(back, data);
}

TEST_F(OpenClDevice, NothingIsNothing) {
  const auto device = open_small();
  const auto empty = device->allocate(0);
  EXPECT_EQ(empty->bytes(), 0u);
  device->write(*empty, 0, nullptr, 0);
  device->read(*empty, 0, nullptr, 0);
  device->fill(*empty, 0, 0, 1);
  EXPECT_EQ(counted_items(*device, 0), 0u);
}

TEST_F(OpenClDevice, OutOfRangeIsRefused) {
  const auto device = open_small();
  const auto buffer = device->allocate(64);
  std::array<char, 128> data{};
  EXPECT_THROW(device->write(*buffer, 0, data.data(), 65), InternalError);
  EXPECT_THROW(device->read(*buffer, 64, data.data(), 1), InternalError);
  EXPECT_THROW(device->read(*buffer, SIZE_MAX, data.data(), 2), InternalError);
  EXPECT_THROW(device->fill(*buffer, 60, 8, 0), InternalError);
  EXPECT_THROW(device->fill(*buffer, 0, 6, 0), InternalError);
}

TEST_F(OpenClDevice, LaunchCountsItsItemsWithAnyGroupSize) {
  for (const unsigned group : {0u, 1u, 7u, 64u, 1000000u}) {
    opencl::OpenRequest request = small();
    request.work_group_size = group;
    const auto device = opencl::open_device(request);
    for (const std::uint32_t items : {1u, 63u, 64u, 65u, 5000u})
      EXPECT_EQ(counted_items(*device, items), items) << "groups of " << group;
  }
}

TEST_F(OpenClDevice, WrongArgumentsAreRefused) {
  const auto device = open_small();
  const std::vector<Arg> too_few = {Arg(1u)};
  const auto count =
      caught<InternalError>([&] { device->launch(KernelId::cadt_selftest, 1, too_few, KernelVariant::narrow); });
  EXPECT_NE(std::string(count.what()).find("takes 4 arguments, not 1"), std::string::npos) << count.what();
  // What the runtime notices arrives with its call and the name of its code.
  const auto buffer = device->allocate(256);
  const std::vector<Arg> wrong = {Arg(1u), Arg(buffer), Arg(buffer), Arg(1u)};
  const auto size =
      caught<DeviceError>([&] { device->launch(KernelId::cadt_selftest, 1, wrong, KernelVariant::narrow); });
  EXPECT_EQ(size.call(), "clSetKernelArg");
  EXPECT_EQ(size.device(), info.name);
  EXPECT_EQ(size.code(), -51);
  EXPECT_NE(std::string(size.what()).find("CL_INVALID_ARG_SIZE"), std::string::npos) << size.what();
}

TEST_F(OpenClDevice, NullBufferIsANullPointer) {
  opencl::OpenRequest request = small();
  // The kernel writes its answer only if it got null where the self-test passes a buffer for the input.
  request.source +=
      "\n__kernel void cadt_bounds(__global double* p, __global uint* out) { *out = p == 0 ? 17u : 18u; }\n";
  const auto device = opencl::open_device(request);
  const auto out = device->allocate(4);
  const std::unique_ptr<Buffer> null;
  for (const std::uint32_t expected : {17u, 18u}) {
    const std::array<Arg, 2> arguments = {expected == 17u ? Arg(null) : Arg(out), Arg(out)};
    device->launch(KernelId::cadt_bounds, 1, arguments, KernelVariant::narrow);
    std::uint32_t answer = 0;
    device->read(*out, 0, &answer, 4);
    EXPECT_EQ(answer, expected);
  }
}

TEST_F(OpenClDevice, LargerThanTheLargestBuffer) {
  const auto device = open_small();
  const std::size_t bytes = device->info().largest_buffer_bytes + 1;
  const auto error = caught<OutOfMemory>([&] { static_cast<void>(device->allocate(bytes)); });
  EXPECT_EQ(error.needed(), bytes);
  EXPECT_EQ(error.available(), device->info().largest_buffer_bytes);
  EXPECT_NE(std::string(error.what()).find(std::to_string(bytes)), std::string::npos) << error.what();
  EXPECT_NO_THROW(static_cast<void>(device->allocate(1000)));
}

// Drivers that defer the allocation would go on for ever.
TEST_F(OpenClDevice, MoreThanAllMemory) {
  const auto device = open_small();
  const std::size_t piece = device->info().largest_buffer_bytes, all = device->info().memory_bytes;
  std::vector<std::unique_ptr<Buffer>> held;
  const auto error = caught<OutOfMemory>([&] {
    while (held.size() <= all / piece) held.push_back(device->allocate(piece));
  });
  EXPECT_EQ(error.needed(), piece);
  EXPECT_LT(error.available(), piece);
  held.clear();
  EXPECT_NO_THROW(held.push_back(device->allocate(piece)));
}

TEST_F(OpenClDevice, LostContextFailsFastAndIsReplaced) {
  opencl::OpenRequest request = small();
  request.fresh = false;
  const auto device = opencl::open_device(request);
  const auto buffer = device->allocate(16);
  opencl::lose_context(request);
  const auto error = caught<DeviceError>([&] { device->fill(*buffer, 0, 16, 0); });
  EXPECT_EQ(error.code(), -34);
  EXPECT_THROW(static_cast<void>(device->allocate(16)), DeviceError);
  EXPECT_THROW(device->finish(), DeviceError);
  EXPECT_EQ(counted_items(*opencl::open_device(request), 100), 100u);
}

TEST_F(OpenClDevice, AliasReadsTheCallersMemory) {
  const auto device = open_small();
  // Read-only pages: a device that wrote them would end the test.
  const std::size_t page = 4096, bytes = 16 * sizeof(double);
  void* memory = mmap(nullptr, page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  auto* values = static_cast<double*>(memory) + 1;  // aligned as a double, no better
  for (int i = 0; i < 16; ++i) values[i] = i + 2;
  ASSERT_EQ(mprotect(memory, page, PROT_READ), 0);
  {
    const auto alias = device->alias(values, bytes);
    ASSERT_EQ(alias != nullptr, !info.gpu);
    if (alias != nullptr) {
      EXPECT_EQ(alias->bytes(), bytes);
      const auto out = device->allocate(8 * sizeof(double)), words = device->allocate(20);
      device->fill(*words, 0, 20, 0);
      const std::array<Arg, 4> arguments = {Arg(alias), Arg(out), Arg(words), Arg(1u)};
      device->launch(KernelId::cadt_selftest, 1, arguments, KernelVariant::narrow);
      double first = 0;
      device->read(*out, 0, &first, sizeof first);
      EXPECT_EQ(first, 2.0 * 2.0 + 3.0);
    }
  }
  munmap(memory, page);
  const std::array<char, 64> bytes_only{};
  EXPECT_EQ(
      device->alias(bytes_only.data() + (reinterpret_cast<std::uintptr_t>(bytes_only.data()) % 2 == 0 ? 1 : 0), 16),
      nullptr);
  EXPECT_EQ(device->alias(nullptr, 0), nullptr);
}

}  // namespace
}  // namespace cadt::test
