// SPDX-License-Identifier: Apache-2.0
// The mesh equals CGAL's, array by array, on every family and every file, for every back end and thread count. As all
// of them are compared with the same arrays, they also equal one another byte for byte.
#include "tests/support/backends.hpp"
#include "tests/support/data_files.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

namespace cadt::test {
namespace {

constexpr std::size_t small_up_to = 16000, medium_up_to = 120000;

class Families : public BackendTest {
 protected:
  void check(std::string_view group) {
    const auto& groups = family_groups();
    const auto found =
        std::find_if(groups.begin(), groups.end(), [&](const FamilyGroup& g) { return g.name == group; });
    ASSERT_NE(found, groups.end()) << group;
    for (const Family& family : found->families()) {
      EXPECT_TRUE(triangulates_as_cgal(family.make(), GetParam().options())) << "family " << family.name;
    }
  }
};

TEST_P(Families, Tiny) { check("tiny"); }
TEST_P(Families, Sizes) { check("sizes"); }
TEST_P(Families, Grids) { check("grids"); }
TEST_P(Families, Tilted) { check("tilted"); }
TEST_P(Families, Scaled) { check("scaled"); }
TEST_P(Families, Circles) { check("circles"); }
TEST_P(Families, Lines) { check("lines"); }
TEST_P(Families, Duplicates) { check("duplicates"); }
TEST_P(Families, Ulps) { check("ulps"); }
TEST_P(Families, Orders) { check("orders"); }
TEST_P(Families, Curves) { check("curves"); }
TEST_P(Families, Clusters) { check("clusters"); }
CADT_ON_EVERY_BACKEND(Families);

class DataTest : public BackendTest {
 protected:
  void SetUp() override {
    BackendTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    if (!data_folder()) GTEST_SKIP() << "no data folder: CADT_DATA_DIR is not set and the default is not there";
  }

  void check(const Points& xy, const ExactCounts& counts) {
    if (counts.not_finite) {
      EXPECT_THROW((void)triangulate(std::span<const double>(xy), GetParam().options()), InputError) << counts.name;
      return;
    }
    const Triangulation mesh = triangulate(std::span<const double>(xy), GetParam().options());
    EXPECT_EQ(mesh.number_of_points(), counts.points) << counts.name;
    EXPECT_EQ(mesh.duplicates().size(), counts.duplicates) << counts.name;
    EXPECT_EQ(mesh.number_of_triangles(), counts.triangles) << counts.name;
    if (counts.triangles > 0) {
      EXPECT_EQ(mesh.hull().size(), counts.hull) << counts.name;
    }
    EXPECT_TRUE(triangulates_as_cgal(xy, GetParam().options())) << counts.name;
  }
};

class HardSets : public DataTest {};

TEST_P(HardSets, Files) {
  const auto files = expected_of_files();
  EXPECT_GT(files.size(), 50u);
  for (const ExactCounts& counts : files) check(hard_file(counts.name), counts);
}

TEST_P(HardSets, Catalogue) {
  const auto ids = expected_of_catalogue();
  EXPECT_GT(ids.size(), 70u);
  for (const ExactCounts& counts : ids) check(catalogue_set(counts.name), counts);
}
CADT_ON_EVERY_BACKEND(HardSets);

class RealSets : public DataTest {
 protected:
  void check_between(std::size_t more_than, std::size_t up_to) {
    std::size_t sets = 0;
    for (const RealSet& set : real_sets()) {
      if (set.points <= more_than || set.points > up_to) continue;
      const Points xy = read(set);
      ASSERT_EQ(xy.size(), 2 * set.points) << set.name;
      EXPECT_TRUE(triangulates_as_cgal(xy, GetParam().options())) << set.name;
      ++sets;
    }
    EXPECT_GT(sets, 0u);
  }
};

TEST_P(RealSets, Small) { check_between(0, small_up_to); }
CADT_ON_EVERY_BACKEND(RealSets);

class LargerRealSets : public RealSets {};
TEST_P(LargerRealSets, Medium) { check_between(small_up_to, medium_up_to); }
TEST_P(LargerRealSets, Large) { check_between(medium_up_to, static_cast<std::size_t>(-1)); }
CADT_ON_MAIN_BACKENDS(LargerRealSets);

// The checks above would say nothing if the comparison could not tell meshes apart.
TEST(Comparison, SeesOtherDiagonal) {
  const Points square = {0, 0, 1, 0, 1, 1, 0, 1};
  Options options;
  options.backend = Backend::host;
  const Triangulation mesh = triangulate(std::span<const double>(square), options);
  ExpectedMesh expected = expected_mesh(square);
  EXPECT_TRUE(same_mesh(mesh, expected));
  for (auto ExpectedMesh::*array :
       {&ExpectedMesh::triangles, &ExpectedMesh::neighbors, &ExpectedMesh::hull, &ExpectedMesh::vertex_triangle}) {
    ExpectedMesh other = expected;
    (other.*array)[1] += 1;
    EXPECT_FALSE(same_mesh(mesh, other));
    other = expected;
    (other.*array).push_back(0);
    EXPECT_FALSE(same_mesh(mesh, other));
  }
  expected.duplicates.push_back({1, 0});
  EXPECT_FALSE(same_mesh(mesh, expected));
}

TEST(Comparison, SeesOtherPoints) {
  Points xy = uniform_points(100);
  Options options;
  options.backend = Backend::host;
  const Triangulation mesh = triangulate(std::span<const double>(xy), options);
  xy[100] += 0.3;
  EXPECT_FALSE(same_mesh(mesh, expected_mesh(xy)));
  EXPECT_FALSE(verified(xy, mesh));
}

}  // namespace
}  // namespace cadt::test
