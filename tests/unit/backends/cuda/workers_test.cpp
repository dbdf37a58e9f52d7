// SPDX-License-Identifier: Apache-2.0
// Threads that copy together: each call is done when it returns, and no thread works for an earlier one.
#include "backends/cuda/workers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <thread>
#include <vector>

namespace cadt::cuda {
namespace {

TEST(Workers, FinishEachCall) {
  constexpr std::size_t items = 64;
  Workers workers;
  for (std::size_t round = 0; round < 3000; ++round) {
    const std::size_t count = 1 + round % 9;
    std::vector<std::size_t> done(items), calls(count);
    std::atomic<std::size_t> next = 0;
    workers.run(count, [&](std::size_t self) {
      ++calls.at(self);
      for (std::size_t i; (i = next++) < items;) done[i] = round + i;
    });
    for (std::size_t i = 0; i < items; ++i) ASSERT_EQ(done[i], round + i);
    EXPECT_EQ(calls[0], 1U);
    for (const std::size_t of_one : calls) EXPECT_LE(of_one, 1U);
  }
}

TEST(Workers, WorkAtTheSameTime) {
  Workers workers;
  std::atomic<int> here = 0;
  workers.run(3, [&](std::size_t) {
    ++here;
    while (here < 3) std::this_thread::yield();  // all must come
  });
  EXPECT_EQ(here, 3);
}

TEST(Workers, ThoseThatCameAreWaitedFor) {
  Workers workers;
  for (int round = 0; round < 20; ++round) {
    std::atomic<bool> came = false, done = false;
    workers.run(2, [&](std::size_t self) {
      if (self == 0) {
        while (!came) std::this_thread::yield();
        return;
      }
      came = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      done = true;
    });
    ASSERT_TRUE(done) << round;
  }
}

TEST(Workers, MayBeLeftWithoutWork) { const Workers workers; }

}  // namespace
}  // namespace cadt::cuda
