// SPDX-License-Identifier: Apache-2.0
// The oracle itself: its counts against numbers that were computed with whole numbers, and its independence of the
// order.
#include "tests/support/data_files.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace cadt::test {
namespace {

void check_counts(const Points& xy, const ExactCounts& counts) {
  const ExpectedMesh mesh = expected_mesh(xy);
  EXPECT_EQ(mesh.representative.size(), counts.points) << counts.name;
  EXPECT_EQ(mesh.duplicates.size(), counts.duplicates) << counts.name;
  EXPECT_EQ(mesh.triangles.size() / 3, counts.triangles) << counts.name;
  EXPECT_EQ(mesh.hull.size(), counts.triangles == 0 ? 0 : counts.hull) << counts.name;
}

TEST(Oracle, HasTheExactCountsOfTheFiles) {
  if (!data_folder()) GTEST_SKIP() << "no data folder: CADT_DATA_DIR is not set and the default is not there";
  for (const ExactCounts& counts : expected_of_files()) check_counts(hard_file(counts.name), counts);
}

TEST(Oracle, HasTheExactCountsOfTheCatalogue) {
  if (!data_folder()) GTEST_SKIP() << "no data folder: CADT_DATA_DIR is not set and the default is not there";
  for (const ExactCounts& counts : expected_of_catalogue()) {
    if (!counts.not_finite) check_counts(catalogue_set(counts.name), counts);
  }
}

TEST(Oracle, DoesNotDependOnTheOrder) {
  for (const char* group : {"grids", "circles", "duplicates"}) {
    for (const FamilyGroup& g : family_groups()) {
      if (g.name != group) continue;
      for (const Family& family : g.families()) {
        const Points xy = family.make();
        const auto order = random_order(xy.size() / 2, 17);
        const ExpectedMesh mesh = expected_mesh(xy), other = expected_mesh(reordered(xy, order));
        std::vector<std::int32_t> back;
        for (const std::size_t i : order) back.push_back(mesh.representative[i]);
        EXPECT_EQ(canonical_set(other.triangles, back), mesh.triangles) << family.name;
      }
    }
  }
}

TEST(FamiliesOfPoints, HaveNamesAndFinitePoints) {
  for (const FamilyGroup& group : family_groups()) {
    std::set<std::string> names;
    for (const Family& family : group.families()) {
      EXPECT_TRUE(names.insert(family.name).second) << family.name;
      for (const double value : family.make()) ASSERT_TRUE(value - value == 0.0) << family.name;
    }
    EXPECT_GE(names.size(), 8u) << group.name;
  }
}

TEST(RealSetsOfPoints, AreRead) {
  if (!data_folder()) GTEST_SKIP() << "no data folder: CADT_DATA_DIR is not set and the default is not there";
  const auto sets = real_sets();
  EXPECT_GT(sets.size(), 100u);
  for (const RealSet& set : sets) {
    if (set.points >= 20000) continue;
    EXPECT_EQ(read(set).size(), 2 * set.points) << set.name;
  }
}

}  // namespace
}  // namespace cadt::test
