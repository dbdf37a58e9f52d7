// SPDX-License-Identifier: Apache-2.0
// Threads that copy together: each call is done when it returns, and no thread works for an earlier one.
#include "backends/cuda/workers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
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

TEST(Workers, MayBeLeftWithoutWork) { const Workers workers; }

}  // namespace
}  // namespace cadt::cuda
