// SPDX-License-Identifier: Apache-2.0
// Meshes that are wrong as a whole although their triangles may each be good, and meshes without triangles.
#include "rejection.hpp"

#include <cmath>
#include <numbers>

namespace {

TEST(KillTopology, FlatTriangleOnTheHull) {
  TestMesh m;
  m.xy = {0, 0, 1, 0, 2, 0, 1, 1};
  m.triangles = {0, 2, 3, 0, 1, 2};
  m.complete();
  expect_killed_by(verify_full(m), "orientation");
  EXPECT_EQ(check_of(verify_full(m), "orientation").first, 1);
}

TEST(KillTopology, TrianglesThatOnlyTouch) {
  TestMesh m;
  m.xy = {0, 0, 1, 0, 1, 1, -1, 0, -1, -1};
  m.triangles = {0, 1, 2, 0, 3, 4};
  expect_killed_by(verify_bare(m), "boundary");
  EXPECT_NE(check_of(verify_bare(m), "boundary").what.find("not the only boundary edge"), std::string::npos);
}

TEST(KillTopology, EdgeUsedTwiceInTheSameDirection) {
  TestMesh m;
  m.xy = {0, 0, 1, 0, 0.5, 1, 0.5, 2};
  m.triangles = {0, 1, 2, 0, 1, 3};
  EXPECT_EQ(failed(verify_bare(m)), Names{"neighbors"});
  EXPECT_EQ(check_of(verify_bare(m), "neighbors").first, 2);
}

TEST(KillTopology, EdgeUsedByThreeTriangles) {
  TestMesh m;
  m.xy = {0, 0, 1, 0, 0.5, 1, 0.5, 2, 0.5, -1};
  m.triangles = {0, 1, 2, 1, 0, 4, 0, 1, 3};
  EXPECT_EQ(failed(verify_bare(m)), Names{"neighbors"});
  EXPECT_EQ(check_of(verify_bare(m), "neighbors").failures, 1U);
}

TEST(KillTopology, TwoComponents) {
  TestMesh m = lattice(3, 3), other = lattice(3, 3);
  for (std::size_t i = 0; i < other.xy.size(); ++i) m.xy.push_back(other.xy[i] + 10);
  for (const std::int32_t v : other.triangles) m.triangles.push_back(v + 9);
  expect_killed_by(verify_bare(m), "boundary");
  expect_killed_by(verify_bare(m), "euler");
}

/// Triangles of a torus on points first .. first + 8.
std::vector<std::int32_t> torus(std::int32_t first) {
  std::vector<std::int32_t> t;
  const auto v = [&](int i, int j) { return first + 3 * (i % 3) + j % 3; };
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      t.insert(t.end(), {v(i, j), v(i + 1, j), v(i, j + 1), v(i + 1, j), v(i + 1, j + 1), v(i, j + 1)});
  return t;
}

TEST(KillTopology, Handle) {
  TestMesh m;
  m.xy = random_points(9, 3);
  m.triangles = torus(0);
  m.triangles.resize(m.triangles.size() - 3);  // one triangle open: the boundary is one cycle
  const VerifyReport report = verify_bare(m);
  EXPECT_TRUE(check_of(report, "boundary").passed) << report.summary();
  expect_killed_by(report, "euler");
}

TEST(KillTopology, ClosedSurface) {
  TestMesh m;
  m.xy = random_points(4, 3);
  m.triangles = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
  expect_killed_by(verify_bare(m), "boundary");
}

/// A disk and a closed torus satisfy Euler's formula of one disk and have one boundary cycle.
TEST(KillTopology, ComponentThatEulersFormulaMisses) {
  TestMesh m = lattice(3, 3);
  const std::vector<double> more = random_points(9, 3);
  m.xy.insert(m.xy.end(), more.begin(), more.end());
  const std::vector<std::int32_t> closed = torus(9);
  m.triangles.insert(m.triangles.end(), closed.begin(), closed.end());
  const VerifyReport report = verify_bare(m);
  EXPECT_TRUE(check_of(report, "boundary").passed);
  expect_killed_by(report, "euler");
  EXPECT_NE(check_of(report, "euler").what.find("not connected"), std::string::npos);
}

/// Every triangle is positive and every turn a left one, but the fan goes around twice.
TEST(KillTopology, HullWoundTwice) {
  TestMesh m;
  m.xy = {0, 0};
  for (std::int32_t i = 0; i < 7; ++i) {
    const double angle = 4 * std::numbers::pi * i / 7;
    m.xy.insert(m.xy.end(), {std::cos(angle), std::sin(angle)});
    m.triangles.insert(m.triangles.end(), {0, 1 + i, 1 + (i + 1) % 7});
  }
  const VerifyReport report = verify_bare(m);
  expect_killed_by(report, "hull");
  EXPECT_TRUE(check_of(report, "orientation").passed);
  EXPECT_TRUE(check_of(report, "euler").passed);
  EXPECT_NE(check_of(report, "hull").what.find("winds 2 times"), std::string::npos);
}

/// The boundary runs from 0 to 1 and straight back to 2: collinear, but not in order.
TEST(KillTopology, HullThatTurnsBack) {
  TestMesh m;
  m.xy = {0, 0, 2, 0, 1, 0, 2, -2, 4, 0, 2, 2};
  m.triangles = {1, 2, 3, 1, 3, 4, 1, 4, 5, 1, 5, 0};
  const VerifyReport report = verify_bare(m);
  expect_killed_by(report, "hull");
  EXPECT_EQ(check_of(report, "hull").first, 1);
  EXPECT_TRUE(check_of(report, "orientation").passed);
}

TEST(KillEmpty, NoTrianglesThoughNotCollinear) {
  const std::vector<double> xy{0, 0, 1, 1, 2, 2, 3, 3 + 0x1p-50};
  const VerifyReport report = on_host_and_devices(std::span<const double>(xy), cadt::MeshView{});
  EXPECT_EQ(failed(report), Names{"vertices"});
  EXPECT_NE(check_of(report, "vertices").what.find("not collinear"), std::string::npos);
}

TEST(KillEmpty, TriangleThoughCollinear) {
  TestMesh m;
  m.xy = {0, 0, 1, 1, 2, 2};
  m.triangles = {0, 1, 2};
  expect_killed_by(verify_bare(m), "orientation");
}

TEST(KillEmpty, HullOfNothing) {
  const std::vector<double> xy{0, 0, 1, 1};
  const std::vector<std::int32_t> hull{0, 1};
  EXPECT_EQ(failed(on_host_and_devices(std::span<const double>(xy), cadt::MeshView{{}, {}, hull, {}, false})),
            Names{"hull"});
}

TEST(KillEmpty, DuplicatesOnALine) {
  const std::vector<double> xy{1, 1, 0.0, 5, 1, 1, -0.0, 5, 1, 1};
  const auto names = [&](const std::vector<cadt::Duplicate>& list) {
    return failed(on_host_and_devices(std::span<const double>(xy), cadt::MeshView{{}, {}, {}, list, true}));
  };
  EXPECT_EQ(names({{2, 0}, {3, 1}, {4, 0}}), Names{});
  EXPECT_EQ(names({{2, 0}, {3, 1}, {4, 2}}), Names{"vertices"});
  EXPECT_EQ(names({{2, 0}, {3, 1}}), Names{"vertices"});
  EXPECT_EQ(names({{2, 0}, {4, 0}, {3, 1}}), Names{"vertices"});
  EXPECT_EQ(names({}), Names{"vertices"});
}

}  // namespace
