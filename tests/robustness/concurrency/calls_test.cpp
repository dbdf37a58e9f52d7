// SPDX-License-Identifier: Apache-2.0
// Calls from several threads at once.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"
#include "tests/support/portable.hpp"

#include <gtest/gtest.h>

#include <exception>
#include <span>
#include <thread>
#include <vector>

namespace cadt::test {
namespace {

// Cocircular points, equal points and points on the hull's edges in one set.
Points mixed_points() {
  Points xy = shuffled(grid_points(30, 30), 2);
  const Points circle = regular_polygon(100, 15, 15, 9);
  xy.insert(xy.end(), circle.begin(), circle.end());
  xy.insert(xy.end(), xy.begin() + 100, xy.begin() + 200);
  return xy;
}

class Calls : public BackendTest {};

TEST_P(Calls, FromSeveralThreads) {
  const Points first = mixed_points(), second = cluster_points(1500);
  const ExpectedMesh expected[2] = {expected_mesh(first), expected_mesh(second)};
  std::vector<testing::AssertionResult> results(4, testing::AssertionFailure() << "did not run");
  {
    std::vector<JoinedThread> callers;
    for (std::size_t c = 0; c < results.size(); ++c) {
      callers.emplace_back([&, c] {
        for (int run = 0; run < 3; ++run) {
          try {
            const Points& xy = c % 2 ? second : first;
            results[c] = same_mesh(triangulate(std::span<const double>(xy), GetParam().options()), expected[c % 2]);
          } catch (const std::exception& error) {
            results[c] = testing::AssertionFailure() << error.what();
          }
          if (!results[c]) return;
        }
      });
    }
  }
  for (const auto& result : results) EXPECT_TRUE(result);
}

CADT_ON_EVERY_BACKEND(Calls);

}  // namespace
}  // namespace cadt::test
