// SPDX-License-Identifier: Apache-2.0
// Control of the concurrency tests: without locks they must fail. A stress test without a control proves nothing.
#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace {

TEST(WithoutLocks, ThreadsBreakTheMesh) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> xy(2 * 20000);
  for (double& v : xy) v = unit(random);
  cadt::Options options;
  options.backend = cadt::Backend::host;
  options.threads = 1;
  const auto expected = cadt::triangulate(std::span<const double>(xy), options).hash();  // nobody to conflict with
  options.threads = 4;
  int broken = 0;
  constexpr int runs = 60;
  for (int run = 0; run < runs && broken == 0; ++run) {
    try {
      if (cadt::triangulate(std::span<const double>(xy), options).hash() != expected) ++broken;
    } catch (const cadt::InternalError&) {
      ++broken;  // the closing pass or the hull found the mesh in pieces
    }
  }
  EXPECT_GT(broken, 0) << "the threads never met in " << runs << " runs";
}

}  // namespace
