// SPDX-License-Identifier: Apache-2.0
// Triangulator::verify: meshes that never leave the device, good ones and ones with one wrong word.
#include "tests/support/report_checks.hpp"
#include "tests/system/resident/resident.hpp"

#include <algorithm>
#include <array>

namespace cadt::test {
namespace {

class ResidentVerify : public ResidentTest {
 protected:
  /// The check on the host of what is on the device now.
  [[nodiscard]] VerifyReport on_copy(const Points& xy, const DeviceTriangulation& mesh,
                                     const VerifyOptions& options = {}) const {
    const std::size_t values = 3 * mesh.number_of_triangles(), count = mesh.number_of_duplicates();
    const auto triangles = memory->download<std::int32_t>(mesh.triangles(), values);
    const auto neighbors = memory->download<std::int32_t>(mesh.neighbors(), values);
    const auto points = memory->download<std::int32_t>(mesh.duplicate_points(), count);
    const auto representatives = memory->download<std::int32_t>(mesh.representatives(), count);
    std::vector<Duplicate> duplicates;
    for (std::size_t i = 0; i < count; ++i) duplicates.push_back({points[i], representatives[i]});
    return cadt::verify(std::span<const double>(xy), MeshView{triangles, neighbors, {}, duplicates, true}, options);
  }

  [[nodiscard]] std::int32_t word(const void* array, std::size_t at) const {
    std::int32_t value = 0;
    memory->read(array, at * sizeof value, std::as_writable_bytes(std::span(&value, 1)));
    return value;
  }
  void overwrite(void* array, std::size_t at, std::int32_t value) const {
    memory->write(array, at * sizeof value, std::as_bytes(std::span(&value, 1)));
  }

