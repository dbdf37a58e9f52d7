// SPDX-License-Identifier: Apache-2.0
// The check of the library's own result.
#include "rejection.hpp"

namespace {

cadt::Triangulation mesh_of(const std::vector<double>& xy) {
  cadt::Options options;
  options.backend = cadt::Backend::host;
  options.threads = 1;
  return cadt::triangulate(std::span<const double>(xy), options);
}

VerifyReport verify_own(const std::vector<double>& xy, const cadt::Triangulation& mesh) {
  return verify(std::span<const double>(xy), mesh, {2, true});
}

TEST(OwnResult, AcceptedInEveryDimension) {
  const std::vector<double> random = random_points(200, 1), grid = lattice(8, 9).xy;
  for (const std::vector<double>& xy :
       {std::vector<double>{}, {1, 2}, {1, 2, 1, 2}, {0, 0, 1, 1, 2, 2}, random, grid}) {
    const VerifyReport report = verify_own(xy, mesh_of(xy));
    EXPECT_TRUE(report.ok) << report.summary();
  }
}

TEST(OwnResult, OfOtherPointsIsRejected) {
  const std::vector<double> random = random_points(200, 1);
  const cadt::Triangulation mesh = mesh_of(random);
  expect_killed_by(verify_own(random_points(200, 2), mesh), "orientation");
  std::vector<double> more = random;
  more.insert(more.end(), {0.5, 0.5});
  expect_killed_by(verify_own(more, mesh), "counts");
  expect_killed_by(verify_own(more, mesh), "vertices");
}

TEST(OwnResult, WrongDimensionIsRejected) {
  // Without triangles and duplicates, two collinear points and one differ in nothing but the dimension and the count.
  const std::vector<double> one{1, 2}, line{0, 0, 1, 1}, none;
  expect_killed_by(verify_own(line, mesh_of(one)), "counts");
  expect_killed_by(verify_own(none, mesh_of(one)), "counts");
}

}  // namespace
