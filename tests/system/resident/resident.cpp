// SPDX-License-Identifier: Apache-2.0
#include "tests/system/resident/resident.hpp"

#include "tests/support/device_choice.hpp"

namespace cadt::test {
namespace {

std::vector<std::int32_t> list(std::span<const std::int32_t> values) { return {values.begin(), values.end()}; }
std::vector<Duplicate> list(std::span<const Duplicate> values) { return {values.begin(), values.end()}; }

/// Only says whether they are equal: the arrays are too long to be printed.
template <class Found, class Expected>
void expect_equal(const char* what, const Found& found, const Expected& expected) {
  ASSERT_EQ(found.size(), expected.size()) << what;
  EXPECT_TRUE(list(found) == list(expected)) << what << " differ";
}

}  // namespace

int device_index(Backend backend) {
  int any = -1;
  for (const DeviceInfo& info : list_devices()) {
    if (info.backend != backend || info.index < 0 || !info.usable || !is_chosen(info)) continue;
    if (info.gpu) return info.index;
    if (any < 0) any = info.index;
  }
  return any;
}

Triangulation on_host(PointsView points) {
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  return Triangulator(options).triangulate(points);  // not the device that the thread keeps, which tests may count
}

void expect_same(const Triangulation& found, const Triangulation& expected) {
  EXPECT_EQ(found.number_of_points(), expected.number_of_points());
  EXPECT_EQ(found.number_of_triangles(), expected.number_of_triangles());
  EXPECT_EQ(found.dimension(), expected.dimension());
  expect_equal("triangles", found.triangles(), expected.triangles());
  expect_equal("neighbours", found.neighbors(), expected.neighbors());
  expect_equal("hulls", found.hull(), expected.hull());
  expect_equal("duplicates", found.duplicates(), expected.duplicates());
  EXPECT_EQ(found.hash(), expected.hash());
}

void expect_same(DeviceMemory& memory, const DeviceTriangulation& found, const Triangulation& expected) {
  const std::size_t triangles = expected.number_of_triangles(), duplicates = expected.duplicates().size();
  ASSERT_EQ(found.number_of_points(), expected.number_of_points());
  ASSERT_EQ(found.number_of_triangles(), triangles);
  ASSERT_EQ(found.number_of_duplicates(), duplicates);
  EXPECT_EQ(found.dimension(), expected.dimension());
  EXPECT_EQ(found.triangles() == nullptr, triangles == 0);
  EXPECT_EQ(found.neighbors() == nullptr, triangles == 0);
  EXPECT_EQ(found.duplicate_points() == nullptr, duplicates == 0);
  EXPECT_EQ(found.representatives() == nullptr, duplicates == 0);
  expect_equal("triangles on the device",
               std::span<const std::int32_t>(memory.download<std::int32_t>(found.triangles(), 3 * triangles)),
               expected.triangles());
  expect_equal("neighbours on the device",
               std::span<const std::int32_t>(memory.download<std::int32_t>(found.neighbors(), 3 * triangles)),
               expected.neighbors());
  const auto points = memory.download<std::int32_t>(found.duplicate_points(), duplicates);
  const auto representatives = memory.download<std::int32_t>(found.representatives(), duplicates);
  std::vector<Duplicate> pairs;
  for (std::size_t i = 0; i < points.size(); ++i) pairs.push_back({points[i], representatives[i]});
  expect_equal("duplicates on the device", std::span<const Duplicate>(pairs), expected.duplicates());
  expect_same(found.download(), expected);
}

CountingAllocator::~CountingAllocator() { EXPECT_EQ(live_.size(), 0U) << "memory was not freed"; }

void CountingAllocator::fail_at(std::size_t call, bool and_later) {
  until_failure_ = call;
  and_later_ = and_later;
  refused = 0;
}

void* CountingAllocator::allocate(std::size_t bytes, void* queue) noexcept {
  ++calls;
  if (queue != memory_.queue()) note("allocate with another queue");
  if (bytes == 0) note("allocate of no bytes");
  if (until_failure_ == 0) {
    ++refused;
    if (!and_later_) until_failure_ = never;
    return nullptr;
  }
  if (until_failure_ != never) --until_failure_;
  void* memory = memory_.allocate(bytes);
  if (memory == nullptr) return nullptr;
  if (!live_.emplace(memory, bytes).second) note("memory that is in use was given twice");
  bytes_live += bytes;
  return memory;
}

void CountingAllocator::deallocate(void* memory, std::size_t bytes, void* queue) noexcept {
  if (queue != memory_.queue()) note("deallocate with another queue");
  const auto at = live_.find(memory);
  if (at == live_.end()) return note("deallocate of memory that was not allocated, or twice");
  if (at->second != bytes)
    note("deallocate of " + std::to_string(bytes) + " bytes that were " + std::to_string(at->second));
  bytes_live -= at->second;
  live_.erase(at);
  memory_.free(memory);
}

void ResidentTest::SetUp() {
  BackendTest::SetUp();
  if (IsSkipped() || HasFatalFailure()) return;
  const Backend backend = GetParam().backend;
  memory = device_memory(backend, device_index(backend));
  ASSERT_NE(memory, nullptr);
}

Options ResidentTest::options() const {
  Options options = GetParam().options();
  if (options.backend == Backend::host) return options;
  options.device = std::to_string(device_index(options.backend));
  options.queue = memory->queue();
  return options;
}

}  // namespace cadt::test
