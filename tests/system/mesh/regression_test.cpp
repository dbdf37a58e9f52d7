// SPDX-License-Identifier: Apache-2.0
// Sets and options that once failed.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>

namespace cadt::test {
namespace {

class Regression : public BackendTest {};

// A row of points, one far below and one far above: the last one, when inserted, causes a cascade of n flips.
// The cascade was spread over launches of a few flips, and 64 such launches counted as no progress: InternalError.
Points row_and_two_hubs(int n) {
  Points xy;
  for (int i = 0; i < n - 2; ++i) xy.insert(xy.end(), {static_cast<double>(i), 0.0});
  xy.insert(xy.end(), {0.0, -static_cast<double>(n), n - 1.0, static_cast<double>(n)});
  return xy;
}

// Three lines one unit in the last place apart: long flip cascades in a mesh of slivers.
Points nearly_collinear(int n) {
  Points xy;
  Random random(5);
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform();
    xy.insert(xy.end(), {x, x / 3 + static_cast<double>(random.below(3)) * 0x1p-54});
  }
  return xy;
}

TEST_P(Regression, LongFlipCascadesAreProgress) {
  for (const int n : {1000, 5000, 40000}) {
    const Points xy = row_and_two_hubs(n);
    const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
    EXPECT_TRUE(verified(xy, mesh)) << n;
    // a launch does many flips of a cascade: 16 on GPUs, where a single lane is slow
    EXPECT_LT(mesh.statistics().launches, 200u + static_cast<unsigned>(n) / 8) << n;
  }
}

TEST_P(Regression, NearlyCollinearPointsAreProgress) {
  const Points xy = nearly_collinear(20000);
  const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
  EXPECT_TRUE(verified(xy, mesh));
}

// Two lines that part, whose points alternate in sorted order: the last level inserted all of one line into a mesh of
// the other, with n / 8 flips a point.
TEST_P(Regression, AlternatingLinesAreNotQuadratic) {
  Points xy;
  const int n = 20000;
  for (int i = 0; i < n; ++i) xy.insert(xy.end(), {static_cast<double>(i), i % 2 == 0 ? 0.0 : 1e-5 * i});
  const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
  EXPECT_TRUE(verified(xy, mesh));
  // It was 2500 n. On GPUs thousands of points come at once: 13 n to 85 n were seen.
  EXPECT_LT(mesh.statistics().flips, (GetParam().backend == Backend::host ? 10u : 400u) * n);
}

// Exponents that span everything went to exact arithmetic for nearly every sign: 90 exact orientations a point.
TEST_P(Regression, WideRangesAreFilteredToo) {
  Points xy;
  Random random(9);
  const int n = 4000;
  for (int i = 0; i < n; ++i) xy.insert(xy.end(), {std::exp(random.uniform(-500, 500)), random.uniform()});
  const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
  EXPECT_TRUE(verified(xy, mesh));
  EXPECT_TRUE(mesh.statistics().wide_arithmetic);
  EXPECT_LT(mesh.statistics().exact_orientations + mesh.statistics().exact_incircles, 4u * n);
}

// The number of a work-item times its grain left 32 bits where work-items are rounded up to whole groups, so elements
// had two owners.
TEST_P(Regression, AnyGrainCutsTheWorkOnce) {
  const Points xy = uniform_points(3000);
  for (const unsigned group : {0u, 4u, 64u}) {
    for (const unsigned grain : {1u << 26, 1u << 30, 1u << 31, ~0u}) {
      Options options = GetParam().options();
      options.tuning.work_group_size = group;
      options.tuning.grain = grain;
      EXPECT_TRUE(verified(xy, triangulate(std::span<const double>(xy), options))) << group << " and " << grain;
    }
  }
}

CADT_ON_EVERY_BACKEND(Regression);

}  // namespace
}  // namespace cadt::test
