// SPDX-License-Identifier: Apache-2.0
// What the tests of points and meshes in device memory share. Each runs on every back end from the same source.
#pragma once

#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/system/resident/device_memory.hpp"

namespace cadt::test {

/// Number of the device that the tests use: a GPU if there is one; -1 if there is none.
[[nodiscard]] int device_index(Backend backend);

/// The reference: the serial host.
[[nodiscard]] Triangulation on_host(PointsView points);

/// The mesh of a set that several tests use, and the set.
struct Known {
  explicit Known(Points points) : xy(std::move(points)), mesh(on_host(std::span<const double>(xy))) {}
  [[nodiscard]] std::size_t size() const { return xy.size() / 2; }
  Points xy;
  Triangulation mesh;
};

/// The arrays of the device, read by the test's own means, the counts, and the copy on the host.
void expect_same(DeviceMemory& memory, const DeviceTriangulation& found, const Triangulation& expected);
/// A copy on the host.
void expect_same(const Triangulation& found, const Triangulation& expected);

/// Calls `work`, which must throw Exception; null and a failure if it does not.
template <class Exception, class Work>
std::unique_ptr<Exception> thrown(const Work& work) {
  try {
    work();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const Exception& exception) {
    return std::make_unique<Exception>(exception);
  } catch (const std::exception& exception) {
    ADD_FAILURE() << "another exception: " << exception.what();
  }
  return nullptr;
}

/// Allocates through the test's own calls, counts what is live, and has no memory left when asked to refuse.
class CountingAllocator final : public DeviceAllocator {
 public:
  explicit CountingAllocator(DeviceMemory& memory) : memory_(memory) {}
  ~CountingAllocator() override;
  [[nodiscard]] void* allocate(std::size_t bytes, void* queue) noexcept override;
  void deallocate(void* memory, std::size_t bytes, void* queue) noexcept override;

  static constexpr std::size_t never = ~std::size_t{0};
  /// The next call with this number, counted from 0 now, gives null, and the ones after it if `and_later`.
  void fail_at(std::size_t call, bool and_later = true);

  std::size_t calls = 0;  ///< of allocate
  std::size_t refused = 0;
  std::size_t bytes_live = 0;
  std::string fault;  ///< the first wrong argument
  [[nodiscard]] std::size_t live() const { return live_.size(); }

 private:
  void note(const std::string& text) {
    if (fault.empty()) fault = text;
  }
  DeviceMemory& memory_;
  std::map<void*, std::size_t> live_;
  std::size_t until_failure_ = never;
  bool and_later_ = true;
};

/// With memory of the test's on the device, and its queue in the options.
class ResidentTest : public BackendTest {
 protected:
  void SetUp() override;
  [[nodiscard]] Options options() const;
  [[nodiscard]] std::shared_ptr<CountingAllocator> counting() const {
    return std::make_shared<CountingAllocator>(*memory);
  }
  [[nodiscard]] DevicePoints upload(const Points& xy) const {
    return {.x = memory->upload(std::span<const double>(xy)), .size = xy.size() / 2};
  }
  std::unique_ptr<DeviceMemory> memory;
};

}  // namespace cadt::test
