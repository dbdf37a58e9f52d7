// SPDX-License-Identifier: Apache-2.0
#include "tests/system/constrained/constrained_check.hpp"

#include "tests/support/oracle_cdt.hpp"
#include "tests/system/constrained/resident_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace cadt::test {
namespace {

constexpr std::size_t most_in_device_memory = 5000;

/// Each set is asked for one of the domains.
ConstraintOptions domain_of(std::size_t segments) {
  ConstraintOptions constraints;
  constraints.domain = static_cast<Domain>(segments % 6);
  if (constraints.domain != Domain::seeds) return constraints;
  constraints.holes = {{0.5, 0.5}, {9, 9}};
  constraints.regions = {{0.25, 0.25, 7}, {1, 2, 8}, {0.25, 0.25, 9}};
  return constraints;
}

}  // namespace

ConstrainedTriangulation ConstrainedTest::triangulated(const Points& xy, const std::vector<Segment>& segments,
                                                       const ConstraintOptions& constraints) const {
  return triangulate_constrained(xy, segments, constraints, GetParam().options());
}

ConstrainedTriangulation ConstrainedTest::check(const Points& xy, const std::vector<Segment>& segments,
                                                std::size_t most_for_cgal) const {
  const ConstrainedTriangulation mesh = triangulated(xy, segments);
  const VerifyReport report = verify(xy, segments, mesh);
  EXPECT_TRUE(report.ok) << report.summary();
  if (xy.size() / 2 <= most_in_device_memory)
    expect_same_in_device_memory(GetParam().options(), xy, segments, domain_of(segments.size()));
#if CADT_TEST_CGAL
  if (xy.size() / 2 > most_for_cgal) return mesh;
  const ConstrainedOracleMesh expected = cgal_constrained(xy, segments);
  std::vector<Triangle> triangles;
  for (std::size_t t = 0; t < mesh.mesh().number_of_triangles(); ++t) triangles.push_back(mesh.mesh().triangle(t));
  make_canonical(triangles);
  EXPECT_EQ(mesh.mesh().dimension(), expected.mesh.dimension);
  EXPECT_TRUE(triangles == expected.mesh.triangles)
      << triangles.size() << " triangles, CGAL has " << expected.mesh.triangles.size();
  EXPECT_TRUE(std::ranges::equal(mesh.constrained_edges(), expected.edges))
      << mesh.constrained_edges().size() << " constrained edges, CGAL has " << expected.edges.size();
#else
  static_cast<void>(most_for_cgal);
#endif
  return mesh;
}

std::int32_t Drawing::add(double x, double y) {
  xy.push_back(x);
  xy.push_back(y);
  return static_cast<std::int32_t>(points()) - 1;
}

void Drawing::join(const std::vector<std::int32_t>& along) {
  for (std::size_t i = 1; i < along.size(); ++i) join(along[i - 1], along[i]);
}

}  // namespace cadt::test
