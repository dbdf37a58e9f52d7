// SPDX-License-Identifier: Apache-2.0
// Control of the concurrency tests: without locks they must fail. A stress test without a control proves nothing.
#include <cadt/cadt.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <vector>

#if !defined(_WIN32)
#include <unistd.h>
#endif

namespace {

constexpr int exit_intact = 0, exit_broken = 1;

/// Ends the process with what has become of the mesh.
[[noreturn]] void triangulate_often() {
#if !defined(_WIN32)
  alarm(20);  // a walk around a vertex of a broken mesh may have no end
#endif
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> xy(2 * 20000);
  for (double& v : xy) v = unit(random);
  cadt::Options options;
  options.backend = cadt::Backend::host;
  options.threads = 1;
  const auto expected = cadt::triangulate(std::span<const double>(xy), options).hash();  // nobody to conflict with
  options.threads = 4;
  for (int run = 0; run < 60; ++run) {
    try {
      if (cadt::triangulate(std::span<const double>(xy), options).hash() != expected) std::_Exit(exit_broken);
    } catch (const cadt::InternalError&) {
      std::_Exit(exit_broken);  // the closing pass or the hull found the mesh in pieces
    }
  }
  std::_Exit(exit_intact);
}

TEST(WithoutLocks, ThreadsBreakTheMesh) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      triangulate_often(), [](int status) { return status != exit_intact; }, "")
      << "the threads never met";
}

}  // namespace
