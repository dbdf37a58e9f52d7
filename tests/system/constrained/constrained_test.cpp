// SPDX-License-Identifier: Apache-2.0
// Constrained Delaunay triangulations on every back end: the triangles and constrained edges of CGAL, whatever the
// order and the direction of segments.
#include <cadt/constrained.hpp>

#include "tests/support/backends.hpp"
#include "tests/support/families.hpp"
#include "tests/support/oracle_cdt.hpp"
#include "tests/system/constrained/legal_segments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace cadt::test {
namespace {

class Constrained : public BackendTest {
 protected:
  /// The mesh, verified, and compared with CGAL's where that is installed.
  ConstrainedTriangulation check(const Points& xy, const std::vector<Segment>& segments) {
    const ConstrainedTriangulation mesh = triangulate_constrained(xy, segments, {}, GetParam().options());
    const VerifyReport report = verify(xy, segments, mesh);
    EXPECT_TRUE(report.ok) << report.summary();
#if CADT_TEST_CGAL
    const ConstrainedOracleMesh expected = cgal_constrained(xy, segments);
    std::vector<Triangle> triangles;
    for (std::size_t t = 0; t < mesh.mesh().number_of_triangles(); ++t) triangles.push_back(mesh.mesh().triangle(t));
    make_canonical(triangles);
    EXPECT_EQ(mesh.mesh().dimension(), expected.mesh.dimension);
    EXPECT_TRUE(triangles == expected.mesh.triangles)
        << triangles.size() << " triangles, CGAL has " << expected.mesh.triangles.size();
    EXPECT_TRUE(std::ranges::equal(mesh.constrained_edges(), expected.edges));
#endif
    return mesh;
  }
};

TEST_P(Constrained, RandomPoints) {
  std::size_t inserted = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Points xy = uniform_points(5 + 7 * seed, seed);
    inserted += check(xy, legal_segments(xy, 20 + 4 * seed, seed)).statistics().inserted_segments;
  }
  EXPECT_GT(inserted, 500U);
}

TEST_P(Constrained, Families) {
  for (const FamilyGroup& group : family_groups()) {
    for (const Family& family : group.families()) {
      const Points xy = family.make();
      if (xy.size() > 2 * 300) continue;
      SCOPED_TRACE(std::string(group.name) + "/" + family.name);
      check(xy, legal_segments(xy, 60, 7));
    }
  }
}

TEST_P(Constrained, Lattices) {
  for (int columns = 2; columns <= 12; ++columns) {
    SCOPED_TRACE(std::to_string(columns) + " columns");
    const Points xy = grid_points(columns, 12);
    check(xy, legal_segments(xy, 150, static_cast<std::uint64_t>(columns)));
  }
}

TEST_P(Constrained, OrderAndDirectionDoNotMatter) {
  const Points xy = uniform_points(300, 3);
  std::vector<Segment> segments = legal_segments(xy, 200, 5);
  const Hash128 expected = check(xy, segments).hash();
  Random random(11);
  for (int round = 0; round < 10; ++round) {
    for (std::size_t i = segments.size(); i > 1; --i) std::swap(segments[i - 1], segments[random.below(i)]);
    for (Segment& s : segments)
      if (random.below(2) != 0) std::swap(s[0], s[1]);
    EXPECT_EQ(triangulate_constrained(xy, segments, {}, GetParam().options()).hash(), expected);
  }
}

CADT_ON_MAIN_BACKENDS(Constrained);

}  // namespace
}  // namespace cadt::test
