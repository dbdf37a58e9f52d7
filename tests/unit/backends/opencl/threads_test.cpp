// SPDX-License-Identifier: Apache-2.0
// Several devices in one process, at once.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include "tests/unit/backends/opencl/support.hpp"

namespace cadt::test {
namespace {

class OpenClThreads : public OpenClTest {
 protected:
  /// Each thread opens the device and counts, many times; returns how many counts were wrong.
  int wrong_counts(bool fresh, int threads, int rounds) const {
    std::atomic<int> wrong{0}, ready{0};
    std::vector<std::thread> pool;
    for (int t = 0; t < threads; ++t)
      pool.emplace_back([&, t] {
        opencl::OpenRequest request = small();
        request.fresh = fresh;
        for (++ready; ready < threads;) std::this_thread::yield();
        try {
          const auto device = opencl::open_device(request);
          for (int i = 0; i < rounds; ++i) {
            const auto items = static_cast<std::uint32_t>(1 + 997 * t + 31 * i);
            if (counted_items(*device, items) != items) ++wrong;
          }
        } catch (const std::exception& error) {
          ADD_FAILURE() << error.what();
        }
      });
    for (std::thread& thread : pool) thread.join();
    return wrong;
  }
};

TEST_F(OpenClThreads, ContextEach) { EXPECT_EQ(wrong_counts(true, 2, 100), 0); }
TEST_F(OpenClThreads, OneContext) { EXPECT_EQ(wrong_counts(false, 4, 100), 0); }

TEST_F(OpenClThreads, SecondOpenIsCheap) {
  using Clock = std::chrono::steady_clock;
  opencl::OpenRequest request = small();
  request.fresh = false;
  request.extra_options = "-DCADT_TEST_MARK=3";  // not opened by another test of this process
  bool built = true;
  const ScopedVariable no_cache("CADT_CACHE_DIR", "");
  const auto first_start = Clock::now();
  const auto first = opencl::open_device(request);
  const auto first_time = Clock::now() - first_start;
  request.from_cache = &built;  // would be set to false by a build
  auto second_time = first_time;
  std::unique_ptr<Device> second;
  for (int i = 0; i < 5; ++i) {  // the best of five: other processes may take the processor
    const auto start = Clock::now();
    second = opencl::open_device(request);
    second_time = std::min(second_time, Clock::now() - start);
  }
  EXPECT_TRUE(built);
  EXPECT_LT(second_time * 4, first_time);
  EXPECT_EQ(counted_items(*second, 77), 77u);
  EXPECT_EQ(counted_items(*first, 78), 78u);
}

}  // namespace
}  // namespace cadt::test
