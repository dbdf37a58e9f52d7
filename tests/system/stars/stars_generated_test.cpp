// SPDX-License-Identifier: Apache-2.0
// The sets that `cadt generate` makes: with stars the same mesh as by insertion.
#include "tests/support/backends.hpp"

#include <cadt/io/generate.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>

namespace cadt::test {
namespace {

class StarsOfGenerated : public BackendTest {};

TEST_P(StarsOfGenerated, EveryDistributionAndSize) {
  Options options;
  options.backend = Backend::host;
  options.threads = 1;
  options.tuning.strategy = Strategy::locks;
  Triangulator locks(options);
  options = GetParam().options();
  options.tuning.strategy = Strategy::stars;
  Triangulator stars(options);
  std::size_t proven = 0;
  for (const io::Distribution& distribution : io::distributions()) {
    for (const std::size_t n : {3u, 4u, 5u, 100u, 1000u, 20000u}) {
      SCOPED_TRACE(std::string(distribution.name) + ", " + std::to_string(n));
      io::PointSet set;
      try {
        set = io::generate(distribution.name, {.n = n, .seed = n});
      } catch (const std::invalid_argument&) {
        ASSERT_LT(n, 100u) << "only small numbers may be refused";
        continue;
      }
      const std::span<const double> points(set.xy);
      const Triangulation expected = locks.triangulate(points), mesh = stars.triangulate(points);
      ASSERT_TRUE(std::ranges::equal(mesh.triangles(), expected.triangles()));
      ASSERT_TRUE(std::ranges::equal(mesh.neighbors(), expected.neighbors()));
      ASSERT_TRUE(std::ranges::equal(mesh.hull(), expected.hull()));
      ASSERT_TRUE(std::ranges::equal(mesh.duplicates(), expected.duplicates()));
      ASSERT_EQ(mesh.dimension(), expected.dimension());
      proven += mesh.statistics().proven_stars;
    }
  }
  EXPECT_GT(proven, 100000u);
}

CADT_ON_MAIN_BACKENDS(StarsOfGenerated);

}  // namespace
}  // namespace cadt::test