  /// Each word of the list is overwritten, checked, and put back.
  void expect_rejected(Triangulator& triangulator, const Points& xy, const DevicePoints& points,
                       const DeviceTriangulation& mesh, void* array, std::size_t at,
                       const std::vector<std::int32_t>& values) {
    const std::int32_t good = word(array, at);
    for (const std::int32_t value : values) {
      if (value == good) continue;
      SCOPED_TRACE("word " + std::to_string(at) + ": " + std::to_string(value) + " for " + std::to_string(good));
      overwrite(array, at, value);
      const VerifyReport report = triangulator.verify(points, mesh);
      EXPECT_FALSE(report.ok);
      expect_same_report(report, on_copy(xy, mesh));
    }
    overwrite(array, at, good);
  }
};

Points some_points() {
  Points xy = uniform_points(1500, 11);
  const Points lattice = grid_points(20, 20);
  for (std::size_t i = 0; i < lattice.size(); ++i) xy.push_back(0.25 + lattice[i] / 64);
  xy.insert(xy.end(), xy.begin(), xy.begin() + 200);
  return xy;
}

TEST_P(ResidentVerify, GoodMeshes) {
  Triangulator triangulator(options());
  const std::array<Points, 8> sets = {some_points(),      uniform_points(50000), grid_points(80, 60), {1, 2},
                                      {0, 0, 1, 1, 2, 2}, Points(20, 0.5),       {0, 0, 1, 0, 0, 1},  hub_points(500)};
  for (const Order order : {Order::canonical, Order::fast}) {
    triangulator.options().order = order;
    for (const Points& xy : sets) {
      const DevicePoints points = upload(xy);
      const DeviceTriangulation mesh = triangulator.triangulate(points);
      const VerifyReport report = triangulator.verify(points, mesh);
      EXPECT_TRUE(report.ok) << report.summary();
      expect_same_report(report, on_copy(xy, mesh));
    }
  }
  EXPECT_TRUE(triangulator.verify({}, triangulator.triangulate(DevicePoints{})).ok);
}

TEST_P(ResidentVerify, PointsInOtherForms) {
  const Points xy = some_points();
  const std::size_t n = xy.size() / 2;
  std::vector<float> x(3, -7.0F), y(3, 9.0F);
  for (std::size_t i = 0; i < n; ++i) {
    x.push_back(static_cast<float>(xy[2 * i]));
    y.push_back(static_cast<float>(xy[2 * i + 1]));
  }
  const DevicePoints points{.x = memory->upload(std::span<const float>(x)),
                            .y = memory->upload(std::span<const float>(y)),
                            .size = n,
                            .scalar = Scalar::float32,
                            .skip = 3};
  Triangulator triangulator(options());
  const VerifyReport report = triangulator.verify(points, triangulator.triangulate(points));
  EXPECT_TRUE(report.ok) << report.summary();
}

TEST_P(ResidentVerify, OneWrongWord) {
  const Points xy = some_points();
  const DevicePoints points = upload(xy);
  const auto n = static_cast<std::int32_t>(xy.size() / 2);
  Triangulator triangulator(options());
  const DeviceTriangulation mesh = triangulator.triangulate(points);
  const auto count = static_cast<std::int32_t>(mesh.number_of_triangles());
  const auto last = static_cast<std::size_t>(3 * count - 1);
  for (const std::size_t at : {std::size_t{0}, std::size_t{1}, last / 2, last - 1, last}) {
    {
      SCOPED_TRACE("triangles");
      expect_rejected(triangulator, xy, points, mesh, mesh.triangles(), at,
                      {-1, n, 0, n / 2, word(mesh.triangles(), at / 3 * 3 + (at + 1) % 3)});
    }
    {
      SCOPED_TRACE("neighbours");
      expect_rejected(triangulator, xy, points, mesh, mesh.neighbors(), at,
                      {-2, -1, count, 0, count / 2, static_cast<std::int32_t>(at / 3)});
    }
  }
  const std::size_t duplicates = mesh.number_of_duplicates();
  ASSERT_GT(duplicates, 0U);
  for (const std::size_t at : {std::size_t{0}, duplicates - 1}) {
    SCOPED_TRACE("duplicates");
    expect_rejected(triangulator, xy, points, mesh, mesh.duplicate_points(), at, {0, n / 2});
    expect_rejected(triangulator, xy, points, mesh, mesh.representatives(), at, {n / 2});
  }
  const VerifyReport report = triangulator.verify(points, mesh);  // everything has been put back
  EXPECT_TRUE(report.ok) << report.summary();
}

/// A mesh that is one, but not the Delaunay triangulation: the points were changed.
TEST_P(ResidentVerify, OtherPoints) {
  Points xy = uniform_points(2000);
  Triangulator triangulator(options());
  const DeviceTriangulation mesh = triangulator.triangulate(upload(xy));
  xy[200] += 0.01;
  const VerifyReport report = triangulator.verify(upload(xy), mesh);
  EXPECT_FALSE(report.ok);
  expect_same_report(report, on_copy(xy, mesh));
  xy.resize(xy.size() - 2);
  (void)thrown<InputError>([&] { (void)triangulator.verify(upload(xy), mesh); });
}

/// Another diagonal of a square: wrong only by the rule for ties.
TEST_P(ResidentVerify, OtherDecisionOfATie) {
  const Points xy = {0, 0, 1, 0, 0, 1, 1, 1};
  const DevicePoints points = upload(xy);
  Triangulator triangulator(options());
  const DeviceTriangulation mesh = triangulator.triangulate(points);
  ASSERT_EQ(mesh.number_of_triangles(), 2U);
  const auto before = memory->download<std::int32_t>(mesh.triangles(), 6);
  const bool has_0_3 = std::count(before.begin(), before.end(), 0) == 2;
  const std::vector<std::int32_t> triangles = has_0_3 ? std::vector{0, 1, 2, 1, 3, 2} : std::vector{0, 1, 3, 0, 3, 2};
  const std::vector<std::int32_t> neighbors =
      has_0_3 ? std::vector{1, -1, -1, -1, 0, -1} : std::vector{-1, 1, -1, -1, -1, 0};
  memory->write(mesh.triangles(), 0, std::as_bytes(std::span(triangles)));
  memory->write(mesh.neighbors(), 0, std::as_bytes(std::span(neighbors)));
  const VerifyReport report = triangulator.verify(points, mesh);
  EXPECT_FALSE(report.ok);
  expect_same_report(report, on_copy(xy, mesh));
  VerifyOptions any;
  any.canonical_ties = false;
  EXPECT_TRUE(triangulator.verify(points, mesh, any).ok);
}

CADT_ON_MAIN_BACKENDS(ResidentVerify);

}  // namespace
}  // namespace cadt::test
