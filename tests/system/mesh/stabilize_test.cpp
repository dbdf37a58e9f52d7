// SPDX-License-Identifier: Apache-2.0
// Stabilised flipping (paper, Algorithm 4): deferring changes nothing in the mesh; the paper's rule leaves a valid mesh
// with few and counted illegal edges.
#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/mesh_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace cadt::test {
namespace {

using Reals = std::span<const double>;

/// The paper's perturbed circles: eight points on each circle of a grid, displaced by up to 1e-4 cells.
Points circles(int cells) {
  Points xy;
  Random random(13);
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const Points circle = regular_polygon(8, i, j, 0.35);
      for (const double value : circle) xy.push_back(value + random.uniform(-1e-4, 1e-4));
    }
  }
  return xy;
}

struct NamedSet {
  std::string name;
  Points xy;
};

/// Every kind of set, small; those with long flip cascades among them.
std::vector<NamedSet> every_family() {
  std::vector<NamedSet> sets;
  for (const FamilyGroup& group : family_groups())
    for (const Family& family : group.families()) sets.push_back({family.name, family.make()});
  return sets;
}

/// All that verify() checks but whether the edges are Delaunay's.
testing::AssertionResult valid_structure(const Points& xy, const Triangulation& mesh) {
  const VerifyReport report = verify(Reals(xy), mesh);
  for (const Check& check : report.checks)
    if (!check.passed && check.name != "delaunay" && check.name != "ties")
      return testing::AssertionFailure() << check.name << ": " << check.what;
  return testing::AssertionSuccess();
}

class Stabilize : public BackendTest {};

TEST_P(Stabilize, DeferIsTheSameMesh) {
  for (const auto& [name, xy] : every_family()) {
    SCOPED_TRACE(name);
    Options options = GetParam().options();
    const Triangulation off = triangulate(Reals(xy), options);
    options.tuning.stabilize = cadt::Stabilize::defer;
    for (const unsigned threshold : {0U, 3U}) {
      options.tuning.flip_threshold = threshold;
      const Triangulation deferred = triangulate(Reals(xy), options);
      ASSERT_TRUE(std::ranges::equal(deferred.triangles(), off.triangles()));
      ASSERT_TRUE(std::ranges::equal(deferred.neighbors(), off.neighbors()));
      ASSERT_TRUE(deferred.statistics().certified);
      ASSERT_EQ(deferred.statistics().illegal_edges, 0u);
    }
  }
}

TEST_P(Stabilize, DeferDefers) {
  const Points xy = uniform_points(50000, 5);
  Options options = GetParam().options();
  const Triangulation off = triangulate(Reals(xy), options);
  EXPECT_EQ(off.statistics().stabilized_edges, 0u);
  options.tuning.stabilize = cadt::Stabilize::defer;
  const Triangulation deferred = triangulate(Reals(xy), options);
  EXPECT_GT(deferred.statistics().stabilized_edges, 1000u);
  EXPECT_GT(deferred.statistics().sweep_repairs, 1000u);
  EXPECT_GT(deferred.statistics().legality_sweeps, 1u);
  EXPECT_EQ(deferred.hash(), off.hash());
  // Nothing is left to do for a threshold that no edge reaches.
  options.tuning.flip_threshold = 1000;
  EXPECT_EQ(triangulate(Reals(xy), options).statistics().stabilized_edges, 0u);
}

TEST_P(Stabilize, PaperLeavesFewEdgesAndSaysSo) {
  for (const auto& [name, xy] : {NamedSet{"uniform", uniform_points(100000, 6)}, NamedSet{"circles", circles(112)}}) {
    SCOPED_TRACE(name);
    Options options = GetParam().options();
    const Triangulation exact = triangulate(Reals(xy), options);
    EXPECT_TRUE(exact.statistics().certified);
    options.tuning.stabilize = cadt::Stabilize::paper;
    const Triangulation mesh = triangulate(Reals(xy), options);
    const Statistics& s = mesh.statistics();
    const std::size_t differing = count_differing(mesh, exact);
    EXPECT_TRUE(valid_structure(xy, mesh));
    EXPECT_EQ(mesh.number_of_triangles(), exact.number_of_triangles());
    EXPECT_LT(static_cast<double>(differing), 0.003 * static_cast<double>(mesh.number_of_triangles()));
    // The count is right: an independent check finds as many edges that are not Delaunay's.
    const VerifyReport report = verify(Reals(xy), mesh);
    std::uint64_t found = 0;
    for (const Check& check : report.checks)
      if (check.name == "delaunay" || check.name == "ties") found += check.failures;
    EXPECT_EQ(s.illegal_edges, found);
    EXPECT_EQ(s.certified_edges + s.illegal_edges, 3 * s.distinct - 3);
    EXPECT_EQ(s.certified, found == 0);
    EXPECT_EQ(s.certified, differing == 0);
    EXPECT_GE(s.stabilized_edges, s.illegal_edges);
    if (name == "circles") {
      EXPECT_GT(s.illegal_edges, 0u);
    }
  }
}

// With R = 0 and an epsilon that nothing exceeds each edge is flipped once, but those of the hull.
TEST_P(Stabilize, PaperObeysItsParameters) {
  const Points xy = uniform_points(3000, 7);
  Options options = GetParam().options();
  options.tuning.stabilize = cadt::Stabilize::paper;
  options.tuning.flip_threshold = 0;
  options.tuning.quality_epsilon = 1000;
  const Triangulation none = triangulate(Reals(xy), options);
  EXPECT_TRUE(valid_structure(xy, none));
  EXPECT_GT(none.statistics().illegal_edges, 1000u);
  EXPECT_GT(none.statistics().flips_per_edge[1], 1000u);
  EXPECT_LT(none.statistics().flips_per_edge[2], 100u);
  options.tuning.quality_epsilon = 0;  // every gain is taken: the mesh is Delaunay's
  const Triangulation all = triangulate(Reals(xy), options);
  EXPECT_TRUE(all.statistics().certified);
  EXPECT_EQ(all.hash(), triangulate(Reals(xy), GetParam().options()).hash());
}

TEST_P(Stabilize, PaperOnEveryFamilyIsAValidMesh) {
  for (const auto& [name, xy] : every_family()) {
    SCOPED_TRACE(name);
    Options options = GetParam().options();
    options.tuning.stabilize = cadt::Stabilize::paper;
    options.tuning.flip_threshold = 1;
    const Triangulation mesh = triangulate(Reals(xy), options);
    ASSERT_TRUE(valid_structure(xy, mesh));
  }
}

TEST_P(Stabilize, RefusesWhatItCannotCount) {
  const Points xy = uniform_points(10);
  Options options = GetParam().options();
  options.tuning.flip_threshold = 1001;
  try {
    static_cast<void>(triangulate(Reals(xy), options));
    FAIL() << "accepted";
  } catch (const OptionError& e) {
    EXPECT_EQ(e.option(), "tuning.flip_threshold");
  }
  options.tuning.flip_threshold = 3;
  for (const double epsilon : {-1e-9, std::numeric_limits<double>::quiet_NaN()}) {
    options.tuning.quality_epsilon = epsilon;
    EXPECT_THROW(static_cast<void>(triangulate(Reals(xy), options)), OptionError);
  }
}

CADT_ON_MAIN_BACKENDS(Stabilize);

}  // namespace
}  // namespace cadt::test
